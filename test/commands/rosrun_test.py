"""rosrun finds each program and script of the package, exactly once."""
import os
import shutil
import subprocess
import unittest

from shell import DEVEL, ROOT, InFreshShell

PROGRAMS = ("benchmark", "mission", "planner_node", "sim_node")
SCRIPTS = ("best_possible", "campaign", "plot_mission.py", "report", "robot_state_publisher.py")


class Rosrun(InFreshShell):
    def path_of(self, name):
        """The file that rosrun would start."""
        said = self.assert_runs(f"rosrun --prefix 'printf %s\\n' spelunk {name}")
        self.assertNotIn("non-unique", said)
        return said.strip()

    def found(self, name):
        return os.path.realpath(self.path_of(name))

    def test_finds_each_program_once(self):
        for name in PROGRAMS:
            found = self.found(name)
            self.assertTrue(found.endswith(f"/devel/lib/spelunk/{name}"), found)

    def test_finds_each_script_once(self):
        for name in SCRIPTS:
            self.assertTrue(os.access(self.found(name), os.X_OK), name)

    def test_finds_those_of_a_build_folder_elsewhere(self):
        subprocess.run(["cp", "-rs", DEVEL, self.folder / "devel"], check=True)
        for name in ("setup.sh", "_setup_util.py"):  # these ask where they lie themselves
            (self.folder / "devel" / name).unlink()
            shutil.copy(DEVEL / name, self.folder / "devel")
        self.setup = self.folder / "devel" / "setup.bash"
        for name in PROGRAMS:
            self.assertEqual(self.path_of(name), f"{self.folder}/devel/lib/spelunk/{name}")

    def test_scripts_take_the_python_that_has_the_ros_modules(self):
        for path in sorted((ROOT / "scripts").iterdir()):
            if path.is_file() and os.access(path, os.X_OK):
                first = path.read_text(encoding="utf-8").splitlines()[0]
                self.assertIn(first, ("#!/usr/bin/env bash", "#!/usr/bin/python3"), path)

    def test_runs_a_program_and_hands_its_arguments_on(self):
        self.assertIn("--time-limit-s", self.assert_runs("rosrun spelunk mission --help"))


if __name__ == "__main__":
    unittest.main()
