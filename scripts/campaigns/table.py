"""Writes campaign.csv: one row a mission, nothing that depends on the speed of the machine.

    python3 -m campaigns.table MISSIONS_FOLDER FILE
"""
import csv
import io
import json
import pathlib
import sys

DESCRIBED = ("mission", "world", "robot", "planner", "parameter_set", "time_limit_s", "seed",
             "kind", "reason")
MEASURED = ("mission_time_s", "explored_volume_m3", "reachable_volume_m3", "path_length_m",
            "collisions", "collision_s", "min_clearance_m", "returned_home", "remaining_at_home_s",
            "falls", "slips", "trips", "zones_marked", "plans")


def complete_folders(missions):
    """Folders of flown missions, by name; half-flown ones start with a dot."""
    return sorted(path.parent for path in pathlib.Path(missions).glob("[!.]*/outcome.json"))


def row_of(folder):
    """The row of one mission; what a crashed one did not measure stays empty."""
    outcome = json.loads((folder / "outcome.json").read_text())
    row = {name: outcome[name] for name in DESCRIBED}
    if outcome["kind"] in ("finished", "stranded"):
        summary = json.loads((folder / "summary.json").read_text())
        row.update({name: summary.get(name, "") for name in MEASURED})
    return row


def text_of(missions):
    """The whole table as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, DESCRIBED + MEASURED, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(row_of(folder) for folder in complete_folders(missions))
    return text.getvalue()


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    target = pathlib.Path(sys.argv[2])
    partial = target.with_name(f".{target.name}.part")
    partial.write_text(text_of(sys.argv[1]))
    partial.replace(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
