#!/usr/bin/env python3
"""Whatever does not arrive, planner_node says for which topic it waits, since when and what to do;
what arrives in the manner of older drivers is taken."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot

from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger

RATE_HZ = 10.0


class Waiting(unittest.TestCase):
    """The tests share one node and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("waiting_test")
        cls.status = Listener("status", PlannerStatus)
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        cls.start = rospy.ServiceProxy("planner_node/start", Trigger)
        cls.robot = MadeUpRobot()

    def send_until(self, condition, timeout_s, publish):
        """Publishes like a driver until the condition holds."""
        rate = rospy.Rate(RATE_HZ)
        for _ in range(int(timeout_s * RATE_HZ)):
            publish()
            if condition():
                return True
            rate.sleep()
        return False

    def refusal_with(self, parts, publish):
        """The answer of ~start that holds all parts, while `publish` goes on."""
        answers = set()

        def refused():
            answers.add(self.start().message)
            return any(all(part in answer for part in parts) for answer in answers)
        self.assertTrue(self.send_until(refused, 8.0, publish), "%s not in %s" % (parts, answers))

    def test_a_nothing_arrives(self):
        answer = self.start()
        self.assertFalse(answer.success)
        for topic, what in (("/odometry", "odometry"), ("/pointcloud", "point clouds")):
            self.assertRegex(answer.message,
                             r"waits for %s on '%s': none since \d+ s \(publishers: " % (what, topic))
        found = self.status.wait(lambda status: "waits for" in status.input_problem, 6.0)
        self.assertIsNotNone(found, self.status.latest())
        self.assertIn("remap", found.input_problem)

    def test_b_odometry_only(self):
        self.refusal_with(["waits for point clouds on '/pointcloud'", "remap 'pointcloud'"],
                          lambda: self.robot.publish_odometry(self.robot.odometry()))
        self.assertNotIn("odometry on", self.start().message)

    def test_c_clouds_without_tf(self):
        def publish():
            self.robot.publish_odometry(self.robot.odometry())
            self.robot.publish_cloud(self.robot.cloud())
        self.refusal_with(["usable point clouds", "'lidar_16'", "'world'", "on tf"], publish)

    def test_d_all_arrives_as_older_drivers_send_it(self):
        def publish():
            odometry, cloud = self.robot.odometry(), self.robot.cloud()
            odometry.header.frame_id = "/world"
            odometry.child_frame_id = "/base_link"
            cloud.header.frame_id = "/lidar_16"
            cloud.row_step = 0
            self.robot.publish(odometry, cloud)
        self.assertTrue(self.send_until(lambda: self.start().success, 8.0, publish),
                        self.start().message)
        self.assertTrue(self.send_until(lambda: self.status.latest().explored_volume_m3 > 100.0,
                                        10.0, publish), self.status.latest())

    def test_e_clouds_stop_in_mid_mission(self):
        since = self.status.count()

        def is_said():
            return any("waits for point clouds on '/pointcloud': none any more since"
                       in status.reason for status in self.status.messages[since:])
        found = self.send_until(is_said, 10.0,
                                lambda: self.robot.publish_odometry(self.robot.odometry()))
        said = {status.state + ": " + status.reason for status in self.status.messages[since:]}
        self.assertTrue(found, said)
        self.assertNotIn(self.status.latest().state, ("Explore", "Reposition"))


if __name__ == "__main__":
    rostest.rosrun("spelunk", "waiting_test", Waiting)
