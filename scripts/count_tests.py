#!/usr/bin/python3
"""Prints how many test cases of a folder of JUnit files passed, failed and were skipped."""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def outcome_of(case, is_wrapper):
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("status") == "notrun":
        return "skipped"
    return None if is_wrapper else "passed"  # a rostest wrapper counts only when it fails


def main():
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for path in sorted(pathlib.Path(sys.argv[1]).rglob("*.xml")):
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            outcome = outcome_of(case, path.name.startswith("rostest-"))
            if outcome:
                counts[outcome] += 1
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))


if __name__ == "__main__":
    main()
