#!/usr/bin/env python3
"""use_sim_time, but nobody sends /clock: said in the log, in the status and by ~start."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from rosgraph_msgs.msg import Log
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger


class NoClock(unittest.TestCase):
    def test_is_said_in_three_ways(self):
        rospy.init_node("no_clock_test")
        log = Listener("/rosout", Log)
        status = Listener("status", PlannerStatus)
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        by_status = status.wait(lambda message: "/clock" in message.input_problem, 4.0)
        self.assertIsNotNone(by_status, status.latest())
        for part in ("use_sim_time", "--clock", "/use_sim_time to false"):
            self.assertIn(part, by_status.input_problem)
        self.assertIsNotNone(log.wait(lambda entry: "/clock" in entry.msg and
                                      entry.name == "/planner_node", 7.0), log.messages)
        answer = rospy.ServiceProxy("planner_node/start", Trigger)()
        self.assertFalse(answer.success)
        self.assertIn("/clock", answer.message)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "no_clock_test", NoClock)
