#!/usr/bin/env python3
"""Every service of planner_node: once as it should go, once as it should be refused."""

import os
import shutil
import sys
import tempfile
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ros_support import Listener

from geometry_msgs.msg import Point, Point32, Polygon
from nav_msgs.msg import Odometry
from spelunk.msg import PlannerStatus
from spelunk.srv import GoTo, Load, Plan, Save, SetBounds, SetNoGoZones
from std_srvs.srv import Trigger

FAR = 1e6


def square(x, y, half):
    return Polygon([Point32(x - half, y - half, 0), Point32(x + half, y - half, 0),
                    Point32(x + half, y + half, 0), Point32(x - half, y + half, 0)])


class Services(unittest.TestCase):
    """The tests share one mission and run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("services_test")
        cls.status = Listener("status", PlannerStatus)
        cls.odometry = Listener("odometry", Odometry)
        cls.folder = tempfile.mkdtemp(prefix="spelunk_services_")
        types = {"start": Trigger, "pause": Trigger, "home": Trigger, "estop": Trigger,
                 "plan": Plan, "go_to": GoTo, "set_bounds": SetBounds,
                 "set_no_go_zones": SetNoGoZones, "save": Save, "load": Load}
        cls.services = {}
        for name, service_type in types.items():
            rospy.wait_for_service("planner_node/" + name, timeout=20.0)
            cls.services[name] = rospy.ServiceProxy("planner_node/" + name, service_type)
        assert cls.odometry.wait(lambda _: True, 20.0), "no odometry"
        rospy.sleep(1.0)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def accepts(self, name, *arguments):
        answer = self.services[name](*arguments)
        self.assertTrue(answer.success, "%s: %s" % (name, answer))
        return answer

    def refuses(self, name, *arguments):
        answer = self.services[name](*arguments)
        self.assertFalse(answer.success, "%s accepted" % name)
        text = answer.message if hasattr(answer, "message") else answer.reason
        self.assertGreater(len(text), 10, "a refusal needs a reason")
        return text

    def wait_state(self, state, timeout_s=20.0):
        since = self.status.count()
        found = self.status.wait(lambda status: status.state == state, timeout_s, max(0, since - 1))
        self.assertIsNotNone(found, "no %s; last: %s" % (state, self.status.latest()))

    def here(self):
        return self.odometry.latest().pose.pose.position

    def test_a1_nothing_to_pause_or_fly_home_to_before_the_start(self):
        self.assertIn("start", self.refuses("home"))
        self.refuses("pause")

    def test_a2_bounds(self):
        self.assertIn("min", self.refuses("set_bounds", Point(1, 1, 1), Point(-1, 2, 2)))
        self.assertIn("NaN", self.refuses("set_bounds", Point(float("nan"), 0, 0), Point(1, 1, 1)))
        here = self.here()
        self.refuses("set_bounds", Point(here.x + 50, here.y, here.z),
                     Point(here.x + 60, here.y + 1, here.z + 1))
        self.accepts("set_bounds", Point(-FAR, -FAR, -FAR), Point(FAR, FAR, float("inf")))

    def test_a3_no_go_zones(self):
        here = self.here()
        on_robot = square(here.x, here.y, 1.0)
        self.refuses("set_no_go_zones", ["here"], [on_robot], [-FAR], [FAR])
        self.refuses("set_no_go_zones", ["two", "names"], [on_robot], [-FAR], [FAR])
        self.refuses("set_no_go_zones", ["line"], [Polygon(on_robot.points[:2])], [-FAR], [FAR])
        self.accepts("set_no_go_zones", ["far away"], [square(500.0, 500.0, 5.0)], [-5.0], [5.0])
        self.accepts("set_no_go_zones", [], [], [], [])

    def test_a4_load_names_the_folder_that_is_missing(self):
        self.assertIn("/no/such/folder", self.refuses("load", "/no/such/folder"))

    def test_b1_start_and_pause(self):
        self.accepts("start")
        self.wait_state("Explore")
        rospy.sleep(3.0)
        self.refuses("go_to", Point(self.here().x + 1.0, self.here().y, self.here().z))
        self.accepts("pause")
        self.wait_state("Hold")
        self.refuses("pause")

    def test_b2_plan_has_a_path_exactly_if_it_succeeds(self):
        rospy.sleep(4.0)
        for _ in range(3):
            answer = self.services["plan"]()
            self.assertEqual(answer.success, bool(answer.path.poses), answer)
            self.assertEqual(answer.success, answer.status == "ok")
            self.assertTrue(answer.reason)

    def test_b3_go_to_refuses_what_it_cannot_reach(self):
        self.refuses("go_to", Point(float("nan"), 0, 0))
        self.refuses("go_to", Point(5000.0, 0, 0))

    def test_b4_go_to_flies_there_and_holds(self):
        here = self.here()
        for dx, dy in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
            target = Point(here.x + dx, here.y + dy, here.z)
            answer = self.services["go_to"](target)
            if answer.success:
                break
        self.assertTrue(answer.success, answer.reason)
        self.assertTrue(answer.path.poses)

        def is_there(odometry):
            position = odometry.pose.pose.position
            return abs(position.x - target.x) + abs(position.y - target.y) < 0.5

        self.assertIsNotNone(self.odometry.wait(is_there, 15.0, self.odometry.count()))
        self.wait_state("Hold")

    def test_c1_save_and_load(self):
        self.accepts("save", self.folder)
        self.assertIn("map.bt", os.listdir(self.folder))
        self.refuses("save", "/proc/spelunk")
        self.accepts("load", self.folder)

    def test_d1_home(self):
        self.accepts("start")
        self.accepts("home")
        self.wait_state("Done", 25.0)

    def test_e1_emergency_stop_until_start(self):
        self.accepts("estop")
        self.wait_state("EStop")
        self.refuses("home")
        self.refuses("go_to", self.here())
        self.accepts("start")
        self.accepts("estop")
        self.wait_state("EStop")


if __name__ == "__main__":
    rostest.rosrun("spelunk", "services_test", Services)
