"""Writes the report of a campaign: one HTML page with everything in it, and its pictures as PNG.

    scripts/report DIR [--out FILE]

Reads what scripts/campaign wrote into DIR, complete or not. The same DIR gives the same bytes.
"""
import argparse
import pathlib
import sys

from campaigns import description, page, results


def main():
    parser = argparse.ArgumentParser(prog="report", description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path, metavar="DIR",
                        help="--out of scripts/campaign")
    parser.add_argument("--out", type=pathlib.Path, metavar="FILE",
                        help="the page, DIR/report/report.html; pictures go beside it")
    options = parser.parse_args()
    out = options.out or options.folder / "report" / "report.html"
    try:
        found = results.read(options.folder)
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(page.render(found, out.parent), encoding="utf-8")
    except (results.ResultsError, description.DescriptionError, OSError) as error:
        print(f"report: {error}", file=sys.stderr)
        return 2
    missing = f"; {len(found.missing)} missions are missing" if found.missing else ""
    print(f"report: {len(found.runs)} missions in {out}{missing}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
