#!/usr/bin/env python3
"""Somebody's SLAM closes loops: tf map -> odom jumps twice while the robot explores."""

import math
import os
import sys
import threading
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped, Vector3

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from spelunk.msg import PlannerStatus
from std_msgs.msg import UInt32
from std_srvs.srv import Trigger
from trajectory_msgs.msg import MultiDOFJointTrajectory

# Of map -> odom: x, y, z in metres and yaw in degrees.
BEGIN = (5.0, -3.0, 0.4, 20.0)
CLOSURES = ((0.75, 0.5, 0.05, 1.5), (0.75, 0.5, 0.05, 1.5))


def yaw_of(rotation):
    return 2.0 * math.atan2(rotation.z, rotation.w)


class Slam:
    """Sends map -> odom, and takes what is commanded in the map into the driver's odom."""

    def __init__(self):
        self._lock = threading.Lock()
        self._shift = np.array(BEGIN[:3])
        self._yaw = math.radians(BEGIN[3])
        self._here = np.zeros(3)
        self._tf = tf2_ros.TransformBroadcaster()
        self._out = rospy.Publisher("command/trajectory", MultiDOFJointTrajectory, queue_size=5)
        rospy.Subscriber("odometry", Odometry, self._see)
        rospy.Subscriber("map_trajectory", MultiDOFJointTrajectory, self._pass_on)
        rospy.Timer(rospy.Duration(0.05), self._send)

    @staticmethod
    def _turn(yaw):
        return np.array([[math.cos(yaw), -math.sin(yaw), 0.0], [math.sin(yaw), math.cos(yaw), 0.0],
                         [0.0, 0.0, 1.0]])

    def close_loop(self, x, y, z, degrees):
        """Moves the robot in the map by (x, y, z), and turns it on its place."""
        with self._lock:
            there = self._turn(self._yaw) @ self._here + self._shift + np.array([x, y, z])
            self._yaw += math.radians(degrees)
            self._shift = there - self._turn(self._yaw) @ self._here

    def _see(self, odometry):
        position = odometry.pose.pose.position
        with self._lock:
            self._here = np.array([position.x, position.y, position.z])

    def _send(self, _):
        message = TransformStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = "map"
        message.child_frame_id = "odom"
        with self._lock:
            message.transform.translation = Vector3(*self._shift)
            message.transform.rotation.z = math.sin(0.5 * self._yaw)
            message.transform.rotation.w = math.cos(0.5 * self._yaw)
        self._tf.sendTransform(message)

    def _pass_on(self, trajectory):
        with self._lock:
            shift, yaw = self._shift, self._yaw
        trajectory.header.frame_id = "odom"
        for point in trajectory.points:
            for pose in point.transforms:
                in_map = np.array([pose.translation.x, pose.translation.y, pose.translation.z])
                pose.translation = Vector3(*(self._turn(-yaw) @ (in_map - shift)))
                half = 0.5 * (yaw_of(pose.rotation) - yaw)
                pose.rotation.z, pose.rotation.w = math.sin(half), math.cos(half)
            for speed in point.velocities:
                in_map = np.array([speed.linear.x, speed.linear.y, speed.linear.z])
                speed.linear = Vector3(*(self._turn(-yaw) @ in_map))
        self._out.publish(trajectory)


class LoopClosure(unittest.TestCase):
    def test_the_mission_goes_on_and_comes_home(self):
        rospy.init_node("loop_closure_test")
        status = Listener("status", PlannerStatus)
        odometry = Listener("odometry", Odometry)
        log = Listener("/rosout", Log)
        collisions = Listener("collisions", UInt32)
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        slam = Slam()
        self.assertIsNotNone(odometry.wait(lambda _: True, 20.0), "no odometry")
        start = rospy.ServiceProxy("planner_node/start", Trigger)
        rospy.sleep(3.0)
        answer = start()
        self.assertTrue(answer.success, answer.message)
        begin = odometry.latest().pose.pose.position
        for closure in CLOSURES:
            moved = status.latest().distance_m if status.latest() else 0.0
            status.wait(lambda one, more=moved: one.distance_m > more + 4.0, 30.0, status.count())
            slam.close_loop(*closure)
        done = status.wait(lambda one: one.state == "Done", 90.0)
        self.assertIsNotNone(done, "last: %s" % status.latest())
        self.assertIn("explored", done.reason)
        said = [entry.msg for entry in log.messages if "odometry was corrected" in entry.msg]
        self.assertEqual(len(said), len(CLOSURES), said)
        end = odometry.latest().pose.pose.position
        self.assertLess(math.dist((begin.x, begin.y), (end.x, end.y)), 1.0)
        self.assertEqual(collisions.latest().data, 0)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "loop_closure_test", LoopClosure)
