"""Reads a campaign's folder: every mission that was flown, and how many were not."""
import dataclasses
import functools
import json
import pathlib

import pandas

from campaigns import description, table

BEST_POSSIBLE = {"bound": "bound.csv", "tour": "tour.csv"}


class ResultsError(Exception):
    """The folder holds nothing to report on."""


def read_table(path):
    """A CSV; the columns of one without rows are numbers like those of the others."""
    frame = pandas.read_csv(path)
    return frame.astype(float) if frame.empty else frame


@dataclasses.dataclass(frozen=True)
class Run:
    """One mission; one that crashed or hung has no summary and no tables."""

    folder: pathlib.Path
    outcome: dict
    summary: dict

    @property
    def is_measured(self):
        return bool(self.summary)

    @property
    def seed(self):
        return self.outcome["seed"]

    @functools.cached_property
    def timeline(self):
        return read_table(self.folder / "timeline.csv")

    @functools.cached_property
    def clearance(self):
        """None where the mission wrote none."""
        path = self.folder / "clearance.csv"
        return read_table(path) if path.exists() else None

    @functools.cached_property
    def plans(self):
        path = self.folder / "plans.csv"
        return read_table(path) if path.exists() else pandas.DataFrame()


@dataclasses.dataclass(frozen=True)
class Series:
    """One planner with one parameter set: measured runs by seed, and how many have no result."""

    planner: str
    label: str
    runs: tuple
    failures: int = 0


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Everything flown by one robot in one world within one time limit."""

    world: str
    robot: str
    time_limit_s: float
    series: tuple
    best_possible: dict  # "bound" and "tour" where known: columns t_s, explored_m3
    references: tuple
    best_possible_problem: str = ""  # why less is known than was asked for

    @property
    def name(self):
        return "__".join([self.world, self.robot, description.number_text(self.time_limit_s)])

    @property
    def title(self):
        return f"{self.world}, {self.robot}, {self.time_limit_s:g} s"

    @property
    def reachable_m3(self):
        """What there is to explore; nothing if no run got so far as to measure it."""
        return max((run.summary["reachable_volume_m3"] for series in self.series
                    for run in series.runs), default=0.0)


@dataclasses.dataclass(frozen=True)
class Results:
    """A whole folder."""

    titles: tuple
    runs: tuple
    comparisons: tuple
    missing: tuple


def read_run(folder):
    outcome = json.loads((folder / "outcome.json").read_text())
    is_measured = outcome["kind"] in ("finished", "stranded")
    summary = json.loads((folder / "summary.json").read_text()) if is_measured else {}
    return Run(folder, outcome, summary)


def campaigns_of(folder):
    """The descriptions that were flown into the folder."""
    return [description.read(path) for path in sorted((folder / "descriptions").glob("*.yaml"))]


def read_best_possible(folder, name):
    """Curves that another program left for a world, a robot and a time limit."""
    place = folder / "best_possible" / name
    return {kind: pandas.read_csv(place / file) for kind, file in BEST_POSSIBLE.items()
            if (place / file).exists()}


def best_possible_problem(folder, name):
    """What kept the best possible from being found out; nothing if it was or nobody asked."""
    path = folder / "best_possible" / name / "outcome.json"
    outcome = json.loads(path.read_text()) if path.exists() else {"kind": "finished"}
    return "" if outcome["kind"] == "finished" else f"{outcome['kind']}: {outcome['reason']}"


def series_of(runs):
    """Measured runs by planner and parameter set, which is named where a planner has several."""
    groups = {}
    for run in runs:
        groups.setdefault((run.outcome["planner"], run.outcome["parameter_set"]), []).append(run)
    planners = [planner for planner, _ in groups]
    found = []
    for (planner, parameter_set), members in sorted(groups.items()):
        label = planner if planners.count(planner) == 1 else f"{planner} ({parameter_set})"
        measured = sorted((run for run in members if run.is_measured), key=lambda run: run.seed)
        found.append(Series(planner, label, tuple(measured), len(members) - len(measured)))
    return tuple(found)


def comparisons_of(folder, runs, references):
    groups = {}
    for run in runs:
        key = run.outcome["world"], run.outcome["robot"], run.outcome["time_limit_s"]
        groups.setdefault(key, []).append(run)
    found = []
    for (world, robot, time_limit_s), members in sorted(groups.items()):
        fitting = tuple(item for item in references
                        if (item["world"], item["robot"], item["time_limit_s"])
                        == (world, robot, time_limit_s))
        bare = Comparison(world, robot, time_limit_s, series_of(members), {}, fitting)
        found.append(dataclasses.replace(
            bare, best_possible=read_best_possible(folder, bare.name),
            best_possible_problem=best_possible_problem(folder, bare.name)))
    return tuple(found)


def read(folder):
    """Everything in a campaign's folder. Raises ResultsError if no mission was flown."""
    folder = pathlib.Path(folder)
    runs = tuple(read_run(path) for path in table.complete_folders(folder / "missions"))
    if not runs:
        raise ResultsError(f"{folder}: no mission flown yet; run scripts/campaign FILE --out "
                           f"{folder}")
    campaigns = campaigns_of(folder)
    flown = {run.outcome["mission"] for run in runs}
    described = {mission.name for campaign in campaigns for mission in campaign.missions}
    references = [item for campaign in campaigns for item in campaign.references]
    return Results(tuple(campaign.title for campaign in campaigns), runs,
                   comparisons_of(folder, runs, references), tuple(sorted(described - flown)))
