#!/usr/bin/env python3
"""An operator drives the walker over the edge of a shaft while it explores: simulator and planner
both tell that it fell, and the mission does not go on as if nothing had happened."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from spelunk.msg import PlannerStatus
from std_msgs.msg import UInt32
from std_srvs.srv import Trigger

FALLS_WITHIN_S = 60.0
TELLS_WITHIN_S = 20.0


class WalkerFall(unittest.TestCase):
    """The tests share one fall and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("walker_fall_test")
        cls.odometry = Listener("odometry", Odometry)
        cls.status = Listener("status", PlannerStatus)
        cls.falls = Listener("falls", UInt32)
        drive = rospy.Publisher("cmd_vel", Twist, queue_size=5)
        assert cls.odometry.wait(lambda _: True, 25.0), "no odometry"
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        rospy.sleep(2.0)
        started = rospy.ServiceProxy("planner_node/start", Trigger)()
        assert started.success, started.message
        assert cls.status.wait(lambda status: status.state == "Explore", 20.0), "does not explore"
        forward = Twist()
        forward.linear.x = 0.5
        end = rospy.Time.now() + rospy.Duration(FALLS_WITHIN_S)
        rate = rospy.Rate(20)
        while not cls.has_fallen() and rospy.Time.now() < end:
            drive.publish(forward)
            rate.sleep()

    @classmethod
    def has_fallen(cls):
        return any(message.data > 0 for message in cls.falls.messages)

    def test_a_the_simulator_counts_one_fall(self):
        self.assertTrue(self.has_fallen())
        rospy.sleep(2.0)
        self.assertEqual(self.falls.latest().data, 1)

    def test_b_the_mission_stops_and_says_why(self):
        stopped = self.status.wait(lambda status: status.state == "EStop", TELLS_WITHIN_S)
        self.assertIsNotNone(stopped, "last: %s" % self.status.latest())
        self.assertRegex(stopped.reason, r"has fallen \(tilted by [0-9]+ degrees\): help it up")

    def test_c_the_mission_waits_for_help(self):
        first = self.status.count()
        rospy.sleep(3.0)
        states = {status.state for status in self.status.messages[first:]}
        self.assertEqual(states, {"EStop"}, "it went on by itself")


if __name__ == "__main__":
    rostest.rosrun("spelunk", "walker_fall_test", WalkerFall)
