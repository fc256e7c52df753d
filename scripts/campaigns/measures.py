"""Numbers of one run, of a series of runs, and of two series compared by seed."""
import dataclasses
import itertools
import warnings

import numpy as np
import scipy.stats

SHARES = (0.5, 0.8, 0.9, 0.95)
CONFIDENCE = 0.95
RESAMPLES = 9999
SEEDS_MIN = 5  # fewer differences give intervals and effect sizes that mean nothing
BOOTSTRAP_SEED = 1
MOVED_M = 0.02  # a second in which the robot went farther counts as navigation


def share(part, whole):
    """Part over whole; not a number where there is no whole."""
    return part / whole if whole > 0 else np.nan


def time_to(run, volume_m3):
    """Seconds until the run had explored so much; infinite if it never did."""
    reached = np.flatnonzero(run.timeline["explored_m3"].to_numpy() >= volume_m3)
    return float(run.timeline["t_s"].iloc[reached[0]]) if reached.size else np.inf


def on_grid(frame, column, times):
    """The column at the times; what ended keeps its last value."""
    return np.interp(times, frame["t_s"], frame[column])


def explored_at(run, times):
    """Explored volume over time, from nothing at the start."""
    frame = run.timeline
    return np.interp(times, np.append(0.0, frame["t_s"]), np.append(0.0, frame["explored_m3"]))


def mean_explored(run, time_limit_s):
    """Explored volume averaged over the time limit: who explores earlier has more."""
    return float(explored_at(run, np.arange(0.0, time_limit_s + 0.5)).mean())


def working_rate(run):
    """m3/s until nine tenths of what the run explored were explored."""
    volume = 0.9 * run.summary["explored_volume_m3"]
    return volume / time_to(run, volume) if volume > 0 else 0.0


def navigation_time(run):
    """Seconds in which the robot moved."""
    return float(np.count_nonzero(np.diff(run.timeline["distance_m"]) > MOVED_M))


def is_home_with_reserve(run):
    return bool(run.summary["returned_home"]) and run.summary["remaining_at_home_s"] > 0


def plan_times_ms(series):
    """Wall time of every plan of every run."""
    found = [run.plans["wall_ms"].to_numpy() for run in series.runs if "wall_ms" in run.plans]
    return np.concatenate(found) if found else np.array([])


def median_run(series):
    """The run in the middle of the explored volumes; the lower one of two."""
    ranked = sorted(series.runs, key=lambda run: (run.summary["explored_volume_m3"], run.seed))
    return ranked[(len(ranked) - 1) // 2]


@dataclasses.dataclass(frozen=True)
class Paired:
    """First minus second, seed by seed. No interval and no effect size where they say nothing."""

    first: str
    second: str
    seeds: int
    mean: float
    low: float
    high: float
    effect: float
    wins: int

    @property
    def has_interval(self):
        return bool(np.isfinite(self.low) and np.isfinite(self.high))


def interval_of_mean(differences):
    """Bootstrap interval, bias corrected and accelerated; by percentiles where it is undefined."""
    if len(differences) < SEEDS_MIN or np.ptp(differences) == 0:
        return np.nan, np.nan
    for method in ("BCa", "percentile"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # too few different values for BCa: the other follows
            interval = scipy.stats.bootstrap(
                (differences,), np.mean, n_resamples=RESAMPLES, confidence_level=CONFIDENCE,
                method=method, random_state=np.random.default_rng(BOOTSTRAP_SEED)
            ).confidence_interval
        if np.isfinite(interval.low) and np.isfinite(interval.high):
            break
    return float(interval.low), float(interval.high)


def effect_size(differences):
    """Cohen's d of paired samples: the mean difference in units of its standard deviation."""
    if len(differences) < SEEDS_MIN or np.ptp(differences) == 0:
        return np.nan
    return float(np.mean(differences) / np.std(differences, ddof=1))


def paired(first, second, measure):
    """Compares two series over the seeds that both flew; None if there are none."""
    of_second = {run.seed: run for run in second.runs}
    differences = np.array([measure(run) - measure(of_second[run.seed]) for run in first.runs
                            if run.seed in of_second])
    if not differences.size:
        return None
    low, high = interval_of_mean(differences)
    return Paired(first.label, second.label, differences.size, float(differences.mean()), low, high,
                  effect_size(differences), int(np.count_nonzero(differences > 0)))


def all_pairs(series, measure):
    """Every two series of a comparison."""
    found = [paired(first, second, measure) for first, second in itertools.combinations(series, 2)]
    return [item for item in found if item]
