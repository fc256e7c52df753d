"""What the tests of campaigns share: an empty folder, a fake mission, one call of a campaign."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
FAKE_MISSION = pathlib.Path(__file__).resolve().with_name("fake_mission.py")
sys.path.insert(0, str(SCRIPTS))
from campaigns import description, fly


class InTemporaryFolder(unittest.TestCase):
    """Each test has an empty folder; `flights` lists what the fake mission was asked to fly."""

    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = pathlib.Path(self.holder.name)
        self.out = self.folder / "out"
        self.environment = {**os.environ, "PYTHONPATH": str(SCRIPTS),
                            "XDG_CACHE_HOME": str(self.folder / "cache"),
                            "FAKE_FLIGHTS": str(self.folder / "flights"),
                            "FAKE_MENDED": str(self.folder / "mended")}

    def describe(self, **group):
        """Path of a description with one group in `room`."""
        content = {"title": "Test", "parameter_sets": {"default": group.pop("settings", {})},
                   "groups": [{"worlds": ["room"], "robots": ["aerial"], "planners": ["steady"],
                               "seeds": [1, 2], "time_limits_s": [10], **group}]}
        return self.write_description(content)

    def write_description(self, content):
        path = self.folder / "description.yaml"
        path.write_text(yaml.safe_dump(content))
        return path

    def command(self, path, *extra, out=None):
        return [sys.executable, "-m", "campaigns.front", str(path), "--out",
                str(out or self.out), "--mission", str(FAKE_MISSION), "--jobs", "2", *extra]

    def campaign(self, path, *extra, out=None):
        """Flies to the end; the completed process."""
        return subprocess.run(self.command(path, *extra, out=out), env=self.environment,
                              capture_output=True, text=True, check=False, timeout=120)

    def fly_without_snakemake(self, path):
        """The same folders as `campaign`, faster: for what only reads them."""
        with unittest.mock.patch.dict(os.environ, self.environment):
            for mission in description.read(path).missions:
                folder = self.out / "missions" / mission.name
                folder.mkdir(parents=True)
                fly.fly(str(FAKE_MISSION), fly.order_of(mission, {}), folder)
        kept = self.out / "descriptions"
        kept.mkdir(exist_ok=True)
        shutil.copy(path, kept)

    def start(self, path, *extra):
        """Starts to fly; the process leads a session of its own."""
        process = subprocess.Popen(self.command(path, *extra), env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def flights(self, what):
        path = self.folder / "flights"
        lines = path.read_text().splitlines() if path.exists() else []
        return sorted(line.split(" ", 1)[1] for line in lines if line.startswith(what))

    def outcomes(self):
        """Kind of outcome of each planner and seed."""
        found = [json.loads(path.read_text())
                 for path in sorted(self.out.glob("missions/[!.]*/outcome.json"))]
        return {f"{outcome['planner']} {outcome['seed']}": outcome for outcome in found}

    def half_flown(self):
        return sorted(path.name for path in self.out.glob("missions/.*"))
