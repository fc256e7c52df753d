#!/usr/bin/env python3
"""walker.launch: the walking robot explores the small room over topics and comes home."""

import math
import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MissionChecks

from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import UInt32

DONE_WITHIN_S = 180.0  # 140 s are simulated; a busy machine does not keep the pace asked for


class WalkerMission(MissionChecks, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("walker_mission_test")
        cls.joints = Listener("joint_states", JointState)
        cls.elevation = Listener("elevation", PointCloud2)
        cls.traversability = Listener("traversability", OccupancyGrid)
        cls.falls = Listener("falls", UInt32)
        cls.collisions = Listener("collisions", UInt32)
        cls.fly_mission(2.0, DONE_WITHIN_S)

    def test_ends_where_it_began_on_its_feet(self):
        first = self.odometry.messages[0].pose.pose.position
        last = self.odometry.latest().pose.pose.position
        self.assertLess(math.hypot(last.x - first.x, last.y - first.y), 1.0)
        self.assertEqual(self.falls.latest().data, 0)
        self.assertEqual(self.collisions.latest().data, 0)

    def test_shows_the_ground_it_walks_on(self):
        cloud = self.elevation.latest()
        self.assertEqual([field.name for field in cloud.fields],
                         ["x", "y", "z", "rgb", "traversability", "variance_m2"])
        self.assertGreater(cloud.width, 2000)
        grid = self.traversability.latest()
        self.assertEqual(len(grid.data), grid.info.width * grid.info.height)
        walkable = sum(1 for cell in grid.data if 0 <= cell < 99)
        self.assertGreater(walkable, 2000, "most of the room's floor")
        self.assertIn(-1, grid.data, "what lies behind the walls")
        robot = self.odometry.latest().pose.pose.position
        self.assertLess(abs(grid.info.origin.position.z - (robot.z - 0.5)), 0.25)

    def test_moves_its_legs_while_it_walks(self):
        knees = [message.position[message.name.index("LF_KFE")] for message in self.joints.messages]
        self.assertGreater(max(knees) - min(knees), 0.1)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "walker_mission_test", WalkerMission)
