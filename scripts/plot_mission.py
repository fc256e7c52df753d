#!/usr/bin/python3
"""Draws a mission folder as exploration.png: the map from above with the way flown, explored volume
and endurance over time.

    plot_mission.py DIR

Reads summary.json, timeline.csv and .plan_view of DIR, which the mission executable wrote.
"""
import csv
import json
import logging
import pathlib
import sys

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # It works without a folder for its cache.
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

PAPER = "#fbfaf7"
INK = "#22262e"
FAINT = "#8b8f98"
UNKNOWN = np.array([0.145, 0.160, 0.190])
WALL = np.array([0.60, 0.43, 0.30])
FLOOR = LinearSegmentedColormap.from_list("floor", ["#a9b9c6", "#e4e2d6", "#f3e3c0", "#d9b98a"])
STATE_COLOURS = {"Explore": "#2a7f9e", "Reposition": "#d9912b", "Home": "#5d9a4b",
                 "Hold": "#b5485d", "EStop": "#8e1f2f", "Idle": "#b9bcc2", "Done": "#b9bcc2"}


class MissionError(Exception):
    """The folder does not hold what a plot needs."""


def read_plan_view(path):
    """Layers free, occupied and floor as arrays [row, column], and (x0, y0, resolution, z_min)."""
    with open(path, "rb") as file:
        header = file.readline().split()
        if header[:2] != [b"plan_view", b"1"] or len(header) != 8:
            raise MissionError(f"{path}: not a plan view of this version")
        width, height = int(header[2]), int(header[3])
        layers = np.frombuffer(file.read(), np.uint8)
    if layers.size != 3 * width * height:
        raise MissionError(f"{path}: cut short")
    return layers.reshape(3, height, width), [float(text) for text in header[4:]]


def read_timeline(path):
    """Columns of timeline.csv as arrays; the state as a list of names."""
    with open(path, newline="") as file:
        reader = csv.DictReader(file)
        rows = list(reader)
        names = reader.fieldnames or []
    if not {"t_s", "explored_m3", "x_m", "y_m", "state"} <= set(names):
        raise MissionError(f"{path}: is no timeline, its header lacks columns")
    columns = {name: np.array([float(row[name]) for row in rows])
               for name in names if name != "state"}
    return columns, [row["state"] for row in rows]


def with_a_row(times, states, summary):
    """The same; of a mission shorter than a second one row that knows no place."""
    if states:
        return times, states
    alone = {name: np.array([np.nan]) for name in times}
    alone.update(t_s=np.zeros(1), distance_m=np.zeros(1), remaining_s=np.zeros(1),
                 explored_m3=np.array([float(summary.get("explored_volume_m3", 0.0))]))
    return alone, ["Idle"]


def thickened(mask):
    """The mask grown by one cell to each side, so that thin walls stay visible."""
    grown = mask.copy()
    grown[1:] |= mask[:-1]
    grown[:-1] |= mask[1:]
    grown[:, 1:] |= mask[:, :-1]
    grown[:, :-1] |= mask[:, 1:]
    return grown


def map_image(layers, resolution, z_min):
    """RGB image of the map: unknown dark, floors by height, walls brown."""
    free, occupied, floor = layers
    image = np.broadcast_to(UNKNOWN, free.shape + (3,)).copy()
    known = free > 0
    heights = z_min + resolution * floor.astype(float)
    if known.any():
        low, high = np.percentile(heights[known], [2, 98])
        span = max(high - low, 2.0)
        shade = FLOOR(np.clip((heights - (low + high - span) / 2) / span, 0, 1))[..., :3]
        image[known] = shade[known]
    tall = max(3.0, 0.25 * np.percentile(free[known], 90)) if known.any() else 3.0
    walls = (occupied >= tall) | ((occupied > 0) & ~known)
    image[thickened(walls) & ~known] = WALL
    image[walls] = WALL
    return image


def known_window(layers, path_x, path_y, frame):
    """Limits in metres around all that is known, with a margin."""
    x0, y0, resolution, _ = frame
    rows, columns = np.nonzero(layers[0] + layers[1].astype(int))
    if rows.size == 0:
        path = np.nan_to_num([path_x.min(), path_x.max(), path_y.min(), path_y.max()])
        return tuple(path + (-5, 5, -5, 5))
    margin = 3.0
    return (x0 + columns.min() * resolution - margin, x0 + (columns.max() + 1) * resolution + margin,
            y0 + rows.min() * resolution - margin, y0 + (rows.max() + 1) * resolution + margin)


def draw_scale_bar(axes, layers, frame, limits):
    """A bar of a round length, in the lower corner where less is known."""
    left, right, bottom, top = limits
    x0, y0, resolution, _ = frame
    wanted = max(0.2 * (right - left), 1.0)
    length = max(value for value in (1, 2, 5, 10, 20, 50, 100, 200, 500) if value <= wanted)
    rows, columns = np.nonzero(layers[0])
    low = y0 + rows * resolution < bottom + 0.08 * (top - bottom)
    x = x0 + columns[low] * resolution
    is_left_free = np.sum(x < left + 1.3 * length) <= np.sum(x > right - 1.3 * length)
    begin = left + 0.03 * (right - left) if is_left_free else right - 0.03 * (right - left) - length
    y = bottom + 0.03 * (top - bottom)
    axes.plot([begin, begin + length], [y, y], color="white", lw=4, solid_capstyle="butt", zorder=9)
    axes.annotate(f"{length} m", (begin + length / 2, y), (0, 5), textcoords="offset points",
                  color="white", ha="center", va="bottom", fontsize=10, zorder=9)


def draw_map(axes, layers, frame, times, window=None):
    """The map from above and the way flown on it, all that is known or a window of it."""
    x0, y0, resolution, z_min = frame
    height, width = layers[0].shape
    x, y = times["x_m"], times["y_m"]
    if width and height:
        axes.imshow(map_image(layers, resolution, z_min), origin="lower", interpolation="nearest",
                    extent=(x0, x0 + width * resolution, y0, y0 + height * resolution))
    left, right, bottom, top = window or known_window(layers, x, y, frame)
    axes.set_facecolor(UNKNOWN)
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.set_aspect("equal")
    points = np.column_stack([x, y])
    segments = np.stack([points[:-1], points[1:]], axis=1)
    axes.plot(x, y, color="black", lw=3.2, alpha=0.55, solid_joinstyle="round", zorder=4)
    way = LineCollection(segments, array=times["t_s"][:-1], cmap="plasma", lw=1.9, zorder=5,
                         capstyle="round")
    axes.add_collection(way)
    axes.plot(x[-1], y[-1], "o", ms=9, mfc="#e8433f", mec="white", mew=1.6, zorder=7)
    axes.plot(x[0], y[0], "*", ms=20, mfc="#35c46a", mec="white", mew=1.4, zorder=6)
    draw_scale_bar(axes, layers, frame, (left, right, bottom, top))
    marks = [Line2D([], [], marker="*", ls="", ms=13, mfc="#35c46a", mec="white", label="start, home"),
             Line2D([], [], marker="o", ls="", ms=8, mfc="#e8433f", mec="white", label="end"),
             Patch(fc=FLOOR(0.5), label="known free"), Patch(fc=WALL, label="rock"),
             Patch(fc=UNKNOWN, ec="#666a73", label="unknown")]
    axes.legend(handles=marks, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=9,
                frameon=False, ncol=len(marks), handletextpad=0.5, columnspacing=1.2)
    axes.ticklabel_format(useOffset=False, style="plain")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return way


def shade_states(axes, seconds, states):
    """A band along the lower edge that shows the state; returns the states that occur."""
    begin = 0
    seen = []
    for k in range(1, len(states) + 1):
        if k < len(states) and states[k] == states[begin]:
            continue
        end = seconds[k] if k < len(states) else seconds[-1]
        colour = STATE_COLOURS.get(states[begin], FAINT)
        axes.axvspan(seconds[begin], end, ymax=0.035, color=colour, lw=0, zorder=3)
        axes.axvspan(seconds[begin], end, color=colour, alpha=0.10, lw=0, zorder=0)
        if states[begin] not in seen:
            seen.append(states[begin])
        begin = k
    return seen


def draw_volume(axes, times, states, summary):
    """Explored volume over time under what there is to explore."""
    seconds, volume = times["t_s"], times["explored_m3"]
    reachable = summary.get("reachable_volume_m3", 0.0)
    axes.fill_between(seconds, volume, color="#2a7f9e", alpha=0.18, lw=0)
    axes.plot(seconds, volume, color="#1c647f", lw=2.2)
    seen = shade_states(axes, seconds, states)
    top = 1.08 * volume.max()
    if reachable > 0:
        top = max(top, 1.12 * reachable) if reachable < 3 * volume.max() else top
        axes.axhline(reachable, color=INK, lw=1.2, ls=(0, (5, 3)))
        share = 100.0 * volume[-1] / reachable
        label = f"reachable {reachable:,.0f} m³, {share:.0f} % seen"
        axes.annotate(label, (max(seconds[-1], 1.0), min(reachable, 0.93 * top)), (-4, 4), fontsize=9.5,
                      textcoords="offset points", ha="right", va="bottom")
    axes.set_ylim(0, max(top, 1.0))
    axes.set_ylabel("explored volume [m³]")
    handles = [Patch(fc=STATE_COLOURS.get(state, FAINT), label=state) for state in seen]
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=len(handles),
                fontsize=9, frameon=False, handlelength=1.1, columnspacing=1.2)


def draw_endurance(axes, times, states):
    """Endurance left, and the least time the straight way home would take."""
    seconds = times["t_s"]
    home = np.hypot(np.hypot(times["x_m"] - times["x_m"][0], times["y_m"] - times["y_m"][0]),
                    times["z_m"] - times["z_m"][0])
    speeds = np.diff(times["distance_m"]) / np.maximum(np.diff(seconds), 1e-9)
    cruise = max(np.percentile(speeds, 90), 0.1) if speeds.size else 1.0
    axes.plot(seconds, times["remaining_s"], color="#b5485d", lw=2.2, label="endurance left")
    axes.fill_between(seconds, home / cruise, color="#5d9a4b", alpha=0.30, lw=0,
                      label=f"straight way home at {cruise:.1f} m/s")
    shade_states(axes, seconds, states)
    axes.set_ylim(0, 1.08 * max(times["remaining_s"].max(), 1.0))
    axes.set_ylabel("time [s]")
    axes.set_xlabel("mission time [s]")
    axes.legend(loc="best", fontsize=9, frameon=False)


def headline(summary):
    """Title and the line of figures under it."""
    names = [pathlib.Path(str(summary.get(key, "?"))).stem for key in ("world", "planner", "robot")]
    title = " · ".join([*names, f"seed {summary.get('seed', '?')}"])
    home = "home with {:,.0f} s left".format(summary.get("remaining_at_home_s", 0.0)) \
        if summary.get("returned_home") else "not home"
    figures = [f"explored {summary.get('explored_volume_m3', 0):,.0f} m³",
               f"path {summary.get('path_length_m', 0):,.0f} m",
               f"time {summary.get('mission_time_s', 0):,.0f} s",
               f"least clearance {summary.get('min_clearance_m', 0):.2f} m",
               f"collisions {summary.get('collisions', 0)}", home]
    return title, "   |   ".join(figures), str(summary.get("outcome", ""))


def style():
    """Quiet axes on warm paper."""
    plt.rcParams.update({"font.family": "DejaVu Sans", "font.size": 10.5, "text.color": INK,
                         "axes.edgecolor": FAINT, "axes.labelcolor": INK, "xtick.color": INK,
                         "ytick.color": INK, "axes.spines.top": False, "axes.spines.right": False,
                         "figure.facecolor": PAPER, "axes.facecolor": PAPER})


def draw(folder):
    """Draws `folder` and writes its exploration.png."""
    summary = json.loads((folder / "summary.json").read_text())
    times, states = with_a_row(*read_timeline(folder / "timeline.csv"), summary)
    layers, frame = read_plan_view(folder / ".plan_view")
    style()
    left, right, bottom, top = known_window(layers, times["x_m"], times["y_m"], frame)
    map_width = float(np.clip(7.1 * (right - left) / (top - bottom), 4.6, 12.0)) + 1.0  # inches
    width = map_width + 8.6
    figure = plt.figure(figsize=(width, 9.2))
    grid = figure.add_gridspec(2, 2, width_ratios=[map_width, 6.0], left=0.75 / width,
                               right=1 - 0.25 / width, top=0.845, bottom=0.075, wspace=0.26,
                               hspace=0.18)
    plan = figure.add_subplot(grid[:, 0])
    volume = figure.add_subplot(grid[0, 1])
    endurance = figure.add_subplot(grid[1, 1], sharex=volume)
    way = draw_map(plan, layers, frame, times)
    bar = figure.colorbar(way, ax=plan, fraction=0.2 / map_width, pad=0.02, shrink=0.8,
                          aspect=38)
    bar.set_label("mission time [s]")
    bar.outline.set_visible(False)
    draw_volume(volume, times, states, summary)
    draw_endurance(endurance, times, states)
    volume.set_xlim(0, max(times["t_s"][-1], 1.0))
    for axes in (volume, endurance):
        axes.grid(True, color=FAINT, alpha=0.25, lw=0.7)
        axes.yaxis.set_major_formatter(matplotlib.ticker.StrMethodFormatter("{x:,.0f}"))
    volume.tick_params(labelbottom=False)
    title, figures, outcome = headline(summary)
    figure.text(0.75 / width, 0.955, title, fontsize=17, weight="bold")
    figure.text(0.75 / width, 0.921, figures, fontsize=11.5)
    figure.text(0.75 / width, 0.889, outcome, fontsize=10.5, color=FAINT)
    partial = folder / ".exploration.png.part"
    figure.savefig(partial, dpi=110, format="png")
    partial.replace(folder / "exploration.png")


def main():
    if len(sys.argv) != 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    try:
        draw(pathlib.Path(sys.argv[1]))
    except (OSError, ValueError, KeyError, MissionError) as error:
        print(f"plot_mission.py: {sys.argv[1]}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
