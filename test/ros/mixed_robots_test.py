#!/usr/bin/env python3
"""A second robot that sends the same frames and a clock of its own: said once, with the remedy."""

import os
import sys
import time
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot

from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock, Log

STEP_S = 0.02
MIXED_S = 8.0


class MixedRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("mixed_robots")
        cls.log = Listener("/rosout", Log)
        cls.odometry = Listener("robot_1/odometry", Odometry)
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        cls.robot = MadeUpRobot()

    def said(self, node, *parts):
        return [entry.msg for entry in self.log.messages
                if entry.name == node and all(part in entry.msg for part in parts)]

    def test_clock_and_frames_of_two_are_said_once(self):
        self.assertIsNotNone(self.odometry.wait(lambda _: True, 30.0))
        for step in range(int(MIXED_S / STEP_S)):
            self.clock.publish(Clock(rospy.Time.from_sec(1000.0 + step * STEP_S)))
            self.robot.publish_tf()
            time.sleep(STEP_S)
        for part, remedy in (("/clock", "clock:=false"), ("'base_link'", "frame_prefix")):
            said = self.said("/robot_1/planner_node", "two nodes", part)
            self.assertEqual(len(said), 1, [entry.msg for entry in self.log.messages])
            for word in (remedy, "/robot_1/sim_node", "/mixed_robots"):
                self.assertIn(word, said[0])
        self.assertEqual(len(self.said("/robot_1/sim_node", "two nodes", "/clock")), 1)
        self.assertLess(len(self.said("/robot_1/planner_node", "clock jumped")), 6)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "mixed_robots_test", MixedRobots)
