#!/usr/bin/python3
"""Flies the navigation problems of Akbari and Bernardini 2021, Table I, and prints paper and ours side by side.

    scripts/navigation_table.py --mission build/devel/lib/spelunk/mission --out out/navigation

Every run is a lockstep mission with --go-to. Runs whose summary.json is there already are not flown again.
"""
import argparse
import json
import os
import subprocess
import sys

METHODS = {"adaptive": "A-NAV", "plain": "R-NAV", "plain_short": "R-NAV, shortened"}

# name, world, sensing range in metres, goal, home (None: only the way to the unknown goal is flown)
PROBLEMS = [
    ("2-SHAFT", "two_shaft", 4, "9,0,3.2", None),
    ("15-OBS", "room_obs_15", 4, "12,7.1,1.2", "2.5,2.5,1.2"),
    ("25-OBS", "room_obs_25", 4, "20,12,1.2", "2.5,2.5,1.2"),
    ("35-OBS", "room_obs_35", 4, "26,16,1.2", "2.5,2.5,1.2"),
    ("MINE", "mine_96", 2, "17.2,46,2.7", "4,44,1.2"),
]

# Table I: planning s, execution s, replans, path m.
PAPER = {
    ("2-SHAFT", "adaptive"): (0.62, 125.30, 17.80, 19.66),
    ("15-OBS", "adaptive"): (0.04, 51.40, 0.0, 6.61),
    ("15-OBS", "plain"): (0.11, 76.80, 3.80, 8.74),
    ("25-OBS", "adaptive"): (0.10, 166.20, 0.0, 21.63),
    ("25-OBS", "plain"): (1.50, 269.00, 14.40, 27.97),
    ("35-OBS", "adaptive"): (0.19, 527.60, 0.0, 33.19),
    ("35-OBS", "plain"): (3.07, 743.49, 20.60, 74.00),
    ("MINE", "adaptive"): (0.08, 98.95, 2.20, 17.50),
    ("MINE", "plain"): (0.63, 156.66, 14.6, 25.98),
}
FIELDS = ("planning_time_s", "execution_time_s", "replans", "path_length_m")


def fly(arguments, problem, method, home_known, seed):
    """The leg asked about of one run, from its summary.json."""
    name, world, sensed_m, goal, home = problem
    folder = os.path.join(arguments.out, f"{name}-{method}-{'home' if home_known else 'goal'}-{seed}")
    summary = os.path.join(folder, "summary.json")
    if not os.path.exists(summary):
        legs = [f"{goal},adaptive", f"{home},{method}"] if home_known else [f"{goal},{method}"]
        command = [arguments.mission, "--quiet", "--world", world, "--robot", "inspector",
                   "--seed", str(seed), "--time-limit-s", "3000", "--out", folder,
                   "--set", f"map.range_max_m={sensed_m}",
                   "--set", f"sensor.sphere.range_max_m={sensed_m + 0.2}"]
        for leg in legs:
            command += ["--go-to", leg]
        subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(summary) as file:
        return json.load(file)["legs"][-1]


def flown(arguments, problem, method, home_known):
    """Mean of each field over the seeds that arrived, and how many did."""
    legs = [fly(arguments, problem, method, home_known, seed)
            for seed in range(1, arguments.seeds + 1)]
    arrived = [leg for leg in legs if leg["outcome"] == "reached"]
    means = tuple(sum(leg[field] for leg in arrived) / max(1, len(arrived)) for field in FIELDS)
    return means, len(arrived), len(legs)


def cells(values):
    return "{:.3f} | {:.1f} | {:.1f} | {:.1f}".format(*values) if values else "| | | "


def print_table(arguments):
    print("| problem | goal | method | paper: planning s | execution s | replans | path m "
          "| ours: planning s | execution s | replans | path m | arrived |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for problem in PROBLEMS:
        for home_known in (False, True):
            if home_known and problem[4] is None:
                continue
            for method in arguments.methods:
                ours, arrived, runs = flown(arguments, problem, method, home_known)
                # The paper flies home in the rooms and does not say whether the mine's goal was known.
                is_papers = home_known or problem[0] in ("2-SHAFT", "MINE")
                paper = PAPER.get((problem[0], method)) if is_papers else None
                print(f"| {problem[0]} | {'known' if home_known else 'unknown'} | {METHODS[method]} "
                      f"| {cells(paper)} | {cells(ours)} | {arrived} of {runs} |")
                sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--mission", required=True, help="the mission executable")
    parser.add_argument("--out", required=True, help="folder for the runs")
    parser.add_argument("--methods", nargs="+", default=list(METHODS), choices=list(METHODS))
    parser.add_argument("--seeds", type=int, default=5)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    print_table(arguments)


if __name__ == "__main__":
    main()
