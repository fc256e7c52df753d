"""What is installed runs from there, without the source folder's files."""
import os
import re
import subprocess
import unittest

from shell import BUILD, LIMIT_S, InFreshShell

PROGRAMS = ("benchmark", "best_possible", "mission", "planner_node", "sim_node",
            "robot_state_publisher.py")


class Install(InFreshShell):
    def setUp(self):
        super().setUp()
        # catkin writes its setup files to the prefix of the build, whatever `--prefix` says.
        cache = (BUILD / "CMakeCache.txt").read_text()
        prefix = re.search(r"(?m)^CMAKE_INSTALL_PREFIX:PATH=(.*)$", cache)[1]
        self.prefix = self.folder / prefix.lstrip("/")
        subprocess.run(["cmake", "--install", BUILD], check=True, stdout=subprocess.DEVNULL,
                       timeout=LIMIT_S, env={**os.environ, "DESTDIR": str(self.folder)})
        self.setup = self.prefix / "setup.bash"

    def test_programs_run_from_where_they_are(self):
        for name in PROGRAMS:
            found = self.assert_runs(f"rosrun --prefix 'printf %s\\n' spelunk {name}").strip()
            self.assertEqual(found, str(self.prefix / "lib" / "spelunk" / name))
        libraries = subprocess.run(["ldd", self.prefix / "lib" / "spelunk" / "planner_node"],
                                   check=True, capture_output=True, text=True).stdout
        ours = [line for line in libraries.splitlines() if "libspelunk" in line]
        self.assertTrue(ours)
        for line in ours:
            self.assertIn(f"=> {self.prefix}/lib/", line)

    def test_their_own_configuration_is_read(self):
        path = self.prefix / "share" / "spelunk" / "config" / "map.yaml"
        path.write_text("map: {resolution_m: 0.375}\n")
        said = self.assert_runs("rosrun spelunk mission --list-params")
        self.assertRegex(said, r"map\.resolution_m +0\.375 ")

    def test_mission_flies_and_draws(self):
        self.assert_runs("rosrun spelunk mission --world room --time-limit-s 25 --out there")
        for name in ("summary.json", "exploration.png"):
            self.assertTrue((self.folder / "there" / name).is_file(), name)

    def test_launch_files_and_messages_are_there(self):
        for name in ("aerial", "walker", "planner", "simulator"):
            self.assertIn("_node", self.assert_runs(f"roslaunch spelunk {name}.launch --nodes"))
        self.assert_runs("/usr/bin/python3 -c 'import spelunk.srv, octomap_msgs.msg'")


if __name__ == "__main__":
    unittest.main()
