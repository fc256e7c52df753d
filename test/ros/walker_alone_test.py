#!/usr/bin/env python3
"""The walker without a planner: what it publishes fits together, and `cmd_vel` drives it."""

import math
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import rospy
import rostest
import tf2_ros

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import UInt32
from visualization_msgs.msg import MarkerArray

SPEED_MAX_MPS = 0.5  # robot.speed_max_mps of config/robots/walker.yaml
LEGS = ("LF", "RF", "LH", "RH")


class WalkerAlone(unittest.TestCase):
    """The tests share one simulator and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("walker_alone_test")
        cls.odometry = Listener("odometry", Odometry)
        cls.cloud = Listener("pointcloud", PointCloud2)
        cls.joints = Listener("joint_states", JointState)
        cls.feet = Listener("feet", MarkerArray)
        cls.falls = Listener("falls", UInt32)
        cls.log = Listener("/rosout", Log)
        cls.tf_buffer = tf2_ros.Buffer()
        cls.tf_listener = tf2_ros.TransformListener(cls.tf_buffer)
        cls.drive = rospy.Publisher("cmd_vel", Twist, queue_size=5)
        assert cls.odometry.wait(lambda _: True, 25.0), "no odometry"
        assert cls.joints.wait(lambda _: True, 10.0), "no joint_states"

    def go(self, forward, left, turn, seconds):
        """Drives for some simulated time; the odometry of that time."""
        first = self.odometry.count()
        twist = Twist()
        twist.linear.x, twist.linear.y, twist.angular.z = forward, left, turn
        rate = rospy.Rate(10)
        end = rospy.Time.now() + rospy.Duration(seconds)
        while rospy.Time.now() < end:
            self.drive.publish(twist)
            rate.sleep()
        return self.odometry.messages[first:]

    def warnings(self):
        return [line.msg for line in self.log.messages if line.msg.startswith("cmd_vel: ")]

    def test_a_twelve_joints_of_the_description(self):
        message = self.joints.latest()
        expected = {leg + joint for leg in LEGS for joint in ("_HAA", "_HFE", "_KFE")}
        self.assertEqual(set(message.name), expected)
        self.assertEqual(len(message.position), 12)
        described = ElementTree.fromstring(rospy.get_param("robot_description"))
        limits = {joint.get("name"): joint.find("limit") for joint in described.iter("joint")
                  if joint.get("type") == "revolute"}
        self.assertEqual(set(limits), expected)
        for name, angle in zip(message.name, message.position):
            self.assertGreaterEqual(angle, float(limits[name].get("lower")) - 1e-6, name)
            self.assertLessEqual(angle, float(limits[name].get("upper")) + 1e-6, name)

    def test_b_the_feet_on_tf_are_where_the_simulator_has_them(self):
        marker = self.feet.wait(lambda message: len(message.markers) == 1, 10.0)
        self.assertIsNotNone(marker)
        rospy.sleep(1.0)
        marker = self.feet.messages[-3].markers[0]
        self.assertEqual(marker.header.frame_id, "world")
        for leg, point in zip(LEGS, marker.points):
            foot = self.tf_buffer.lookup_transform("world", leg + "_FOOT", marker.header.stamp,
                                                   rospy.Duration(2.0)).transform.translation
            self.assertLess(math.dist((foot.x, foot.y, foot.z), (point.x, point.y, point.z)),
                            0.02, leg)

    def test_c_every_sensor_sends_clouds_that_tf_can_place(self):
        for frame in ("lidar_16", "depth_front", "depth_rear"):
            cloud = self.cloud.wait(
                lambda message, wanted=frame: message.header.frame_id == wanted, 10.0)
            self.assertIsNotNone(cloud, frame)
            self.assertGreater(cloud.width, 100, frame)
            self.tf_buffer.lookup_transform("world", frame, rospy.Time(0), rospy.Duration(2.0))

    def test_d_walks_as_told_within_its_limits(self):
        before = self.odometry.latest().pose.pose.position
        driven = self.go(0.3, 0.0, 0.0, 4.0)
        after = driven[-1].pose.pose.position
        self.assertGreater(math.hypot(after.x - before.x, after.y - before.y), 0.6)
        self.assertEqual(self.warnings(), [])

        driven = self.go(-5.0, 0.0, 0.0, 4.0)
        speeds = [message.twist.twist.linear.x for message in driven]
        mean = sum(speeds[len(speeds) // 2:]) / (len(speeds) - len(speeds) // 2)
        self.assertLess(mean, -0.1, "it does not walk backwards")
        self.assertGreater(mean, -0.8 * SPEED_MAX_MPS, "walks backwards as fast as forwards")

    def test_e_says_that_it_was_limited_but_not_each_time(self):
        said = self.log.wait(lambda line: line.msg.startswith("cmd_vel: "), 5.0)
        self.assertIsNotNone(said)
        self.assertIn("-5 to -0.3 m/s", said.msg)
        self.assertLessEqual(len(self.warnings()), 2)

    def test_f_stops_when_commands_stay_away(self):
        rospy.sleep(2.0)
        first = self.odometry.latest().pose.pose.position
        rospy.sleep(2.0)
        last = self.odometry.latest().pose.pose.position
        self.assertLess(math.hypot(last.x - first.x, last.y - first.y), 0.05)

    def test_g_a_command_that_is_not_finite_moves_nothing(self):
        first = self.odometry.latest().pose.pose.position
        driven = self.go(float("nan"), 0.0, 0.0, 1.5)
        last = driven[-1].pose.pose.position
        self.assertLess(math.hypot(last.x - first.x, last.y - first.y), 0.1)
        refused = self.log.wait(lambda line: line.msg.startswith("cmd_vel refused"), 5.0)
        self.assertIsNotNone(refused)
        self.assertEqual(self.falls.latest().data, 0)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "walker_alone_test", WalkerAlone)
