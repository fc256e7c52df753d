"""Robots, sensors, planners and meshes from files of one's own, named as seen from the shell."""
import json
import unittest

from shell import PROGRAMS, InFreshShell, write_mesh

MULE = "robot: {speed_max_mps: 1.25, sensors: [feeler]}\n"
FEELER = "sensor: {feeler: {rows: 12, columns: 360, range_max_m: 20}}\n"
PATIENT = "nbvp: {max_vertices: 123}\n"
NAMES = "--world mine.stl --robot own/mule.yaml"


class NamedFiles(InFreshShell):
    def setUp(self):
        super().setUp()
        write_mesh(self.folder / "mine.stl")
        (self.folder / "own").mkdir()
        (self.folder / "own" / "mule.yaml").write_text(MULE)
        (self.folder / "own" / "feeler.yaml").write_text(FEELER)
        (self.folder / "patient.yaml").write_text(PATIENT)

    def test_mission(self):
        said = self.assert_runs(f"{PROGRAMS}/mission {NAMES} --planner patient.yaml --list-params")
        for name, value in (("robot.speed_max_mps", "1.25"), ("sensor.feeler.rows", "12"),
                            ("nbvp.max_vertices", "123")):
            self.assertRegex(said, rf"{name} +{value} ")
        self.assert_runs(f"{PROGRAMS}/mission {NAMES} --planner patient.yaml --time-limit-s 40 "
                         "--out out")
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertEqual((summary["world"], summary["robot"], summary["planner"]),
                         ("mine.stl", "own/mule.yaml", "patient.yaml"))

    def test_best_possible(self):
        self.assert_runs(f"{PROGRAMS}/best_possible {NAMES} --time-limit-s 20 --out out")

    def test_launch_files(self):
        self.assert_launches("roslaunch spelunk aerial.launch world:=mine.stl robot:=own/mule.yaml "
                             "planner:=patient.yaml rviz:=false")

    def test_home_folder_which_the_shell_leaves_as_it_is(self):
        self.environment["HOME"] = str(self.folder)
        self.assert_launches("roslaunch spelunk simulator.launch world:=~/mine.stl "
                             "robot:=~/own/mule.yaml")


if __name__ == "__main__":
    unittest.main()
