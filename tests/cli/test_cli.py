"""The program as its users and their scripts meet it: exit codes, messages, files.

usage: test_cli.py BINARY SOURCE_FOLDER [CLASS]
"""

import json
import os
import pathlib
import pty
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BINARY = pathlib.Path(sys.argv[1])
SOURCE = pathlib.Path(sys.argv[2])
# Seconds are spent on lighting: what concerns files and messages alone does without.
SMALL = ["--set", "camera.width=16", "--set", "camera.height=12", "--preset", "draft", "--set", "scattering.bounces=0"]
LIT = [*SMALL, "--set", "scattering.bounces=1"]


def any_volume():
    """A real .vdb with smoke and fire: the one that comes with the program, else one of the test data."""
    own = sorted((SOURCE / "volumes").glob("*.vdb"))
    if own:
        return own[0]
    data = os.environ.get("BRISANCE_DATA")
    return pathlib.Path(data) / "volumes" / "explosion" / "ground_explosion_0015.vdb" if data else None


class Case(unittest.TestCase):
    """Runs the program in a folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="brisance-cli-")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def run_program(self, *arguments, **options):
        return subprocess.run([BINARY, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              check=False, **options)

    def expect(self, code, *arguments, says=(), **options):
        """The program ends with `code`, and standard error holds every text of `says`."""
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        self.assertNotIn("\r", done.stderr)
        self.assertNotIn("\r", done.stdout)
        return done

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())


class VolumeCase(Case):
    """Needs a real volume."""

    def setUp(self):
        super().setUp()
        volume = any_volume()
        if volume is None or not volume.exists():
            self.skipTest("no volume: neither volumes/*.vdb nor BRISANCE_DATA")
        self.volume = volume
        # Where outputs go, apart from what is read.
        self.out = self.folder / "out"
        self.out.mkdir()

    def outputs(self):
        return sorted(path.name for path in self.out.iterdir())

    def make_sequence(self, frames):
        for frame in frames:
            shutil.copyfile(self.volume, self.folder / f"burst_{frame:04}.vdb")
        return "burst_####.vdb"


class CommandLine(Case):
    def test_help_lists_every_exit_code(self):
        for arguments in (["--help"], ["render", "--help"]):
            text = self.expect(0, *arguments).stdout
            for code in (0, 1, 2, 65, 66, 73, 74, 75, 130):
                self.assertRegex(text, rf"(?m)^  {code} ")

    def test_version(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^brisance \d+\.\d+\.\d+\n$")

    def test_usage_errors(self):
        for arguments in ([], ["rendr"], ["render"], ["render", "a.json", "--no-such-option"],
                          ["render", "a.json", "b.json"], ["render", "a.json", "--preset", "fast"],
                          ["render", "a.json", "--progress", "loud"],
                          ["render", "a.json", "--threads", "-1"], ["render", "a.json", "--threads", "two"],
                          ["inspect"], ["schema", "extra"]):
            self.expect(2, *arguments)

    def test_schema_is_the_committed_one(self):
        committed = (SOURCE / "shots" / "shot.schema.json").read_text(encoding="utf-8")
        self.assertEqual(self.expect(0, "schema").stdout, committed)

    def test_keys_for_people(self):
        self.assertIn("smoke.albedo\n", self.expect(0, "schema", "--keys").stdout)

    def test_full_standard_output_is_an_error(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([BINARY, "schema"], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, 74, done.stderr)


class ShotFiles(Case):
    def test_missing_file(self):
        self.expect(66, "render", "absent.json", says="absent.json: no such file")

    def test_unknown_key_names_line_and_nearest(self):
        self.write("a.json", '{"volume": {"file": "a.vdb"},\n "smoke": {"albdo": 1}}')
        self.expect(2, "render", "a.json", says="a.json:2: unknown key smoke.albdo; did you mean smoke.albedo?")

    def test_wrong_type(self):
        self.write("a.json", '{"volume": {"file": "a.vdb"},\n\n "camera": {"width": "wide"}}')
        self.expect(2, "render", "a.json", says=["a.json:3: camera.width: expected a whole number", '"wide"'])

    def test_no_json(self):
        self.write("a.json", "{\n\n")
        self.expect(2, "render", "a.json", says="a.json:3: syntax error")

    def test_wrong_override(self):
        self.write("a.json", '{"volume": {"file": "a.vdb"}}')
        self.expect(2, "render", "a.json", "--set", "smoke.albedo=2",
                    says="--set smoke.albedo=2: smoke.albedo: expected")
        self.expect(2, "render", "a.json", "--set", "smoke", says="key=value")

    def test_volume_is_sought_beside_the_shot(self):
        self.write("shots/a.json", '{"volume": {"file": "a.vdb"}}')
        self.expect(66, "render", "shots/a.json", says="shots/a.vdb")

    def test_unexpanded_variable(self):
        self.write("a.json", '{"volume": {"file": "$HIP/a.vdb"}}')
        self.expect(2, "render", "a.json", says="$HIP")

    def test_printed_config_renders_the_same(self):
        self.write("a.json", '{/* comment */ "volume": {"file": "a.vdb"}, "smoke": {"albedo": 0.5}}')
        first = self.expect(0, "render", "a.json", "--print-config", "--set", "lighting.alpha=3").stdout
        self.assertEqual(json.loads(first)["lighting"]["alpha"], 3)
        self.assertEqual(json.loads(first)["smoke"]["albedo"], [0.5, 0.5, 0.5])
        self.write("b.json", first)
        self.assertEqual(self.expect(0, "render", "b.json", "--print-config").stdout, first)


class Volumes(Case):
    def test_missing_file(self):
        for command in ("render", "plan", "inspect"):
            self.expect(66, command, "absent.vdb", says="absent.vdb")

    def test_what_is_no_volume(self):
        self.write("text.vdb", "certainly not a volume, but long enough to be taken for one at first sight")
        self.write("empty.vdb", "")
        for name in ("text.vdb", "empty.vdb"):
            self.write("a.json", json.dumps({"volume": {"file": name}}))
            self.expect(65, "render", name, says=name)
            self.expect(65, "render", "a.json", says=name)
            self.expect(65, "inspect", name, says=name)
        self.assertEqual(self.names(), ["a.json", "empty.vdb", "text.vdb"])

    def test_folder_in_place_of_a_volume(self):
        (self.folder / "a.vdb").mkdir()
        self.assertIn(self.run_program("render", "a.vdb").returncode, (65, 66))


class Rendering(VolumeCase):
    def test_bare_volume_gives_picture_and_numbers(self):
        done = self.expect(0, "render", self.volume, *SMALL, "-o", self.out / "a.exr")
        self.assertEqual(done.stdout.split(), [str(self.out / name) for name in ("a.exr", "a.png", "a.stats.json")])
        self.assertEqual(self.outputs(), ["a.exr", "a.png", "a.stats.json"])
        self.assertEqual((self.out / "a.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")
        self.assertEqual((self.out / "a.png").read_bytes()[:4], b"\x89PNG")
        statistics = json.loads((self.out / "a.stats.json").read_text(encoding="utf-8"))
        self.assertEqual(statistics["schema_version"], 1)
        self.assertIn("png_exposure_stops", statistics)

    def test_folder_as_output_and_what_is_not_wanted(self):
        self.expect(0, "render", self.volume, *SMALL, "-o", self.out, "--set", "output.png=false", "--set",
                    "output.statistics=false", "--set", "name=burst")
        self.assertEqual(self.outputs(), ["burst.exr"])

    def test_same_bits_with_any_number_of_threads(self):
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        for threads in (1, 2, 8):
            self.expect(0, "render", self.volume, *LIT, "--threads", threads, "-o", self.out / f"{threads}.exr",
                        env=environment)
        first = (self.out / "1.exr").read_bytes()
        self.assertEqual((self.out / "2.exr").read_bytes(), first)
        self.assertEqual((self.out / "8.exr").read_bytes(), first)

    def test_log_holds_whole_lines(self):
        done = self.expect(0, "render", self.volume, *SMALL, "-o", self.out, "--progress", "plain")
        self.assertRegex(done.stderr, r"(?m)^ +\d+\.\d s  ")
        self.assertNotIn("\x1b", done.stderr)

    def test_silence(self):
        self.assertNotRegex(self.expect(0, "render", self.volume, *SMALL, "-o", self.out, "--progress", "none").stderr,
                            r"(?m)^ +\d+\.\d s  ")

    def test_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        with subprocess.Popen([BINARY, "render", self.volume, *SMALL, "-o", self.out], stdout=subprocess.DEVNULL,
                              stderr=theirs, cwd=self.folder) as process:
            os.close(theirs)
            shown = b""
            try:
                while chunk := os.read(ours, 65536):
                    shown += chunk
            except OSError:
                pass  # how Linux reports that the other end is closed
        os.close(ours)
        self.assertEqual(process.returncode, 0)
        self.assertIn(b"\r[", shown)
        self.assertTrue(shown.rstrip(b"\n").endswith(b"\x1b[K") or b"\r\x1b[K" in shown)

    def test_explanation(self):
        self.assertIn("MV", self.expect(0, "render", self.volume, *LIT, "-o", self.out, "--explain").stderr)
        plan = self.expect(0, "plan", self.volume, *LIT, "-o", self.out)
        self.assertIn("MV", plan.stdout)
        self.assertIn(str(self.volume), plan.stdout)

    def test_missing_folder_is_found_before_rendering(self):
        start = time.monotonic()
        self.expect(73, "render", self.volume, "--set", "camera.width=16384", "--set", "camera.height=16384", "-o",
                    "absent/a.exr", says=["absent", "does not exist"])
        self.assertLess(time.monotonic() - start, 60.0)

    def test_unwritable_folder(self):
        self.out.chmod(0o555)
        self.addCleanup(self.out.chmod, 0o755)
        if os.geteuid() != 0:
            self.expect(73, "render", self.volume, *SMALL, "-o", self.out, says="no permission")
            return
        # Root may write anywhere: be somebody else.
        shutil.copyfile(self.volume, self.folder / "a.vdb")
        self.folder.chmod(0o755)
        try:
            self.expect(73, "render", "a.vdb", *SMALL, "-o", self.out, says="no permission", user=65534)
        except (PermissionError, OSError) as error:
            self.skipTest(f"cannot run as an ordinary user: {error}")

    def test_full_disk(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))

        self.expect(74, "render", self.volume, *SMALL, "-o", self.out / "a.exr", preexec_fn=limit, says="a.exr")
        self.assertEqual(self.outputs(), [])

    def test_too_little_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))

        if self.run_program("--version", preexec_fn=limit).returncode != 0:
            self.skipTest("the program does not start with limited memory (a sanitizer needs more)")
        # 268 million pixels of four channels take 4 GiB.
        self.expect(75, "render", self.volume, "--preset", "draft", "--set", "camera.width=16384", "--set",
                    "camera.height=16384", "-o", self.out, preexec_fn=limit, says="out of memory")
        self.assertEqual(self.outputs(), [])

    def test_output_names(self):
        self.expect(2, "render", self.volume, "-o", "a.png", says=".exr")
        pattern = self.make_sequence([1, 2])
        self.expect(2, "render", pattern, "-o", "a.exr", says="####")

    def test_never_overwrites_what_it_reads(self):
        shot = self.write("a.exr", json.dumps({"volume": {"file": str(self.volume)}}))
        self.expect(2, "render", "a.exr", *SMALL, "-o", "a.exr", says="would be overwritten")
        self.assertIn("volume", shot.read_text(encoding="utf-8"))

    def test_frame_outside_the_sequence(self):
        pattern = self.make_sequence([1, 2, 4])
        self.expect(66, "render", pattern, *SMALL, "-f", "2-4", "-o", self.out, says=["frame 3", "1-2, 4"])
        self.assertEqual(self.outputs(), [])  # told before the first frame is rendered
        self.expect(2, "render", pattern, "-f", "1:4", says="':'")

    def test_frames_get_their_numbers(self):
        pattern = self.make_sequence([1, 2, 4])
        self.expect(0, "render", pattern, *SMALL, "-f", "1-4x3", "-o", self.out / "a.@@@.exr", "--set",
                    "output.png=false", "--set", "output.statistics=false")
        self.assertEqual(self.outputs(), ["a.001.exr", "a.004.exr"])

    def test_keep_going(self):
        pattern = self.make_sequence([1, 2, 4])
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        done = self.expect(66, "render", pattern, *SMALL, "-f", "1-4", "-o", self.out / "a.#.exr", "--keep-going",
                           "--set", "output.png=false", "--set", "output.statistics=false",
                           says=["frame 3", "burst_0002.vdb"])
        self.assertIn("2 frames failed", done.stderr)
        self.assertEqual(self.outputs(), ["a.1.exr", "a.4.exr"])

    def test_damaged_frame_stops_the_rest(self):
        pattern = self.make_sequence([1, 2])
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        self.expect(65, "render", pattern, *SMALL, "-f", "1-2", "-o", self.out, says="burst_0002.vdb")
        self.assertEqual(self.outputs(), [])

    def test_interruption_leaves_nothing(self):
        for sent, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with subprocess.Popen([BINARY, "render", self.volume, "--set", "camera.width=4096", "--set",
                                   "camera.height=4096", "-o", self.out, "--progress", "plain"], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, cwd=self.folder) as process:
                process.stderr.readline()  # handlers are in place once it speaks
                process.send_signal(sent)
                process.communicate(timeout=60)
            self.assertEqual(process.returncode, code)
            self.assertEqual(self.outputs(), [])


class RealFiles(Case):
    """Odd files of other programs."""

    def setUp(self):
        super().setUp()
        data = os.environ.get("BRISANCE_DATA")
        if not data:
            self.skipTest("BRISANCE_DATA is not set")
        self.odd = pathlib.Path(data) / "volumes" / "odd"

    def test_invalid_files_are_bad_data(self):
        files = sorted(self.odd.glob("bad_*"))
        self.assertTrue(files)
        for file in files:
            self.write("a.json", json.dumps({"volume": {"file": str(file)}}))
            self.expect(65, "render", "a.json", *SMALL, says=file.name)

    def test_every_odd_file_has_a_verdict(self):
        for file in sorted(self.odd.glob("*.vdb")):
            done = self.run_program("render", file, *SMALL, "-o", self.folder / "a.exr")
            self.assertIn(done.returncode, (0, 65), f"{file.name}: {done.stderr}")
            if done.returncode == 65:
                self.assertIn("error: ", done.stderr)


def main():
    names = sys.argv[3:]
    loader = unittest.TestLoader()
    module = sys.modules[__name__]
    suite = loader.loadTestsFromNames(names, module) if names else loader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if result.testsRun == len(result.skipped) else 0)


if __name__ == "__main__":
    main()
