"""`brisance report --suite` as its users meet it: scenes of a folder, one of them broken and one absent, and the page.

usage: test_suite.py BINARY SOURCE_FOLDER [CLASS]
"""

import csv
import json
import os
import pathlib
import sys
import tempfile
import unittest

import browser
import test_report

SOURCE = test_report.SOURCE
METHODS = ["lighting_grid", "path", "ray_lights", "vbnl", "other=path,smoke.albedo=0"]
QUICK = ["--suite", "quick", "--shots", "shots", "--set", "camera.width=16", "--set", "camera.height=9",
         "--reference-samples", "16", "--strip", "3", "--progress", "plain", "--methods", *METHODS, "-o", "suite.html"]
MOST_BYTES = 30 << 20  # of a page


def make_shots(folder):
    """The list's scenes: one whole, one broken, one absent; one medium, and a further one beside the folder."""
    (folder / "shots" / "media").mkdir(parents=True)
    whole = test_report.SHOT.read_text(encoding="utf-8").replace("../volumes", str(SOURCE / "volumes"))
    (folder / "shots" / "explosion.json").write_text(whole, encoding="utf-8")
    (folder / "shots" / "fire_room.json").write_text("{ broken", encoding="utf-8")
    fog = (SOURCE / "shots" / "media" / "cornell_fog.json").read_text(encoding="utf-8")
    (folder / "shots" / "media" / "cornell_fog.json").write_text(fog, encoding="utf-8")
    (folder / "more.json").write_text(fog.replace('"cornell_fog"', '"more"'), encoding="utf-8")


class CommandLine(test_report.Case):
    """What is wrong with a suite is said before anything is rendered."""

    def test_usage_errors(self):
        make_shots(self.folder)
        before = self.names()
        self.expect(2, "--suite", "middling", says=["middling", "quick, draft, full"])
        self.expect(2, *QUICK, "--budgets", "4", says="--suite")
        self.expect(2, "more.json", "--shots", "shots", says="--suite")
        self.expect(2, "more.json", "--strip", "3", says="--suite")
        suite = ["--suite", "quick", "--shots", "shots"]
        self.expect(2, *suite, "--strip", "1", says=["--strip 1", "0, or 2 and more"])
        self.expect(2, *suite, "--strip", "17", says="--strip")
        self.expect(2, "more.json", "more.json", says="one SHOT_OR_VDB, or --suite; 2 were given")
        self.expect(2, "--suite", "quick", "--shots", "shots", "--scenes", "moon", says=["moon", "media/cornell_fog"])
        self.expect(66, "--suite", "quick", "--shots", "absent", says=["absent", "--shots"])
        self.expect(2, "--suite", "quick", "--shots", "shots", "--methods", "photons", says="photons")
        self.expect(73, "--suite", "quick", "--shots", "shots", "-o", "absent/suite.html", says="absent")
        self.assertEqual(self.names(), before)

    def test_fails_where_every_scene_does(self):
        (self.folder / "shots").mkdir()
        self.expect(1, *QUICK, says=["every scene failed", "explosion.json"])
        self.assertEqual(self.names(), ["shots"])


class Page(unittest.TestCase):
    """One small suite, its summary, and its page in Chromium."""

    @classmethod
    def setUpClass(cls):
        if not (SOURCE / "volumes" / "explosion.vdb").exists():
            raise unittest.SkipTest("no volume: volumes/explosion.vdb is missing")
        holder = tempfile.TemporaryDirectory(prefix="brisance-suite-")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)
        make_shots(cls.folder)
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        cls.done = test_report.run_program(cls.folder, "report", "more.json", *QUICK, env=environment)
        if cls.done.returncode != 0:
            raise AssertionError(cls.done.stderr)
        cls.data = json.loads((cls.folder / "suite.json").read_text(encoding="utf-8"))
        cls.scenes = {scene["name"]: scene for scene in cls.data["scenes"]}
        cls.page = None
        if browser.find_browser():
            cls.page = browser.Page()
            cls.page.__enter__()
            cls.addClassCleanup(cls.page.__exit__)

    def setUp(self):
        if "browser" in self.id().rsplit(".", 1)[-1]:
            if self.page is None:
                self.skipTest("no Chromium: install the package chromium, or name one in BRISANCE_BROWSER")
            self.page.problems.clear()

    def test_files(self):
        names = ["suite.csv", "suite.html", "suite.json", "suite.md"]
        self.assertEqual(sorted(self.done.stdout.split()[-4:]), names)
        for name in names:
            self.assertTrue((self.folder / name).exists(), name)
        self.assertLess((self.folder / "suite.html").stat().st_size, MOST_BYTES)

    def test_scenes_that_fail_are_rows(self):
        self.assertEqual(list(self.scenes), ["explosion", "fire_room", "street", "media/cornell_fog", "more"])
        for name, says in (("fire_room", "fire_room.json"), ("street", "street.json")):
            self.assertIsNone(self.scenes[name]["report"])
            self.assertIn(says, self.scenes[name]["failure"])
            self.assertNotIn("\n", self.scenes[name]["failure"])
        for name in ("explosion", "media/cornell_fog", "more"):
            self.assertIsNone(self.scenes[name]["failure"])

    def test_methods_follow_from_cells(self):
        def methods(name):
            return [method["label"] for method in self.scenes[name]["report"]["methods"]]

        self.assertEqual(methods("explosion"), ["lighting_grid", "path", "ray_lights"])
        self.assertEqual(methods("more"), ["lighting_grid", "path", "ray_lights", "vbnl"])
        contenders = {cell["cell"]: [c["method"] for c in cell["contenders"]] for cell in self.scenes["more"]["cells"]}
        self.assertEqual(contenders["MM"], ["lighting_grid", "path", "ray_lights"])
        self.assertEqual(contenders["SS"], ["path", "vbnl"])
        self.assertEqual(contenders["SA"], ["lighting_grid", "path"])

    def test_methods_that_fail_are_rows(self):
        for name in ("explosion", "media/cornell_fog", "more"):
            failures = self.scenes[name]["failures"]
            self.assertEqual([failure["method"] for failure in failures], ["other"])
            self.assertIn("smoke.albedo", failures[0]["reason"])

    def test_summary_has_every_scene_and_cell(self):
        text = (self.folder / "suite.md").read_text(encoding="utf-8")
        for name, scene in self.scenes.items():
            self.assertIn(f"\n### {name}\n", text)
            for cell in scene["cells"]:
                self.assertIn(f"| {name} | {cell['cell']} | ", text)
            for failure in scene["failures"]:
                self.assertIn(f"| {name} | {failure['method']} | ", text)
        self.assertIn("2001-09-09", text)
        self.assertIn("brisance report more.json --suite quick", text)

    def test_csv_has_every_scene_once(self):
        with open(self.folder / "suite.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["shot"] for row in rows}, {"explosion", "cornell_fog", "more"})
        self.assertNotIn("shot", {row["shot"] for row in rows})

    def flicker(self, scene, method):
        """By cell."""
        methods = self.scenes[scene]["report"]["methods"]
        return next(m["flicker"] for m in methods if m["label"] == method)

    def test_flicker_is_that_of_what_methods_draw(self):
        for name in ("explosion", "media/cornell_fog", "more"):
            self.assertEqual(self.scenes[name]["report"]["strip_frames"], 3)
        # What marches or traces the same rays through the same fire or to the same lamp sees the same; paths do not.
        self.assertLess(self.flicker("explosion", "lighting_grid")["V"], 0.01)
        self.assertGreater(self.flicker("explosion", "path")["V"], 0.05)
        self.assertLess(self.flicker("more", "lighting_grid")["A"], 1e-4)
        self.assertGreater(self.flicker("more", "path")["A"], 0.05)
        self.assertEqual(list(self.flicker("more", "vbnl")), ["MS", "SS"])
        self.assertIn("frame 3 of 3: ", self.done.stderr)

    def test_flicker_is_a_column(self):
        text = (self.folder / "suite.md").read_text(encoding="utf-8")
        self.assertIn("| smallest error | flicker |", text)
        with open(self.folder / "suite.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["flicker"]]
        counted = sum(len(method["flicker"]) for scene in self.scenes.values() if scene["report"]
                      for method in scene["report"]["methods"])
        self.assertEqual(len(rows), counted)
        row = next(row for row in rows if row["shot"] == "explosion" and row["method"] == "path" and
                   row["layer"] == "MV")
        self.assertAlmostEqual(float(row["flicker"]), self.flicker("explosion", "path")["MV"])
        self.assertEqual(row["step"], "4 spp")

    def test_progress_names_the_scene(self):
        self.assertIn("scene 4 of 5, media/cornell_fog: ", self.done.stderr)

    def test_page_needs_nothing_from_elsewhere(self):
        text = (self.folder / "suite.html").read_text(encoding="utf-8")
        self.assertNotRegex(text, r'(?:src|href)\s*=\s*"?https?:')

    # In the browser

    def check_scene(self, title, methods):
        self.assertEqual(self.page.problems, [])
        self.assertEqual(self.page.evaluate("document.querySelector('h1').textContent"), title)
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#reach-table tbody tr').length"), methods)
        broken = "image => image.src && (!image.complete || !image.naturalWidth)"
        self.assertEqual(self.page.evaluate(f"[...document.images].filter({broken}).length"), 0)
        left = self.page.evaluate("document.querySelector('#slider [slot=first]').src")
        self.assertTrue(left.startswith("data:image/png;base64,"))
        self.assertFalse(self.page.evaluate("document.documentElement.scrollWidth > innerWidth"))

    def test_browser_shows_who_is_best(self):
        self.page.open(self.folder / "suite.html")
        self.check_scene("explosion", 3)
        rows = self.page.evaluate("[...document.querySelectorAll('#winners-table tbody tr')].map(r => r.textContent)")
        measured = sum(len(scene["cells"]) for scene in self.scenes.values())
        self.assertEqual(len(rows), measured + 2)
        self.assertEqual(sum("failed: " in row for row in rows), 2)
        best = self.scenes["explosion"]["cells"][0]
        self.assertIn(best["contenders"][best["best_at_time"]]["method"], rows[0])
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#failures-table tbody tr').length"), 3)

    def test_browser_shows_film_strips(self):
        self.page.open(self.folder / "suite.html")
        labels = "[...document.querySelectorAll('#strips .strip strong')].map(e => e.textContent)"
        self.assertEqual(self.page.evaluate(labels), ["lighting_grid", "path", "ray_lights"])  # MM
        pictures = "[...document.querySelectorAll('#strips .strip img')].filter(i => i.complete && i.naturalWidth > 0)"
        self.assertEqual(self.page.evaluate(pictures + ".length"), 3 * 4)
        frames = "new Set([...document.querySelectorAll('.strip[data-run=method2step1] img')].map(i => i.src)).size"
        self.assertEqual(self.page.evaluate(frames), 4)  # three frames that differ, and what differs
        self.page.click("#strips .choice button")
        self.assertEqual(self.page.evaluate(labels), ["lighting_grid", "path"])  # V
        text = self.page.evaluate("document.querySelector('#strips .strips').textContent")
        self.assertIn("flicker", text)
        self.assertEqual(self.page.problems, [])

    def test_browser_goes_to_another_scene(self):
        self.page.open(self.folder / "suite.html")
        links = self.page.evaluate("[...document.querySelectorAll('#scenes a')].map(a => a.getAttribute('href'))")
        self.assertEqual(links, ["?scene=1", "?scene=2"])
        self.page.open(self.folder / "suite.html", "?scene=2")
        self.check_scene("more", 4)
        self.assertEqual(self.page.evaluate("document.querySelector('#scenes strong').textContent"), "more")


if __name__ == "__main__":
    test_report.main(sys.modules[__name__])
