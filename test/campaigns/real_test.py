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
        path = support.ROOT / "config" / "campaigns" / "small.yaml"
        for out in ("first", "second"):
            answer = self.campaign(path, out=self.folder / out)
            self.assertEqual(answer.returncode, 0, answer.stderr + answer.stdout)
            self.assertIn("4 of 4 missions flown: 4 finished", answer.stdout)
        first = self.folder / "first"
        compared = [first / "campaign.csv", *first.glob("missions/*/timeline.csv"),
                    *first.glob("missions/*/clearance.csv"), *first.glob("missions/*/map.bt")]
        self.assertEqual(len(compared), 13)
        for file in compared:
            self.assertTrue(filecmp.cmp(file, self.folder / "second" / file.relative_to(first),
                                        shallow=False), file)
        subprocess.run([sys.executable, "-m", "campaigns.report", str(first)], check=True,
                       env=self.environment, timeout=120)
        pictures = sorted(picture.name for picture in (first / "report").glob("*.png"))
        self.assertEqual(pictures, ["room__aerial__40__clearance.png",
                                    "room__aerial__40__map__gbplanner__default.png",
                                    "room__aerial__40__map__informed__default.png",
                                    "room__aerial__40__volume.png"])


if __name__ == "__main__":
    unittest.main()
