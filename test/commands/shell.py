"""What the tests of typed commands share: a stranger's shell and a free port for its master."""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import rosgraph

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SPELUNK_BUILD_DIR", ROOT / "build"))
DEVEL = BUILD / "devel"
PROGRAMS = DEVEL / "lib" / "spelunk"
LIMIT_S = 120
START_LIMIT_S = 60  # until all nodes of a launch are there
LOOK_PERIOD_S = 0.2
BOX_ROOM = """solid room
{facets}endsolid room
"""
CORNERS = [(x, y, z) for x in (-8, 8) for y in (-6, 6) for z in (0, 4)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def write_mesh(path):
    """A box room whose start lies beside it."""
    facets = ""
    for a, b, c, d in FACES:
        for triangle in ((a, b, c), (a, c, d)):
            rows = "".join("vertex %g %g %g\n" % CORNERS[corner] for corner in triangle)
            facets += f"facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet\n"
    path.write_text(BOX_ROOM.format(facets=facets))
    path.with_suffix(".json").write_text('{"start": [0, 0, 1.5, 0]}')


class InFreshShell(unittest.TestCase):
    """Each test has an empty folder and a shell that knows nothing but the setup file."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="spelunk_commands_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.port = free_port()
        self.setup = DEVEL / "setup.bash"
        self.environment = {
            "HOME": os.environ.get("HOME", str(self.folder)), "LANG": "C.UTF-8",
            "PATH": "/usr/local/bin:/usr/bin:/bin", "ROS_IP": "127.0.0.1",
            "ROS_HOME": str(self.folder / "ros_home"), "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1",
            "ROS_MASTER_URI": f"http://127.0.0.1:{self.port}"}

    def run_line(self, line, **options):
        """The line typed in the empty folder after the setup file was sourced: exit code and all
        that was printed."""
        begin = f'. "{self.setup}" || exit 99\n'
        options = {"cwd": self.folder, "timeout": LIMIT_S, "env": self.environment, **options}
        # A session of its own, so that nothing of it outlives a test that hangs.
        process = subprocess.Popen(["bash", "-c", begin + line], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   errors="replace", start_new_session=True, cwd=options["cwd"],
                                   env=options["env"])
        try:
            said, _ = process.communicate(timeout=options["timeout"])
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            said, _ = process.communicate()
            self.fail(f"not done after {options['timeout']} s: {line}\n{said}")
        return process.returncode, re.sub(r"\x1b\[[0-9;]*m", "", said)

    def assert_runs(self, line, **options):
        """What the line printed, which must have ended well."""
        code, said = self.run_line(line, **options)
        self.assertEqual(code, 0, f"{line}\n{said}")
        return said

    def assert_launches(self, line):
        """Starts it, sees that all its nodes come, and ends it by Ctrl-C; what it printed."""
        line = line.replace("roslaunch", f"roslaunch -p {self.port}", 1)
        names = set(self.assert_runs(line + " --nodes").split())
        self.assertTrue(names)
        shell = f'. "{self.setup}"; exec {line}'
        with open(self.folder / "launch.log", "w+") as log:
            process = subprocess.Popen(["bash", "-c", shell], cwd=self.folder, text=True,
                                       env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                                       stderr=subprocess.STDOUT, start_new_session=True)
            try:
                missing = self.missing_nodes(names, process)
            finally:
                process.send_signal(signal.SIGINT)
                try:
                    code = process.wait(timeout=START_LIMIT_S)
                except subprocess.TimeoutExpired:
                    os.killpg(process.pid, signal.SIGKILL)
                    code = process.wait()
            log.seek(0)
            said = log.read()
        self.assertEqual(missing, set(), said)
        self.assertEqual(code, 0, said)
        self.assertNotIn("REQUIRED process", said)
        return said

    def missing_nodes(self, names, process):
        """Nodes that do not come in time: those that no topic of their own is known of."""
        master = rosgraph.Master("/launch_watcher", self.environment["ROS_MASTER_URI"])
        give_up = time.monotonic() + START_LIMIT_S
        there = set()
        while time.monotonic() < give_up and process.poll() is None and not names <= there:
            time.sleep(LOOK_PERIOD_S)
            try:
                there = {node for topics in master.getSystemState() for _, nodes in topics
                         for node in nodes}
            except OSError:  # the master itself is not there yet
                continue
        return names - there
