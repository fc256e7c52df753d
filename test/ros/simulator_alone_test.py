#!/usr/bin/env python3
"""simulator.launch without our planner: anybody's `path` or `command/trajectory` flies the robot."""

import os
import sys
import unittest

import rospy
import rostest
import tf2_ros

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from geometry_msgs.msg import PoseStamped, Transform, Twist
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import BatteryState, PointCloud2
from trajectory_msgs.msg import MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint


class SimulatorAlone(unittest.TestCase):
    """The tests share one simulator and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("simulator_alone_test")
        cls.odometry = Listener("odometry", Odometry)
        cls.cloud = Listener("pointcloud", PointCloud2)
        cls.battery = Listener("battery", BatteryState)
        cls.tf_buffer = tf2_ros.Buffer()
        cls.tf_listener = tf2_ros.TransformListener(cls.tf_buffer)
        cls.path = rospy.Publisher("path", Path, queue_size=5)
        cls.trajectory = rospy.Publisher("command/trajectory", MultiDOFJointTrajectory,
                                         queue_size=5)
        assert cls.odometry.wait(lambda _: True, 25.0), "no odometry"
        rospy.sleep(1.0)

    def here(self):
        return self.odometry.latest().pose.pose.position

    def path_ahead(self, dx, frame="world"):
        path = Path()
        path.header.frame_id = frame
        pose = PoseStamped()
        pose.pose.position.x = self.here().x + dx
        pose.pose.position.y = self.here().y
        pose.pose.position.z = self.here().z
        pose.pose.orientation.w = 1.0
        path.poses = [pose]
        return path

    def arrives(self, x):
        return self.odometry.wait(lambda odometry: abs(odometry.pose.pose.position.x - x) < 0.15,
                                  8.0, self.odometry.count()) is not None

    def test_a_clouds_fit_tf_and_the_battery_runs_down(self):
        cloud = self.cloud.wait(lambda message: message.width > 100, 10.0)
        self.assertIsNotNone(cloud)
        self.assertEqual(cloud.header.frame_id, "lidar_16")
        rospy.sleep(0.5)
        cloud = self.cloud.messages[-3]
        self.tf_buffer.lookup_transform("world", cloud.header.frame_id, cloud.header.stamp,
                                        rospy.Duration(1.0))
        first = self.battery.wait(lambda _: True, 10.0)
        self.assertLessEqual(first.percentage, 1.0)
        later = self.battery.wait(lambda message: message.charge < first.charge, 10.0)
        self.assertIsNotNone(later, "the battery does not run down")
        self.assertLess(later.current, 0.0)

    def test_b_a_path_in_another_frame_moves_nothing(self):
        x = self.here().x
        self.path.publish(self.path_ahead(0.8, frame="moon"))
        rospy.sleep(2.0)
        self.assertLess(abs(self.here().x - x), 0.1)

    def test_c_follows_a_path(self):
        path = self.path_ahead(0.8)
        self.path.publish(path)
        self.assertTrue(self.arrives(path.poses[0].pose.position.x), self.here())

    def test_d_follows_a_trajectory_and_then_no_bare_path(self):
        rospy.sleep(1.0)
        x = self.here().x
        trajectory = MultiDOFJointTrajectory()
        trajectory.header.frame_id = "world"
        trajectory.header.stamp = rospy.Time.now()
        for number in range(21):
            share = number / 20.0
            transform = Transform()
            transform.translation.x = x - 0.8 * share
            transform.translation.y = self.here().y
            transform.translation.z = self.here().z
            transform.rotation.w = 1.0
            twist = Twist()
            twist.linear.x = -0.4 if 0 < number < 20 else 0.0
            trajectory.points.append(MultiDOFJointTrajectoryPoint(
                [transform], [twist], [], rospy.Duration(2.0 * share)))
        self.trajectory.publish(trajectory)
        self.assertTrue(self.arrives(x - 0.8), self.here())
        rospy.sleep(1.0)
        x = self.here().x
        self.path.publish(self.path_ahead(0.8))
        rospy.sleep(2.0)
        self.assertLess(abs(self.here().x - x), 0.15, "both would fight over the robot")


if __name__ == "__main__":
    rostest.rosrun("spelunk", "simulator_alone_test", SimulatorAlone)
