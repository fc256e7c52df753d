#!/usr/bin/env python3
"""A robot whose odometry and tf are in UTM: the map works around an origin of its own, all that goes in
and comes out stays in UTM."""

import json
import os
import shutil
import sys
import tempfile
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener, MadeUpRobot, cloud_message, room_hits

from geometry_msgs.msg import Point, Point32, Polygon
from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud2
from spelunk.msg import Graph, PlannerStatus
from spelunk.srv import GoTo, Load, Plan, Save, SetBounds, SetNoGoZones
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

UTM = np.array([467012.5, 5419960.25, 301.75])
ORIGIN = np.array([467000.0, 5420000.0, 300.0])
LOCAL = "robot_7/local_map"
RATE_HZ = 10.0


class RobotInUtm(MadeUpRobot):
    """Its room lies around UTM; its frames have a prefix."""

    def __init__(self):
        super().__init__()
        self.position = UTM.copy()

    def cloud(self):
        return cloud_message(room_hits(self.position - UTM, self.HALF_SIZE), "robot_7/lidar_16",
                             rospy.Time.now())

    def publish_tf(self):
        self.send_frames("robot_7/base_link", "robot_7/lidar_16")


def square(centre, half):
    x, y = centre[:2]
    return Polygon([Point32(x - half, y - half, 0), Point32(x + half, y - half, 0),
                    Point32(x + half, y + half, 0), Point32(x - half, y + half, 0)])


def points_of(cloud):
    """x, y, z of a cloud of three float32."""
    return np.frombuffer(cloud.data, np.float32).reshape(-1, 3).astype(float)


class FarFromOrigin(unittest.TestCase):
    """The tests share one mission and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("far_from_origin_test")
        cls.status = Listener("status", PlannerStatus)
        cls.path = Listener("path", Path)
        cls.map_cloud = Listener("map_cloud", PointCloud2)
        cls.markers = Listener("markers", MarkerArray)
        cls.graph = Listener("graph", Graph)
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        cls.robot = RobotInUtm()
        cls.folder = tempfile.mkdtemp(prefix="spelunk_far_")
        cls.services = {}
        for name, service_type in {"start": Trigger, "pause": Trigger, "plan": Plan, "go_to": GoTo,
                                   "set_bounds": SetBounds, "set_no_go_zones": SetNoGoZones,
                                   "set_local_no_go_zones": SetNoGoZones, "save": Save,
                                   "load": Load}.items():
            rospy.wait_for_service("planner_node/" + name, timeout=20.0)
            cls.services[name] = rospy.ServiceProxy("planner_node/" + name, service_type)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def send(self, seconds, until=lambda: False):
        rate = rospy.Rate(RATE_HZ)
        for _ in range(int(seconds * RATE_HZ)):
            self.robot.publish()
            rate.sleep()
            if until():
                return

    def in_utm(self, point):
        """Asserts that a point lies in the room."""
        self.assertTrue(np.all(np.abs(np.array([point.x, point.y, point.z]) - UTM) < 12.0), point)

    def test_a_bounds_and_zones_may_be_given_before_the_robot_is_met(self):
        answer = self.services["set_bounds"](Point(*(UTM - 7.0)), Point(*(UTM + [9.0, 7.0, 7.0])))
        self.assertTrue(answer.success, answer.reason)
        answer = self.services["set_local_no_go_zones"](["there"], [square(UTM, 1.0)], [0.0],
                                                        [1.0])
        self.assertFalse(answer.success)
        self.assertIn("first odometry", answer.reason)

    def test_b_the_map_grows_and_clouds_are_right_to_the_millimetre(self):
        self.send(15.0, lambda: self.map_cloud.latest() and self.map_cloud.latest().width > 1000)
        cloud = self.map_cloud.latest()
        self.assertIsNotNone(cloud)
        self.assertGreater(cloud.width, 1000)
        self.assertEqual(cloud.header.frame_id, LOCAL)
        at = self.buffer.lookup_transform("world", LOCAL, rospy.Time(0), rospy.Duration(5.0))
        origin = at.transform.translation
        self.assertEqual((origin.x, origin.y, origin.z), tuple(ORIGIN))
        walls = points_of(cloud) + ORIGIN - UTM
        half = self.robot.HALF_SIZE
        self.assertLess(np.max(np.abs(walls) - half), 0.16)  # voxels of 0.15 m
        self.assertGreater(np.max(np.abs(walls[:, 1])), half[1] - 0.1)

    def test_c_zones_in_32_bit_numbers_of_utm_are_said_to_be_coarse(self):
        east = UTM + [5.0, 0.0, 0.0]
        answer = self.services["set_no_go_zones"](["east"], [square(east, 1.0)], [0.0], [400.0])
        self.assertTrue(answer.success, answer.reason)
        self.assertRegex(answer.reason, "only exact to 0.25 m.*" + LOCAL)
        answer = self.services["set_local_no_go_zones"](["here"], [square(UTM - ORIGIN, 1.0)],
                                                        [-100.0], [100.0])
        self.assertFalse(answer.success)
        self.assertIn("holds the robot", answer.reason)
        self.assertTrue(self.services["set_no_go_zones"]([], [], [], []).success)

    def test_d_path_graph_and_markers(self):
        answer = self.services["start"]()
        self.assertTrue(answer.success, answer.message)
        self.send(20.0, lambda: self.path.latest() and len(self.path.latest().poses) > 1 and
                  self.graph.count() and self.markers.count())
        path = self.path.latest()
        self.assertIsNotNone(path, self.status.latest())
        self.assertEqual(path.header.frame_id, "world")
        self.assertGreater(len(path.poses), 1, self.status.latest())
        for pose in path.poses:
            self.in_utm(pose.pose.position)
        for vertex in self.graph.latest().vertices:
            self.in_utm(vertex)
        self.assertEqual({marker.header.frame_id for marker in self.markers.latest().markers},
                         {LOCAL})

    def test_e_services(self):
        self.services["pause"]()
        self.send(1.0)
        answer = self.services["plan"]()
        for pose in answer.path.poses:
            self.in_utm(pose.pose.position)
        beyond = self.services["go_to"](Point(*(UTM + [0.0, 30.0, 0.0])))
        self.assertFalse(beyond.success)
        inside = self.services["set_bounds"](Point(*(UTM + 3.0)), Point(*(UTM + 6.0)))
        self.assertIn("exclude the robot", inside.reason)

    def test_f_save_and_load(self):
        answer = self.services["save"](self.folder)
        self.assertTrue(answer.success, answer.reason)
        with open(os.path.join(self.folder, "mission.json")) as file:
            saved = json.load(file)
        self.assertEqual(saved["map_origin_m"], list(ORIGIN))
        self.assertLess(np.linalg.norm(np.array(saved["trail"][0][:3]) - UTM), 1.0)
        self.assertAlmostEqual(saved["bounds"]["max"][0], UTM[0] + 9.0, places=3)
        with open(os.path.join(self.folder, "map.bt"), "rb") as file:
            self.assertIn(b"# origin 467000 5420000 300 m", file.read(200))
        before = self.status.latest().explored_volume_m3
        answer = self.services["load"](self.folder)
        self.assertTrue(answer.success, answer.reason)
        self.send(2.0)
        self.assertAlmostEqual(self.status.latest().explored_volume_m3, before, delta=0.2 * before)

    def test_g_a_mission_saved_around_another_origin_is_taken_up_there(self):
        path = os.path.join(self.folder, "mission.json")
        with open(path) as file:
            saved = json.load(file)
        saved["map_origin_m"][1] -= 100.0  # as if it had been begun south of the 5419950
        with open(path, "w") as file:
            json.dump(saved, file)
        answer = self.services["load"](self.folder)
        self.assertTrue(answer.success, answer.reason)
        since = self.map_cloud.count()
        self.send(3.0, lambda: self.map_cloud.count() > since + 1)
        at = self.buffer.lookup_transform("world", LOCAL, rospy.Time(0), rospy.Duration(5.0))
        self.assertEqual(at.transform.translation.y, ORIGIN[1] - 100.0)
        answer = self.services["plan"]()
        for pose in answer.path.poses:
            self.in_utm(pose.pose.position)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "far_from_origin_test", FarFromOrigin)
