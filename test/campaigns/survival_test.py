"""The judge of survival, and a small part of the survival campaign that is really flown."""
import json
import os
import subprocess
import sys
import unittest

import support

FINE = {"returned_home": True, "remaining_at_home_s": 3.0, "remaining_targets": [], "collisions": 0,
        "falls": 0, "promise_broken_ticks": 0, "way_home_unsure_s": 0.0, "outcome": "explored"}


class Judge(support.InTemporaryFolder):
    def add(self, name, kind="finished", events="", **changes):
        folder = self.out / "missions" / name
        folder.mkdir(parents=True)
        outcome = {"mission": name, "kind": kind, "reason": "why", "time_limit_s": 100,
                   "settings": {"sim.events": events}}
        (folder / "outcome.json").write_text(json.dumps(outcome))
        if kind in ("finished", "stranded"):
            (folder / "summary.json").write_text(json.dumps({**FINE, **changes}))

    def judged(self):
        return subprocess.run([sys.executable, "-m", "campaigns.survival", str(self.out)],
                              env=self.environment, capture_output=True, text=True, check=False)

    def test_missions_that_all_survive_are_fine(self):
        self.add("a")
        self.add("b", remaining_at_home_s=50.0)
        answer = self.judged()
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("    2 missions, 0 ticks", answer.stdout)

    def test_each_kind_of_harm_is_counted_and_named(self):
        harms = {"stranded": {"kind": "stranded", "returned_home": False, "way_home_unsure_s": 1.0},
                 "collided": {"collisions": 1}, "fell": {"falls": 1},
                 "broke a promise": {"promise_broken_ticks": 7},
                 "ended without a reason": {"outcome": ""}, "crashed or hung": {"kind": "hang"}}
        for number, (name, harm) in enumerate(harms.items()):
            self.out = self.folder / f"out{number}"
            self.add("bad", **harm)
            answer = self.judged()
            self.assertEqual(answer.returncode, 1, name)
            self.assertIn(f"    1 {name}\n        bad: why", answer.stdout)

    def test_a_robot_that_was_cut_off_and_said_so_is_shown_but_no_harm(self):
        self.add("shut", kind="stranded", events="[fall 30 12]", returned_home=False,
                 way_home_unsure_s=12.0)
        answer = self.judged()
        self.assertEqual(answer.returncode, 0)
        self.assertIn("    1 cut off, and said so\n        shut: why", answer.stdout)

    def test_home_early_with_places_left_is_shown(self):
        self.add("early", remaining_at_home_s=11.0, remaining_targets=[{"why": "far"}])
        self.add("late", remaining_at_home_s=9.0, remaining_targets=[{"why": "far"}])
        self.assertIn("    1 home early with places left\n        early: why", self.judged().stdout)

    def test_a_folder_without_missions_is_refused_with_the_command_that_fills_it(self):
        answer = self.judged()
        self.assertEqual(answer.returncode, 2)
        self.assertIn("scripts/campaign config/campaigns/survival.yaml", answer.stderr)


@unittest.skipUnless(os.path.exists(os.environ.get("SPELUNK_MISSION", "")), "mission is not built")
class Flown(support.InTemporaryFolder):
    def command(self, path, *extra, out=None):
        return [sys.executable, "-m", "campaigns.front", str(path), "--out", str(out or self.out),
                "--mission", os.environ["SPELUNK_MISSION"], "--jobs", "2", *extra]

    def test_the_small_part_survives(self):
        path = support.ROOT / "config" / "campaigns" / "survival_small.yaml"
        flown = subprocess.run(self.command(path), env=self.environment, capture_output=True,
                               text=True, check=False, timeout=900)
        self.assertEqual(flown.returncode, 0, flown.stdout + flown.stderr)
        answer = subprocess.run([sys.executable, "-m", "campaigns.survival", str(self.out)],
                                env=self.environment, capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("   18 missions, 0 ticks", answer.stdout)

    def test_the_whole_campaign_is_one_that_the_executable_takes(self):
        path = support.ROOT / "config" / "campaigns" / "survival.yaml"
        answer = self.campaign(path, "--dry-run")
        self.assertEqual(answer.returncode, 0, answer.stderr)


if __name__ == "__main__":
    unittest.main()
