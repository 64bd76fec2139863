"""The program as its users and their scripts meet it: exit codes, messages, files.

usage: test_cli.py BINARY SOURCE_FOLDER [CLASS]
"""

import json
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

BINARY = pathlib.Path(sys.argv[1])
SOURCE = pathlib.Path(sys.argv[2])
# Lighting takes seconds, and estimating its error half of what remains; tests of files and messages run without both.
TINY = ["--set", "camera.width=16", "--set", "camera.height=12", "--preset", "draft"]
SMALL = [*TINY, "--set", "scattering.bounces=0", "--set", "certify.belief=0"]
LIT = [*TINY, "--set", "scattering.bounces=1"]


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
        # Outputs go to a folder without inputs.
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
                          ["inspect"], ["schema", "extra"], ["compare"], ["compare", "a.exr"],
                          ["compare", "a.exr", "b.exr", "c.exr", "d.exr"],
                          ["compare", "a.exr", "b.exr", "--cells", "--layers", "V"],
                          ["compare", "a.exr", "b.exr", "--pixels-per-degree", "0"]):
            self.expect(2, *arguments)

    def test_without_arguments_help_is_shown(self):
        self.assertIn("render", self.expect(2).stdout)

    def test_unknown_commands_and_options_suggest_the_nearest(self):
        self.expect(2, "rendr", "a.json", says="brisance: error: unknown command rendr; did you mean render?")
        self.expect(2, "render", "a.json", "--frmes", "1",
                    says="brisance: error: unknown option --frmes; did you mean --frames?")
        self.expect(2, "inspect", "a.vdb", "-f", "1-3",
                    says="brisance: error: unknown option -f; `brisance inspect --help` lists all options")
        self.expect(2, "--bogus", says="brisance: error: unknown option --bogus; did you mean --")
        self.expect(2, "inspect", "a.vdb", "b.vdb", says="brisance: error: unexpected argument b.vdb; ")
        for option, word, words in (
                ("--preset", "drfat", "draft, final, got drfat; did you mean draft?"),
                ("--method", "pth", "lighting_grid, path, auto, got pth; did you mean path?"),
                ("--progress", "palin", "alfred, auto, bar, ndjson, none, plain, tty, got palin; did you mean plain?")):
            self.expect(2, "render", "a.json", option, word,
                        says=f"brisance: error: {option}: expected one of {words}")
        done = self.expect(2, "\x1b[31m\xff", says="unknown command")
        self.assertNotIn("\x1b", done.stderr)

    def test_keys_of_lists_are_listed(self):
        text = self.expect(0, "schema", "--keys").stdout
        for key in ("scene.lights[].power", "scene.quads[].corners", "scene.spheres[].radius", "volumes[].file"):
            self.assertIn(f"    {key}: ", text)

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

    def test_a_damaged_grid_does_not_hide_the_others(self):
        damaged = bytearray((SOURCE / "volumes" / "candle.vdb").read_bytes())
        damaged[41465] = 0xff  # the size of a block of its density
        (self.folder / "damaged.vdb").write_bytes(damaged)
        text = self.expect(65, "inspect", "damaged.vdb").stdout
        self.assertRegex(text, r"temperature\[0\][^\n]*\n  voxels     5249 active[^?]*\n  usable")
        self.assertIn("cannot be rendered: damaged.vdb", text)

    def test_further_volumes_are_found_missing_before_rendering(self):
        self.write("a.json", json.dumps({"scene": {"spheres": [{"centre": [0, 0, 0], "radius": 1}]},
                                         "volumes": [{"file": "dust_####.vdb"}]}))
        self.expect(66, "render", "a.json", "-f", "1-2", says="dust_0001.vdb")
        self.assertEqual(self.names(), ["a.json"])

    def test_damaged_volume_is_one_line(self):
        candle = bytearray((SOURCE / "volumes" / "candle.vdb").read_bytes())
        candle[862:866] = b"\xff\xff\xff\x7f"  # the root's number of tiles
        (self.folder / "damaged.vdb").write_bytes(candle)
        done = self.expect(65, "render", "damaged.vdb", *SMALL,
                           says=["damaged.vdb: damaged VDB: ", "claims 2147483647 tiles"])
        self.assertEqual(done.stderr.count("error"), 1, done.stderr)

    def test_names_need_not_be_utf8(self):
        name = os.fsdecode(b"smoke_\xff.vdb")
        (self.folder / name).write_bytes((SOURCE / "volumes" / "candle.vdb").read_bytes())
        self.expect(0, "render", name, *SMALL, "-o", "a.exr")
        self.expect(66, "render", os.fsdecode(b"set_\xff.glb"), says="set_")

    def test_pipes_and_devices_are_no_inputs(self):
        os.mkfifo(self.folder / "pipe.vdb")
        os.mkfifo(self.folder / "pipe.json")
        self.expect(65, "render", "pipe.vdb", says="pipe.vdb: is a pipe", timeout=60)
        self.expect(2, "render", "pipe.json", says="pipe.json: is a pipe", timeout=60)
        self.expect(2, "render", "/dev/zero", says="/dev/zero: is a device", timeout=60)
        (self.folder / "zero.gltf").symlink_to("/dev/zero")
        self.expect(65, "render", "zero.gltf", says="is a device", timeout=60)

    def test_folder_instead_of_a_volume(self):
        (self.folder / "a.vdb").mkdir()
        self.assertIn(self.run_program("render", "a.vdb").returncode, (65, 66))


class Rendering(VolumeCase):
    def test_bare_volume_gives_picture_and_numbers(self):
        done = self.expect(0, "render", self.volume, *SMALL, "-o", self.out / "a.exr")
        names = ["a.exr", "a.png", "a.stats.json", "a.look.json"]
        self.assertEqual(done.stdout.split(), [str(self.out / name) for name in names])
        self.assertEqual(self.outputs(), sorted(names))
        self.assertEqual((self.out / "a.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")
        self.assertEqual((self.out / "a.png").read_bytes()[:4], b"\x89PNG")
        statistics = json.loads((self.out / "a.stats.json").read_text(encoding="utf-8"))
        self.assertEqual(statistics["schema_version"], 1)
        self.assertIn("png_exposure_stops", statistics)

    def test_folder_as_output_and_what_is_not_wanted(self):
        self.expect(0, "render", self.volume, *SMALL, "-o", self.out, "--set", "output.png=false", "--set",
                    "output.statistics=false", "--set", "name=burst")
        self.assertEqual(self.outputs(), ["burst.exr"])

    def test_time_and_believed_error(self):
        self.expect(2, "render", self.volume, "--seconds", "0", says="--seconds")
        self.expect(0, "render", self.volume, *LIT, "--seconds", "0.001", "-o", self.out / "a.exr",
                    says=["seconds=0.001: ", "do not suffice", "believed error: "])
        statistics = json.loads((self.out / "a.stats.json").read_text(encoding="utf-8"))
        self.assertIn("choice for the time", [stage["name"] for stage in statistics["stages"]])
        self.assertGreater(statistics["believed_error"]["picture"]["error"], 0.0)
        self.assertIn(b"brisance/believed_error\0string\0", (self.out / "a.exr").read_bytes())

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

    def test_folders_are_made_on_request(self):
        self.expect(0, "render", self.volume, *SMALL, "-o", self.out / "new" / "deep" / "a.exr", "--make-folders")
        self.assertTrue((self.out / "new" / "deep" / "a.exr").exists())

    def test_a_link_to_nothing_is_no_output_and_stays(self):
        (self.out / "a.exr").symlink_to(self.out / "gone.exr")
        self.expect(73, "render", self.volume, *SMALL, "-o", self.out / "a.exr", says="is a link to")
        self.assertTrue((self.out / "a.exr").is_symlink())
        self.assertEqual(self.outputs(), ["a.exr"])

    def test_a_folder_that_takes_no_file_is_not_called_missing(self):
        done = self.expect(73, "render", self.volume, *SMALL, "-o", "/proc/a.exr", says="/proc")
        self.assertNotIn("does not exist", done.stderr)

    def test_sequences_are_inspected(self):
        self.assertIn("density", self.expect(0, "inspect", self.make_sequence([3, 4])).stdout)

    def look_of(self, *arguments):
        self.expect(0, "render", *arguments, *SMALL, "-o", self.out / "a.#.exr", "--set", "output.png=false")
        return (self.out / "a.look.json").read_text(encoding="utf-8")

    def test_every_chunk_of_a_sequence_decides_the_same_look(self):
        candle = SOURCE / "volumes" / "candle.vdb"
        for frame in (1, 2, 3):
            shutil.copyfile(candle if frame < 3 else self.volume, self.folder / f"burst_{frame:04}.vdb")
        looks = [self.look_of("burst_####.vdb", "-f", frames) for frames in ("1", "2", "1-2")]
        looks.append(self.look_of(self.folder, "-f", "2"))
        self.assertEqual(len(set(looks)), 1)
        self.assertIn('"looked_at": [1,2,3]', looks[0])

    def test_an_automatic_exposure_is_one_for_a_sequence(self):
        shutil.copyfile(SOURCE / "volumes" / "candle.vdb", self.folder / "burst_0001.vdb")
        shutil.copyfile(SOURCE / "volumes" / "explosion.vdb", self.folder / "burst_0002.vdb")
        self.write("a.json", json.dumps({"volume": {"file": "burst_####.vdb"}, "fire": {"model": "blackbody", "temperature_in": [0, 1000],
                                                           "temperature_kelvin": [0, 1000]}}))
        stops = set()
        for frame in (1, 2):
            done = self.expect(0, "render", "a.json", *SMALL, "-f", frame, "-o", self.out / "a.#.exr",
                               says=["the shot has no camera", "chosen from a small picture of frame"])
            self.assertNotIn("chosen from the picture", done.stderr)
            text = (self.out / f"a.{frame}.stats.json").read_text(encoding="utf-8")
            stops.add(json.loads(text)["png_exposure_stops"])
        self.assertEqual(len(stops), 1)

    def test_a_look_is_written_used_and_overridden(self):
        self.expect(0, "inspect", SOURCE / "volumes" / "candle.vdb", "--write-look", "kept.look.json")
        look = json.loads((self.folder / "kept.look.json").read_text(encoding="utf-8"))
        look["decisions"]["smoke.extinction_per_metre"]["value"] = 77
        self.write("kept.look.json", json.dumps(look))

        def config(*arguments):
            return json.loads(self.expect(0, "render", *arguments, "--print-config").stdout)

        used = config(SOURCE / "volumes" / "candle.vdb", "--look", "kept.look.json")
        self.assertEqual(used["smoke"]["extinction_per_metre"], 77)
        self.assertEqual(used["camera"]["eye"], look["decisions"]["camera.eye"]["value"])
        changed = config(SOURCE / "volumes" / "candle.vdb", "--look", "kept.look.json", "--set",
                         "smoke.extinction_per_metre=5")
        self.assertEqual(changed["smoke"]["extinction_per_metre"], 5)
        self.write("a.json", json.dumps({"volume": {"file": str(SOURCE / "volumes" / "candle.vdb")},
                                         "smoke": {"albedo": 0.5}}))
        laid_under = config("a.json", "--look", "kept.look.json")
        self.assertEqual(laid_under["smoke"]["albedo"], [0.5, 0.5, 0.5])
        self.assertEqual(laid_under["smoke"]["extinction_per_metre"], 77)

    def test_a_damaged_look_is_one_line(self):
        candle = SOURCE / "volumes" / "candle.vdb"
        self.write("bad.look.json", "{\"brisance_look\": 1")
        self.expect(2, "render", candle, "--look", "bad.look.json", says="bad.look.json")
        self.write("bad.look.json", "{}")
        self.expect(2, "render", candle, "--look", "bad.look.json", says="is no look")
        self.expect(66, "render", candle, "--look", "absent.look.json", says="absent.look.json")
        self.expect(66, "render", self.out, says="holds no .vdb")

    def test_what_does_not_shine_gets_a_warning(self):
        self.expect(0, "render", SOURCE / "volumes" / "candle.vdb", *SMALL, "-o", self.out, "--set",
                    "fire.model=none", "--set", "scene.lights=[]", says="nothing-shines")

    def test_unwritable_folder(self):
        self.out.chmod(0o555)
        self.addCleanup(self.out.chmod, 0o755)
        if os.geteuid() != 0:
            self.expect(73, "render", self.volume, *SMALL, "-o", self.out, says="no permission")
            return
        # Root may write anywhere, so the test runs as another user.
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
        self.assertEqual(self.outputs(), [])  # reported before the first frame is rendered
        self.expect(2, "render", pattern, "-f", "1:4", says="':'")

    def test_frames_get_their_numbers(self):
        pattern = self.make_sequence([1, 2, 4])
        self.expect(0, "render", pattern, *SMALL, "-f", "1-4x3", "-o", self.out / "a.@@@.exr", "--set",
                    "output.png=false", "--set", "output.statistics=false")
        self.assertEqual(self.outputs(), ["a.001.exr", "a.004.exr"])

    def test_automatic_method_is_one_for_all_frames(self):
        pattern = self.make_sequence([1, 2, 4])
        done = self.expect(0, "render", pattern, *SMALL, "-f", "1,2", "-o", self.out / "a.#.exr", "--method", "auto",
                           "--set", "output.png=false", says="method: the ")
        self.assertEqual(done.stderr.count("method: the "), 1)
        for frame, stages_first in ((1, True), (2, False)):
            stages = json.loads((self.out / f"a.{frame}.stats.json").read_text(encoding="utf-8"))["stages"]
            self.assertEqual("choice of the method" in [stage["name"] for stage in stages], stages_first)

    def test_automatic_method_is_not_stopped_by_a_damaged_frame_that_is_not_rendered(self):
        pattern = self.make_sequence([1, 2])
        (self.folder / "burst_0003.vdb").write_bytes(b"damaged" * self.volume.stat().st_size)
        shot = self.write("a.json", json.dumps({"volume": {"file": pattern, "preset": "houdini"}}))
        self.expect(0, "render", shot, *SMALL, "-f", "1", "-o", self.out / "a.#.exr", "--method", "auto",
                    says=["burst_0003.vdb", "method: the "])

    def test_keep_going(self):
        pattern = self.make_sequence([1, 2, 4])
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        done = self.expect(66, "render", pattern, *SMALL, "-f", "1-4", "-o", self.out / "a.#.exr", "--keep-going",
                           "--set", "output.png=false", "--set", "output.statistics=false",
                           says=["frame 3", "burst_0002.vdb"])
        self.assertIn("2 frames failed", done.stderr)
        self.assertEqual(self.outputs(), ["a.1.exr", "a.4.exr"])

    def test_every_chunk_of_a_sequence_has_the_lattices_of_its_largest_file(self):
        pattern = self.make_sequence([1, 2, 3])
        with open(self.folder / "burst_0002.vdb", "ab") as largest:
            largest.write(b"\0" * 64)
        for frame in (1, 3):
            self.expect(0, "render", pattern, *SMALL, "-f", frame, "-o", self.out,
                        says="lattices of all frames, by the largest file, burst_0002.vdb: lighting.levels=")
        done = self.expect(0, "render", pattern, *SMALL, "-f", 1, "-o", self.out, "--set", "lighting.levels=4",
                           "--set", "scattering.lattice_level=0", "--set", "lighting.lattice_level=0",
                           "--set", "lighting.smoke_lattice_level=0")
        self.assertNotIn("lattices of all frames", done.stderr)

    def test_volumes_of_different_ranges(self):
        pattern = self.make_sequence([1, 2, 3])
        for frame in (1, 2):
            shutil.copyfile(self.volume, self.folder / f"other_{frame:04}.vdb")
        shot = self.write("two.json", json.dumps({"volume": {"file": pattern},
                                                  "volumes": [{"file": "other_####.vdb"}]}))
        self.expect(0, "render", shot, *SMALL, "-f", 2, "-o", self.out / "a.####.exr")
        done = self.expect(66, "render", shot, *SMALL, "-f", 3, "-o", self.out / "a.####.exr",
                           says=["frame 3 is missing", "time.after"])
        self.assertEqual(done.stderr.count("error:"), 1)

    def test_damaged_frame_stops_the_rest(self):
        pattern = self.make_sequence([1, 2])
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        self.expect(65, "render", pattern, *SMALL, "-f", "1-2", "-o", self.out, says="burst_0002.vdb")
        self.assertEqual(self.outputs(), [])

    def test_interruption_leaves_nothing(self):
        for sent, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with subprocess.Popen([BINARY, "render", self.volume, "--set", "camera.width=1024", "--set",
                                   "camera.height=1024", "-o", self.out, "--progress", "plain"], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, cwd=self.folder) as process:
                process.stderr.readline()  # signal handlers are installed before the first line
                process.send_signal(sent)
                process.communicate(timeout=60)
            self.assertEqual(process.returncode, code)
            self.assertEqual(self.outputs(), [])


def write_exr(path, width, height, **channels):
    """An uncompressed float EXR, as another renderer writes it; channels are functions of x and y."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = sorted(channels)
    kinds = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", kinds), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    line = 8 + 4 * width * len(names)
    offsets = struct.pack(f"<{height}Q", *(len(header) + 8 * height + line * y for y in range(height)))
    lines = b"".join(
        struct.pack("<ii", y, line - 8) +
        b"".join(struct.pack(f"<{width}f", *(channels[name](x, y) for x in range(width))) for name in names)
        for y in range(height))
    path.write_bytes(header + offsets + lines)


class Compare(VolumeCase):
    SIZE = (24, 16)

    def gray(self, name, value):
        write_exr(self.folder / name, *self.SIZE, Y=value)
        return name

    def numbers(self, *arguments, code=0):
        """Standard output as JSON."""
        return json.loads(self.expect(code, "compare", *arguments, "--json").stdout)

    def layers(self, *arguments):
        frame, = self.numbers(*arguments)["frames"]
        return {layer["layer"]: layer for layer in frame["layers"]}

    def render(self, name, *options, look=SMALL):
        self.expect(0, "render", self.volume, *look, "--set", "output.png=false", "--set", "output.statistics=false",
                    "-o", self.folder / name, *options)
        return name

    def test_an_image_is_itself(self):
        image = self.render("a.exr", look=LIT)
        for layer in self.layers(image, image, "--cells").values():
            for measure in ("rrmse", "relmse", "mape", "mean", "flip"):
                self.assertEqual(layer[measure], 0)
        self.assertIn("flip", self.expect(0, "compare", image, image).stdout)

    def test_other_methods_compare_and_other_scenes_do_not(self):
        image = self.render("a.exr", look=LIT)
        other_method = self.render("b.exr", "--set", "lighting.shadows=none", "--set", "name=b", look=LIT)
        layers = self.layers(image, other_method, "--cells", "--fail-above", "rrmse=1000")
        self.assertGreater(layers["MV"]["rrmse"], 0.01)
        self.assertEqual(layers["V"]["rrmse"], 0)
        other_scene = self.render("c.exr", "--set", "smoke.mean_cosine=0.25", "--set", "fire.strength=7", look=LIT)
        self.expect(65, "compare", image, other_scene,
                    says=["a.exr and c.exr show different shots", "smoke.mean_cosine: ", " against 0.25; ",
                          "fire.strength: ", "--force"])
        forced = self.expect(0, "compare", image, other_scene, "--force", "--json", says="notice: a.exr and c.exr")
        self.assertIn("smoke.mean_cosine", json.loads(forced.stdout)["overruled_differences"][0])

    def test_frames_are_distinguished(self):
        pattern = self.make_sequence([1, 2])
        for frame in (1, 2):
            self.expect(0, "render", pattern, *SMALL, "-f", frame, "-o", f"{frame}.exr")
        self.expect(65, "compare", "1.exr", "2.exr", says="frame: 1 against 2")
        self.expect(0, "compare", "1.exr", "2.exr", "--force")

    def test_layers(self):
        image = self.render("a.exr", look=LIT)
        self.assertEqual(self.layers(image, image, "--layers", "V+MV")["V+MV"]["rrmse"], 0)
        self.expect(65, "compare", image, image, "--layers", "V+MM", says="a.exr has no layer MM; it has beauty, ")
        reference = self.gray("y.exr", lambda x, y: 1)
        self.expect(65, "compare", reference, reference, "--cells", says="no layers besides the beauty")

    def test_sizes_and_shots_are_reported_in_one_line(self):
        image = self.render("a.exr")
        larger = self.render("b.exr", "--set", "camera.width=20", "--set", "smoke.mean_cosine=0.25")
        done = self.expect(65, "compare", image, larger,
                           says=["a.exr is 16 x 12 pixels, b.exr 20 x 12; ", "smoke.mean_cosine", "camera.width"])
        self.assertEqual(done.stderr.count("\n"), 1)
        self.expect(65, "compare", image, larger, "--force", says="16 x 12")

    def test_gray_halves_of_another_renderer(self):
        # Checkerboards of +-10 %, one of columns and one of rows: independent of each other and of the image.
        image = self.folder / "image.exr"
        write_exr(image, *self.SIZE, R=lambda x, y: 1.02, G=lambda x, y: 1.02, B=lambda x, y: 1.02)
        halves = [self.gray("a.exr", lambda x, y: 1.1 if x % 2 else 0.9),
                  self.gray("b.exr", lambda x, y: 1.1 if y % 2 else 0.9)]
        layer = self.layers(image, *halves)["beauty"]
        self.assertAlmostEqual(layer["noise_free"], 0.02, places=4)
        self.assertAlmostEqual(layer["mean"], 0.02, places=5)
        self.assertAlmostEqual(layer["reference_noise"], 0.1 / 2**0.5, places=3)
        self.assertGreater(layer["rrmse"], 0.07)
        self.assertTrue(layer["below_noise"])
        done = self.expect(0, "compare", image, *halves, says="without a shot of Brisance")
        self.assertIn("below 2 times the reference's noise", done.stdout)
        self.expect(65, "compare", image, halves[0], halves[0], says="not independent halves")

    def test_pixels_that_are_no_numbers_never_pass(self):
        reference = self.gray("a.exr", lambda x, y: 1)
        image = self.gray("b.exr", lambda x, y: float("nan") if x == 3 and y < 2 else 1)
        done = self.expect(1, "compare", image, reference, "--fail-above", "rrmse=0.5",
                           says="2 pixels that are not finite")
        self.assertIn("NOT FINITE: 2 pixels of the image and 0 of the reference", done.stdout)
        layer = self.layers(image, reference)["beauty"]
        self.assertEqual(layer["not_finite_pixels"], {"image": 2, "reference": 0})
        self.assertEqual(layer["rrmse"], 0)
        self.assertGreaterEqual(layer["flip"], 2 / (24 * 16))

    def test_limits(self):
        reference = self.gray("a.exr", lambda x, y: 1)
        image = self.gray("b.exr", lambda x, y: 0.9)
        self.expect(0, "compare", image, reference, "--fail-above", "rrmse=0.11", "--fail-above", "mean=0.11")
        self.expect(1, "compare", image, reference, "--fail-above", "mean=0.09",
                    says="mean of beauty is -0.1, above 0.09")
        result = self.numbers(image, reference, "--fail-above", "rrmse=0.09", "--fail-above", "flip=1", code=1)
        self.assertEqual(len(result["exceeded"]), 1)
        black = self.gray("c.exr", lambda x, y: 0)
        self.expect(1, "compare", image, black, "--fail-above", "rrmse=1e300", says="is inf")
        self.assertIsNone(self.layers(image, black)["beauty"]["rrmse"])
        for wrong in ("rrmse", "rmse=1", "rrmse=x", "rrmse=-1", "rrmse=0.1x", "temporal=1", "noise_free=1"):
            self.expect(2, "compare", image, reference, "--fail-above", wrong, says=f"--fail-above {wrong}: ")

    def test_map_of_errors(self):
        reference = self.gray("a.exr", lambda x, y: 1)
        image = self.gray("b.exr", lambda x, y: 0.5 if x < 12 else 1)
        self.expect(0, "compare", image, reference, "--flip-map", "map.png")
        self.assertEqual((self.folder / "map.png").read_bytes()[:4], b"\x89PNG")
        self.expect(2, "compare", image, reference, "--flip-map", "map.exr", says=".png")
        self.expect(73, "compare", image, reference, "--flip-map", "absent/map.png", says="absent")

    def test_sequences(self):
        for frame in (1, 2, 3):
            self.gray(f"r.{frame:02}.exr", lambda x, y, t=frame: 1 + 0.1 * t * x)
            self.gray(f"frozen.{frame:02}.exr", lambda x, y: 1.5)
            self.gray(f"offset.{frame:02}.exr", lambda x, y, t=frame: 1.5 + 0.1 * t * x)
        frozen = self.numbers("frozen.##.exr", "r.##.exr")
        self.assertEqual([frame["frame"] for frame in frozen["frames"]], [1, 2, 3])
        self.assertEqual([(c["from"], c["to"]) for c in frozen["changes"]], [(1, 2), (2, 3)])
        for change in frozen["changes"]:
            self.assertAlmostEqual(change["layers"][0]["temporal"], 1)
        offset = self.numbers("offset.##.exr", "r.##.exr", "-f", "1-3x2", "--flip-map", "map.#.png")
        self.assertLess(offset["changes"][0]["layers"][0]["temporal"], 1e-5)
        self.assertGreater(offset["frames"][0]["layers"][0]["rrmse"], 0.1)
        self.assertEqual([name for name in self.names() if name.endswith("png")], ["map.1.png", "map.3.png"])
        self.assertIn("1-2", self.expect(0, "compare", "frozen.##.exr", "r.##.exr").stdout)
        self.expect(1, "compare", "frozen.##.exr", "r.##.exr", "--fail-above", "temporal=0.5",
                    says="temporal of beauty from frame 1 to 2 is 1, above 0.5")
        self.expect(2, "compare", "frozen.##.exr", "r.01.exr", says="####")
        self.expect(2, "compare", "frozen.##.exr", "r.##.exr", "--flip-map", "map.png", says="####")
        (self.folder / "r.02.exr").unlink()
        self.expect(66, "compare", "frozen.##.exr", "r.##.exr", says="frame 2")

    def test_flicker_and_spectrum_of_a_sequence(self):
        wave = lambda x: 0.1 * (x % 6 - 2.5)
        for frame in range(1, 5):
            travelling = {"Y": lambda x, y, t=frame: 1 + wave(x - 2 * t), "motion.X": lambda x, y: -2,
                          "motion.Y": lambda x, y: 0}
            write_exr(self.folder / f"a.{frame}.exr", *self.SIZE, **travelling)
            self.gray(f"r.{frame}.exr", lambda x, y: 1)
        result = self.numbers("a.#.exr", "r.#.exr", "--motion", "motion", "--spectrum", "s.html")
        for change in result["changes"]:
            self.assertLess(change["layers"][0]["flicker"], 1e-6)
            self.assertAlmostEqual(change["layers"][0]["seen_before"], 22 / 24)
        spectrum, = result["spectra"]
        self.assertAlmostEqual(sum(spectrum["power"]), result["frames"][0]["layers"][0]["rrmse"] ** 2, places=6)
        page = (self.folder / "s.html").read_text(encoding="utf-8")
        self.assertIn("<polyline", page)
        self.assertNotIn("http", page)
        self.assertNotIn("flicker", self.numbers("a.#.exr", "r.#.exr")["changes"][0]["layers"][0])
        self.expect(0, "compare", "a.#.exr", "r.#.exr", says="no flicker is measured")
        self.expect(0, "compare", "a.#.exr", "r.#.exr", "--motion", "motion", "--fail-above", "flicker=0.01")
        self.expect(65, "compare", "a.#.exr", "r.#.exr", "--motion", "vectors", says="no layer vectors of two channels")
        self.expect(2, "compare", "a.#.exr", "r.#.exr", "-f", "1-2", "--spectrum", "s.html", says="2 frames are too few")
        self.expect(73, "compare", "a.#.exr", "r.#.exr", "--spectrum", "absent/s.html", says="absent")

    def test_a_camera_that_stands_has_the_flicker_of_its_noise(self):
        for frame in (1, 2):
            self.render(f"p.{frame}.exr", "-f", "1", "--method", "path", "--set", "tracing.samples=4",
                        "--set", f"tracing.seed={frame}")
            self.render(f"g.{frame}.exr", "-f", "1")
        numbers = self.numbers("p.#.exr", "g.#.exr", "--force")["changes"][0]["layers"][0]
        self.assertGreater(numbers["flicker"], 0.001)
        self.assertGreater(numbers["seen_before"], 0.3)

    def test_files_that_cannot_be_read(self):
        reference = self.gray("a.exr", lambda x, y: 1)
        self.write("text.exr", "no picture")
        self.expect(66, "compare", reference, "absent.exr", says="absent.exr: no such file")
        self.expect(66, "compare", "absent.exr", reference, says="absent.exr")
        self.expect(65, "compare", reference, "text.exr", says="text.exr: it is not an OpenEXR file")


class Flicker(VolumeCase):
    """A still in other words."""

    def variants(self, *options, code=0):
        done = self.expect(code, "flicker", self.volume, *LIT, "--width", "16", "--json", *options)
        return {v["variant"]: v for v in json.loads(done.stdout)["variants"]}

    def test_a_still_is_the_same_again_and_nearly_the_same_elsewhere(self):
        variants = self.variants()
        self.assertTrue(variants["rendered again"]["same_bits"])
        for name, variant in variants.items():
            beauty = variant["layers"][0]
            self.assertEqual((beauty["layer"], round(beauty["share"], 6)), ("beauty", 1))
            self.assertLess(beauty["change"], 0.05, name)
        # Lattices are anchored to the world: whole voxels move the smoke through them.
        self.assertGreater(variants["moved by 3, 5, 7 voxels"]["layers"][0]["change"], 0)
        self.assertTrue(variants["other seeds"]["same_bits"])  # nothing in this picture is drawn by chance

    def test_noise_is_seen_and_fails(self):
        noisy = ["--set", "method=path", "--set", "tracing.samples=4"]
        self.assertGreater(self.variants(*noisy)["other seeds"]["layers"][0]["change"], 0.01)
        done = self.expect(1, "flicker", self.volume, *SMALL, *noisy, "--fail-above", "0.001", says="other seeds")
        self.assertIn("same bits", done.stdout)

    def test_it_looks_at_one_frame(self):
        self.expect(2, "flicker", self.make_sequence([1, 2]), says="choose one with -f")
        self.expect(66, "flicker", "absent.vdb", says="absent.vdb")


class PathTracer(VolumeCase):
    """What method path adds: halves, certificates, single paths."""

    SHOT = ["--set", "camera.width=24", "--set", "camera.height=18"]
    TRACED = [*SHOT, "--method", "path", "--set", "tracing.samples=4", "--set", "output.png=false"]

    def statistics(self, name="a"):
        return json.loads((self.out / f"{name}.stats.json").read_text(encoding="utf-8"))

    def test_method_is_a_shorthand(self):
        for command in ("render", "plan"):
            self.expect(2, command, self.volume, "--method", "guess", says="--method")
        text = self.expect(0, "render", self.volume, "--method", "path", "--print-config").stdout
        self.assertEqual(json.loads(text)["method"], "path")
        self.assertIn("method is path", self.expect(0, "plan", self.volume, "--method", "path", "-o", self.out).stdout)

    def test_a_render_without_end_is_refused(self):
        never = ["--method", "path", "--set", "tracing.samples=none"]
        self.expect(2, "render", self.volume, *never, says=["tracing.samples", "would never end"])
        self.expect(0, "render", self.volume, *never, "--set", "tracing.seconds=1", "--print-config")
        self.expect(0, "render", self.volume, *never, "--set", "tracing.error=0.1", "--print-config")

    def test_halves(self):
        done = self.expect(0, "render", self.volume, *self.TRACED, "--set", "output.halves=true", "-o",
                           self.out / "a.exr")
        written = ["a.A.exr", "a.B.exr", "a.exr", "a.look.json", "a.stats.json"]
        self.assertEqual(self.outputs(), written)
        self.assertEqual(sorted(pathlib.Path(line).name for line in done.stdout.splitlines()), written)
        layer, = json.loads(self.expect(0, "compare", self.out / "a.exr", self.out / "a.A.exr", self.out / "a.B.exr",
                                        "--json").stdout)["frames"][0]["layers"]
        self.assertLess(abs(layer["mean"]), 1e-5)  # the picture is the mean of the halves
        self.assertGreater(layer["reference_noise"], 0)

    def test_halves_of_what_has_none(self):
        self.expect(0, "render", self.volume, *SMALL, "--set", "output.halves=true", "-o", self.out / "a.exr",
                    says="[halves]")
        self.assertNotIn("a.A.exr", self.outputs())

    def test_certificates(self):
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        budget = ["--certify", "--set", "certify.samples=4096"]
        for look in (self.TRACED, LIT):
            files = []
            for threads in (1, 2):
                self.expect(0, "render", self.volume, *look, *budget, "-o", self.out / "a.exr", "--threads", threads,
                            env=environment, says="certificate: error ")
                files.append((self.out / "a.exr").read_bytes())
            self.assertEqual(files[0], files[1])
            certificate = self.statistics()["certificate"]
            self.assertEqual(certificate["confidence"], 0.95)
            self.assertLessEqual(certificate["samples"], 4096)
            low, high = certificate["picture"]["error_interval"]
            self.assertLessEqual(low, certificate["picture"]["error"])
            self.assertLessEqual(certificate["picture"]["error"], high)
            self.assertIn("V", certificate["cells"])
            self.assertIn(b"brisance/certificate\0string\0", files[0])
        self.expect(0, "render", self.volume, *self.TRACED, "-o", self.out / "b.exr")
        self.assertNotIn("certificate", self.statistics("b"))

    def test_built_in_explosion_is_near_the_truth(self):
        if not (SOURCE / "volumes" / "explosion.vdb").exists():
            self.skipTest("no volume: volumes/explosion.vdb is missing")
        self.expect(0, "render", SOURCE / "shots" / "explosion.json", "--preset", "draft", "--set", "camera.width=96",
                    "--set", "camera.height=54", "--set", "camera.samples_per_axis=4", "--certify", "--set",
                    "certify.samples=32768", "-o", self.out / "a.exr")
        certificate = self.statistics()["certificate"]
        # Bounds against gross faults, 1.6 times what was measured: 0.036 and 0.059. One pixel that glows where it
        # should not has made the second 0.7.
        self.assertLess(certificate["picture"]["error_interval"][1], 0.057)
        self.assertLess(certificate["cells"]["MM"]["error_interval"][1], 0.094)

    def test_vertices_add_up_to_their_path(self):
        fire_alone = ["--set", "scene.lights=[]"]
        for more in (fire_alone, [*fire_alone, "--set", "camera.filter=gaussian"], []):  # the last with a look's lamps
            text = self.expect(0, "trace-path", self.volume, 12, 9, 5, *self.SHOT, *more).stdout.splitlines()
            vertices = [line for line in text if " throughput " in line and line.startswith("  ")]
            gathered = [re.search(rf" {what} (\S+) (\S+) (\S+)", line).groups() for line in vertices
                        for what in ("along", "from fire", "from emitters")]
            orders = [line.split()[-3:] for line in text if re.match(r"  \d\+? +((V|MV|MM) +)?[-\d.e+]+ \S+ \S+$", line)]
            self.assertGreater(len(vertices), 1)
            self.assertGreater(len(orders), 1)
            for channel in range(3):
                path = sum(float(order[channel]) for order in orders)
                self.assertAlmostEqual(sum(float(rgb[channel]) for rgb in gathered), path, delta=1e-5 * abs(path))

    def test_one_path(self):
        arguments = [self.volume, 12, 9, 5, *self.SHOT]
        text = self.expect(0, "trace-path", *arguments).stdout
        self.assertIn("pixel 12 9, sample 5 (half B)", text)
        self.assertTrue(text.endswith("\nfinite\n"))
        self.assertEqual(self.expect(0, "trace-path", *arguments, "--threads", 1).stdout, text)
        self.expect(2, "trace-path", self.volume, 24, 0, 0, *self.SHOT, says="outside of the picture")
        for wrong in ([self.volume, 1, 2], [self.volume, -1, 2, 3], [self.volume, 1, 2, "x"]):
            self.expect(2, "trace-path", *wrong)
        pattern = self.make_sequence([1, 2])
        self.expect(2, "trace-path", pattern, 1, 2, 3, says="-f")
        self.assertIn("frame 2,", self.expect(0, "trace-path", pattern, 1, 2, 3, *self.SHOT, "-f", 2).stdout)


class VirtualLights(Case):
    """--debug virtual-lights: pictures of the method beside the frame."""

    SUFFIXES = ["count.png", "exr", "path_length.png", "ply", "png", "profiles.exr", "profiles.png"]

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.out.mkdir()
        quad = lambda *corners: {"corners": corners, "colour": 0.6, "metallic": 1, "specular": 1, "roughness": 0.5}
        self.shot = self.write("room.json", json.dumps({
            "scene": {"quads": [quad([-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]),
                                quad([-1, 1, 0], [1, 1, 0], [1, 1, 2], [-1, 1, 2])],
                      "lights": [{"kind": "point", "position": [0, 0, 1], "power": [9, 9, 9]}]},
            "camera": {"eye": [0, -3, 1], "target": [0, 0, 0.7], "up": [0, 0, 1], "width": 24, "height": 16,
                       "samples_per_axis": 1},
            "virtual_lights": {"count": 300, "photons": 20000, "profile_resolution": 4}}))

    def outputs(self):
        return sorted(path.name for path in self.out.iterdir())

    def render(self, *more, code=0, **options):
        return self.expect(code, "render", self.shot, "--debug", "virtual-lights", "-o", self.out / "a.exr", *more,
                           **options)

    def test_files_beside_the_frame(self):
        done = self.render()
        files = ["a.exr", "a.png", "a.stats.json", *(f"a.virtual_lights.{end}" for end in self.SUFFIXES)]
        self.assertEqual(self.outputs(), files)
        self.assertEqual(sorted(pathlib.Path(line).name for line in done.stdout.split()), files)
        self.assertIn(b"\nelement vertex 2", (self.out / "a.virtual_lights.ply").read_bytes())

    def test_only_where_requested(self):
        self.expect(0, "render", self.shot, "-o", self.out / "a.exr")
        self.assertEqual(self.outputs(), ["a.exr", "a.png", "a.stats.json"])

    def test_key_of_the_shot_and_no_pngs(self):
        self.expect(0, "render", self.shot, "--set", "output.virtual_lights=true", "--set", "output.png=false", "-o",
                    self.out / "a.exr")
        self.assertEqual(self.outputs(), ["a.exr", "a.stats.json", *(f"a.virtual_lights.{end}" for end in
                                                                     ("exr", "ply", "profiles.exr"))])

    def test_sequences(self):
        self.expect(0, "render", self.shot, "--debug", "virtual-lights", "-f", "1-3", "-o", self.out / "b.####.exr",
                    "--set", "output.png=false")
        self.assertEqual(len([name for name in self.outputs() if name.endswith(".ply")]), 3)
        self.assertIn("b.0003.virtual_lights.profiles.exr", self.outputs())

    def test_nothing_to_show_is_one_line(self):
        for more, why in ((["--method", "path", "--set", "tracing.samples=2"], "method path uses none"),
                          (["--set", "virtual_lights.count=0"], "virtual_lights.count is 0"),
                          (["--set", "scene.quads=[]"], "there are no surfaces")):
            done = self.render(*more, says=f"no pictures of virtual lights are written: {why}")
            self.assertEqual(done.stderr.count("virtual-lights"), 1)
            self.assertEqual(self.outputs(), ["a.exr", "a.png", "a.stats.json"])

    def test_unknown_pictures(self):
        self.expect(2, "render", self.shot, "--debug", "lights", says="virtual-lights")

    def test_a_name_that_is_taken_is_found_before_rendering(self):
        (self.out / "a.virtual_lights.ply").mkdir()
        self.render(code=73, says="a.virtual_lights.ply")
        self.assertEqual(self.outputs(), ["a.virtual_lights.ply"])

    def test_full_disk(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (18000, 18000))

        self.render(code=74, says="a.virtual_lights.ply", preexec_fn=limit)  # 300 lights of 75 bytes
        self.assertEqual(self.outputs(), ["a.exr", "a.png"])


class Checkpoints(VolumeCase):
    """Long renders that are stopped, and go on as if nothing had been."""

    # 3072 pixels: 516 kB of checkpoint, and less than half of that as EXR.
    TRACED = ["--method", "path", "--set", "camera.width=64", "--set", "camera.height=48", "--set", "output.png=false",
              "--set", "output.statistics=false", "--set", "tracing.checkpoint_seconds=0", "--set", "smoke.albedo=0.5"]

    def setUp(self):
        super().setUp()
        self.state = self.folder / "state"
        self.environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}

    def arguments(self, name, samples, *more):
        return ["render", self.volume, *self.TRACED, "--set", f"tracing.samples={samples}", "-o", self.out / name, *more]

    def render(self, name, samples, *more, code=0, **options):
        return self.expect(code, *self.arguments(name, samples, *more), env=self.environment, **options)

    def bytes_of(self, name):
        return (self.out / name).read_bytes()

    def start(self, *arguments):
        return subprocess.Popen([BINARY, *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, env=self.environment)

    def test_killed_again_and_again(self):
        samples = 48
        self.render("whole.exr", samples)
        moments = random.Random(1)
        stopped = 0
        for sent in (signal.SIGKILL, signal.SIGTERM, signal.SIGKILL, signal.SIGKILL):
            before = self.state.read_bytes() if self.state.exists() else b""
            with self.start(*self.arguments("parts.exr", samples, "--checkpoint", self.state)) as process:
                while process.poll() is None and (not self.state.exists() or self.state.read_bytes() == before):
                    time.sleep(0.005)
                time.sleep(0.3 * moments.random())
                process.send_signal(sent)
            stopped += process.returncode != 0
            if "parts.exr" in self.outputs():
                break  # the signal came after the picture
        self.assertGreaterEqual(stopped, 1)
        if "parts.exr" not in self.outputs():
            self.render("parts.exr", samples, "--checkpoint", self.state, says="going on from")
        self.assertEqual(self.bytes_of("parts.exr"), self.bytes_of("whole.exr"))
        self.assertEqual(self.names(), ["out", "state"])

    def temporary(self, name, process, host=socket.gethostname()):
        return self.folder / f".{name}.{host}.{process}.tmp"

    def test_leftovers_of_killed_runs(self):
        with subprocess.Popen(["true"]) as ended:
            ended.wait()
        left = self.temporary("state", ended.pid)
        others = [self.temporary("state", os.getpid()), self.temporary("other", ended.pid),
                  self.temporary("state", ended.pid, "elsewhere")]
        for path in (left, *others):
            path.write_bytes(b"half a checkpoint")
        self.render("a.exr", 2, "--checkpoint", self.state)
        self.assertEqual(self.names(), sorted(["out", "state", *(path.name for path in others)]))
        # Also where there is nothing left to render.
        left.write_bytes(b"half a checkpoint")
        self.render("a.exr", 2, "--checkpoint", self.state, says="going on from")
        self.assertFalse(left.exists())

    def test_more_paths_than_before(self):
        self.render("whole.exr", 12, "--set", "output.halves=true")
        self.render("parts.exr", 4, "--checkpoint", self.state)
        self.assertTrue(self.state.exists())
        self.render("parts.exr", 12, "--checkpoint", self.state, "--set", "output.halves=true",
                    says=["going on from", "after 4 "])
        for end in ("exr", "A.exr", "B.exr"):
            self.assertEqual(self.bytes_of(f"parts.{end}"), self.bytes_of(f"whole.{end}"))
        # Enough already: nothing to add, and the same picture again.
        self.render("again.exr", 12, "--checkpoint", self.state, "--certify", "--set", "certify.samples=1024",
                    says="certificate: ")

    def test_full_disk(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (400 << 10, 400 << 10))

        self.render("whole.exr", 4)
        self.render("parts.exr", 4, "--checkpoint", self.state, preexec_fn=limit, says=["[checkpoint]", "not kept"])
        self.assertEqual(self.bytes_of("parts.exr"), self.bytes_of("whole.exr"))
        self.assertFalse(self.state.exists())

    def test_of_another_render(self):
        self.render("a.exr", 4, "--checkpoint", self.state)
        kept = self.state.read_bytes()
        for other in ("smoke.albedo=0.6", "camera.width=66", "output.layers.bounces=true", "tracing.light_sampling=false",
                      "tracing.seed=1"):
            self.render("b.exr", 8, "--checkpoint", self.state, "--set", other, code=65,
                        says=[str(self.state), "belongs to another"])
            self.assertEqual(self.state.read_bytes(), kept)
        self.assertEqual(self.outputs(), ["a.exr"])

    def test_damaged(self):
        self.render("a.exr", 4, "--checkpoint", self.state)
        kept = self.state.read_bytes()
        flipped = bytearray(kept)
        flipped[len(kept) // 2] ^= 4
        for bytes_now in (kept[:-1], kept[:40], bytes(flipped), kept + b"x", b"", b"no checkpoint"):
            self.state.write_bytes(bytes_now)
            self.render("b.exr", 8, "--checkpoint", self.state, code=65, says=str(self.state))
            self.assertEqual(self.state.read_bytes(), bytes_now)

    def test_sequences_have_one_each(self):
        pattern = self.make_sequence([1, 2])
        sequence = ["render", pattern, *self.TRACED, "--set", "tracing.samples=2", "-o", self.out / "a.#.exr"]
        self.expect(2, *sequence, "--checkpoint", "state", says="####")
        self.expect(0, *sequence, "--checkpoint", "state.##")
        self.assertEqual([name for name in self.names() if name.startswith("state")], ["state.01", "state.02"])
        self.expect(65, *sequence, "-f", 2, "--checkpoint", "state.01", says="belongs to another")

    def test_where_it_has_no_place(self):
        self.expect(2, "render", self.volume, *SMALL, "--checkpoint", self.state, says=["--checkpoint", "--method path"])
        for other in (self.volume, self.out / "a.exr"):
            self.render("a.exr", 2, "--checkpoint", other, code=2, says="is something else")
        self.render("a.exr", 2, "--checkpoint", "absent/state", code=73, says="absent")
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


def main(module):
    names = sys.argv[3:]
    loader = unittest.TestLoader()
    suite = loader.loadTestsFromNames(names, module) if names else loader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if result.testsRun == len(result.skipped) else 0)


if __name__ == "__main__":
    main(sys.modules[__name__])
