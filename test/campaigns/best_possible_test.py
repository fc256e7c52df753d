"""The best possible run of a world: its steps, its place in campaigns, and one real world."""
import csv
import filecmp
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import support
from campaigns import best_possible

FAKE = pathlib.Path(__file__).resolve().with_name("fake_best_possible.py")
TOUR = {"length_m": 100.0, "speed_mps": 2.0, "is_cut": True}


def flight(time_s, outcome="explored: the tour is at its end", path_m=100.0):
    return {"mission_time_s": time_s, "outcome": outcome, "path_length_m": path_m}


class SpeedShare(unittest.TestCase):
    def test_a_tour_that_was_over_early_is_laid_out_with_the_speed_that_was_flown(self):
        self.assertAlmostEqual(best_possible.corrected_share(TOUR, flight(45.0), 0.85), 100 / 90)

    def test_one_step_does_not_go_beyond_reason(self):
        share = best_possible.corrected_share(TOUR, flight(2.0), 0.5)
        self.assertAlmostEqual(share, 0.5 * best_possible.FASTER)

    def test_a_tour_that_used_its_time_or_sees_everything_stays(self):
        self.assertIsNone(best_possible.corrected_share(TOUR, flight(58.0), 0.85))
        self.assertIsNone(best_possible.corrected_share({**TOUR, "is_cut": False}, flight(20.0), 0.85))

    def test_a_tour_that_was_not_over_in_time_becomes_shorter(self):
        slow = flight(60.0, "home by endurance", path_m=72.0)
        self.assertAlmostEqual(best_possible.corrected_share(TOUR, slow, 0.85), 0.6)
        hardly = flight(60.0, "home by endurance", path_m=110.0)
        self.assertLess(best_possible.corrected_share(TOUR, hardly, 0.85), 0.8)

    def test_home_counts_more_than_volume(self):
        home, lost = ({"returned_home": is_home, "explored_volume_m3": volume}
                      for is_home, volume in ((True, 10.0), (False, 99.0)))
        self.assertGreater(best_possible.rank(home), best_possible.rank(lost))


class WithFakes(support.InTemporaryFolder):
    """Executables and solver are fakes; `place` holds the answers of the campaign."""

    def setUp(self):
        super().setUp()
        tools = self.folder / "tools"
        (tools / "tour_env" / "bin").mkdir(parents=True)
        for path, target in ((tools / "mission", support.FAKE_MISSION),
                             (tools / "best_possible", FAKE),
                             (tools / "tour_env" / "bin" / "python", FAKE)):
            path.symlink_to(target)
        self.environment["SPELUNK_BUILD_DIR"] = str(tools)
        self.tools, self.place = tools, self.out / "best_possible"

    def campaign(self, path, *extra, out=None):
        return super().campaign(path, "--mission", str(self.tools / "mission"), *extra, out=out)

    def alone(self, *extra):
        return subprocess.run([sys.executable, "-m", "campaigns.best_possible", "--world", "room",
                               "--time-limit-s", "10", "--out", str(self.out), "--executables",
                               str(self.tools), *extra], env=self.environment, text=True,
                              capture_output=True, check=False, timeout=60)

    def surveys(self):
        return self.flights("survey")


class Alone(WithFakes):
    def test_bound_tour_and_flight_lie_side_by_side(self):
        answer = self.alone()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("explores 110 m3 and is home after 10 s; nobody explores more than 200 m3 (55 %)",
                      answer.stdout)
        rows = (self.out / "tour.csv").read_text().splitlines()
        self.assertEqual(rows[:3], ["t_s,explored_m3", "0.000,0.000", "1.000,11.000"])
        self.assertEqual({path.name for path in self.out.iterdir()},
                         {"bound.csv", "tour.csv", "tour_points.csv", "tour.json", "flight",
                          "outcome.json", "best_possible.log"})

    def test_the_tour_that_explored_most_stays_with_its_flight(self):
        self.alone()  # 8.5 m in 10 s, as expected, with either kind of tour
        self.assertEqual(self.flights("begin"), 2 * ["oracle 1"])
        shutil.rmtree(self.out)
        self.alone("--set", "fake.half=1")  # 8.5 m in 4 s, then 1.6 times so far in 6 s
        self.assertEqual(self.flights("begin"), 6 * ["oracle 1"])
        length = round(json.loads((self.out / "tour.json").read_text())["length_m"], 3)
        flown = json.loads((self.out / "flight" / "summary.json").read_text())
        self.assertEqual((length, flown["explored_volume_m3"]), (13.6, 66.0))
        self.assertIn("6.000,66.000", (self.out / "tour.csv").read_text())

    def test_a_folder_with_something_in_it_is_left_alone(self):
        self.out.mkdir()
        (self.out / "mine.txt").touch()
        answer = self.alone()
        self.assertEqual(answer.returncode, 1)
        self.assertIn("is not empty; choose another --out", answer.stderr)
        self.assertEqual([path.name for path in self.out.iterdir()], ["mine.txt"])

    def test_a_missing_solver_is_named_with_the_remedy(self):
        answer = self.alone("--tour-python", "/nowhere/python")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("/nowhere/python is no executable: run scripts/build and scripts/install tour",
                      answer.stdout)


class InCampaigns(WithFakes):
    def test_it_is_found_out_once_for_all_planners_and_only_where_asked(self):
        group = {"robots": ["aerial"], "seeds": [1], "time_limits_s": [10]}
        path = self.write_description({
            "parameter_sets": {"slow": {"robot.speed_max_mps": 0.3, "fake.wall_s": 0}},
            "groups": [{**group, "worlds": ["room"], "planners": ["steady", "brisk"],
                        "parameter_sets": ["slow"], "best_possible": True},
                       {**group, "worlds": ["cave"], "planners": ["steady"]}]})
        answer = self.campaign(path)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("1 of 1 best possibles known: 1 finished", answer.stdout)
        self.assertEqual(self.surveys(), ["room robot.speed_max_mps=0.3"])
        self.assertEqual([path.name for path in self.place.iterdir()], ["room__aerial__10"])
        self.assertEqual((self.out / "campaign.csv").read_text().count("finished"), 3)

        self.assertEqual(self.campaign(path).returncode, 0)
        self.assertEqual(len(self.surveys()), 1)  # resumed, not repeated

    def test_a_failure_is_recorded_stops_nothing_and_is_repeated_when_asked(self):
        path = self.describe(worlds=["room_obs_15", "room"], seeds=[1], best_possible=True)
        first = self.campaign(path)
        self.assertEqual(first.returncode, 1)
        self.assertIn("2 of 2 missions flown: 2 finished", first.stdout)
        self.assertIn("2 of 2 best possibles known: 1 finished, 1 bad input", first.stdout)
        failed = self.place / "room_obs_15__aerial__10"
        self.assertEqual(json.loads((failed / "outcome.json").read_text())["reason"],
                         "best_possible: nothing can be reached")
        self.assertTrue((failed / "bound.csv").exists())
        self.check_report()

        self.campaign(path)
        self.assertEqual(len(self.surveys()), 2)
        (self.folder / "mended").touch()
        again = self.campaign(path, "--retry-failed")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(len(self.surveys()), 3)

    def check_report(self):
        subprocess.run([sys.executable, "-m", "campaigns.report", str(self.out)], check=True,
                       env=self.environment, timeout=120)
        page = (self.out / "report" / "report.html").read_text()
        self.assertIn("Could not be found out: bad input: best_possible: nothing can be reached", page)
        self.assertEqual(page.count("Could not be found out"), 1)
        self.assertTrue((self.out / "report" / "room__aerial__10__ratio.png").exists())

    def test_a_dry_run_lists_it(self):
        answer = self.campaign(self.describe(best_possible=True), "--dry-run")
        self.assertIn("to find out: best_possible room__aerial__10", answer.stdout)
        self.assertFalse(self.out.exists())


MISSION = pathlib.Path(os.environ.get("SPELUNK_MISSION", "/nowhere"))
TOUR_PYTHON = pathlib.Path(os.environ.get("SPELUNK_BUILD_DIR", support.ROOT / "build")) \
    / "tour_env" / "bin" / "python"


@unittest.skipUnless(MISSION.exists() and MISSION.with_name("best_possible").exists()
                     and TOUR_PYTHON.exists(), "mission, best_possible or OR-tools is not there")
class Real(support.InTemporaryFolder):
    def find_out(self, out):
        return subprocess.run([sys.executable, "-m", "campaigns.best_possible", "--world", "room",
                               "--time-limit-s", "60", "--out", str(out), "--executables",
                               str(MISSION.parent), "--tour-python", str(TOUR_PYTHON)],
                              env=self.environment, text=True, capture_output=True, check=False,
                              timeout=300)

    def test_a_room_is_explored_nearly_as_well_as_can_be_and_again_the_same(self):
        for name in ("a", "b"):
            answer = self.find_out(self.folder / name)
            self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        for name in ("bound.csv", "tour.csv", "tour_points.csv"):
            self.assertTrue(filecmp.cmp(self.folder / "a" / name, self.folder / "b" / name,
                                        shallow=False), name)
        bound, tour = (self.curve(self.folder / "a" / name) for name in ("bound.csv", "tour.csv"))
        self.assertGreater(tour[max(tour)], 0.9 * bound[60.0])
        for second, volume in tour.items():
            self.assertLessEqual(volume, bound[second], second)

    def curve(self, path):
        with open(path, encoding="utf-8", newline="") as file:
            return {float(row["t_s"]): float(row["explored_m3"]) for row in csv.DictReader(file)}


if __name__ == "__main__":
    unittest.main()
