"""What the tests of typed commands share: a stranger's shell and a free port for its master."""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SPELUNK_BUILD_DIR", ROOT / "build"))
DEVEL = BUILD / "devel"
PROGRAMS = DEVEL / "lib" / "spelunk"
LIMIT_S = 120


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


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
