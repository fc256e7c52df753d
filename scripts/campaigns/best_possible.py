"""Finds out what can be explored at best: a bound nobody passes, and a tour that knows the world.

    scripts/best_possible --world W --robot R --time-limit-s T --out DIR [--set key=value]

DIR gets bound.csv and the survey (executable best_possible), tour_points.csv (OR-tools), flight/
(planner oracle over these points) and tour.csv: t_s, explored_m3 of that flight. Before the flight
nobody knows how fast the robot is along the tour, so a tour that leaves time unused, or that is not
over in time, is laid out again with the speed that was flown; nor whether it sees the end of a loop
before it must turn back, so tours with and without such loops are flown. The flight that explored
most stays.
DIR appears when it is complete. What failed stands in its outcome.json, and the log beside it.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import shutil
import signal
import sys
import time

from campaigns import fly
from campaigns.description import number_text

LAYOUTS = 3             # at most, of a kind
WAYS_HOME = ("flown", "any")  # that tours rely on: the kinds
FIRST_SPEED_SHARE = 0.85
SLOWER = 0.93           # at least, where a tour was not over in time
FASTER = 1.6            # at most in one step
WORTH_ANOTHER = 1.03    # so much longer must a tour become to be flown
SEED = 1
STEP_LIMIT_S = 3600     # of wall time, for a step that flies nothing
AT_THE_END = "the tour is at its end"  # what planner oracle says
LOG = "best_possible.log"


class Failed(Exception):
    """A step did not do its part."""

    def __init__(self, kind, reason):
        super().__init__(f"{kind}: {reason}")
        self.kind, self.reason = kind, reason


def parsed(arguments):
    scripts = pathlib.Path(__file__).resolve().parent.parent
    build = pathlib.Path(os.environ.get("SPELUNK_BUILD_DIR", scripts.parent / "build"))
    parser = argparse.ArgumentParser(prog="best_possible", description=__doc__.split("\n\n")[0])
    parser.add_argument("--world", required=True, help="name from worlds/ or path of a mesh")
    parser.add_argument("--robot", default="aerial", help="name from config/robots or path of a file")
    parser.add_argument("--time-limit-s", type=float, default=900.0)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="a new or empty folder")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--executables", type=pathlib.Path, metavar="FOLDER",
                        default=build / "devel" / "lib" / "spelunk",
                        help="where best_possible and mission lie")
    parser.add_argument("--tour-python", type=pathlib.Path, metavar="PYTHON",
                        default=build / "tour_env" / "bin" / "python",
                        help="a Python that has OR-tools; scripts/install tour makes it")
    parser.add_argument("--record-failures", action="store_true",
                        help="exit code 0 also where a step failed: that is a result, too")
    return parser.parse_args(arguments)


def step(command, folder, wall_limit_s, accepted=(0,)):
    """Runs a command; raises Failed with the last line it said."""
    log = folder / LOG
    if not shutil.which(command[0]):
        raise Failed(fly.BAD_INPUT, f"{command[0]} is no executable: run scripts/build and "
                                    "scripts/install tour")
    with open(log, "ab") as file:
        code = fly.run([str(word) for word in command], file, wall_limit_s)
    fly.require_space(folder)
    if code is None:
        raise Failed(fly.HANG, f"{pathlib.Path(command[0]).name} is not done after "
                               f"{wall_limit_s:g} s")
    if code not in accepted:
        how = f"killed by {signal.Signals(-code).name}" if code < 0 else fly.last_line(log)
        raise Failed(fly.BAD_INPUT if code == 2 else fly.CRASH, how)


def common_arguments(options):
    pairs = [("--world", options.world), ("--robot", options.robot),
             ("--time-limit-s", number_text(options.time_limit_s))]
    return [word for pair in pairs + [("--set", text) for text in options.set] for word in pair]


def survey(options, folder):
    step([options.executables / "best_possible", *common_arguments(options), "--out", folder],
         folder, STEP_LIMIT_S)


def lay_out(options, survey_folder, out, speed_share, way_home):
    """What tour.json says of the tour."""
    step([options.tour_python, "-m", "campaigns.tour", survey_folder, "--out", out,
          "--time-limit-s", number_text(options.time_limit_s), "--speed-share",
          f"{speed_share:.4f}", "--way-home", way_home], survey_folder, STEP_LIMIT_S)
    return json.loads((out / "tour.json").read_text())


def flight_of(options, out, log_folder):
    """Flies the tour in `out`; its summary."""
    (out / "flight").mkdir()
    tour = (out / "tour_points.csv").resolve()
    step([options.executables / "mission", *common_arguments(options), "--planner", "oracle",
          "--seed", str(SEED), "--set", f"oracle.tour={tour}", "--out", out / "flight"], log_folder,
         60 + 2 * options.time_limit_s, accepted=(0, 1))
    return json.loads((out / "flight" / "summary.json").read_text())


def corrected_share(tour, summary, speed_share):
    """The share of full speed to lay out the next tour with; None if another is not worth it."""
    flown_s = max(summary["mission_time_s"], 1.0)
    if AT_THE_END in summary["outcome"]:
        share = min(tour["length_m"] / (tour["speed_mps"] * flown_s), FASTER * speed_share)
        is_worth_it = tour["is_cut"] and share >= WORTH_ANOTHER * speed_share
        return share if is_worth_it else None
    flown = summary["path_length_m"] / (tour["speed_mps"] * flown_s)
    return min(flown, SLOWER * speed_share)


def rank(summary):
    """Home first, then what was explored."""
    return summary["returned_home"], summary["explored_volume_m3"]


def best_flight(options, folder):
    """Lays out and flies until that is worth it no more; the best summary, its files in place."""
    best = None
    kept, attempt = folder / ".best", folder / ".attempt"
    for way_home in WAYS_HOME:
        speed_share = FIRST_SPEED_SHARE
        for _ in range(LAYOUTS):
            attempt.mkdir()
            tour = lay_out(options, folder, attempt, speed_share, way_home)
            summary = flight_of(options, attempt, folder)
            worse = attempt
            if best is None or rank(summary) > rank(best):
                best, worse = summary, kept
            shutil.rmtree(worse, ignore_errors=True)
            if worse is kept:
                attempt.rename(kept)
            speed_share = corrected_share(tour, summary, speed_share)
            if speed_share is None:
                break
    for path in list(kept.iterdir()):
        path.rename(folder / path.name)
    kept.rmdir()
    return best


def write_curve(folder):
    """tour.csv from the flight's timeline, from nothing at the start."""
    with open(folder / "flight" / "timeline.csv", encoding="utf-8", newline="") as file:
        rows = [(row["t_s"], row["explored_m3"]) for row in csv.DictReader(file)]
    lines = ["t_s,explored_m3", "0.000,0.000"] + [",".join(row) for row in rows]
    (folder / "tour.csv").write_text("\n".join(lines) + "\n")


def last_bound(folder):
    with open(folder / "bound.csv", encoding="utf-8", newline="") as file:
        return float(list(csv.DictReader(file))[-1]["explored_m3"])


def whole(options, folder):
    """All steps; what there is to say in one line."""
    survey(options, folder)
    summary = best_flight(options, folder)
    if not summary["returned_home"]:
        raise Failed(fly.STRANDED, summary["outcome"])
    write_curve(folder)
    explored, bound = summary["explored_volume_m3"], last_bound(folder)
    share = explored / bound if bound > 0 else math.nan
    return f"an informed tour explores {explored:.0f} m3 and is home after " \
           f"{summary['mission_time_s']:.0f} s; nobody explores more than {bound:.0f} m3 " \
           f"({100 * share:.0f} %)"


def record(options, folder):
    """Does it all and writes outcome.json; its content."""
    begin = time.monotonic()
    try:
        kind, reason = fly.FINISHED, whole(options, folder)
    except Failed as error:
        kind, reason = error.kind, error.reason
    outcome = {"world": options.world, "robot": options.robot, "settings": options.set,
               "time_limit_s": options.time_limit_s, "kind": kind, "reason": reason,
               "wall_time_s": round(time.monotonic() - begin, 3)}
    (folder / "outcome.json").write_text(json.dumps(outcome, indent=2) + "\n")
    return outcome


def settle(folder):
    """As fly.settle, for a folder with folders in it."""
    for place in [folder, *(path for path in folder.rglob("*") if path.is_dir())]:
        for path in place.iterdir():
            if path.is_file():
                with open(path, "rb") as file:
                    os.fsync(file.fileno())


def refuse_full(out):
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise fly.MachineError(f"{out} is not empty; choose another --out")


def main(arguments=None):
    options = parsed(arguments)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, fly.interrupt)
    folder = fly.part_folder(options.out)
    try:
        refuse_full(options.out)
        folder.mkdir(parents=True)
        fly.require_space(folder)
        outcome = record(options, folder)
        settle(folder)
        folder.rename(options.out)
    except (fly.MachineError, OSError, fly.Interrupted) as error:
        print(f"campaign: {options.out.name}: {error}", file=sys.stderr)
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"best_possible: {options.out}: {outcome['kind']}: {outcome['reason']}")
    return int(outcome["kind"] != fly.FINISHED and not options.record_failures)


if __name__ == "__main__":
    sys.exit(main())
