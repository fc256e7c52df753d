#!/usr/bin/python3
"""Stands in for the mission executable: the planner's name says how the mission goes.

Each flight appends "begin NAME" and "end NAME" to the file $FAKE_FLIGHTS. Whatever planner is bad
becomes good where the file $FAKE_MENDED exists. `--set fake.wall_s=2` takes two seconds.
"""
import argparse
import json
import os
import pathlib
import signal
import sys
import time

PLANNERS = ("steady", "brisk", "stranding", "crashing", "hanging", "refusing", "mute", "patient",
            "informed", "instant", "oracle")


def parsed():
    parser = argparse.ArgumentParser()
    parser.add_argument("--world", default="room")
    parser.add_argument("--robot", default="aerial")
    parser.add_argument("--planner", default="steady")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--time-limit-s", type=float, default=10)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--list-params", action="store_true")
    return parser.parse_args()


def note(text):
    with open(os.environ["FAKE_FLIGHTS"], "a", encoding="utf-8") as file:
        file.write(text + "\n")


def refuse(options):
    if options.planner not in PLANNERS:
        print(f"mission: planner \"{options.planner}\" is not known; choose one of: "
              f"{', '.join(PLANNERS)}", file=sys.stderr)
        sys.exit(2)


def misbehave(options):
    if os.path.exists(os.environ.get("FAKE_MENDED", "")):
        return
    if options.planner == "crashing":
        print("about to touch address zero", flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)
    if options.planner in ("hanging", "patient"):
        time.sleep(1000)
    if options.planner == "refusing":
        print("mission: nothing to fly in", file=sys.stderr)
        sys.exit(2)
    if options.planner == "mute":
        sys.exit(0)


def flown_s(options):
    """All its time; on a tour as long as that takes at 1 m/s, or at 2 m/s with `fake.half`."""
    settings = dict(pair.split("=") for pair in options.set)
    if "fake.half" not in settings:
        return options.time_limit_s
    points = pathlib.Path(settings["oracle.tour"]).read_text().splitlines()
    return float(points[2].split(",")[0])


def write(options):
    """What a mission writes, a plain function of the arguments."""
    rate = 10.0 + options.seed + 5 * (options.planner == "brisk")
    is_instant = options.planner == "instant"  # nothing was seen, and less than a second flown
    seconds = range(1, 1 if is_instant else int(flown_s(options)) + 1)
    rows = [f"{t}.000,{rate * t:.3f},{t}.000,{t}.000,{options.seed}.000,1.000,0.000,"
            f"{options.time_limit_s - t:.3f},Explore" for t in seconds]
    (options.out / "timeline.csv").write_text(
        "t_s,explored_m3,distance_m,x_m,y_m,z_m,yaw_rad,remaining_s,state\n"
        + "".join(f"{row}\n" for row in rows))
    clearance_m = 0.5 + 0.01 * options.seed
    (options.out / "clearance.csv").write_text(
        "t_s,clearance_m\n" + "".join(f"{t}.000,{clearance_m:.3f}\n" for t in seconds))
    (options.out / "plans.csv").write_text(
        "t_s,asked,status,kind,vertices,edges,global_vertices,global_edges,wall_ms\n"
        + "".join(f"{t}.000,explore,ok,local,9,12,{t},{2 * t},{10 * t}.000\n" for t in seconds))
    home = options.planner != "stranding"
    explored = "the tour is at its end" if options.planner == "oracle" else "nothing is left"
    (options.out / "summary.json").write_text(json.dumps({
        "planner": options.planner, "world": options.world, "robot": options.robot,
        "seed": options.seed, "time_limit_s": options.time_limit_s,
        "outcome": f"explored: {explored}" if home else "stranded: no way home",
        "mission_time_s": float(len(seconds)), "wall_time_s": time.monotonic(),
        "explored_volume_m3": rate * len(seconds), "reachable_volume_m3": 200.0 * (not is_instant),
        "path_length_m": options.time_limit_s, "collisions": 0 if home else 1, "collision_s": 0.0,
        "min_clearance_m": clearance_m, "returned_home": home,
        "remaining_at_home_s": 3.0 if home else 0.0, "falls": 0, "slips": 0, "trips": 0,
        "zones_marked": 0, "plans": 10, "plan_time_ms": {"median": 1, "p95": 2, "max": 3}}))
    return 0 if home else 1


def main():
    options = parsed()
    refuse(options)
    if options.list_params:
        return 0
    name = f"{options.planner} {options.seed}"
    note(f"begin {name}")
    settings = dict(pair.split("=") for pair in options.set)
    time.sleep(float(settings.get("fake.wall_s", 0)))
    misbehave(options)
    code = write(options)
    note(f"end {name}")
    return code


if __name__ == "__main__":
    sys.exit(main())
