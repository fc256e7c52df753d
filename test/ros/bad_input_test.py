#!/usr/bin/env python3
"""Whatever a sensor sends: planner_node says what is wrong, the robot holds, the node lives on."""

import os
import sys
import unittest

import numpy as np
import rosgraph
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot, cloud_message

from rosgraph_msgs.msg import Log
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger

RATE_HZ = 10.0


class BadInput(unittest.TestCase):
    """The tests share one node and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("bad_input_test")
        cls.status = Listener("status", PlannerStatus)
        cls.log = Listener("/rosout", Log)
        cls.robot = MadeUpRobot()
        rospy.wait_for_service("planner_node/start", timeout=20.0)

    def setUp(self):
        self.send(seconds=0.5)

    def tearDown(self):
        names = rosgraph.Master("/bad_input_test").getSystemState()[2]
        self.assertTrue(any("/planner_node" in nodes for _, nodes in names), "the node is gone")

    def send(self, seconds, odometry=lambda message: message, cloud=lambda message: message):
        """Publishes like a driver, through what spoils the messages."""
        rate = rospy.Rate(RATE_HZ)
        for _ in range(int(seconds * RATE_HZ)):
            self.robot.publish(odometry(self.robot.odometry()), cloud(self.robot.cloud()))
            rate.sleep()

    def problem(self, *parts, seconds=1.5, **spoilers):
        """Sends spoilt messages; the status must name all `parts` of the problem."""
        since = self.status.count()
        self.send(seconds, **spoilers)
        found = self.status.wait(
            lambda status: all(part in status.input_problem for part in parts), 2.0, since)
        said = {status.input_problem for status in self.status.messages[since:]}
        self.assertIsNotNone(found, "%s is not in %s" % (parts, said))

    def test_a_silence_names_topic_and_remap(self):
        rospy.sleep(4.5)
        since = self.status.count()
        found = self.status.wait(lambda status: "remap" in status.input_problem, 3.0, since - 1)
        self.assertIsNotNone(found, self.status.latest())
        self.assertRegex(found.input_problem, "/(pointcloud|odometry)'")

    def test_b_odometry_with_nan(self):
        def spoil(message):
            message.pose.pose.position.x = float("nan")
            return message
        self.problem("odometry", "not finite", odometry=spoil)

    def test_b_odometry_without_orientation(self):
        def spoil(message):
            message.pose.pose.orientation.w = 0.0
            return message
        self.problem("odometry", "zero length", odometry=spoil)

    def test_b_odometry_in_an_unknown_frame(self):
        def spoil(message):
            message.header.frame_id = "moon"
            return message
        self.problem("'moon'", odometry=spoil)

    def test_c_cloud_in_an_unknown_frame(self):
        def spoil(message):
            message.header.frame_id = "periscope"
            return message
        self.problem("'periscope'", "tf", cloud=spoil)

    def test_c_cloud_without_frame(self):
        def spoil(message):
            message.header.frame_id = ""
            return message
        self.problem("frame_id", cloud=spoil)

    def test_c_cloud_from_the_future(self):
        def spoil(message):
            message.header.stamp += rospy.Duration(60.0)
            return message
        self.problem("future", "clocks", cloud=spoil)

    def test_c_cloud_from_long_ago(self):
        def spoil(message):
            message.header.stamp -= rospy.Duration(60.0)
            return message
        self.problem("old", "clocks", cloud=spoil)

    def test_c_cloud_without_points(self):
        self.problem("no points", cloud=lambda message: cloud_message(
            np.zeros((0, 3)), "lidar_16", message.header.stamp))

    def test_c_cloud_of_nan(self):
        self.problem("NaN", cloud=lambda message: cloud_message(
            np.full((50, 3), np.nan), "lidar_16", message.header.stamp))

    def test_c_cloud_that_announces_more_than_it_holds(self):
        def spoil(message):
            message.width *= 1000
            return message
        self.problem("more points", cloud=spoil)

    def test_d_a_message_repeats_at_most_once_in_five_seconds(self):
        def spoil(message):
            message.header.frame_id = ""
            return message
        since = self.log.count()
        self.send(6.0, cloud=spoil)
        lines = [entry for entry in self.log.messages[since:] if "frame_id" in entry.msg]
        self.assertIn(len(lines), (1, 2), "60 bad clouds")

    def test_e_missing_odometry_holds_and_what_was_gathered_is_kept(self):
        rospy.ServiceProxy("planner_node/start", Trigger)()
        self.send(1.5)
        before = self.status.latest().explored_volume_m3

        def spoil(message):
            message.pose.pose.position.x = float("nan")
            return message
        since = self.status.count()
        self.send(3.0, odometry=spoil)
        states = [status.state for status in self.status.messages[since:]]
        self.assertTrue(states, "no status")
        self.assertNotIn(states[-1], ("Explore", "Reposition"), states)
        self.assertGreaterEqual(self.status.latest().explored_volume_m3, before)

    def test_e_a_jump_of_metres_is_said(self):
        """The mission starts among the jumps, after a second of them in which nothing else is said;
        in so small a room it ends before later ones."""
        since_status, since_log = self.status.count(), self.log.count()
        hops = 0

        def hop(message):
            nonlocal hops
            hops += 1
            if hops == 12:
                rospy.ServiceProxy("planner_node/start", Trigger)()
            message.pose.pose.position.x += 3.0 * (hops // 4 % 2)
            message.pose.pose.position.y += 2.0 * (hops // 4 % 2)
            return message
        self.send(2.0, odometry=hop)
        self.assertIsNotNone(self.log.wait(lambda entry: "jumped by 3.6" in entry.msg, 2.0,
                                           since_log))
        said = [status.reason for status in self.status.messages[since_status:]]
        self.assertTrue(any("jumped" in reason for reason in said), said)

    def test_f_good_input_clears_the_problem(self):
        self.send(6.0)
        self.assertEqual(self.status.latest().input_problem, "")
        self.assertGreater(self.status.latest().last_map_update_ms, 0.0)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "bad_input_test", BadInput)
