#!/usr/bin/env python3
"""A robot whose LiDAR sees a hoop of its own: said within seconds and in the mission's refusal."""

import os
import sys
import unittest

import numpy as np
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot, cloud_message, room_hits

from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger

RATE_HZ = 10.0
HOOP_M = 0.5


def hoop():
    azimuth, height = np.meshgrid(np.linspace(-np.pi, np.pi, 360), [-0.04, 0.0, 0.04])
    return np.stack([HOOP_M * np.cos(azimuth), HOOP_M * np.sin(azimuth), height],
                    axis=-1).reshape(-1, 3)


class SelfReturns(unittest.TestCase):
    def test_are_named_with_the_remedy(self):
        rospy.init_node("self_returns_test")
        status = Listener("status", PlannerStatus)
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        start = rospy.ServiceProxy("planner_node/start", Trigger)
        robot = MadeUpRobot()
        rate = rospy.Rate(RATE_HZ)

        def is_said(text):
            return "self_filter_boxes_m: [" in text and "0.50" in text

        by_input = by_mission = started = False
        for _ in range(200):
            points = np.concatenate([room_hits(robot.position, robot.HALF_SIZE), hoop()])
            robot.publish(cloud=cloud_message(points, "lidar_16", rospy.Time.now()))
            started = started or start().success
            messages = list(status.messages)
            by_input = any(is_said(message.input_problem) for message in messages)
            by_mission = any(is_said(message.reason) for message in messages)
            if by_input and by_mission:
                break
            rate.sleep()
        said = {(message.state, message.reason, message.input_problem) for message in messages}
        self.assertTrue(by_input, said)
        self.assertTrue(by_mission, said)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "self_returns_test", SelfReturns)
