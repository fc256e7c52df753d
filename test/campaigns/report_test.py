"""Reports of campaigns of the fake mission, read in a real browser."""
import os
import re
import shutil
import subprocess
import sys
import unittest

import support

BROWSER = ["chromium", "--headless", "--disable-gpu", "--hide-scrollbars", "--no-first-run",
           *(["--no-sandbox"] if os.geteuid() == 0 else [])]
NO_NETWORK = "--host-resolver-rules=MAP * ~NOTFOUND"


class Report(support.InTemporaryFolder):
    def report(self, *extra):
        return subprocess.run([sys.executable, "-m", "campaigns.report", str(self.out), *extra],
                              env=self.environment, capture_output=True, text=True, check=False,
                              timeout=120)

    def open(self, path, *extra):
        """What the browser makes of the page."""
        command = [*BROWSER, NO_NETWORK, f"--user-data-dir={self.folder / 'browser'}",
                   "--virtual-time-budget=2000", *extra, path.as_uri()]
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)

    def dom(self, path):
        return self.open(path, "--dump-dom").stdout

    def write_best_possible(self, bound=100.0, tour=50.0):
        place = self.out / "best_possible" / "room__aerial__10"
        place.mkdir(parents=True)
        for name, rate in (("bound", bound), ("tour", tour)):
            (place / f"{name}.csv").write_text("t_s,explored_m3\n" + "".join(
                f"{t},{rate * t}\n" for t in range(11)))

    def test_a_whole_campaign_in_a_browser(self):
        self.fly_without_snakemake(self.describe(planners=["steady", "brisk", "crashing"],
                                                 seeds="1-5"))
        self.write_best_possible()
        answer = self.report()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        page = self.out / "report" / "report.html"
        dom = self.dom(page)
        text = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", re.sub(r"(?s)<style>.*?</style>", "",
                                                                  dom)))
        for part in ("15 missions flown", "10 finished", "5 crash", "room, aerial, 10 s",
                     "Reachable: 200 m³", "No run gave a result: crashing.",
                     "brisk 5 180 160 to 200 90 80 to 100",  # 10 s of 16 to 20 m3/s
                     "brisk − steady explored at the end, m³ 5 50",
                     "5 of 5", "0.36 0.32 to 0.40", "0.18 0.16 to 0.20",  # of tour and bound
                     "killed by SIGSEGV", "room__aerial__crashing__default__10__003"):
            self.assertIn(part, text)
        self.assertNotIn("missing", text)
        self.check_pictures(page, dom)

    def check_pictures(self, page, dom):
        """Embedded, beside the page, and nothing is fetched from anywhere."""
        sources = re.findall(r'<img src="([^"]*)"', dom)
        self.assertEqual(len(sources), 3)
        for source in sources:
            self.assertTrue(source.startswith("data:image/png;base64,iVBOR"), source[:60])
        self.assertEqual(sorted(path.name for path in page.parent.glob("*.png")),
                         [f"room__aerial__10__{what}.png"
                          for what in ("clearance", "ratio", "volume")])
        self.assertNotRegex(page.read_text(), r"(src|href)=\"(https?:|//|file:)")
        shot = self.folder / "shot.png"
        self.open(page, "--window-size=1280,3000", f"--screenshot={shot}")
        self.assertGreater(shot.stat().st_size, 100_000)  # a blank page takes some 10 kB

    def test_the_same_folder_gives_the_same_bytes(self):
        self.fly_without_snakemake(self.describe(planners=["steady", "brisk"], seeds="1-5"))
        for name in ("a", "b"):
            answer = self.report("--out", str(self.folder / name / "page.html"))
            self.assertEqual(answer.returncode, 0, answer.stderr)
        names = sorted(path.name for path in (self.folder / "a").iterdir())
        self.assertEqual(len(names), 3)
        for name in names:
            self.assertEqual((self.folder / "a" / name).read_bytes(),
                             (self.folder / "b" / name).read_bytes(), name)

    def test_an_incomplete_campaign_says_how_much_is_missing(self):
        self.fly_without_snakemake(self.describe(seeds=[1]))
        self.describe(seeds="1-4", planners=["steady", "brisk"]).replace(
            self.out / "descriptions" / "description.yaml")
        answer = self.report()
        self.assertIn("7 missions are missing", answer.stdout)
        page = (self.out / "report" / "report.html").read_text()
        self.assertIn("7 missing", page)
        self.assertIn("room__aerial__brisk__default__10__004", page)
        self.assertIn("there is no best_possible/room__aerial__10", page)
        self.assertIn("no two planners here that flew the same seed", page)

    def test_runs_without_a_result_are_counted_beside_the_others(self):
        path = self.describe(planners=["crashing"], seeds="1-3")
        self.fly_without_snakemake(path)
        (self.folder / "mended").touch()
        shutil.rmtree(self.out / "missions" / "room__aerial__crashing__default__10__002")
        self.describe(planners=["crashing"], seeds=[2])
        self.fly_without_snakemake(path)
        self.assertEqual(self.report().returncode, 0)
        page = (self.out / "report" / "report.html").read_text()
        self.assertIn("<small class=\"bad\">2 without result</small></td><td>120</td>", page)

    def test_a_parameter_set_is_named_where_a_planner_has_several(self):
        group = {"worlds": ["room"], "robots": ["aerial"], "seeds": [1], "time_limits_s": [10]}
        self.fly_without_snakemake(self.write_description({
            "parameter_sets": {"a": {"fake.wall_s": 0}, "b": {"fake.wall_s": 0.0}},
            "groups": [{**group, "planners": ["steady"], "parameter_sets": ["a", "b"]},
                       {**group, "planners": ["brisk"], "parameter_sets": ["a"]}]}))
        self.assertEqual(self.report().returncode, 0)
        page = (self.out / "report" / "report.html").read_text()
        for label in ("steady (a)", "steady (b)", "brisk"):
            self.assertIn(f'<td class="label">{label}</td>', page)

    def test_only_crashes_make_a_report_too(self):
        self.fly_without_snakemake(self.describe(planners=["crashing"], seeds=[1]))
        self.assertEqual(self.report().returncode, 0)
        page = (self.out / "report" / "report.html").read_text()
        self.assertIn("No mission of this comparison ended with a result", page)

    def test_missions_that_saw_nothing_make_a_report_too(self):
        self.fly_without_snakemake(self.describe(planners=["instant"], seeds=[1, 2]))
        (self.out / "missions" / "room__aerial__instant__default__10__001" / ".plan_view").touch()
        answer = self.report()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(answer.stderr, "")
        page = (self.out / "report" / "report.html").read_text()
        self.assertIn("<td>0<br><small>0 to 0</small></td><td>–</td>", page)

    def test_the_papers_figures_stand_beside_ours(self):
        reference = {"world": "room", "robot": "aerial", "time_limit_s": 10, "vertices": 32,
                     "label": "paper <1>", "edges": 52, "navigation_s": 508, "exploration_s": 595,
                     "volume_m3": 858}
        self.fly_without_snakemake(self.write_description({
            "references": [reference],
            "groups": [{"worlds": ["room"], "robots": ["aerial"], "planners": ["informed"],
                        "seeds": [1, 2], "time_limits_s": [10]}]}))
        self.assertEqual(self.report().returncode, 0)
        page = re.sub(r"\s+", " ", (self.out / "report" / "report.html").read_text())
        self.assertIn("paper &lt;1&gt;</td>" + "".join(
            f"<td>{value}</td>" for value in (32, 52, 508, 595, 858)), page)
        self.assertIn("informed, 2 seeds</td><td>10<br>", page)

    def test_an_empty_folder_is_named_with_the_remedy(self):
        answer = self.report()
        self.assertEqual(answer.returncode, 2)
        self.assertIn("no mission flown yet; run scripts/campaign", answer.stderr)


if __name__ == "__main__":
    unittest.main()
