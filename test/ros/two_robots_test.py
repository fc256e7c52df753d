#!/usr/bin/env python3
"""Two robots in namespaces of one master: one clock, frames of their own, maps that do not mix."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import PointCloud2
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

ROBOTS = ("robot_1", "robot_2")


class TwoRobots(unittest.TestCase):
    """The tests share both missions and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("two_robots_test")
        cls.log = Listener("/rosout", Log)
        cls.tf = Listener("/tf", TFMessage)
        cls.clock = Listener("/clock", Clock)
        cls.status = {name: Listener(name + "/status", PlannerStatus) for name in ROBOTS}
        cls.odometry = {name: Listener(name + "/odometry", Odometry) for name in ROBOTS}
        cls.cloud = {name: Listener(name + "/pointcloud", PointCloud2) for name in ROBOTS}
        for name in ROBOTS:
            assert cls.odometry[name].wait(lambda _: True, 30.0), "no odometry of " + name
            rospy.wait_for_service(name + "/planner_node/start", timeout=20.0)
        rospy.sleep(2.0)
        cls.started = {name: rospy.ServiceProxy(name + "/planner_node/start", Trigger)()
                       for name in ROBOTS}

    def test_a_frames_have_the_prefix_of_their_robot(self):
        for name in ROBOTS:
            self.assertTrue(self.cloud[name].wait(lambda _: True, 10.0))
            self.assertEqual(self.cloud[name].latest().header.frame_id, name + "/lidar_16")
            self.assertEqual(self.odometry[name].latest().child_frame_id, name + "/base_link")
        children = {transform.child_frame_id for message in self.tf.messages
                    for transform in message.transforms}
        self.assertEqual(children, {name + "/" + frame for name in ROBOTS
                                    for frame in ("base_link", "lidar_16")})

    def test_b_time_never_goes_back(self):
        stamps = [message.clock.to_sec() for message in self.clock.messages]
        self.assertEqual(stamps, sorted(stamps))
        for name in ROBOTS:
            stamps = [message.header.stamp.to_sec() for message in self.odometry[name].messages]
            self.assertEqual(stamps, sorted(stamps), name)
            behind = self.clock.latest().clock - self.odometry[name].latest().header.stamp
            self.assertLess(abs(behind.to_sec()), 5.0, name)

    def test_c_both_explore_their_room_and_come_home(self):
        for name in ROBOTS:
            self.assertTrue(self.started[name].success, self.started[name].message)
            done = self.status[name].wait(lambda status: status.state == "Done", 80.0)
            self.assertIsNotNone(done, self.status[name].latest())
            self.assertGreater(done.explored_volume_m3, 100.0, name)
            self.assertEqual(done.input_problem, "", name)

    def test_d_nothing_was_said_of_clocks_or_frames(self):
        said = [entry.msg for entry in self.log.messages
                if "jump" in entry.msg or "two nodes" in entry.msg]
        self.assertEqual(said, [])


if __name__ == "__main__":
    rostest.rosrun("spelunk", "two_robots_test", TwoRobots)
