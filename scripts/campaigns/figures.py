"""The pictures of a report, each one PNG."""
import itertools
import sys
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from campaigns import measures

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import plot_mission

DPI = 150
# Okabe and Ito: told apart by the colour-blind; the dashes tell them apart in print.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#333333")
DASHES = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)), (0, (4, 1, 1, 1, 1, 1)))
SMOOTHING_MAX_S = 30
FAR_ABOVE = 2.5  # what is reachable is drawn up to so many times what was explored
FIRST_RATIO_S = 5  # before, both are a few cubic metres around the start


class Styles:
    """One colour and dash for each label, the same in every picture."""

    def __init__(self, labels):
        cycle = zip(itertools.cycle(COLOURS), itertools.cycle(DASHES))
        self.of = dict(zip(sorted(set(labels)), cycle))

    def line(self, label):
        colour, dash = self.of[label]
        return {"color": colour, "ls": dash, "lw": 2.0}

    def colour(self, label):
        return self.of[label][0]


def smoothed(values, half_width):
    """Running mean over so many values to each side; the ends are held."""
    width = 2 * half_width + 1
    return np.convolve(np.pad(values, half_width, mode="edge"), np.ones(width) / width, "valid")


def new_axes(columns=1, width=7.4, height=4.3):
    plot_mission.style()
    plt.rcParams.update({"figure.facecolor": "white", "axes.facecolor": "white"})
    return plt.subplots(1, columns, figsize=(width * columns, height), constrained_layout=True,
                        squeeze=False)


def finish(figure, path):
    """Writes the figure, cut to what is drawn: labels beside a map in equal scales stay whole."""
    figure.savefig(path, dpi=DPI, bbox_inches="tight", pad_inches=0.08)
    plt.close(figure)
    return path


def set_axes(axes, time_limit_s, title, ylabel):
    axes.set(title=title, xlabel="mission time [s]", ylabel=ylabel, xlim=(0, time_limit_s))
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    axes.yaxis.set_major_formatter(matplotlib.ticker.StrMethodFormatter("{x:,g}"))


def draw_band(axes, times, lines, label, styles, count):
    """Mean line within the range over the seeds."""
    lines = np.array(lines)
    axes.plot(times, lines.mean(axis=0), label=f"{label}, {count} seed{'s' * (count != 1)}",
              **styles.line(label))
    axes.fill_between(times, lines.min(axis=0), lines.max(axis=0), color=styles.colour(label),
                      alpha=0.18, lw=0)


def flown(comparison):
    return [series for series in comparison.series if series.runs]


def draw_volume(comparison, styles, path):
    """Explored volume over time under what is reachable."""
    figure, ((axes,),) = new_axes(width=9.8, height=4.7)
    times = np.arange(0.0, comparison.time_limit_s + 0.5)
    for series in flown(comparison):
        draw_band(axes, times, [measures.explored_at(run, times) for run in series.runs],
                  series.label, styles, len(series.runs))
    for kind, name in (("tour", "informed tour"), ("bound", "upper bound")):
        if kind in comparison.best_possible:
            curve = measures.on_grid(comparison.best_possible[kind], "explored_m3", times)
            axes.plot(times, curve, color="#777777", lw=1.3, ls="-" if kind == "tour" else ":",
                      label=name)
    set_axes(axes, comparison.time_limit_s, f"{comparison.title}: mean and range over the seeds",
             "explored volume [m³]")
    reachable = comparison.reachable_m3
    explored = max(run.summary["explored_volume_m3"] for series in flown(comparison)
                   for run in series.runs)
    is_shown = reachable <= FAR_ABOVE * explored
    axes.axhline(reachable, color="#333333", lw=1, ls=(0, (5, 3)),
                 label=f"reachable, {reachable:,.0f} m³{'' if is_shown else ' (far above)'}")
    axes.set_ylim(top=max(1.08 * reachable if is_shown else 1.3 * explored, 1.0))
    if reachable > 0:
        share = axes.secondary_yaxis("right", functions=(lambda volume: 100 * volume / reachable,
                                                         lambda part: part * reachable / 100))
        share.set_ylabel("share of the reachable volume [%]")
    axes.legend(loc="best", fontsize=9, framealpha=0.9)
    return finish(figure, path)


def draw_clearance(comparison, styles, path):
    """Distance to the nearest obstacle over time; None where no run measured it."""
    figure, ((axes,),) = new_axes(width=9.8, height=3.6)
    times = np.arange(0.0, comparison.time_limit_s + 0.5)
    half_width = int(min(SMOOTHING_MAX_S, comparison.time_limit_s / 20) / 2)
    drawn = False
    for series in flown(comparison):
        lines = [smoothed(measures.on_grid(run.clearance, "clearance_m", times), half_width)
                 for run in series.runs if run.clearance is not None and len(run.clearance)]
        if lines:
            draw_band(axes, times, lines, series.label, styles, len(lines))
            drawn = True
    if not drawn:
        plt.close(figure)
        return None
    set_axes(axes, comparison.time_limit_s,
             f"{comparison.title}: running mean of {2 * half_width + 1} s",
             "distance to the nearest\nobstacle [m]")
    axes.legend(loc="best", fontsize=9, framealpha=0.9)
    return finish(figure, path)


def ratio(run, best, times):
    """Achieved volume over the best possible one at the times."""
    return measures.explored_at(run, times) / np.maximum(
        measures.on_grid(best, "explored_m3", times), 1e-9)


def draw_ratios(comparison, styles, path):
    """Achieved over the informed tour and over the upper bound; None where neither is known."""
    known = [(kind, name) for kind, name in (("tour", "informed tour"), ("bound", "upper bound"))
             if kind in comparison.best_possible]
    if not known:
        return None
    figure, axes = new_axes(len(known), width=9.8 if len(known) == 1 else 6.2, height=3.9)
    times = np.arange(FIRST_RATIO_S, comparison.time_limit_s + 0.5)
    for panel, (kind, name) in zip(axes[0], known):
        for series in flown(comparison):
            draw_band(panel, times, [ratio(run, comparison.best_possible[kind], times)
                                     for run in series.runs], series.label, styles,
                      len(series.runs))
        set_axes(panel, comparison.time_limit_s, f"achieved / {name}", f"share of the {name} [-]")
        panel.axhline(1.0, color="#333333", lw=1, ls=(0, (5, 3)))
        panel.legend(loc="best", fontsize=9, framealpha=0.9)
    return finish(figure, path)


def draw_differences(comparison, pairs, path):
    """Mean difference and its interval of every pair; None without any interval."""
    pairs = [pair for pair in pairs if pair.has_interval]
    if not pairs:
        return None
    figure, ((axes,),) = new_axes(width=9.8, height=1.5 + 0.42 * len(pairs))
    for row, pair in enumerate(reversed(pairs)):
        axes.plot([pair.low, pair.high], [row, row], color="#0072B2", lw=3, solid_capstyle="butt")
        axes.plot(pair.mean, row, "o", color="#0072B2", mec="white", ms=9)
    axes.set_yticks(range(len(pairs)),
                    [f"{pair.first} − {pair.second}" for pair in reversed(pairs)])
    axes.axvline(0, color="#333333", lw=1, ls=(0, (5, 3)))
    axes.set(title=f"{comparison.title}: difference by seed, mean and 95 % interval",
             xlabel="explored volume at the end, first − second [m³]",
             ylim=(-0.7, len(pairs) - 0.3))
    axes.grid(axis="x", alpha=0.3)
    axes.xaxis.set_major_formatter(matplotlib.ticker.StrMethodFormatter("{x:,g}"))
    return finish(figure, path)


def plan_of(run):
    """Layers and frame of a run's map and its timeline; None where there is nothing to draw."""
    if not (run.folder / ".plan_view").exists() or run.timeline.empty:
        return None
    times, _ = plot_mission.read_timeline(run.folder / "timeline.csv")
    return (*plot_mission.read_plan_view(run.folder / ".plan_view"), times)


def common_window(plans):
    """Limits in metres around all that any of the maps knows."""
    windows = np.array([plot_mission.known_window(layers, times["x_m"], times["y_m"], frame)
                        for layers, frame, times in plans])
    return (windows[:, 0].min(), windows[:, 1].max(), windows[:, 2].min(), windows[:, 3].max())


def draw_map(plan, window, path):
    """Map and way of one run, in a window that all maps of a comparison share."""
    layers, frame, times = plan
    left, right, bottom, top = window
    width = 7.4
    height = float(np.clip(0.76 * width * (top - bottom) / (right - left), 2.4, 8.0)) + 1.0
    figure, ((axes,),) = new_axes(width=width, height=height)
    way = plot_mission.draw_map(axes, layers, frame, times, window)
    bar = figure.colorbar(way, ax=axes, fraction=0.04, pad=0.02, aspect=34)
    bar.set_label("mission time [s]")
    return finish(figure, path)
