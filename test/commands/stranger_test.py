"""What people do who know only the README: odd folders, odd names, Ctrl-C, a full disk."""
import csv
import json
import os
import pty
import shlex
import signal
import subprocess
import tempfile
import unittest

from shell import PROGRAMS, InFreshShell

MISSION = PROGRAMS / "mission"
SHORT = "--world room --time-limit-s 40"
LIMIT_S = 120


class Stranger(InFreshShell):
    def mission(self, arguments, **environment):
        """Exit code and all that was printed; the program itself, without any setup."""
        self.setup = "/dev/null"
        given = {**self.environment, **environment}
        return self.run_line(f"{MISSION} {arguments}",
                             env={key: value for key, value in given.items() if value is not None})

    def assert_flies(self, arguments, out="out", **environment):
        code, said = self.mission(f"{arguments} --out {shlex.quote(out)}", **environment)
        self.assertEqual(code, 0, said)
        folder = self.folder / out
        self.assertTrue((folder / "exploration.png").is_file(), said)
        return folder, said

    def assert_refused(self, arguments, *words):
        code, said = self.mission(arguments)
        self.assertEqual(code, 2, said)
        for word in words:
            self.assertIn(word, said)

    def test_quotes_and_spaces_in_the_folders_name(self):
        self.assert_flies(SHORT, out="my $HOME \"results\"; `date`/it's")

    def test_no_home(self):
        self.assert_flies(SHORT, HOME=None)

    def test_home_and_cache_that_cannot_be_written(self):
        _, said = self.assert_flies(SHORT, HOME="/proc", SPELUNK_CACHE="/proc/cache")
        self.assertNotIn("matplotlib", said.lower())

    def test_comma_decimals(self):
        folder, _ = self.assert_flies(SHORT, LC_ALL="de_DE.UTF-8", LANG="de_DE.UTF-8")
        with open(folder / "timeline.csv", encoding="utf-8", newline="") as file:
            self.assertGreater(float(list(csv.DictReader(file))[-1]["explored_m3"]), 10.0)

    def test_out_is_a_file(self):
        (self.folder / "out").write_text("mine")
        self.assert_refused(f"{SHORT} --out out", "'out'", "not", "--out")
        self.assertEqual((self.folder / "out").read_text(), "mine")

    def test_very_long_name(self):
        self.assert_refused(f"{SHORT} --out {'x' * 300}", "too long", "--out")

    def test_options_that_make_no_sense(self):
        for arguments in ("--seed -1", "--seed 1.5", "--time-limit-s -5", "--time-limit-s nan",
                          "--start 1,2,3", "--go-to here", "--set nothing", "--robots aerial",
                          "room"):
            with self.subTest(arguments):
                self.assert_refused(f"{SHORT} {arguments}")

    def start(self, arguments, **options):
        process = subprocess.Popen([MISSION, *arguments.split()], cwd=self.folder, text=True,
                                   env=self.environment, stdin=subprocess.DEVNULL,
                                   stderr=subprocess.STDOUT, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def flying(self, out):
        """A long mission that has begun to fly."""
        process = self.start(f"--world room --time-limit-s 900 --set delays.scan_s=5 --out {out}",
                             stdout=subprocess.PIPE)
        while "endurance" not in process.stdout.readline():
            self.assertIsNone(process.poll())
        return process

    def test_ctrl_c_leaves_what_was_gathered(self):
        process = self.flying("out")
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 130, said)
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertRegex(summary["outcome"], "^interrupted by .* m from home")
        self.assertGreater(summary["mission_time_s"], 0)
        for name in ("timeline.csv", "plans.csv", "map.bt", "exploration.png"):
            self.assertTrue((self.folder / "out" / name).is_file(), name)

    def test_two_missions_into_one_folder(self):
        process = self.flying("out")
        self.assert_refused(f"{SHORT} --out out", "another mission is flying into it")
        self.assertIsNone(process.poll())

    def test_reader_of_the_progress_that_goes_away(self):
        self.setup = "/dev/null"
        code, said = self.run_line(f"{MISSION} {SHORT} --out out | head -n 1")
        self.assertEqual(code, 0, said)
        self.assertTrue((self.folder / "out" / "exploration.png").is_file(), said)

    def test_terminal_that_knows_no_escapes(self):
        self.environment["TERM"] = "dumb"
        ours, theirs = pty.openpty()
        process = self.start(f"{SHORT} --out out", stdout=theirs)
        os.close(theirs)
        said = b""
        while True:
            try:
                said += os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
        os.close(ours)
        self.assertEqual(process.wait(timeout=LIMIT_S), 0)
        self.assertIn(b"endurance", said)
        self.assertNotIn(b"\x1b", said)

    def test_full_disk(self):
        """The result is said all the same, and what was there before stays whole."""
        disk = tempfile.mkdtemp(dir=self.folder)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk],
                                 check=False, stderr=subprocess.DEVNULL)
        if mounted.returncode != 0:
            self.skipTest("only root can make a small disk")
        try:
            with open(os.path.join(disk, "summary.json"), "w", encoding="utf-8") as file:
                file.write("of an earlier mission")
            with open(os.path.join(disk, "filler"), "wb") as file:
                file.write(bytes(52 * 1024))
            code, said = self.mission(f"{SHORT} --out '{disk}'")
            self.assertNotEqual(code, 0, said)
            self.assertIn("space", said)
            self.assertIn("reachable", said)
            left = sorted(os.listdir(disk))
            self.assertFalse([name for name in left if name.endswith(".part")], left)
        finally:
            subprocess.run(["umount", disk], check=True)


if __name__ == "__main__":
    unittest.main()
