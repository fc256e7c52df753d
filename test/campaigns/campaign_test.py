"""Whole campaigns of a fake mission: crashes, hangs, kills, resumption."""
import filecmp
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import support
from campaigns import fly, front, table

WAIT_S = 60


def wait_until(condition, what):
    deadline = time.monotonic() + WAIT_S
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {WAIT_S} s in vain: {what}")
        time.sleep(0.05)


def processes_in(folder):
    """Command lines of the processes that work in a folder or know of it."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().decode(errors="replace").split("\0")
            if str(folder) in os.readlink(process / "cwd") or any(str(folder) in w for w in words):
                found.append(" ".join(words))
        except OSError:
            continue  # it has ended
    return found


class Outcomes(support.InTemporaryFolder):
    def test_what_fails_is_recorded_and_only_flown_again_when_asked(self):
        planners = ["steady", "stranding", "crashing", "hanging", "refusing", "mute"]
        description = self.describe(planners=planners, seeds=[1], wall_limit_s=8)
        first = self.campaign(description)
        self.assertEqual(first.returncode, 1, first.stderr)
        self.assertIn("6 of 6 missions flown: 1 finished, 1 stranded, 2 crash, 1 hang, 1 bad input",
                      first.stdout)
        self.check_records()

        begun = self.flights("begin")
        self.assertEqual(begun, sorted(f"{planner} 1" for planner in planners))
        self.assertEqual(self.campaign(description).returncode, 1)
        self.assertEqual(self.flights("begin"), begun)

        (self.folder / "mended").touch()
        again = self.campaign(description, "--retry-failed")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(self.flights("begin"), sorted(begun + ["crashing 1", "hanging 1", "mute 1",
                                                                "refusing 1"]))
        table = (self.out / "campaign.csv").read_text()
        self.assertEqual(table.count(",finished,"), 5, table)

    def check_records(self):
        outcomes = self.outcomes()
        reasons = {name: outcome["reason"] for name, outcome in outcomes.items()}
        self.assertEqual({name: outcome["kind"] for name, outcome in outcomes.items()},
                         {"steady 1": "finished", "stranding 1": "stranded", "crashing 1": "crash",
                          "hanging 1": "hang", "refusing 1": "bad input", "mute 1": "crash"})
        self.assertEqual(reasons["crashing 1"], "killed by SIGSEGV")
        self.assertEqual(reasons["hanging 1"], "not done after 8 s of wall time")
        self.assertEqual(reasons["refusing 1"], "mission: nothing to fly in")
        self.assertEqual(reasons["stranding 1"], "stranded: no way home")
        self.assertIn("summary.json", reasons["mute 1"])
        log, = self.out.glob("missions/*crashing*/mission.log")
        self.assertIn("about to touch address zero", log.read_text())
        self.assertEqual(self.half_flown(), [])


class Interruption(support.InTemporaryFolder):
    def setUp(self):
        super().setUp()
        self.description = self.describe(planners=["steady", "patient"], seeds=[1, 2, 3])

    def start_and_wait(self):
        """A campaign with three finished missions, and others that do not end."""
        process = self.start(self.description, "--jobs", "4")
        wait_until(lambda: len(self.outcomes()) == 3 and len(self.flights("begin")) > 3,
                   "the first missions")
        return process

    def check_resumed(self):
        """The rest is flown, nothing twice, and the files are those of a run straight through."""
        finished = sorted(self.outcomes())
        self.assertEqual(finished, ["steady 1", "steady 2", "steady 3"])
        (self.folder / "mended").touch()
        resumed = self.campaign(self.description)
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        self.assertEqual(self.half_flown(), [])
        begun = self.flights("begin")
        for name in finished:
            self.assertEqual(begun.count(name), 1, name)
        straight = self.folder / "straight"
        self.out.rename(self.folder / "resumed")
        self.fly_without_snakemake(self.description)
        self.out.rename(straight)
        (straight / "campaign.csv").write_text(table.text_of(straight / "missions"))
        compared = [*straight.glob("missions/*/*.csv"), straight / "campaign.csv"]
        self.assertEqual(len(compared), 6 * 3 + 1)
        for path in compared:
            here = self.folder / "resumed" / path.relative_to(straight)
            self.assertTrue(filecmp.cmp(path, here, shallow=False), path)

    def test_killed_hard_in_the_middle_it_leaves_nothing_running_and_goes_on(self):
        process = self.start_and_wait()
        process.kill()
        wait_until(lambda: not processes_in(self.out), "the children's end")
        self.check_resumed()

    def test_interrupted_it_ends_its_children_and_goes_on(self):
        process = self.start_and_wait()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 130)
        self.assertEqual(processes_in(self.out), [])
        self.assertEqual(self.half_flown(), [])
        self.check_resumed()

    def test_half_flown_folders_are_removed_and_others_kept(self):
        for place in (self.out / "missions", self.out / "best_possible"):
            for name in (".room__aerial__steady__default__10__001.part.host.7", "room__a"):
                (place / name).mkdir(parents=True)
                (place / name / "timeline.csv").write_text("t_s,expl")
        front.remove_unfinished(self.out)
        for place in (self.out / "missions", self.out / "best_possible"):
            self.assertEqual([path.name for path in place.iterdir()], ["room__a"])


class Machine(support.InTemporaryFolder):
    def test_a_second_campaign_into_the_same_folder_is_refused(self):
        description = self.describe(settings={"fake.wall_s": 5})
        process = self.start(description)
        wait_until(lambda: self.flights("begin"), "the first mission")
        second = self.campaign(description)
        self.assertEqual(second.returncode, 2)
        self.assertIn("another campaign is flying into it", second.stderr)
        process.send_signal(signal.SIGINT)
        process.wait(timeout=30)

    def test_a_folder_that_cannot_be_written_is_named(self):
        (self.folder / "file").touch()
        answer = self.campaign(self.describe(), out=self.folder / "file" / "out")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("choose a folder that can be written", answer.stderr)

    def test_a_full_disk_is_no_fault_of_the_mission(self):
        (self.folder / ".space_test").symlink_to("/dev/full")
        with self.assertRaisesRegex(fly.MachineError, "No space left.*free some space"):
            fly.require_space(self.folder)

    def test_a_missing_executable_is_named_with_the_remedy(self):
        answer = self.campaign(self.describe(), "--mission", "/nowhere/mission")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("run scripts/build", answer.stderr)


class Checks(support.InTemporaryFolder):
    def test_unknown_names_are_refused_together_before_anything_is_written(self):
        answer = self.campaign(self.describe(worlds=["moon", "room"], robots=["aerial", "boat"],
                                             planners=["steady", "lazy"]))
        self.assertEqual(answer.returncode, 2)
        self.assertIn("3 problem(s)", answer.stderr)
        for part in ('"moon"', '"boat"', 'planner "lazy" is not known; choose one of: steady'):
            self.assertIn(part, answer.stderr)
        self.assertFalse(self.out.exists())

    def test_a_dry_run_lists_and_writes_nothing(self):
        answer = self.campaign(self.describe(), "--dry-run")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("to fly: room__aerial__steady__default__10__002", answer.stdout)
        self.assertFalse(self.out.exists())

    def test_other_settings_under_the_same_name_are_refused(self):
        self.campaign(self.describe(seeds=[1]))
        answer = self.campaign(self.describe(seeds=[1], settings={"fake.wall_s": 0}))
        self.assertEqual(answer.returncode, 2)
        self.assertIn("flown with other settings", answer.stderr)


class Cluster(support.InTemporaryFolder):
    def test_snakemake_alone_flies_the_same_campaign_through_a_submit_command(self):
        description = self.describe(seeds=[1])
        command = ["snakemake", "--snakefile", str(support.SCRIPTS / "campaigns" / "Snakefile"),
                   "--directory", str(self.out), "--cluster", "bash", "--jobs", "2",
                   "--latency-wait", "5", "--max-status-checks-per-second", "20",
                   "--rerun-triggers", "mtime", "--ignore-incomplete",
                   "--config", f"description={description}", f"mission={support.FAKE_MISSION}"]
        self.out.mkdir()
        answer = subprocess.run(command, env=self.environment, capture_output=True, text=True,
                                check=False, timeout=120)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.campaign(description, out=self.folder / "local")
        self.assertEqual((self.out / "campaign.csv").read_bytes(),
                         (self.folder / "local" / "campaign.csv").read_bytes())


if __name__ == "__main__":
    sys.exit(unittest.main())
