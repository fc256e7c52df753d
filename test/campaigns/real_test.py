"""A short campaign of real missions, twice, and its report."""
import filecmp
import os
import subprocess
import sys
import unittest

import support


@unittest.skipUnless(os.path.exists(os.environ.get("SPELUNK_MISSION", "")), "mission is not built")
class Real(support.InTemporaryFolder):
    def command(self, path, *extra, out=None):
        return [sys.executable, "-m", "campaigns.front", str(path), "--out", str(out or self.out),
                "--mission", os.environ["SPELUNK_MISSION"], *extra]

    def test_two_runs_give_the_same_bytes_and_a_report(self):
        self.fly(support.ROOT / "config" / "campaigns" / "small.yaml", "first", 4)
        self.fly(self.describe(planners=["gbplanner", "informed"], seeds=[2], time_limits_s=[40]),
                 "second", 2)
        second = self.folder / "second"
        compared = [*second.glob("missions/*/timeline.csv"), *second.glob("missions/*/map.bt"),
                    *second.glob("missions/*/clearance.csv")]
        self.assertEqual(len(compared), 6)
        for file in compared:
            self.assertTrue(filecmp.cmp(file, self.folder / "first" / file.relative_to(second),
                                        shallow=False), file)
        rows = (self.folder / "first" / "campaign.csv").read_text().splitlines()
        again = (second / "campaign.csv").read_text().splitlines()
        self.assertEqual((len(rows), len(again)), (5, 3))
        self.assertLess(set(again), set(rows))
        self.check_report(self.folder / "first")

    def fly(self, path, out, missions):
        answer = self.campaign(path, out=self.folder / out)
        self.assertEqual(answer.returncode, 0, answer.stderr + answer.stdout)
        said = f"{missions} of {missions} missions flown: {missions} finished"
        self.assertIn(said, answer.stdout)

    def check_report(self, folder):
        subprocess.run([sys.executable, "-m", "campaigns.report", str(folder)], check=True,
                       env=self.environment, timeout=120)
        pictures = sorted(picture.name for picture in (folder / "report").glob("*.png"))
        self.assertEqual(pictures, ["room__aerial__40__clearance.png",
                                    "room__aerial__40__map__gbplanner__default.png",
                                    "room__aerial__40__map__informed__default.png",
                                    "room__aerial__40__volume.png"])

    def test_the_executable_takes_every_planner_and_parameter_of_the_shipped_campaigns(self):
        for name in ("aerial", "aerial_informed", "informed_paper", "walker"):
            path = support.ROOT / "config" / "campaigns" / f"{name}.yaml"
            answer = self.campaign(path, "--dry-run")
            self.assertEqual(answer.returncode, 0, answer.stderr)

    def test_what_the_executable_refuses_is_said_before_anything_flies(self):
        answer = self.campaign(self.describe(planners=["gbplaner", "informed"],
                                             robots=["aerial", "walker"],
                                             settings={"map.resolutoin_m": 0.1}))
        self.assertEqual(answer.returncode, 2)
        for part in ("\"gbplaner\" is not known; choose one of: gbplanner", "resolutoin_m",
                     "is for robots that fly"):
            self.assertIn(part, answer.stderr)


if __name__ == "__main__":
    unittest.main()
