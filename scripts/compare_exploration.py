#!/usr/bin/python3
"""Compares exploration planners over several seeds: volume and distance to the nearest obstacle
over time, mean and range, as one PNG a comparison, and Table II of Akbari 2021.

    compare_exploration.py --mission PATH --out DIR [--only NAME ...] [--seeds N] [--plot-only]

Flies what is missing in DIR (a finished run is never flown again) and draws what is there.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SLOW = ["--robot", "inspector", "--set", "map.range_max_m=4"]
NAMES = {"informed": "IE", "frontier_nearest": "FE", "frontier_utility": "UE", "gbplanner": "GE"}
COLOURS = {"informed": "#b5485d", "frontier_nearest": "#8b8f98", "frontier_utility": "#2a7f9e",
           "gbplanner": "#5d9a4b"}
# What gbplanner is told about a robot that sees 4 m.
SHORT_SIGHTED_GE = ["--set", "gbplanner.local_box_m=[24,24,10]",
                    "--set", "gbplanner.gain_threshold_m3=10",
                    "--set", "gbplanner.frontier_gain_m3=6",
                    "--set", "gbplanner.edge_length_max_m=3"]


def problem(title, world, time_s, resolution_m, planners):
    return {"title": title, "world": world, "time_s": time_s, "resolution_m": resolution_m,
            "planners": planners}


FRONTIERS = ["informed", "frontier_nearest", "frontier_utility"]
COMPARISONS = {
    "fig12_problem1": problem("cave_1, 600 s, 0.1 m", "cave_1", 600, 0.1, FRONTIERS),
    "fig12_problem2": problem("cave_1, 1500 s, 0.2 m", "cave_1", 1500, 0.2, FRONTIERS),
    "fig12_problem3": problem("cave_2, 600 s, 0.1 m", "cave_2", 600, 0.1, FRONTIERS),
    "fig12_problem4": problem("cave_2, 1900 s, 0.2 m", "cave_2", 1900, 0.2, FRONTIERS),
    "fig14": problem("mine_225, 800 s, 0.1 m", "mine_225", 800, 0.1,
                     ["informed", "frontier_utility"]),
    "fig15": problem("mine_96, 1500 s, 0.2 m", "mine_96", 1500, 0.2, ["informed", "gbplanner"]),
}
PAPER_TABLE_2 = {"fig12_problem1": (32, 52, 508, 595, 858),
                 "fig12_problem2": (90, 161, 1306, 1434, 2604),
                 "fig12_problem3": (55, 109, 452, 591, 859),
                 "fig12_problem4": (207, 553, 1603, 1853, 3062)}


def fly(mission, folder, comparison, planner, seed):
    """One run, unless its folder is complete."""
    if (folder / "summary.json").exists():
        return
    extra = SHORT_SIGHTED_GE if planner == "gbplanner" else []
    command = [str(mission), "--world", comparison["world"], "--planner", planner, "--seed",
               str(seed), "--time-limit-s", str(comparison["time_s"]), "--out", str(folder),
               *SLOW, "--set", f"map.resolution_m={comparison['resolution_m']}", *extra, "--quiet"]
    print(" ".join(command), flush=True)
    finished = subprocess.run(command, check=False)
    if finished.returncode not in (0, 1):
        raise SystemExit(f"{folder}: the mission could not be flown")


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]
            if name != "state"}


def runs_of(out, name, planner):
    return sorted(path.parent for path in (out / name / planner).glob("*/summary.json"))


def on_grid(folders, file, column, times):
    """One line a run; a run that ended keeps its last value."""
    lines = []
    for folder in folders:
        data = columns(folder / file)
        lines.append(np.interp(times, data["t_s"], data[column]))
    return np.array(lines)


def smoothed(lines, width):
    kernel = np.ones(width) / width
    return np.array([np.convolve(np.pad(line, width // 2, mode="edge"), kernel, "valid")
                     [:line.size] for line in lines])


def draw(out, name, comparison):
    figure, (volume, clearance) = plt.subplots(1, 2, figsize=(12, 4.2), constrained_layout=True)
    times = np.arange(0.0, comparison["time_s"] + 1.0)
    drawn = 0
    for planner in comparison["planners"]:
        folders = runs_of(out, name, planner)
        if not folders:
            continue
        drawn += len(folders)
        for axes, file, column, width in ((volume, "timeline.csv", "explored_m3", 1),
                                          (clearance, "clearance.csv", "clearance_m", 31)):
            lines = smoothed(on_grid(folders, file, column, times), width)
            axes.plot(times, lines.mean(axis=0), color=COLOURS[planner],
                      label=f"{NAMES[planner]} ({len(folders)} seeds)")
            axes.fill_between(times, lines.min(axis=0), lines.max(axis=0), alpha=0.2, lw=0,
                              color=COLOURS[planner])
    if drawn == 0:
        return plt.close(figure)
    volume.set(title=comparison["title"], xlabel="mission time [s]",
               ylabel="explored volume [m³]")
    clearance.set(title="half-minute mean, range over seeds", xlabel="mission time [s]",
                  ylabel="distance to the nearest obstacle [m]")
    volume.legend(frameon=False)
    for axes in (volume, clearance):
        axes.grid(alpha=0.3)
        axes.set_xlim(0, comparison["time_s"])
        axes.set_ylim(bottom=0)
    figure.savefig(out / f"{name}.png", dpi=110)
    plt.close(figure)
    return None


def graph_size(folder):
    with open(folder / "plans.csv", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    return float(last["global_vertices"]), float(last["global_edges"])


def summaries(folders):
    return [json.loads((folder / "summary.json").read_text()) for folder in folders]


def flying_time(folder):
    """Seconds in which the robot moved."""
    data = columns(folder / "timeline.csv")
    return float(np.count_nonzero(np.diff(data["distance_m"]) > 0.02))


def spread(values):
    return f"{np.mean(values):.0f} ({np.min(values):.0f} to {np.max(values):.0f})"


def print_tables(out):
    print("| problem | | V | E | navigation s | exploration s | volume m3 |\n|---|---|---|---|---|---|---|")
    for name, paper in PAPER_TABLE_2.items():
        folders = runs_of(out, name, "informed")
        if not folders:
            continue
        print(f"| {COMPARISONS[name]['title']} | paper | "
              + " | ".join(str(value) for value in paper) + " |")
        sizes = [graph_size(folder) for folder in folders]
        found = summaries(folders)
        print(f"| | ours | {spread([s[0] for s in sizes])} | {spread([s[1] for s in sizes])} | "
              f"{spread([flying_time(folder) for folder in folders])} | "
              f"{spread([s['mission_time_s'] for s in found])} | "
              f"{spread([s['explored_volume_m3'] for s in found])} |")
    print("\n| comparison | planner | seeds | volume m3 | mean distance to obstacle m | home with reserve | collisions |"
          "\n|---|---|---|---|---|---|---|")
    for name, comparison in COMPARISONS.items():
        for planner in comparison["planners"]:
            folders = runs_of(out, name, planner)
            if not folders:
                continue
            found = summaries(folders)
            clearance = [columns(folder / "clearance.csv")["clearance_m"].mean()
                         for folder in folders]
            home = sum(s["returned_home"] and s["remaining_at_home_s"] > 0 for s in found)
            print(f"| {comparison['title']} | {NAMES[planner]} | {len(folders)} | "
                  f"{spread([s['explored_volume_m3'] for s in found])} | {np.mean(clearance):.2f} | "
                  f"{home} of {len(folders)} | {sum(s['collisions'] for s in found)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--mission", type=pathlib.Path, help="the mission executable")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--only", nargs="*", default=list(COMPARISONS), choices=list(COMPARISONS))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--plot-only", action="store_true")
    options = parser.parse_args()
    for seed in range(1, options.seeds + 1):
        for name in [] if options.plot_only else options.only:
            for planner in COMPARISONS[name]["planners"]:
                fly(options.mission, options.out / name / planner / str(seed), COMPARISONS[name],
                    planner, seed)
    for name in options.only:
        draw(options.out, name, COMPARISONS[name])
    print_tables(options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
