#!/usr/bin/env python3
"""Every launch file loads with its defaults, and RViz listens to topics that the nodes publish."""

import glob
import os
import unittest

import rospkg
import roslaunch
import rostest
import yaml

PUBLISHED = {"/map_cloud", "/markers", "/path", "/pointcloud", "/mesh", "/elevation",
             "/traversability", "/feet"}


class LaunchFiles(unittest.TestCase):
    def setUp(self):
        self.package = rospkg.RosPack().get_path("spelunk")

    def load(self, name, arguments=()):
        path = os.path.join(self.package, "launch", name)
        return roslaunch.config.load_config_default([(path, list(arguments))], None, verbose=False)

    def test_every_file_loads_and_names_existing_programs(self):
        files = sorted(os.path.basename(path)
                       for path in glob.glob(os.path.join(self.package, "launch", "*.launch")))
        self.assertLessEqual({"aerial.launch", "walker.launch"}, set(files))
        for name in files:
            config = self.load(name)
            self.assertEqual(config.config_errors, [], name)
            self.assertTrue(config.nodes, name)

    def test_arguments_reach_the_nodes(self):
        config = self.load("aerial.launch", ["world:=cave", "seed:=7", "planner:=gbplanner",
                                             "time_limit_s:=123", "speed_factor:=2.5",
                                             "world_scale:=0.001", "world_up:=y",
                                             "rviz:=false"])
        values = {name: parameter.value for name, parameter in config.params.items()}
        self.assertEqual(values["/sim_node/world"], "cave")
        self.assertEqual(values["/sim_node/seed"], 7)
        self.assertEqual(values["/planner_node/seed"], 7)
        self.assertEqual(values["/planner_node/time_limit_s"], 123.0)
        self.assertEqual(values["/sim_node/speed_factor"], 2.5)
        self.assertEqual(values["/sim_node/world_scale"], 0.001)
        self.assertEqual(values["/sim_node/world_up"], "y")
        self.assertTrue(values["/use_sim_time"])
        self.assertEqual({node.name for node in config.nodes}, {"sim_node", "planner_node"})

    def test_both_nodes_of_the_walker_are_told_so_and_its_legs_are_shown(self):
        config = self.load("walker.launch", ["seed:=7", "rviz:=true"])
        values = {name: parameter.value for name, parameter in config.params.items()}
        self.assertEqual(values["/sim_node/robot"], "walker")
        self.assertEqual(values["/planner_node/robot"], "walker")
        self.assertEqual(values["/planner_node/seed"], 7)
        self.assertEqual({node.name for node in config.nodes},
                         {"sim_node", "planner_node", "robot_state_publisher", "rviz"})
        required = {node.name for node in config.nodes if node.required}
        self.assertNotIn("robot_state_publisher", required, "it is only for display")

    def test_overrides_reach_both_nodes(self):
        overrides = os.path.join(self.package, "test", "ros", "room_overrides.yaml")
        config = self.load("aerial.launch", ["overrides:=" + overrides, "rviz:=false"])
        for node in ("sim_node", "planner_node"):
            names = [name for name in config.params if name.startswith("/%s/set/" % node)]
            self.assertTrue(names, node)

    def test_rviz_listens_to_what_is_published(self):
        paths = glob.glob(os.path.join(self.package, "config", "rviz", "*.rviz"))
        self.assertGreaterEqual(len(paths), 2)
        for path in paths:
            with open(path, encoding="utf-8") as file:
                displays = yaml.safe_load(file)["Visualization Manager"]["Displays"]
            topics = {display[key] for display in displays for key in ("Topic", "Marker Topic")
                      if key in display}
            self.assertTrue(topics, path)
            self.assertTrue(topics <= PUBLISHED, topics - PUBLISHED)


if __name__ == "__main__":
    rostest.rosrun("spelunk", "launch_files_test", LaunchFiles)
