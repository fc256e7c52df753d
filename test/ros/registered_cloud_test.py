#!/usr/bin/env python3
"""A LiDAR odometry like FAST-LIO: clouds come in the frame of its poses, `camera_init`."""

import os
import sys
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot, cloud_message, room_hits

from rosgraph_msgs.msg import Log
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger

RATE_HZ = 10.0
ROOM_CENTRE = np.array([30.0, 0.0, 0.0])


def transform(parent, child, offset):
    message = TransformStamped()
    message.header.stamp = rospy.Time.now()
    message.header.frame_id = parent
    message.child_frame_id = child
    message.transform.translation.x, message.transform.translation.y, \
        message.transform.translation.z = offset
    message.transform.rotation.w = 1.0
    return message


class RegisteredCloud(unittest.TestCase):
    def test_is_mapped_from_where_the_robot_is(self):
        """Rays that began at the world's origin, 22 m before the room, would free 300 m3 outside."""
        rospy.init_node("registered_cloud_test")
        status = Listener("status", PlannerStatus)
        log = Listener("/rosout", Log)
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        start = rospy.ServiceProxy("planner_node/start", Trigger)
        robot = MadeUpRobot()
        links = tf2_ros.TransformBroadcaster()
        fixed = tf2_ros.StaticTransformBroadcaster()
        fixed.sendTransform([transform("world", "camera_init", np.zeros(3))])
        half = MadeUpRobot.HALF_SIZE
        rate = rospy.Rate(RATE_HZ)
        started = False
        for step in range(150):
            in_room = np.array([-2.0 + 0.02 * step, 0.5, 0.0])
            robot.position = ROOM_CENTRE + in_room
            odometry = robot.odometry()
            odometry.header.frame_id = "camera_init"
            odometry.child_frame_id = "body"
            links.sendTransform([transform("camera_init", "body", robot.position)])
            points = room_hits(in_room, half) + robot.position
            robot.publish_odometry(odometry)
            robot.publish_cloud(cloud_message(points, "camera_init", odometry.header.stamp))
            started = started or start().success
            if started and status.latest() and status.latest().plans > 1 and step > 50:
                break
            rate.sleep()
        self.assertTrue(started, start().message)
        volume = status.latest().explored_volume_m3
        self.assertGreater(volume, 300.0)
        self.assertLess(volume, 8.0 * np.prod(half))
        said = [entry.msg for entry in log.messages if "registered" in entry.msg]
        self.assertEqual(len(said), 1, said)
        self.assertIn("sensor.lidar_16.mount_m", said[0])


if __name__ == "__main__":
    rostest.rosrun("spelunk", "registered_cloud_test", RegisteredCloud)
