#!/usr/bin/env python3
"""Both nodes over topics: the robot explores the small room and comes home."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MissionChecks

from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud2
from spelunk.msg import Graph
from std_msgs.msg import UInt32
from trajectory_msgs.msg import MultiDOFJointTrajectory
from visualization_msgs.msg import Marker, MarkerArray

DONE_WITHIN_S = 45.0


class MissionOverTopics(MissionChecks, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("mission_over_topics_test")
        cls.path = Listener("path", Path)
        cls.trajectory = Listener("command/trajectory", MultiDOFJointTrajectory)
        cls.graph = Listener("graph", Graph)
        cls.markers = Listener("markers", MarkerArray)
        cls.map_cloud = Listener("map_cloud", PointCloud2)
        cls.collisions = Listener("collisions", UInt32)
        cls.mesh = Listener("mesh", Marker)
        cls.fly_mission(1.0, DONE_WITHIN_S)

    def test_ends_where_it_began_and_touched_nothing(self):
        first, last = self.odometry.messages[0], self.odometry.latest()
        gap = sum((getattr(first.pose.pose.position, axis) -
                   getattr(last.pose.pose.position, axis)) ** 2 for axis in "xyz") ** 0.5
        self.assertLess(gap, 1.5)
        self.assertIsNotNone(self.collisions.latest())
        self.assertEqual(self.collisions.latest().data, 0)

    def test_goes_through_explore_and_home(self):
        states = {status.state for status in self.status.messages}
        self.assertTrue({"Explore", "Home", "Done"} <= states, states)
        self.assertFalse({"EStop"} & states, states)

    def test_sends_paths_and_the_same_timed(self):
        flown = [path for path in self.path.messages if path.poses]
        self.assertTrue(flown)
        self.assertEqual({path.header.frame_id for path in flown}, {"world"})
        timed = [trajectory for trajectory in self.trajectory.messages if trajectory.points]
        self.assertTrue(timed)
        times = [point.time_from_start.to_sec() for point in timed[0].points]
        self.assertEqual(times, sorted(times))

    def test_shows_map_graph_and_mission(self):
        self.assertTrue(any(cloud.width > 100 for cloud in self.map_cloud.messages))
        self.assertTrue(any(graph.vertices for graph in self.graph.messages))
        shown = {marker.ns for array in self.markers.messages for marker in array.markers}
        for layer in ("robot", "status", "trail", "path", "graph/local"):
            self.assertIn(layer, shown)
        self.assertGreater(len(self.mesh.latest().points), 30)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "mission_over_topics_test", MissionOverTopics)
