"""`brisance report` as its users meet it: the command line, and the page in a real browser.

usage: test_report.py BINARY SOURCE_FOLDER [CLASS]
"""

import base64
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import browser

BINARY = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(sys.argv[2]).resolve()
SHOT = SOURCE / "shots" / "explosion.json"
NAME = "boom </script><b>&\"'"  # what a shot may be called
SMALL = ["--preset", "draft", "--set", "camera.width=32", "--set", "camera.height=18", "--progress", "none"]
QUICK = [*SMALL, "--budgets", "2,8", "lighting_grid:1,2", "--reference-samples", "32"]


def run_program(folder, *arguments, **options):
    return subprocess.run([BINARY, *map(str, arguments)], cwd=folder, capture_output=True, text=True, check=False,
                          **options)


class Case(unittest.TestCase):
    def setUp(self):
        if not (SOURCE / "volumes" / "explosion.vdb").exists():
            self.skipTest("no volume: volumes/explosion.vdb is missing")
        holder = tempfile.TemporaryDirectory(prefix="brisance-report-")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def expect(self, code, *arguments, says=()):
        done = run_program(self.folder, "report", *arguments)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        return done

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())


class CommandLine(Case):
    """What is wrong is said before anything is rendered, and leaves no file."""

    def test_usage_errors(self):
        self.expect(2)
        self.expect(2, SHOT, "--methods", "photons", says="no method is called \"photons\"")
        self.expect(2, SHOT, "--budgets", "grid:1", says="no method has this label")
        self.expect(2, SHOT, "--budgets", "1", says="tracing.samples")
        self.expect(2, SHOT, "--ladder", "path:tracing.sample=4", says="tracing.sample")
        self.expect(2, SHOT, "--methods", "thin=path,smoke.albedo=0", says=["thin, 4 spp", "smoke.albedo"])
        self.expect(2, SHOT, "--reference-samples", "0")
        self.expect(2, SHOT, "--reference", "a.exr", "--reference-seconds", "1")
        self.expect(2, SHOT, "--picture-width", "1")
        self.expect(2, SHOT, "-o", "report.htm", says=".html")
        self.assertEqual(self.names(), [])

    def test_files_that_are_not_there(self):
        self.expect(66, "absent.json", says="absent.json")
        self.expect(66, SHOT, "--reference", "absent.exr", says="absent.exr")
        self.expect(73, SHOT, "-o", "absent/report.html", says="absent")
        self.assertEqual(self.names(), [])

    def test_reads_one_frame(self):
        for number in (3, 5):
            (self.folder / f"fire_{number}.vdb").symlink_to(SOURCE / "volumes" / "explosion.vdb")
        self.expect(2, "fire_#.vdb", *QUICK, says=["3, 5", "-f"])
        self.expect(66, "fire_#.vdb", *QUICK, "-f", "4", says="frame 4")

    def test_never_overwrites_what_it_reads(self):
        volume = self.folder / "report.html"  # a shot may be called anything
        volume.write_text(SHOT.read_text(encoding="utf-8").replace("../volumes", str(SOURCE / "volumes")),
                          encoding="utf-8")
        self.expect(2, volume, *QUICK, says="would be overwritten")
        self.assertEqual(self.names(), ["report.html"])

    def test_a_reference_of_another_picture_is_refused(self):
        done = run_program(self.folder, "render", SHOT, *SMALL, "--set", "smoke.albedo=0.9", "--set",
                           "scattering.bounces=0", "--set", "output.png=false", "--set", "output.statistics=false",
                           "-o", "other.exr")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect(65, SHOT, *SMALL, "--reference", "other.exr", says=["smoke.albedo", "scattering.bounces"])
        self.expect(65, SHOT, *SMALL, "--set", "camera.width=16", "--reference", "other.exr",
                    says="other.exr is 32 x 18 pixels, the shot 16 x 18")
        self.assertEqual(self.names(), ["other.exr"])


    def test_given_halves_replace_a_reference(self):
        done = run_program(self.folder, "render", SHOT, *SMALL, "--set", "method=path", "--set", "tracing.samples=32",
                           "--set", "output.halves=true", "-o", "truth.exr")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.expect(0, SHOT, *SMALL, "--methods", "path", "--budgets", "8", "--reference", "truth.A.exr",
                           "truth.B.exr", "-o", "with halves.html")
        self.assertIn("two given pictures", done.stdout)
        data = json.loads((self.folder / "with halves.json").read_text(encoding="utf-8"))
        self.assertEqual(data["reference"]["files"], ["truth.A.exr", "truth.B.exr"])
        self.assertGreater(data["reference"]["noise"][""], 0)
        self.assertEqual(data["reference"]["notices"], [])
        self.assertIn("tracing.seed=1", data["methods"][0]["runs"][0]["command"])
        # Eight paths are further from the truth than the 32 of the reference: they share none with it.
        error = data["methods"][0]["runs"][0]["errors"][""]["noise_free"]
        self.assertGreater(error, data["reference"]["noise"][""])
        self.expect(65, SHOT, *SMALL, "--reference", "truth.A.exr", "truth.A.exr", says="no independent halves")
        self.expect(2, SHOT, *SMALL, "--reference", "truth.A.exr", "-o", "truth.A.exr", says=".html")


class Page(unittest.TestCase):
    """One small report, and what it looks like in Chromium."""

    @classmethod
    def setUpClass(cls):
        if not (SOURCE / "volumes" / "explosion.vdb").exists():
            raise unittest.SkipTest("no volume: volumes/explosion.vdb is missing")
        cls.holder = tempfile.TemporaryDirectory(prefix="brisance-report-")
        cls.addClassCleanup(cls.holder.cleanup)
        cls.folder = pathlib.Path(cls.holder.name)
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        methods = ["lighting_grid", "path", "exact=path,tracing.free_flight=exact"]
        cls.done = run_program(cls.folder, "report", SHOT, *QUICK, "--set", f"name={NAME}", "--methods", *methods,
                               "--repeats", "2", "-o", "report.html", env=environment)
        if cls.done.returncode != 0:
            raise AssertionError(cls.done.stderr)
        cls.data = json.loads((cls.folder / "report.json").read_text(encoding="utf-8"))
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
            self.page.prefer("light")
            self.page.open(self.folder / "report.html")

    def evaluate(self, expression):
        return self.page.evaluate(expression)

    def press(self, section, group, label):
        """Presses a button of a row of buttons."""
        self.evaluate(f"[...document.querySelectorAll('#{section} [aria-label=\"{group}\"] button')]"
                 f".find(button => button.textContent === {json.dumps(label)}).click()")
        self.page.settle()

    # Files and tables

    def test_files(self):
        names = ["report.csv", "report.html", "report.json", "report.times.csv"]
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), names)
        self.assertEqual(sorted(self.done.stdout.split()[-4:]), names)

    def test_table_on_standard_output(self):
        for text in ("10 %", "1 %", "lighting_grid ", "exact ", "reference: method path, 32 paths per pixel"):
            self.assertIn(text, self.done.stdout)

    def test_json(self):
        data = self.data
        self.assertEqual(data["date"], "2001-09-09T01:46:40Z")
        self.assertEqual(data["measure"], "noise_free")
        self.assertEqual(data["shot"]["name"], NAME)
        self.assertEqual(data["layers"], ["", "V", "MV", "MM"])
        self.assertEqual([method["label"] for method in data["methods"]], ["lighting_grid", "path", "exact"])
        for method in data["methods"]:
            self.assertEqual(len(method["runs"]), 2)
            for run in method["runs"]:
                self.assertGreater(run["wall_seconds"], 0)
                self.assertGreater(run["cpu_seconds"], 0)
                self.assertEqual(sorted(run["errors"]), ["", "MM", "MV", "V"])
                self.assertTrue(run["statistics"]["stages"])
        coarse, fine = (run["errors"][""]["noise_free"] for run in data["methods"][1]["runs"])
        self.assertLess(fine, coarse)

    def test_csv_repeats_the_json(self):
        with open(self.folder / "report.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 3 * 2 * 4)
        for row in rows:
            self.assertEqual(row["shot"], NAME)
            method = next(m for m in self.data["methods"] if m["label"] == row["method"])
            run = next(r for r in method["runs"] if r["label"] == row["step"])
            errors = run["errors"]["" if row["layer"] == "beauty" else row["layer"]]
            for column, key in (("rrmse_noise_free", "noise_free"), ("rrmse", "rrmse"), ("hdr_flip", "flip")):
                self.assertEqual(float(row[column]), errors[key])
        with open(self.folder / "report.times.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 3 * 4 * 2 * 4)

    def test_repeats_have_bars_where_the_method_is_random(self):
        self.assertEqual(self.data["time"]["repeats"], 2)
        with open(self.folder / "report.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for method in self.data["methods"]:
            for run in method["runs"]:
                for layer, errors in run["errors"].items():
                    spread = errors["spread"]
                    where = (method["label"], run["label"], layer)
                    (row,) = (r for r in rows if (r["method"], r["step"], r["layer"]) == (*where[:2], layer or "beauty"))
                    self.assertEqual(row["repeats"], "2")
                    if method["label"] == "lighting_grid":
                        self.assertIsNone(spread, where)
                        self.assertEqual(row["rrmse_sd"], "")
                    else:
                        self.assertGreater(spread["rrmse"], 0, where)
                        self.assertLess(spread["rrmse"], errors["rrmse"], where)
                        self.assertEqual(float(row["rrmse_sd"]), spread["rrmse"])
                        self.assertEqual(float(row["bias_sd"]), spread["mean"])

    def test_commands_repeat_a_run(self):
        run = self.data["methods"][1]["runs"][0]
        command = run["command"]
        self.assertTrue(command.startswith("brisance render "))
        done = subprocess.run(command.replace("brisance", str(BINARY), 1), shell=True, cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        files = [self.folder / file for file in done.stdout.split()]
        for file in files:
            self.addCleanup(file.unlink)
        statistics = json.loads(files[-1].read_text(encoding="utf-8"))
        self.assertEqual(statistics["cells"], run["statistics"]["cells"])
        (again,) = (s for s in statistics["stages"] if s["name"] == "path tracing")
        (first,) = (s for s in run["statistics"]["stages"] if s["name"] == "path tracing")
        for count in ("paths", "scatterings_per_path", "relative_standard_error"):
            self.assertEqual(again["detail"][count], first["detail"][count])

    def test_page_needs_nothing_from_elsewhere(self):
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertNotRegex(text, r'(?:src|href)\s*=\s*"?https?:')
        self.assertNotIn(NAME, text)
        self.assertNotIn(str(SOURCE / "build"), text)
        for owner in ("Leon Sorokin", "Dmitry Snisarenko"):
            self.assertIn(owner, text)

    # In the browser

    def test_browser_loads_it_without_errors(self):
        self.assertEqual(self.page.problems, [])
        self.assertEqual(self.evaluate("document.querySelector('h1').textContent"), NAME)
        self.assertIn(NAME, self.evaluate("document.title"))
        self.assertEqual(self.evaluate("document.querySelectorAll('h1 b').length"), 0)
        broken = "image => image.src && (!image.complete || !image.naturalWidth)"
        self.assertEqual(self.evaluate(f"[...document.images].filter({broken}).length"), 0)
        self.assertFalse(self.evaluate("document.documentElement.scrollWidth > innerWidth"))

    def test_browser_shows_all_points_of_the_plot(self):
        plotted = "document.querySelector('.plot').dataset"
        expected = sum(run["errors"][""]["noise_free"] > 0 for m in self.data["methods"] for run in m["runs"])
        self.assertEqual(self.evaluate(f"Number({plotted}.points)"), expected)
        self.assertEqual(self.evaluate(f"Number({plotted}.series)"), 3)
        series = self.evaluate("brisanceReport.plot.plot.data.slice(1).map(ys => ys.filter(y => y != null))")
        wanted = [[100 * run["errors"][""]["noise_free"] for run in method["runs"]] for method in self.data["methods"]]
        for plotted_values, values in zip(series, wanted):
            self.assertEqual(len(plotted_values), sum(value > 0 for value in values))
            for a, b in zip(sorted(plotted_values), sorted(value for value in values if value > 0)):
                self.assertAlmostEqual(a, b)
        # Something is drawn, in the colour of the first method.
        self.assertTrue(self.evaluate("""(() => {
            const canvas = document.querySelector('.plot canvas');
            const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
            const swatch = document.querySelector('.legend .swatch');
            const [r, g, b] = getComputedStyle(swatch).backgroundColor.match(/\\d+/g);
            for (let i = 0; i < data.length; i += 4)
                if (data[i] == r && data[i + 1] == g && data[i + 2] == b && data[i + 3] == 255) return true;
            return false;
        })()"""))

    def test_browser_shows_bars(self):
        self.press("convergence", "Measure", "rRMSE")
        self.assertEqual(self.evaluate("Number(document.querySelector('.plot').dataset.bars)"), 4)
        bars = self.evaluate("brisanceReport.plot.series.map(s => s.points.map(p => [p.low, p.y, p.high]))")
        self.assertEqual(bars[0], [[None, y, None] for _, y, _ in bars[0]], "the grid has none")
        for points, method in zip(bars[1:], self.data["methods"][1:]):
            by_error = sorted((run["errors"][""] for run in method["runs"]), key=lambda errors: errors["rrmse"])
            for (low, y, high), errors in zip(sorted(points, key=lambda point: point[1]), by_error):
                self.assertAlmostEqual(high - y, 100 * errors["spread"]["rrmse"])
                self.assertAlmostEqual(y - low, 100 * errors["spread"]["rrmse"])
        rows = self.evaluate("[...document.querySelectorAll('#measurements-table tbody tr')].map(r => r.textContent)")
        self.assertEqual(["\u00b1" in row for row in rows], [False, False, True, True, True, True])
        self.assertIn("means of 2 renders", self.evaluate("document.querySelector('#about-bars').textContent"))

    def test_browser_hides_a_method(self):
        self.page.click(".legend button:nth-child(2)")
        self.assertEqual(self.evaluate("brisanceReport.plot.plot.series.map(s => s.show)"), [True, True, False, True])
        self.assertEqual(self.evaluate("document.querySelector('.legend button:nth-child(2)').ariaPressed"), "false")
        self.press("convergence", "Layer", "MM")
        self.assertEqual(self.evaluate("brisanceReport.plot.plot.series.map(s => s.show)"), [True, True, False, True])
        self.page.click(".legend button:nth-child(2)")
        self.assertEqual(self.evaluate("brisanceReport.plot.plot.series.map(s => s.show)"), [True] * 4)

    def test_browser_has_every_layer_measure_and_clock(self):
        for group in ("Layer", "Measure", "Time"):
            count = self.evaluate(f"document.querySelectorAll('#convergence [aria-label=\"{group}\"] button').length")
            self.assertEqual(count, {"Layer": 4, "Measure": 5, "Time": 2}[group])
            for i in range(count):
                self.evaluate(f"document.querySelectorAll('#convergence [aria-label=\"{group}\"] button')[{i}].click()")
                self.page.settle()
                self.assertTrue(self.evaluate("document.querySelector('.plot canvas, .plot-frame p') !== null"))
        self.assertEqual(self.page.problems, [])

    def test_browser_tables(self):
        self.assertEqual(self.evaluate("document.querySelectorAll('#reach-table tbody tr').length"), 3)
        self.assertEqual(self.evaluate("document.querySelectorAll('#measurements-table tbody tr').length"), 6)
        row = "document.querySelectorAll('#reach-table tbody tr:first-child td')"
        cells = self.evaluate(f"[...{row}].map(cell => cell.textContent)")
        floor = self.data["methods"][0]["convergence"][""]["wall"]["times"][3]
        if floor["kind"] == "not_reached":
            self.assertIn(f"not reachedbias floor {100 * floor['floor']:.3g} %", cells)
        self.press("measurements", "Layer", "V")
        self.assertEqual(self.evaluate("document.querySelectorAll('#measurements-table tbody tr').length"), 6)

    def test_browser_moves_the_slider(self):
        clip = """getComputedStyle(document.querySelector('#slider').shadowRoot
                  .querySelector('.first-overlay-container')).clipPath"""
        self.evaluate("document.querySelector('#slider').scrollIntoView({block: 'center'})")
        self.page.settle()
        before = self.evaluate(clip)
        self.assertEqual(before, "inset(0px 50% 0px 0px)")
        x, y, width, height = self.evaluate(
            "(() => { const b = document.querySelector('#slider').getBoundingClientRect();"
            "return [b.x, b.y, b.width, b.height]; })()")
        self.page.drag((x + width / 2, y + height / 2), (x + width / 4, y + height / 2))
        # It glides to where it was put.
        moving = "document.querySelector('#slider').shadowRoot.getAnimations().map(animation => animation.finished)"
        self.evaluate(f"Promise.all({moving}).then(() => 0)")
        hidden = float(re.fullmatch(r"inset\(0px ([\d.]+)% 0px 0px\)", self.evaluate(clip))[1])
        self.assertAlmostEqual(hidden, 75.0, delta=1.0)
        self.assertAlmostEqual(self.evaluate("document.querySelector('#slider').value"), 25.0, delta=1.0)

    def test_browser_compares_any_two_pictures(self):
        sources = "['first', 'second'].map(s => document.querySelector(`#slider [slot=${s}]`).src)"
        start = self.evaluate(sources)
        self.assertTrue(all(src.startswith("data:image/png;base64,") for src in start))
        self.assertEqual(base64.b64decode(start[0].split(",")[1])[:4], b"\x89PNG")
        select = "document.querySelector('[aria-label=\"Right picture\"]')"
        self.evaluate(f"{select}.value = 'reference'; {select}.dispatchEvent(new Event('change'))")
        left, right = self.evaluate(sources)
        self.assertEqual(left, start[0])
        self.assertNotEqual(right, start[1])
        seen = {left}
        for group, label in (("Exposure", "+3 EV"), ("Layer", "MV"), ("Show", "Relative error"), ("Show", "HDR-FLIP")):
            self.press("pictures", group, label)
            self.assertNotIn(self.evaluate(sources)[0], seen, label)
            seen.add(self.evaluate(sources)[0])
        self.assertTrue(self.evaluate("document.querySelector('.colour-bar') !== null"))
        self.press("pictures", "Show", "Left \u2212 right")
        self.assertTrue(self.evaluate("document.querySelector('#slider').hidden"))
        self.assertEqual(self.page.problems, [])

    def test_browser_shows_the_picture_of_a_point(self):
        # The last point of the second method, where the plot has drawn it.
        self.evaluate("document.querySelector('.plot').scrollIntoView({block: 'center'})")
        self.page.settle()
        x, y, run = self.evaluate("""(() => {
            const {plot} = brisanceReport.plot, point = brisanceReport.plot.series[1].points.at(-1);
            const box = plot.over.getBoundingClientRect();
            return [box.x + plot.valToPos(point.seconds, 'x'), box.y + plot.valToPos(point.y, 'y'), point.run.id];
        })()""")
        self.page.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.page.settle()
        self.assertFalse(self.evaluate("document.querySelector('.tip').hidden"))
        self.assertIn("path", self.evaluate("document.querySelector('.tip').textContent"))
        for kind in ("mousePressed", "mouseReleased"):
            self.page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.assertEqual(self.evaluate("document.querySelector('[aria-label=\"Left picture\"]').value"), run)

    def test_browser_light_and_dark(self):
        colour = "getComputedStyle(document.body).backgroundColor"
        light = self.evaluate(colour)
        self.page.prefer("dark")
        self.page.settle()
        dark = self.evaluate(colour)
        self.assertNotEqual(light, dark)
        self.evaluate("[...document.querySelectorAll('#theme button')].find(b => b.textContent === 'Light').click()")
        self.assertEqual(self.evaluate(colour), light)
        self.assertEqual(self.page.problems, [])

    def test_browser_on_a_narrow_screen(self):
        self.page.resize(390, 800)
        self.addCleanup(self.page.resize, *self.page.size)
        self.page.open(self.folder / "report.html")
        self.assertFalse(self.evaluate("document.documentElement.scrollWidth > innerWidth"))
        self.assertEqual(self.page.problems, [])


def main(module):
    names = sys.argv[3:]
    loader = unittest.TestLoader()
    suite = loader.loadTestsFromNames(names, module) if names else loader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    if not result.wasSuccessful():
        sys.exit(1)
    skipped = len(result.skipped)
    sys.exit(77 if skipped > 0 and skipped >= result.testsRun else 0)


if __name__ == "__main__":
    main(sys.modules[__name__])
