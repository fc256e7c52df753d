"""Tours through surveys made by hand, whose best tours are known or found by trying all."""
import itertools
import json
import math
import os
import pathlib
import subprocess
import sys
import unittest

import support

TOUR_PYTHON = pathlib.Path(os.environ.get("SPELUNK_BUILD_DIR", support.ROOT / "build")) \
    / "tour_env" / "bin" / "python"
SPEED_MPS = 2.0
START = (0.0, 0.0, 1.0)


def length_of(points):
    return sum(math.dist(start, end) for start, end in zip(points, points[1:]))


class Mine:
    """A corridor along x with an outlook every 5 m, and rooms beside it; a room is seen only from
    its own outlook."""

    def __init__(self, length_m, rooms, corridor_m3=1.0):
        corridor = [(5.0 * i, 0.0, 1.0) for i in range(int(length_m / 5) + 1)]
        self.outlooks = corridor + [(x, y, 1.0) for x, y, _ in rooms]
        self.pairs = [(i, i + 1) for i in range(len(corridor) - 1)]
        self.pairs += [(int(x / 5), len(corridor) + i) for i, (x, _, _) in enumerate(rooms)]
        self.volumes = [corridor_m3] * len(corridor) + [volume for _, _, volume in rooms]
        self.rooms = rooms
        self.seen = [[k] for k in range(len(self.outlooks))]

    def write(self, folder):
        ways = [{"from": a, "to": b, "points": [self.outlooks[a], self.outlooks[b]],
                 "length_m": math.dist(self.outlooks[a], self.outlooks[b])}
                for a, b in self.pairs]
        (folder / "survey.json").write_text(json.dumps({
            "speed_mps": SPEED_MPS, "outlooks": self.outlooks, "ways": ways,
            "volumes_m3": self.volumes}))
        rows = bytearray()
        for voxels in self.seen:
            row = bytearray((len(self.volumes) + 7) // 8)
            for voxel in voxels:
                row[voxel // 8] |= 1 << voxel % 8
            rows += row
        (folder / "survey_seen.bin").write_bytes(rows)

    def length_to(self, rooms):
        """Of the shortest closed tour to some rooms of a straight corridor."""
        far = max((x for x, _, _ in rooms), default=0.0)
        return 2 * far + sum(2 * abs(y) for _, y, _ in rooms)


@unittest.skipUnless(TOUR_PYTHON.exists(), "OR-tools is not installed: scripts/install tour")
class TourTest(support.InTemporaryFolder):
    def run_tour(self, budget_m, out=None):
        """Lays out a tour of at most so many metres; the completed process."""
        seconds = (budget_m / SPEED_MPS + 25.0) / 0.96 + 1e-6  # the reserve that a tour leaves
        return subprocess.run([TOUR_PYTHON, "-m", "campaigns.tour", str(self.folder), "--out",
                               str(out or self.folder), "--time-limit-s", str(seconds),
                               "--speed-share", "1"], env=self.environment, capture_output=True,
                              text=True, check=False, timeout=120)


class Tours(TourTest):
    def tour(self, mine, budget_m):
        """Its points and what tour.json says."""
        mine.write(self.folder)
        answer = self.run_tour(budget_m)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        lines = (self.folder / "tour_points.csv").read_text().splitlines()
        self.assertEqual(lines[0], "x_m,y_m,z_m")
        points = [tuple(map(float, line.split(","))) for line in lines[1:]]
        said = json.loads((self.folder / "tour.json").read_text())
        self.assertEqual((points[0], points[-1]), (START, START))
        length_m = length_of(points)
        self.assertAlmostEqual(said["length_m"], length_m, delta=0.01)
        self.assertLessEqual(length_m, budget_m + 0.01)
        return points, said

    def test_with_time_enough_it_sees_all_on_the_shortest_way(self):
        mine = Mine(40, [(10, 8, 50.0), (10, -6, 50.0), (25, 8, 50.0), (40, -8, 50.0)])
        points, said = self.tour(mine, 500.0)
        self.assertEqual(set(points), set(mine.outlooks))
        self.assertAlmostEqual(said["length_m"], mine.length_to(mine.rooms), delta=0.01)
        self.assertAlmostEqual(said["seen_m3"], sum(mine.volumes), delta=0.01)
        self.assertFalse(said["is_cut"])

    def test_with_less_time_it_sees_as_much_as_the_best_choice_of_rooms(self):
        mine = Mine(40, [(5, 9, 40.0), (15, -4, 35.0), (20, 7, 60.0), (25, -9, 30.0),
                         (30, 3, 45.0), (40, 5, 90.0)], corridor_m3=0.01)
        subsets = [subset for size in range(7) for subset in itertools.combinations(mine.rooms, size)]
        for budget_m in (25.0, 60.0, 96.0):
            best = max(sum(volume for _, _, volume in subset) for subset in subsets
                       if mine.length_to(subset) <= budget_m)
            _, said = self.tour(mine, budget_m)
            self.assertGreaterEqual(said["seen_m3"], best)
            self.assertTrue(said["is_cut"])

    def test_around_a_block_it_takes_the_order_that_trying_all_finds(self):
        places = [START, (20, 3, 1), (3, 18, 1), (21, 22, 1), (-9, 11, 1), (10, -12, 1), (30, 12, 1)]
        mine = Mine(0, [])
        mine.outlooks, mine.volumes = places, [10.0] * len(places)
        mine.seen = [[k] for k in range(len(places))]
        mine.pairs = list(itertools.combinations(range(len(places)), 2))
        _, said = self.tour(mine, 1000.0)
        shortest = min(length_of([START, *order, START])
                       for order in itertools.permutations(places[1:]))
        self.assertAlmostEqual(said["length_m"], shortest, delta=0.01)

    def test_what_is_seen_on_the_way_is_no_reason_to_go_elsewhere(self):
        mine = Mine(20, [(20, 8, 80.0), (5, 8, 70.0)])
        mine.seen[4].append(len(mine.volumes) - 1)  # the second room is seen from the corridor, too
        points, said = self.tour(mine, 500.0)
        self.assertNotIn((5.0, 8.0, 1.0), points)
        self.assertAlmostEqual(said["seen_m3"], sum(mine.volumes), delta=0.01)

    def test_of_two_directions_it_flies_the_one_that_sees_earlier(self):
        ring = [START, (10, 0, 1), (10, 10, 1), (0, 10, 1)]
        mine = Mine(0, [])
        mine.outlooks, mine.pairs = ring, [(0, 1), (1, 2), (2, 3), (3, 0)]
        mine.seen = [[k] for k in range(4)]
        for volumes, first in (([1, 90, 20, 20], (10, 0, 1)), ([1, 20, 20, 90], (0, 10, 1))):
            mine.volumes = volumes
            self.assertEqual(self.tour(mine, 100.0)[0][1], first)

    def test_it_never_relies_on_a_way_home_that_it_has_not_flown(self):
        ring = [(10.0 * math.sin(angle), 10.0 - 10.0 * math.cos(angle), 1.0)
                for angle in (2.0 * math.pi * k / 12 for k in range(12))]
        ring[0] = START
        mine = Mine(0, [])
        mine.outlooks, mine.volumes = ring, [10.0] * 12
        mine.pairs = [(k, (k + 1) % 12) for k in range(12)]
        mine.seen = [[k] for k in range(12)]
        side_m = math.dist(ring[0], ring[1])
        # Round it would be home in time, but half way round the way back is all that it knows.
        points, said = self.tour(mine, 13.5 * side_m)
        self.assertEqual(len(set(points)), 7)
        self.assertAlmostEqual(said["seen_m3"], 70.0, delta=0.01)
        points, said = self.tour(mine, 22.5 * side_m)
        self.assertEqual(len(set(points)), 12)
        self.assertAlmostEqual(said["length_m"], 12 * side_m, delta=0.01)

    def test_outlooks_that_no_way_leads_to_are_left_out(self):
        mine = Mine(20, [(10, 8, 50.0), (20, 8, 5000.0)])
        mine.pairs.pop()
        points, said = self.tour(mine, 500.0)
        self.assertNotIn((20.0, 8.0, 1.0), points)
        self.assertIn((10.0, 8.0, 1.0), points)
        self.assertLess(said["seen_m3"], 60.0)

    def test_without_time_it_stays(self):
        points, said = self.tour(Mine(20, [(10, 8, 50.0)]), 0.0)
        self.assertEqual((points, said["outlooks"]), ([START, START], 0))

    def test_the_same_survey_gives_the_same_bytes(self):
        Mine(60, [(5 * i, 4 + i % 5, 20.0 + 3 * i) for i in range(1, 13)]).write(self.folder)
        for name in ("a", "b"):
            (self.folder / name).mkdir()
            self.assertEqual(self.run_tour(120.0, self.folder / name).returncode, 0)
        for name in ("tour_points.csv", "tour.json"):
            self.assertEqual((self.folder / "a" / name).read_bytes(),
                             (self.folder / "b" / name).read_bytes())


class BadSurveys(TourTest):
    def check_refused(self, *parts):
        answer = self.run_tour(100.0)
        self.assertEqual(answer.returncode, 2)
        self.assertNotIn("Traceback", answer.stderr)
        for part in parts:
            self.assertIn(part, answer.stderr)
        self.assertFalse((self.folder / "tour_points.csv").exists())

    def test_a_missing_survey_is_named(self):
        self.check_refused(str(self.folder), "no survey to be read", "best_possible writes")

    def test_a_survey_that_is_no_survey_is_named(self):
        Mine(20, []).write(self.folder)
        (self.folder / "survey.json").write_text("{\"outlooks\": [[0, 0, 1]]}")
        self.check_refused("survey.json", "volumes_m3")

    def test_an_empty_survey_is_named(self):
        mine = Mine(0, [])
        mine.volumes, mine.seen = [], [[]]
        mine.write(self.folder)
        self.check_refused("the survey is empty")

    def test_bits_that_do_not_fit_are_named(self):
        Mine(20, []).write(self.folder)
        (self.folder / "survey_seen.bin").write_bytes(b"\0\0")
        self.check_refused("survey_seen.bin holds 2 bytes", "5 outlooks and 5 voxels")


if __name__ == "__main__":
    sys.exit(unittest.main())
