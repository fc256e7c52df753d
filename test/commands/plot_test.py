"""plot_mission.py draws whatever a mission leaves behind."""
import json
import subprocess
import unittest

from shell import ROOT, InFreshShell

HEADER = "t_s,explored_m3,distance_m,x_m,y_m,z_m,yaw_rad,remaining_s,state\n"
ROW = "{t}.000,{volume}.000,{t}.000,{t}.000,0.000,1.000,0.000,{left}.000,Explore\n"
PNG = b"\x89PNG"


class Plot(InFreshShell):
    def write_mission(self, seconds, width=4, height=3, **summary):
        rows = [ROW.format(t=t, volume=10 * t, left=900 - t) for t in range(1, seconds + 1)]
        (self.folder / "timeline.csv").write_text(HEADER + "".join(rows))
        (self.folder / "summary.json").write_text(json.dumps(
            {"world": "room", "robot": "aerial", "planner": "gbplanner", "seed": 1, **summary}))
        (self.folder / ".plan_view").write_bytes(
            f"plan_view 1 {width} {height} 0 0 0.5 0\n".encode() + bytes(3 * width * height))

    def draw(self):
        answer = subprocess.run([ROOT / "scripts" / "plot_mission.py", self.folder],
                                capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))
        self.assertEqual((self.folder / "exploration.png").read_bytes()[:4], PNG)

    def test_mission_shorter_than_a_second(self):
        self.write_mission(0)
        self.draw()

    def test_mission_of_one_second(self):
        self.write_mission(1)
        self.draw()

    def test_mission_that_never_saw_anything(self):
        self.write_mission(0, width=0, height=0)
        self.draw()

    def test_names_that_are_paths(self):
        self.write_mission(3, robot="/home/me/my robot.yaml", world="/mines/a \"b\" 'c'.stl")
        self.draw()


if __name__ == "__main__":
    unittest.main()
