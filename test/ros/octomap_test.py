#!/usr/bin/env python3
"""The map as octomap_msgs/Octomap: what subscribers of other programs get, and when."""

import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot

from octomap_msgs.msg import Octomap
from spelunk.srv import Save

PERIOD_S = 2.0  # octomap_period_s of planner_node
CLOUDS = 10


def payload(path):
    """The bytes of an octree file after its header."""
    return pathlib.Path(path).read_bytes().split(b"\ndata\n", 1)[1]


class OctomapTopic(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("octomap_test")
        cls.folder = tempfile.mkdtemp(prefix="spelunk_octomap_")
        rospy.wait_for_service("planner_node/save", timeout=20.0)
        robot = MadeUpRobot()
        rate = rospy.Rate(10.0)
        for _ in range(CLOUDS):
            robot.publish()
            rate.sleep()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def saved(self, name):
        path = os.path.join(self.folder, name)
        answer = rospy.ServiceProxy("planner_node/save", Save)(path)
        self.assertTrue(answer.success, answer)
        return path

    def last_of(self, topic, count=1):
        """The last of so many messages of a topic."""
        heard = Listener(topic, Octomap)
        found = heard.wait(lambda _: heard.messages and len(heard.messages) >= count, 20.0)
        self.assertIsNotNone(found, "no octomap on " + topic)
        return heard.messages

    def test_every_value_is_that_of_the_map(self):
        message = self.last_of("octomap_full")[-1]
        self.assertFalse(message.binary)
        folder = self.saved("state")
        files = [os.path.join(root, name) for root, _, names in os.walk(folder) for name in names
                 if name.endswith(".ot")]
        self.assertEqual(len(files), 1, os.listdir(self.folder))
        data = bytes(value & 0xFF for value in message.data)
        self.assertGreater(len(data), 1000)
        self.assertEqual(data, payload(files[0]))

    def test_binary_says_what_it_is_and_comes_again_no_sooner_than_it_should(self):
        messages = self.last_of("octomap", count=3)
        message = messages[-1]
        self.assertTrue(message.binary)
        self.assertEqual((message.id, message.header.frame_id), ("OcTree", "world"))
        self.assertGreater(message.resolution, 0.0)
        self.assertGreater(len(message.data), 100)
        header = message._connection_header
        self.assertEqual((header["type"], header["md5sum"], header["latching"]),
                         ("octomap_msgs/Octomap", "9a45536b45c5e409cd49f04bb2d9999f", "1"))
        stamps = [each.header.stamp.to_sec() for each in messages]
        self.assertGreater(stamps[-1] - stamps[-2], 0.5 * PERIOD_S)

    def test_who_comes_late_gets_it_at_once(self):
        self.last_of("octomap")
        late = Listener("octomap", Octomap)
        self.assertIsNotNone(late.wait(lambda _: True, 0.5 * PERIOD_S))


if __name__ == "__main__":
    rostest.rosrun("spelunk", "octomap_test", OctomapTopic)
