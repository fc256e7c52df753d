#!/usr/bin/env python3
"""A clock that jumps back, as when a simulator restarts: said, held, and nothing is lost."""

import os
import sys
import time
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot

from rosgraph_msgs.msg import Clock
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger

STEP_S = 0.05


class ClockJump(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("clock_jump_test")
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        cls.status = Listener("status", PlannerStatus)
        cls.robot = MadeUpRobot()

    def run_clock(self, from_s, seconds, until=lambda: False):
        """Publishes clock and robot at real speed."""
        for step in range(int(seconds / STEP_S)):
            self.clock.publish(Clock(rospy.Time.from_sec(from_s + step * STEP_S)))
            time.sleep(STEP_S)
            if step % 2 == 0:
                self.robot.publish()
            if until():
                return

    def test_holds_and_goes_on_after_start(self):
        self.run_clock(100.0, 15.0, lambda: self.status.latest() and
                       self.status.latest().state not in ("Idle",))
        before = self.status.latest()
        self.assertIsNotNone(before, "no status")
        self.assertNotEqual(before.state, "Idle", before)
        since = self.status.count()
        self.run_clock(5.0, 2.0)
        found = self.status.wait(lambda status: "jumped back" in status.input_problem, 3.0, since)
        self.assertIsNotNone(found, self.status.messages[since:])
        self.assertNotIn(self.status.latest().state, ("Explore", "Reposition"))
        self.assertGreaterEqual(self.status.latest().mission_time_s, before.mission_time_s)
        self.assertGreaterEqual(self.status.latest().explored_volume_m3,
                                before.explored_volume_m3)
        self.run_clock(7.0, 6.0)
        answer = rospy.ServiceProxy("planner_node/start", Trigger)()
        self.assertTrue(answer.success, answer.message)
        since = self.status.count()
        self.run_clock(13.0, 1.5)
        self.assertEqual(self.status.latest().input_problem, "", self.status.latest())


if __name__ == "__main__":
    rostest.rosrun("spelunk", "clock_jump_test", ClockJump)
