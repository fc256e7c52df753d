#!/usr/bin/env python3
"""What stops the robot and calls it home answers at once while a plan of seconds runs."""

import os
import sys
import threading
import time
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from nav_msgs.msg import Odometry, Path
from spelunk.msg import PlannerStatus
from spelunk.srv import Plan
from std_srvs.srv import Trigger

LONG_S = 2.0    # a plan that takes longer is slow
QUICK_S = 0.5   # the promise is 0.1 s; the machine of a test may be busy


class Urgent(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("urgent_test")
        cls.status = Listener("status", PlannerStatus)
        cls.odometry = Listener("odometry", Odometry)
        cls.path = Listener("path", Path)
        cls.services = {}
        for name in ("start", "pause", "home", "estop"):
            rospy.wait_for_service("planner_node/" + name, timeout=20.0)
            cls.services[name] = rospy.ServiceProxy("planner_node/" + name, Trigger)
        cls.plan = rospy.ServiceProxy("planner_node/plan", Plan)
        assert cls.odometry.wait(lambda _: True, 20.0), "no odometry"
        rospy.sleep(1.0)

    def ask_while_planning(self, names):
        """Seconds that each service takes while ~plan runs, and how long that runs on after."""
        ended = []

        def plan():
            self.plan()
            ended.append(time.monotonic())

        thread = threading.Thread(target=plan)
        thread.start()
        rospy.sleep(0.5)  # the plan is under way
        took = {}
        for name in names:
            begin = time.monotonic()
            answer = self.services[name]()
            took[name] = time.monotonic() - begin
            self.assertTrue(answer.success, "%s: %s" % (name, answer.message))
        last = time.monotonic()
        thread.join()
        return took, ended[0] - last

    def test_answers_while_a_plan_of_seconds_runs(self):
        self.assertTrue(self.services["start"]().success)
        self.status.wait(lambda status: status.state == "Explore", 30.0)
        took, goes_on = self.ask_while_planning(("pause", "home", "estop"))
        self.assertGreater(goes_on, LONG_S, "the plan is not slow: the test shows nothing")
        for name, seconds in took.items():
            self.assertLess(seconds, QUICK_S, "%s took %.2f s" % (name, seconds))
        found = self.status.wait(lambda status: status.state == "EStop", 10.0)
        self.assertIsNotNone(found, "last: %s" % self.status.latest())
        self.assertFalse(self.path.latest().poses, "the robot is to hold")


if __name__ == "__main__":
    rostest.rosrun("spelunk", "urgent_test", Urgent)
