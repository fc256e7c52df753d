"""Every command line that README and docs show runs, shortened where it flies."""
import os
import re
import unittest

import documented
from shell import BUILD, ROOT, InFreshShell, write_mesh

FLIGHT_S = 25  # simulated
FLYING_FILES = ("summary.json", "timeline.csv", "plans.csv", "map.bt", "exploration.png")
TOUR_PYTHON = BUILD / "tour_env" / "bin" / "python"


class Commands(InFreshShell):
    def setUp(self):
        super().setUp()
        for path in ROOT.iterdir():
            if path.name not in ("build", "out", "bin", ".git"):
                (self.folder / path.name).symlink_to(path)
        (self.folder / "build").symlink_to(BUILD)
        write_mesh(self.folder / "mine.stl")
        self.environment["PWD"] = str(self.folder)
        self.environment["SPELUNK_BUILD_DIR"] = str(BUILD)

    def meant(self, line):
        """The line with files that are there in place of those that a reader has."""
        return re.sub(r"(/path/to/|/path/)?\b(MINE|mine)\.stl", str(self.folder / "mine.stl"), line)

    def lines(self, pattern):
        found = [line for line in documented.commands() if re.match(pattern, line)]
        self.assertTrue(found, f"no line like {pattern} is shown any more")
        return [self.meant(line) for line in found]

    def test_every_line_that_is_shown_is_tried_here(self):
        tried = "|".join(f"(?:{pattern})" for pattern in TRIED)
        for line in documented.commands():
            self.assertRegex(line, f"^(?:{tried})", "no test runs this line; add one")

    def test_setup_file(self):
        for line in self.lines(SETUP):
            self.assert_runs(f"{line} && rospack find spelunk")

    def test_missions(self):
        for line in self.lines(MISSION):
            with self.subTest(line):
                if " --out " in line:
                    self.fly(line)
                elif "--help" not in line:
                    self.assert_runs(line + " --list-params")

    def fly(self, line):
        out = self.folder / re.search(r" --out (\S+)", line)[1]
        goes_to_a_point = "--go-to" in line  # and is there before long
        said = self.assert_runs(line if goes_to_a_point else f"{line} --time-limit-s {FLIGHT_S}",
                                timeout=400)
        self.assertRegex(said, r"(?m)^reached$" if goes_to_a_point else r"(?m)^written to ")
        self.assertEqual([name for name in FLYING_FILES if not (out / name).is_file()], [], said)

    def test_lists_of_options_and_parameters(self):
        self.assertIn("--go-to", self.assert_runs("rosrun spelunk mission --help"))
        self.assertIn("gbplanner.max_vertices",
                      self.assert_runs("rosrun spelunk mission --list-params"))

    def test_settings(self):
        for text in documented.settings():
            with self.subTest(text):
                planner = "nbvp" if "nbvp." in text else "gbplanner"
                self.assert_runs(f"rosrun spelunk mission --planner {planner} {text} --list-params")

    def test_launches(self):
        for line in self.lines(LAUNCH):
            with self.subTest(line):
                line = line.replace("rviz:=true", "")
                has_rviz = "aerial.launch" in line or "walker.launch" in line
                self.assert_launches(line + (" rviz:=false" if has_rviz else ""))

    def test_campaign_and_report(self):
        lines = self.lines(CAMPAIGN)
        for line in lines:
            with self.subTest(line):
                self.assert_runs(line + " --dry-run")
        self.assert_runs(next(line for line in lines if "small.yaml" in line))
        for line in self.lines(REPORT):
            self.assert_runs(line)
        self.assertTrue((self.folder / "out" / "small" / "report" / "report.html").is_file())

    @unittest.skipUnless(TOUR_PYTHON.exists(), "OR-tools is not installed: scripts/install tour")
    def test_best_possible(self):
        for line in self.lines(BEST_POSSIBLE):
            line = re.sub("--world \\S+", "--world room", line)
            self.assert_runs(re.sub("--time-limit-s \\S+", f"--time-limit-s {FLIGHT_S}", line))

    def test_cluster(self):
        for line in self.lines(CLUSTER):
            campaign = re.search(r"description=(\S+)", line)[1].replace("$PWD", str(ROOT))
            out = re.search(r"--directory (\S+)", line)[1]
            self.assertTrue(os.path.exists(campaign))
            said = self.assert_runs(f"mkdir -p {out} && {line} --dry-run")
            self.assertRegex(said, r"(?m)^total\s+\d+")

    def test_benchmark(self):
        for line in self.lines(BENCHMARK):
            line = line if line.startswith("rosrun") else f"rosrun spelunk {line}"
            line += "" if "--mesh" in line else f" --mesh {self.folder / 'mine.stl'}"
            line += "" if "--only" in line else " --only status"
            self.assertIn("equal", self.assert_runs(line))

    def test_demo(self):
        """With a build that was made before; what it installs and builds, scripts/test has done."""
        (self.folder / "scripts").unlink()
        scripts = self.folder / "scripts"
        scripts.mkdir()
        for name in ("demo", "environment.sh"):
            (scripts / name).write_bytes((ROOT / "scripts" / name).read_bytes())
        (scripts / "build").write_text("#!/bin/sh\n")
        for name in ("demo", "build"):
            (scripts / name).chmod(0o755)
        for line in self.lines(DEMO):
            self.assert_runs(f"{line} --time-limit-s {FLIGHT_S}")
        for name in FLYING_FILES:
            self.assertTrue((self.folder / "out" / "demo" / name).is_file(), name)

    def test_scripts_that_are_too_long_to_run_here(self):
        for line in self.lines(TOO_LONG):
            script = line.split()[0]
            self.assertTrue(os.access(ROOT / script, os.X_OK), script)
            self.assert_runs(f"bash -n {script}")

    def test_workspace(self):
        """Messages only: compiling all of the package takes minutes."""
        workspace = self.folder / "ws"
        (workspace / "src").mkdir(parents=True)
        (workspace / "src" / "spelunk").symlink_to(ROOT)
        self.setup = "/dev/null"
        for line in self.lines(WORKSPACE):
            if line.startswith("catkin_make"):
                self.assert_runs(f"{line} {MESSAGES}", cwd=workspace)
                said = self.assert_runs(". devel/setup.bash && rospack find spelunk && "
                                        "python3 -c 'import spelunk.msg, octomap_msgs.msg'",
                                        cwd=workspace)
                self.assertIn(str(workspace / "src" / "spelunk"), said)


SETUP = r"\. "
MISSION = r"(rosrun spelunk )?mission(?! --planner oracle)"
LAUNCH = "roslaunch spelunk "
CAMPAIGN = "scripts/campaign "
REPORT = "scripts/report "
SURVIVAL = "scripts/survival "  # campaigns/survival_test.py
BEST_POSSIBLE = "scripts/best_possible "
CLUSTER = "snakemake "
BENCHMARK = "(rosrun spelunk )?benchmark "
DEMO = "scripts/demo"
TOO_LONG = "scripts/test"
MESSAGES = "spelunk_generate_messages octomap_msgs_generate_messages"
WORKSPACE = "catkin(_make| build)"
PREPARED = "mkdir -p out/|mission --planner oracle"  # part of test_cluster, of test_best_possible
TRIED = (SETUP, MISSION, LAUNCH, CAMPAIGN, REPORT, SURVIVAL, BEST_POSSIBLE, CLUSTER, BENCHMARK, DEMO,
         TOO_LONG, WORKSPACE, PREPARED)


if __name__ == "__main__":
    unittest.main()
