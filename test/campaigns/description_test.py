"""Descriptions of campaigns: what they mean and what is refused."""
import pathlib
import unittest

import support
from campaigns import checks, description

GROUP = {"worlds": ["room"], "robots": ["aerial"], "planners": ["gbplanner"], "seeds": [1],
         "time_limits_s": [40]}


def problems_of(**changes):
    """Problems of a description that is fine but for the changes."""
    return description.parse({"groups": [GROUP], **changes})[1]


class Description(unittest.TestCase):
    def test_every_combination_of_a_group_is_one_mission(self):
        campaign, problems = description.parse({
            "parameter_sets": {"fine": {"map.resolution_m": 0.1}},
            "groups": [{"worlds": ["a", "b"], "robots": ["aerial"], "planners": ["p", "q", "r"],
                        "parameter_sets": ["default", "fine"], "seeds": "3-5",
                        "time_limits_s": [10, 20.5]}]})
        self.assertEqual(problems, [])
        self.assertEqual(len({mission.name for mission in campaign.missions}), 2 * 3 * 2 * 3 * 2)
        self.assertEqual(campaign.missions[0].name, "a__aerial__p__default__10__003")
        self.assertEqual({mission.wall_limit_s for mission in campaign.missions}, {80, 101})

    def test_settings_are_written_as_the_executable_takes_them(self):
        settings = {"planner.box_m": [24, 24.5, 10], "planner.once": True, "map.range_m": 4.0}
        campaign, _ = description.parse({"parameter_sets": {"default": settings},
                                         "groups": [GROUP]})
        arguments = campaign.missions[0].arguments({"room": "/meshes/room.stl"})
        self.assertEqual(" ".join(arguments),
                         "--world /meshes/room.stl --robot aerial --planner gbplanner --seed 1 "
                         "--time-limit-s 40 --set map.range_m=4 "
                         "--set planner.box_m=[24,24.5,10] --set planner.once=true")

    def test_placeholders_stand_for_what_a_mission_is(self):
        campaign, problems = description.parse({
            "parameter_sets": {"default": {"oracle.tour": "tours/{world}__{robot}__{time_limit_s}"}},
            "groups": [{**GROUP, "worlds": ["cave", "room"]}]})
        self.assertEqual(problems, [])
        self.assertEqual([mission.settings for mission in campaign.missions],
                         [(("oracle.tour", "tours/cave__aerial__40"),),
                          (("oracle.tour", "tours/room__aerial__40"),)])
        self.assertIn("{seed} stands for nothing; known: world, robot, time_limit_s",
                      problems_of(parameter_sets={"a": {"oracle.tour": "x{seed}"}})[0])

    def test_groups_may_differ(self):
        other = {**GROUP, "worlds": ["cave"], "planners": ["informed"], "wall_limit_s": 7}
        campaign, problems = description.parse({"groups": [GROUP, other]})
        self.assertEqual(problems, [])
        self.assertEqual([(mission.world, mission.planner, mission.wall_limit_s)
                          for mission in campaign.missions],
                         [("cave", "informed", 7), ("room", "gbplanner", 140)])

    def test_robots_planners_and_meshes_may_be_files_seen_from_the_description(self):
        group = {**GROUP, "robots": ["aerial", "own/mule.yaml"], "planners": ["/p/patient.yaml"]}
        campaign, problems = description.parse({"groups": [group], "meshes": {"room": "mine.stl"}},
                                               folder=pathlib.Path("/home/me"))
        self.assertEqual(problems, [])
        self.assertEqual([mission.name for mission in campaign.missions],
                         ["room__aerial__patient__default__40__001",
                          "room__mule__patient__default__40__001"])
        arguments = " ".join(campaign.missions[1].arguments(campaign.meshes))
        self.assertIn("--world /home/me/mine.stl --robot /home/me/own/mule.yaml "
                      "--planner /p/patient.yaml", arguments)
        found = checks.robot_problems(campaign, support.ROOT)
        self.assertEqual(found, ["planner file /p/patient.yaml is not there",
                                 "robot file /home/me/own/mule.yaml is not there"])

    def test_all_problems_come_in_one_message(self):
        path = "bad.yaml"
        _, problems = description.parse({
            "tittle": "x", "parameter_sets": {"fine": {"resolution": 1}},
            "groups": [{**GROUP, "seeds": "9-3", "time_limits_s": [-1], "robots": "aerial",
                        "parameter_sets": ["coarse"], "planer": ["gbplanner"]}]})
        self.assertEqual(len(problems), 7, problems)
        text = str(description.DescriptionError(path, problems))
        for part in ("unknown key \"tittle\"", "unknown key \"planer\"", "\"resolution\"",
                     "groups[1].robots", "first-last", "\"-1\"", "\"coarse\" is not described"):
            self.assertIn(part, text)

    def test_a_name_that_cannot_be_a_folder_is_refused(self):
        for name in ("a/b", "../x", "a__b", "", "-x", "a b"):
            self.assertTrue(problems_of(groups=[{**GROUP, "worlds": [name]}]), name)
        for name in ("room_and_pillar", "mine-2.5", "A1", "b_"):
            self.assertEqual(problems_of(groups=[{**GROUP, "worlds": [name]}]), [], name)

    def test_seeds_are_whole_numbers(self):
        for seeds in ([], [1.5], [True], [-1], "1-", "a-b", 3, None):
            self.assertTrue(problems_of(groups=[{**GROUP, "seeds": seeds}]), seeds)

    def test_a_mission_described_twice_is_refused(self):
        self.assertIn("described twice", problems_of(groups=[GROUP, GROUP])[0])

    def test_references_name_all_figures(self):
        self.assertIn("lacks", problems_of(references=[{"world": "room"}])[0])

    def test_no_map_at_all_is_refused(self):
        for content in (None, [], "text", {"groups": []}, {"groups": "room"}):
            self.assertTrue(description.parse(content)[1])

    def test_unreadable_files_are_named(self):
        with self.assertRaisesRegex(description.DescriptionError, "nowhere.yaml"):
            description.read("nowhere.yaml")


class Shipped(unittest.TestCase):
    def test_every_description_loads(self):
        paths = sorted((support.ROOT / "config" / "campaigns").glob("*.yaml"))
        self.assertGreaterEqual(len(paths), 7)
        for path in paths:
            self.assertTrue(description.read(path).missions, path)

    def test_the_aerial_campaign_has_the_papers_ninety_missions(self):
        campaign = description.read(support.ROOT / "config" / "campaigns" / "aerial.yaml")
        self.assertEqual(len(campaign.missions), 90)


class Worlds(unittest.TestCase):
    def setUp(self):
        self.campaign, _ = description.parse({"groups": [{**GROUP, "worlds": ["edgar", "room"]}]})

    def test_an_unknown_world_is_named_with_the_remedy(self):
        problems = checks.world_problems(self.campaign, support.ROOT)
        self.assertEqual(len(problems), 1)
        self.assertIn("--world edgar=PATH", problems[0])
        self.assertIn("long_wall", problems[0])

    def test_a_mesh_must_be_there_and_somebody_must_fly_in_it(self):
        self.campaign.meshes.update({"edgar": "/nowhere/mine.stl", "eddy": "/nowhere/mine.stl"})
        problems = checks.world_problems(self.campaign, support.ROOT)
        self.assertEqual(len(problems), 2)
        self.assertIn("no mission flies there", problems[0])
        self.assertIn("/nowhere/mine.stl is no mesh", problems[1])

    def test_an_unknown_robot_is_named(self):
        campaign, _ = description.parse({"groups": [{**GROUP, "robots": ["submarine"]}]})
        self.assertIn("aerial, inspector, walker", checks.robot_problems(campaign, support.ROOT)[0])


if __name__ == "__main__":
    unittest.main()
