"""Counts what a robot must never do over the missions of a campaign, and names the missions that did.

    python3 -m campaigns.survival DIR

Exit code 0: nobody stranded, touched rock or fell, no promise was broken, every mission has a reason
for its end. 1: somebody did. 2: DIR holds no flown campaign.
"""
import argparse
import pathlib
import sys

from campaigns import results

UNUSED_SHARE = 0.1  # of the endurance; more than this at home while there is work left is looked at


def is_unflown(run):
    return not run.is_measured


def is_stranded(run):
    return run.is_measured and not is_home(run) and not is_cut_off(run)


def is_cut_off(run):
    """Not home where rock fell, and the mission said that no way home is sure."""
    falls = "fall " in run.outcome["settings"].get("sim.events", "")
    return run.is_measured and not is_home(run) and falls and run.summary["way_home_unsure_s"] > 0


def is_home(run):
    return bool(run.summary["returned_home"])


def is_early(run):
    """At home with much endurance left, although the planner names places that are left."""
    if not run.is_measured or not is_home(run) or not run.summary["remaining_targets"]:
        return False
    return run.summary["remaining_at_home_s"] > UNUSED_SHARE * run.outcome["time_limit_s"]


def number(key):
    return lambda run: run.is_measured and run.summary[key] > 0


def is_without_reason(run):
    return run.is_measured and not run.summary["outcome"].strip()


MUST_NOT = {
    "crashed or hung": is_unflown,
    "stranded": is_stranded,
    "collided": number("collisions"),
    "fell": number("falls"),
    "broke a promise": number("promise_broken_ticks"),
    "ended without a reason": is_without_reason,
}
TO_LOOK_AT = {"cut off, and said so": is_cut_off, "home early with places left": is_early}


def lines_of(runs, rules):
    """One line a rule, and below it the missions that it holds for."""
    lines = []
    for name, holds in rules.items():
        found = [run for run in runs if holds(run)]
        lines.append(f"{len(found):5d} {name}")
        lines += [f"        {run.outcome['mission']}: {run.outcome['reason']}" for run in found]
    return lines


def runs_in(folder):
    return [results.read_run(path.parent)
            for path in sorted((folder / "missions").glob("[!.]*/outcome.json"))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path, help="what scripts/campaign flew into")
    folder = parser.parse_args().folder
    runs = runs_in(folder)
    if not runs:
        print(f"survival: {folder} holds no flown missions; fly some first: "
              f"scripts/campaign config/campaigns/survival.yaml --out {folder}", file=sys.stderr)
        return 2
    ticks = sum(run.summary["promise_broken_ticks"] for run in runs if run.is_measured)
    print(f"{len(runs):5d} missions, {ticks} ticks with a broken promise")
    print("\n".join(lines_of(runs, {**MUST_NOT, **TO_LOOK_AT})))
    return int(any(holds(run) for run in runs for holds in MUST_NOT.values()))


if __name__ == "__main__":
    sys.exit(main())
