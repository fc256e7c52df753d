"""A node that refuses to start says all of why, on stderr and in ROS's log, through roslaunch too."""
import pathlib
import unittest

from shell import InFreshShell

# What is wrong with the launch: arguments and the words of the answer.
AERIAL = (
    ("world missing", "world:=nowhere", ["world 'nowhere' is not known", "long_wall"]),
    ("mesh missing", "world:=sub/mine.stl", ["mesh 'sub/mine.stl'", "{folder}/sub/mine.stl"]),
    ("mesh broken", "world:={folder}/broken.stl", ["broken.stl", "triangles"]),
    ("robot missing", "world:=room robot:=submarine", ["unknown robot 'submarine'", "walker"]),
    ("robot file missing", "world:=room robot:=my/robot.yaml", ["{folder}/my/robot.yaml"]),
    ("planner missing", "world:=room planner:=gbplaner", ["\"gbplaner\"", "gbplanner"]),
    ("start outside", "world:=room start:=900,0,1,0", ["outside the world", "(900, 0, 1)"]),
    ("start unreadable", "world:=room start:=here", ["four numbers x, y, z, yaw"]),
    ("start in collision", "world:=room start:={wall}", ["in collision with the world"]),
)
OVERRIDES = (
    ("unknown", "robot: {sped_max_mps: 1}", ["robot.sped_max_mps", "robot.speed_max_mps"]),
    ("unreadable", "robot: {speed_max_mps: fast}", ["'fast'", "must be a number"]),
    ("out of range", "map: {resolution_m: 50}", ["map.resolution_m = 50", "[0.02, 2]"]),
    ("nested", "robot: {box_m: [[1, 2], [3, 4]]}", ["robot.box_m", "flat list"]),
    ("sensor missing", "robot: {sensors: [sonar]}", ["sonar.yaml", "config/sensors"]),
    ("body above box", "sim: {body_m: [1.2, 0.7, 0.3]}",
     ["robot.box_m = [1.1, 1.1, 0.4]", "sim.body_m = [1.2, 0.7, 0.3]"]),
)
ROOM_CORNER = "-5.9,-3.9,0.1,0"


class Refusals(InFreshShell):
    def setUp(self):
        super().setUp()
        (self.folder / "broken.stl").write_text("solid of nothing\nvertex one two three\n")

    def launch(self, arguments):
        """What a launch that refuses prints, and what ROS's log has of it."""
        code, said = self.run_line(
            f"roslaunch -p {self.port} spelunk aerial.launch rviz:=false {arguments}")
        logs = [path.read_text(errors="replace")
                for path in pathlib.Path(self.environment["ROS_HOME"]).rglob("rosout.log")]
        self.assertIn("REQUIRED process", said, (code, said))
        return said, "".join(logs)

    def assert_refuses(self, arguments, words):
        said, logged = self.launch(arguments)
        for word in words:
            word = word.format(folder=self.folder)
            self.assertIn(word, said)
            self.assertIn(word, logged)

    def test_what_arguments_name_wrongly(self):
        for name, arguments, words in AERIAL:
            with self.subTest(name):
                self.assert_refuses(arguments.format(folder=self.folder, wall=ROOM_CORNER), words)

    def test_what_parameters_say_wrongly(self):
        for name, text, words in OVERRIDES:
            with self.subTest(name):
                (self.folder / "mine.yaml").write_text(text + "\n")
                self.assert_refuses("world:=room overrides:=mine.yaml", words)

    def test_all_problems_come_at_once(self):
        (self.folder / "mine.yaml").write_text("map: {hit_probability: 2, resoluton_m: 1}\n")
        self.assert_refuses("world:=room overrides:=mine.yaml",
                            ["2 problem(s)", "[0.5, 1]", "map.resoluton_m"])

    def test_no_master(self):
        for node in ("planner_node", "sim_node"):
            code, said = self.run_line(f"rosrun spelunk {node}")
            self.assertNotEqual(code, 0)
            for word in (f"127.0.0.1:{self.port}", "roscore", "roslaunch"):
                self.assertIn(word, said)


if __name__ == "__main__":
    unittest.main()
