"""Time left of a campaign."""
import unittest

import support
from campaigns import description, progress


def missions_of(*groups):
    return description.parse({"groups": [
        {"robots": ["aerial"], "seeds": "1-4", "time_limits_s": [100], **group}
        for group in groups]})[0].missions


def outcomes_of(missions, wall_time_s):
    return {mission.name: {"planner": mission.planner, "robot": mission.robot, "kind": "finished",
                           "world": mission.world, "time_limit_s": mission.time_limit_s,
                           "wall_time_s": wall_time_s} for mission in missions}


class TimeLeft(unittest.TestCase):
    def setUp(self):
        self.slow = missions_of({"worlds": ["cave"], "planners": ["slow"]})
        self.fast = missions_of({"worlds": ["cave"], "planners": ["fast"]})
        self.elsewhere = missions_of({"worlds": ["room"], "planners": ["slow"]})

    def test_nothing_is_known_at_first_and_nothing_left_at_last(self):
        self.assertIsNone(progress.time_left(self.slow, {}, 2))
        self.assertEqual(progress.time_left(self.slow, outcomes_of(self.slow, 9.0), 2), 0.0)

    def test_missions_take_what_their_like_took(self):
        outcomes = {**outcomes_of(self.slow[:1], 30.0), **outcomes_of(self.fast[:2], 10.0)}
        self.assertEqual(progress.time_left(self.slow + self.fast, outcomes, 1), 3 * 30 + 2 * 10)

    def test_the_same_world_is_the_better_witness(self):
        outcomes = {**outcomes_of(self.slow[:1], 30.0), **outcomes_of(self.elsewhere[:1], 50.0)}
        self.assertEqual(progress.time_left(self.elsewhere, outcomes, 1), 3 * 50)

    def test_an_unseen_planner_is_reckoned_by_its_time_limit(self):
        outcomes = outcomes_of(self.slow[:1], 30.0)
        self.assertAlmostEqual(progress.time_left(self.slow[:1] + self.fast, outcomes, 1), 4 * 30)

    def test_the_last_mission_cannot_be_shared_between_cores(self):
        outcomes = outcomes_of(self.slow[:3], 30.0)
        self.assertEqual(progress.time_left(self.slow, outcomes, 8), 30)

    def test_clock(self):
        self.assertEqual([progress.clock(seconds) for seconds in (0, 59.6, 3723)],
                         ["0:00:00", "0:01:00", "1:02:03"])

    def test_kinds_are_counted_in_a_fixed_order(self):
        outcomes = {name: {"kind": kind} for name, kind in
                    zip("abcd", ["hang", "finished", "crash", "finished"])}
        self.assertEqual(progress.kinds_text(outcomes), "2 finished, 1 crash, 1 hang")


if __name__ == "__main__":
    unittest.main()
