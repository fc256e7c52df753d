#!/usr/bin/python3
"""Stands in for the executable best_possible, or, called with -m campaigns.tour, for OR-tools' Python.

The world's name says how it goes: `room_obs_15` cannot be surveyed unless the file $FAKE_MENDED
exists. A tour is as long as its speed share allows in ten seconds at 1 m/s, so that each layout can
be told from the others.
"""
import argparse
import json
import os
import pathlib
import sys


def parsed():
    parser = argparse.ArgumentParser()
    parser.add_argument("-m", dest="module")
    parser.add_argument("-c", dest="text")  # whether OR-tools is there
    parser.add_argument("folder", nargs="?")
    for name in ("--world", "--robot", "--out", "--time-limit-s", "--speed-share", "--way-home"):
        parser.add_argument(name)
    parser.add_argument("--set", action="append", default=[])
    return parser.parse_args()


def survey(options):
    with open(os.environ["FAKE_FLIGHTS"], "a", encoding="utf-8") as file:
        file.write(f"survey {options.world} {' '.join(options.set)}\n")
    out = pathlib.Path(options.out)
    seconds = range(int(float(options.time_limit_s)) + 1)
    (out / "bound.csv").write_text("t_s,explored_m3\n" + "".join(f"{t},{20 * t}\n" for t in seconds))
    if options.world == "room_obs_15" and not os.path.exists(os.environ.get("FAKE_MENDED", "")):
        print("best_possible: nothing can be reached", file=sys.stderr)
        return 2
    return 0


def tour(options):
    out = pathlib.Path(options.out)
    length_m = 10 * float(options.speed_share)
    (out / "tour_points.csv").write_text(f"x_m,y_m,z_m\n0,0,0\n{length_m / 2},0,0\n0,0,0\n")
    (out / "tour.json").write_text(json.dumps(
        {"length_m": length_m, "speed_mps": 1.0, "is_cut": length_m < 12}))
    return 0


def main():
    options = parsed()
    if options.text:
        return 0
    return tour(options) if options.module else survey(options)


if __name__ == "__main__":
    sys.exit(main())
