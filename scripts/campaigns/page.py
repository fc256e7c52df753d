"""Fills the page of a report: texts of all numbers, pictures embedded."""
import base64
import pathlib

import jinja2
import markupsafe
import numpy as np

from campaigns import figures, measures

TEMPLATE = "report.html.j2"
KINDS = ("finished", "stranded", "crash", "hang", "bad input")


def number(value, digits=0):
    """1,234.5; a dash for what does not exist."""
    return f"{value:,.{digits}f}" if np.isfinite(value) else "–"


def spread(values, digits=0):
    """Mean and, below it, the range; the value alone where there is one."""
    values = np.asarray(values, dtype=float)
    if not np.isfinite(values).any():
        return "–"
    if values.size == 1:
        return number(values[0], digits)
    return markupsafe.Markup(f"{number(values.mean(), digits)}<br><small>"
                             f"{number(values.min(), digits)} to {number(values.max(), digits)}"
                             "</small>")


def time_to_share(series, volume_m3):
    """Median seconds over all runs, those that never came so far counting as endless."""
    times = [measures.time_to(run, volume_m3) for run in series.runs]
    reached = int(np.count_nonzero(np.isfinite(times)))
    return {"seconds": number(float(np.median(times))), "reached": reached, "runs": len(times)}


def figure_row(series, comparison):
    """What the table of a comparison says of one series."""
    found = [run.summary for run in series.runs]
    plans = measures.plan_times_ms(series)
    reachable = comparison.reachable_m3
    volumes = [summary["explored_volume_m3"] for summary in found]
    return {
        "label": series.label, "runs": len(found), "failures": series.failures,
        "volume": spread(volumes),
        "share": spread([100 * measures.share(volume, reachable) for volume in volumes]),
        "times": [time_to_share(series, share * reachable) for share in measures.SHARES],
        "rate": spread([measures.share(summary["explored_volume_m3"], summary["mission_time_s"])
                        for summary in found], 1),
        "working_rate": spread([measures.working_rate(run) for run in series.runs], 1),
        "path": spread([summary["path_length_m"] for summary in found]),
        "plans": [number(float(np.percentile(plans, q))) for q in (50, 95, 100)] if plans.size
        else ["–"] * 3,
        "clearance": number(min(summary["min_clearance_m"] for summary in found), 2),
        "mean_clearance": spread([run.clearance["clearance_m"].mean() for run in series.runs
                                  if run.clearance is not None and len(run.clearance)], 2),
        "collisions": sum(summary["collisions"] for summary in found),
        "falls": sum(summary.get("falls", 0) for summary in found),
        "home": sum(measures.is_home_with_reserve(run) for run in series.runs),
        "reserve": spread([summary["remaining_at_home_s"] for summary in found
                           if summary["returned_home"]])}


def pair_row(pair, unit):
    interval = f"{number(pair.low)} to {number(pair.high)}" if pair.has_interval else "–"
    return {"pair": f"{pair.first} − {pair.second}", "unit": unit, "seeds": pair.seeds,
            "mean": number(pair.mean), "interval": interval, "effect": number(pair.effect, 2),
            "wins": pair.wins, "is_clear": pair.has_interval and (pair.low > 0 or pair.high < 0)}


def graph_rows(comparison):
    """Table II of Akbari 2021: the paper's row and ours, for Informed Exploration."""
    rows = [{"label": item["label"], **{key: number(item[key]) for key in
                                        ("vertices", "edges", "navigation_s", "exploration_s",
                                         "volume_m3")}} for item in comparison.references]
    for series in comparison.series:
        runs = [run for run in series.runs if "global_vertices" in run.plans and len(run.plans)]
        if series.planner == "informed" and runs:
            rows.append({
                "label": f"{series.label}, {len(runs)} seeds",
                "vertices": spread([run.plans["global_vertices"].iloc[-1] for run in runs]),
                "edges": spread([run.plans["global_edges"].iloc[-1] for run in runs]),
                "navigation_s": spread([measures.navigation_time(run) for run in runs]),
                "exploration_s": spread([run.summary["mission_time_s"] for run in runs]),
                "volume_m3": spread([run.summary["explored_volume_m3"] for run in runs])})
    return rows if any(series.planner == "informed" and series.runs
                       for series in comparison.series) else []


def ratio_rows(comparison):
    """Achieved over the best possible at the end of the time limit."""
    rows = []
    for series in figures.flown(comparison):
        row = {"label": series.label}
        for kind in ("tour", "bound"):
            best = comparison.best_possible.get(kind)
            row[kind] = "–" if best is None else spread(
                [figures.ratio(run, best, comparison.time_limit_s) for run in series.runs], 2)
        rows.append(row)
    return rows


def mission_row(run):
    """A line of the table of every mission."""
    summary = run.summary
    row = {"name": run.outcome["mission"], "kind": run.outcome["kind"],
           "reason": run.outcome["reason"], "wall": number(run.outcome["wall_time_s"])}
    if summary:
        home = f"{number(summary['remaining_at_home_s'])} s left" if summary["returned_home"] \
            else "not home"
        row.update(volume=number(summary["explored_volume_m3"]), home=home,
                   share=number(100 * measures.share(summary["explored_volume_m3"],
                                                     summary["reachable_volume_m3"])),
                   path=number(summary["path_length_m"]), time=number(summary["mission_time_s"]),
                   collisions=summary["collisions"])
    return row


class Pictures:
    """Draws into a folder and embeds what was drawn."""

    def __init__(self, folder, results):
        self.folder = folder
        labels = [series.label for comparison in results.comparisons
                  for series in figures.flown(comparison)]
        self.styles = figures.Styles(labels)

    def embedded(self, path, text):
        """The picture as the template needs it; None if there was nothing to draw."""
        if path is None:
            return None
        content = base64.b64encode(pathlib.Path(path).read_bytes()).decode()
        return {"source": f"data:image/png;base64,{content}", "text": text, "file": path.name}

    def of(self, comparison, what, text, draw, *arguments):
        path = self.folder / f"{comparison.name}__{what}.png"
        return self.embedded(draw(comparison, *arguments, path), text)

    def maps(self, comparison):
        """Median run of each series, all in the same window."""
        runs = {series.label: measures.median_run(series) for series in figures.flown(comparison)}
        plans = {label: figures.plan_of(run) for label, run in runs.items()}
        plans = {label: plan for label, plan in plans.items() if plan}
        window = figures.common_window(plans.values()) if plans else None
        return [self.map_of(comparison, label, runs[label], plan, window)
                for label, plan in plans.items()]

    def map_of(self, comparison, label, run, plan, window):
        text = f"{label}, seed {run.seed}: {number(run.summary['explored_volume_m3'])} m³ explored"
        name = f"{comparison.name}__map__{run.outcome['planner']}__" \
               f"{run.outcome['parameter_set']}.png"
        return self.embedded(figures.draw_map(plan, window, self.folder / name), text)


def section(comparison, pictures):
    """Everything the page says of one comparison."""
    flown = figures.flown(comparison)
    base = {"title": comparison.title, "name": comparison.name, "flown": bool(flown)}
    if not flown:
        return base
    volumes = measures.all_pairs(flown, lambda run: run.summary["explored_volume_m3"])
    averages = measures.all_pairs(
        flown, lambda run: measures.mean_explored(run, comparison.time_limit_s))
    return {
        **base, "reachable": number(comparison.reachable_m3),
        "is_on_foot": any(run.summary.get("slips", 0) or run.summary.get("falls", 0)
                          for series in flown for run in series.runs),
        "without_result": [series.label for series in comparison.series if not series.runs],
        "rows": [figure_row(series, comparison) for series in flown],
        "pairs": [pair_row(pair, "explored at the end, m³") for pair in volumes]
        + [pair_row(pair, "explored, mean over time, m³") for pair in averages],
        "graph": graph_rows(comparison),
        "best_possible": sorted(comparison.best_possible), "ratios": ratio_rows(comparison),
        "best_possible_problem": comparison.best_possible_problem,
        "volume": pictures.of(comparison, "volume", "Explored volume over time",
                              figures.draw_volume, pictures.styles),
        "clearance": pictures.of(comparison, "clearance", "Clearance over time",
                                 figures.draw_clearance, pictures.styles),
        "ratio": pictures.of(comparison, "ratio", "Share of the best possible over time",
                             figures.draw_ratios, pictures.styles),
        "differences": pictures.of(comparison, "differences", "Differences by seed",
                                   figures.draw_differences, volumes),
        "maps": pictures.maps(comparison)}


def kinds_of(results):
    """How many missions ended how, in a fixed order."""
    counts = {kind: sum(run.outcome["kind"] == kind for run in results.runs) for kind in KINDS}
    return {kind: count for kind, count in counts.items() if count}


def render(results, folder):
    """The whole page as HTML; leaves its pictures in `folder`."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent), autoescape=True,
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    pictures = Pictures(folder, results)
    return environment.get_template(TEMPLATE).render(
        titles=results.titles or ("Campaign",), kinds=kinds_of(results),
        flown=len(results.runs), missing=results.missing,
        shares=[f"{100 * share:g}" for share in measures.SHARES],
        resamples=measures.RESAMPLES, seeds_min=measures.SEEDS_MIN,
        sections=[section(comparison, pictures) for comparison in results.comparisons],
        missions=[mission_row(run) for run in results.runs])
