"""How far a campaign is and how long it will take."""
import json
import math
import shutil
import sys
import time

from campaigns import table

START = "\r\x1b[K"  # of a line that replaces what stands there


def clock(seconds):
    """1:02:03."""
    seconds = int(round(seconds))
    return f"{seconds // 3600}:{seconds // 60 % 60:02d}:{seconds % 60:02d}"


def mean(values):
    return sum(values) / len(values)


def time_left(missions, outcomes, jobs):
    """Seconds until all is flown, or None while nothing is known.

    A mission is expected to take as long as those of its planner, robot and time limit did in its
    world, else anywhere, else what the others needed in proportion to their time limits.
    """
    if not outcomes:
        return None
    took = {}
    shares = []
    for outcome in outcomes.values():
        kind = (outcome["planner"], outcome["robot"], outcome["time_limit_s"])
        for key in (kind, kind + (outcome["world"],)):
            took.setdefault(key, []).append(outcome["wall_time_s"])
        shares.append(outcome["wall_time_s"] / outcome["time_limit_s"])
    expected = []
    for mission in missions:
        if mission.name not in outcomes:
            kind = (mission.planner, mission.robot, mission.time_limit_s)
            known = took.get(kind + (mission.world,)) or took.get(kind)
            expected.append(mean(known) if known else mean(shares) * mission.time_limit_s)
    if not expected:
        return 0.0
    rounds = math.ceil(len(expected) / jobs)  # the last round keeps not every core busy
    return max(sum(expected) / jobs, mean(expected) * rounds)


def outcomes_of(missions, folder):
    """Outcome of each mission of the campaign that is complete, by name."""
    names = {mission.name for mission in missions}
    return {path.name: json.loads((path / "outcome.json").read_text())
            for path in table.complete_folders(folder) if path.name in names}


def kinds_text(outcomes):
    """`88 finished, 1 stranded, 1 crash`."""
    counts = {}
    for outcome in outcomes.values():
        counts[outcome["kind"]] = counts.get(outcome["kind"], 0) + 1
    order = ["finished", "stranded", "crash", "hang", "bad input"]
    return ", ".join(f"{counts[kind]} {kind}" for kind in order if kind in counts) or "none yet"


class Display:
    """One line that is rewritten on a terminal, else one line a mission."""

    def __init__(self, campaign, out, jobs):
        self.campaign, self.jobs = campaign, jobs
        self.folder, self.best_folder = out / "missions", out / "best_possible"
        self.begin = time.monotonic()
        self.seen = set(outcomes_of(campaign.missions, self.folder))
        self.best_seen = set(outcomes_of(campaign.best_possible, self.best_folder))

    def show(self):
        """Looks at what is complete and says what is new."""
        best = outcomes_of(self.campaign.best_possible, self.best_folder)
        for name in sorted(set(best) - self.best_seen):
            print(f"{START if sys.stdout.isatty() else ''}best_possible {name}: "
                  f"{best[name]['kind']}: {best[name]['reason']}", flush=True)
            self.best_seen.add(name)
        outcomes = outcomes_of(self.campaign.missions, self.folder)
        for name in sorted(set(outcomes) - self.seen):
            self.say(name, outcomes[name], len(self.seen) + 1)
            self.seen.add(name)
        if sys.stdout.isatty():
            left = time_left(self.campaign.missions, outcomes, self.jobs)
            rest = "" if left is None else f", about {clock(left)} left"
            line = f"{self.count(len(outcomes))} {kinds_text(outcomes)}; " \
                   f"{clock(time.monotonic() - self.begin)} gone{rest}"
            print(f"{START}{line[:shutil.get_terminal_size().columns - 1]}", end="", flush=True)

    def count(self, done):
        return f"[{done}/{len(self.campaign.missions)}]"

    def say(self, name, outcome, done):
        """One mission has ended."""
        start = START if sys.stdout.isatty() else ""
        print(f"{start}{self.count(done)} {name}: {outcome['kind']} after "
              f"{outcome['wall_time_s']:.0f} s: {outcome['reason']}", flush=True)
        if not sys.stdout.isatty():
            left = time_left(self.campaign.missions,
                             outcomes_of(self.campaign.missions, self.folder), self.jobs)
            print(f"{self.count(done)} {clock(time.monotonic() - self.begin)} gone, "
                  f"about {clock(left)} left", flush=True)
