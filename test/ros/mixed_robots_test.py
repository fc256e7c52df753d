#!/usr/bin/env python3
"""Two simulators on one master without frame prefixes, each with a clock: said once, with the remedy."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from rosgraph_msgs.msg import Log

WATCHED_S = 8.0


class MixedRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("mixed_robots_test")
        cls.log = Listener("/rosout", Log)

    def said(self, node, *parts):
        return [entry.msg for entry in self.log.messages
                if entry.name == node and all(part in entry.msg for part in parts)]

    def test_clock_and_frames_of_two_are_said_once(self):
        for part, remedy in (("/clock", "clock:=false"), ("'base_link'", "frame_prefix")):
            found = self.log.wait(
                lambda entry: entry.name == "/robot_1/planner_node" and part in entry.msg and
                "two nodes" in entry.msg, 40.0)
            self.assertIsNotNone(found, part)
            for word in (remedy, "/robot_1/sim_node", "/robot_2/sim_node"):
                self.assertIn(word, found.msg)
        rospy.rostime.wallsleep(WATCHED_S)
        self.assertEqual(len(self.said("/robot_1/planner_node", "two nodes", "/clock")), 1)
        self.assertEqual(len(self.said("/robot_1/planner_node", "two nodes", "'base_link'")), 1)
        self.assertEqual(len(self.said("/robot_1/sim_node", "two nodes", "/clock")), 1)
        self.assertLess(len(self.said("/robot_1/planner_node", "jump")), 5)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "mixed_robots_test", MixedRobots)
