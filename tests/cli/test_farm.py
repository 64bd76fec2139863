"""Sequences on several machines: tasks, finished frames, what frames read, progress for other programs, submitting.

usage: test_farm.py BINARY SOURCE_FOLDER [CLASS]
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import test_cli
from test_cli import BINARY, SMALL, SOURCE, VolumeCase

CAMERA = {"eye": [0, -9, 2], "target": [0, 0, 2]}
EXR_ONLY = ["--set", "output.png=false", "--set", "output.statistics=false"]


class FarmCase(VolumeCase):
    """A sequence of frames 1 to 5, and its outputs."""

    def setUp(self):
        super().setUp()
        self.pattern = self.make_sequence([1, 2, 3, 4, 5])
        # Files of one sequence differ: a byte after the end is no part of a grid.
        self.asked = [self.pattern, *SMALL, "-o", self.out / "a.####.exr"]

    def render(self, *more, code=0, says=()):
        return self.expect(code, "render", *self.asked, *more, says=says)

    def exr(self, frame):
        return self.out / f"a.{frame:04}.exr"

    def pixels(self, frame):
        """The file after its header, which holds times."""
        return self.exr(frame).read_bytes()


class Tasks(FarmCase):
    def images(self, done):
        return [line for line in done.stdout.split() if line.endswith(".exr")]

    def test_every_frame_belongs_to_one_task(self):
        images = []
        for task in range(3):
            images += self.images(self.render(*EXR_ONLY, "--task-index", task, "--task-count", 3))
        self.assertEqual(images, [str(self.exr(frame)) for frame in range(1, 6)])

    def test_frames_asked_for_are_divided(self):
        done = self.render(*EXR_ONLY, "-f", "5,1-3", "--task-index", 0, "--task-count", 2)
        self.assertEqual(self.images(done), [str(self.exr(frame)) for frame in (5, 1)])

    def test_a_task_of_one_frame_keeps_the_numbers_of_the_sequence(self):
        self.expect(0, "render", self.pattern, *SMALL, *EXR_ONLY, "-o", self.out, "--set", "name=b", "--task-index", 1,
                    "--task-count", 5)
        self.assertEqual(self.outputs(), ["b.0002.exr"])
        self.expect(2, "render", self.pattern, *SMALL, "-o", self.out / "one.exr", "--task-index", 1, "--task-count",
                    5, says="####")

    def test_more_tasks_than_frames(self):
        done = self.render(*EXR_ONLY, "-f", "1-2", "--task-index", 0, "--task-count", 3, says="0 frames written")
        self.assertEqual(done.stdout, "")

    def test_out_of_range_is_one_line(self):
        for index, count in ((5, 5), (-1, 5), (0, 0)):
            done = self.render("--task-index", index, "--task-count", count, code=2, says="--task-")
            self.assertEqual(sum("error" in line for line in done.stderr.splitlines()), 1)
        self.render("--task-index", 1, code=2, says="--task-count")


class SkipExisting(FarmCase):
    finished = None  # the frames of all tests, rendered once: of the same contents, below the same names

    @classmethod
    def tearDownClass(cls):
        if cls.finished:
            cls.finished.cleanup()
        super().tearDownClass()

    def setUp(self):
        super().setUp()
        if not SkipExisting.finished:
            self.render()
            SkipExisting.finished = tempfile.TemporaryDirectory(prefix="brisance-farm-")
            shutil.copytree(self.out, SkipExisting.finished.name, dirs_exist_ok=True)
        shutil.rmtree(self.out)
        shutil.copytree(SkipExisting.finished.name, self.out)
        self.times = {frame: self.exr(frame).stat().st_mtime_ns for frame in range(1, 6)}

    def rendered_again(self, *more):
        """Frames that were, and standard error."""
        done = self.expect(0, "render", *self.asked, "--skip-existing", *more)
        return [frame for frame in self.times if self.exr(frame).stat().st_mtime_ns != self.times[frame]], done.stderr

    def test_finished_frames_stay(self):
        frames, said = self.rendered_again("--progress", "plain")
        self.assertEqual(frames, [])
        self.assertRegex(said, "0 frames written in .*; 5 were finished before")

    def test_missing_and_damaged_ones_are_rendered(self):
        self.exr(2).unlink()
        self.exr(3).write_bytes(self.exr(3).read_bytes()[:-40])
        (self.out / "a.0004.png").unlink()
        png = self.out / "a.0005.png"
        png.write_bytes(png.read_bytes()[:-20])
        before = self.exr(1).read_bytes()
        times = self.times.pop(2)
        frames, said = self.rendered_again()
        self.assertNotEqual(times, self.exr(2).stat().st_mtime_ns)
        self.assertEqual(frames, [3, 4, 5])
        for line in ("frame 3: rendered again: ", "damaged", "a.0004.png is not there", "a.0005.png is damaged"):
            self.assertIn(line, said)
        self.assertNotIn("frame 2: rendered again", said)  # it was never there
        self.assertEqual(self.exr(1).read_bytes(), before)

    def test_other_settings(self):
        frames, said = self.rendered_again("-f", "1-2", "--set", "smoke.albedo=0.25")
        self.assertEqual(frames, [1, 2])
        self.assertIn("it has other settings: smoke.albedo: ", said)

    def test_other_contents_of_the_volume(self):
        volume = self.folder / "burst_0004.vdb"
        with volume.open("r+b") as file:
            file.seek(-1, os.SEEK_END)
            last = file.read(1)
            file.seek(-1, os.SEEK_END)
            file.write(bytes([last[0] ^ 1]))  # the same size
        done = self.run_program("verify", *self.asked)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stdout)
        self.assertIn("frame 4: ", done.stdout)
        self.assertIn("burst_0004.vdb has other contents now", done.stdout)

    def test_a_copy_with_another_date_is_the_same_input(self):
        os.utime(self.folder / "burst_0001.vdb", (0, 0))
        self.assertEqual(self.rendered_again()[0], [])

    def test_a_certificate_is_asked_for(self):
        frames, said = self.rendered_again("-f", "1", "--certify", "--set", "certify.samples=1024")
        self.assertEqual(frames, [1])
        self.assertIn("certify", said)


class Inputs(FarmCase):
    def test_every_file_once(self):
        sky = {"lights": [{"kind": "environment", "file": "sky.exr"}]}
        shot = self.write("a.json", json.dumps({"volume": {"file": self.pattern}, "scene": sky, "camera": CAMERA}))
        self.expect(66, "render", shot, "--list-inputs", "-f", "1-2", says=["sky.exr", "is not there"])
        (self.folder / "sky.exr").write_bytes(b"")
        expected = [str(shot), *(str(self.folder / name) for name in ("burst_0001.vdb", "sky.exr", "burst_0002.vdb"))]
        for command in ("render", "plan"):
            done = self.expect(0, command, shot, "--list-inputs", "-f", "1-2")
            self.assertEqual(done.stdout.splitlines(), expected)
        done = self.expect(0, "render", shot, "--list-inputs", "--task-index", 4, "--task-count", 5)
        # The first of the largest files decides the lattices of all.
        self.assertEqual(done.stdout.splitlines(), [*expected[:2], str(self.folder / "burst_0005.vdb"), expected[2]])
        self.assertEqual(self.outputs(), [])

    def test_what_decides_a_look_or_a_camera_is_among_them(self):
        volumes = [str(self.folder / f"burst_{frame:04}.vdb") for frame in range(1, 6)]
        shot = self.write("a.json", json.dumps({"volume": {"file": self.pattern}}))
        look = self.folder / "a.look.json"
        self.expect(0, "inspect", self.pattern, "--write-look", look)
        for input_, more, shared in ((self.pattern, [], volumes), (self.folder, [], volumes), (shot, [], [shot, *volumes]),
                                     (self.pattern, ["--look", look], [look, *volumes[:2]])):
            done = self.expect(0, "render", input_, *more, "--list-inputs", "-f", "2")
            self.assertEqual([pathlib.Path(line).name for line in done.stdout.splitlines()],
                             [pathlib.Path(file).name for file in shared])

    def test_the_file_that_decides_for_all_is_among_them(self):
        with (self.folder / "burst_0005.vdb").open("ab") as file:
            file.write(b"more")
        shot = self.write("a.json", json.dumps({"volume": {"file": self.pattern}, "method": "auto", "camera": CAMERA}))
        done = self.expect(0, "render", shot, "--list-inputs", "-f", "1")
        self.assertEqual([line.rsplit("/", 1)[-1] for line in done.stdout.splitlines()],
                         ["a.json", "burst_0005.vdb", "burst_0001.vdb"])

    def test_plan_as_json(self):
        asked = ["plan", *self.asked, "-f", "1-2", "--json"]
        lamps = json.loads(self.expect(0, *asked).stdout)["frames"][0]  # those of the first look
        self.assertIsNone(lamps["seconds"])
        self.assertTrue(lamps["why_no_seconds"])
        plan = json.loads(self.expect(0, *asked, "--set", "scene.lights=[]").stdout)
        documented = documented_keys("plan --json")
        self.assertLessEqual(set(plan), documented)
        self.assertEqual(plan["schema_version"], 1)
        self.assertEqual([frame["frame"] for frame in plan["frames"]], [1, 2])
        for frame in plan["frames"]:
            self.assertLessEqual(set(frame), documented)
            self.assertEqual(frame["image"], str(self.exr(frame["frame"])))
            self.assertGreater(frame["seconds"], 0.0)
            self.assertGreater(frame["memory_bytes"], 1 << 20)
            self.assertEqual([file["path"] for file in frame["files"]], [f"burst_{frame['frame']:04}.vdb"])
            self.assertEqual(frame["files"][0]["bytes"], self.volume.stat().st_size)
        self.assertAlmostEqual(plan["seconds"], sum(frame["seconds"] for frame in plan["frames"]), places=6)
        self.assertEqual(plan["memory_bytes"], max(frame["memory_bytes"] for frame in plan["frames"]))
        self.assertEqual(self.outputs(), [])


def documented_keys(heading):
    """Names in the first column of the tables below a heading of docs/farm.md."""
    text = (test_cli.SOURCE / "docs" / "farm.md").read_text(encoding="utf-8")
    section = text.split(f"## {heading}", 1)[1].split("\n## ", 1)[0]
    names = set()
    for line in section.splitlines():
        if line.startswith("| `"):
            names.update(part.strip(" `") for part in line.split("|")[1].split(","))
    return names


class ProgressLines(FarmCase):
    def test_one_json_object_on_each_line(self):
        done = self.render("-f", "1-3", "--progress", "ndjson", "--explain")
        events = [json.loads(line) for line in done.stderr.splitlines()]
        documented = documented_keys("--progress ndjson")
        for event in events:
            self.assertLessEqual(set(event), documented)
        self.assertEqual([event["frame"] for event in events if event["event"] == "frame"], [1, 2, 3])
        written = [event for event in events if event["event"] == "written"]
        self.assertEqual([file for event in written for file in event["files"]], done.stdout.split())
        percents = [event["percent"] for event in events if event["event"] == "progress"]
        self.assertEqual(percents, sorted(percents))
        self.assertEqual(percents[-1], 100)
        last = events[-1]
        self.assertEqual((last["event"], last["written"], last["skipped"], last["failed"]), ("summary", 3, 0, 0))

    def test_errors_are_objects_too(self):
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        done = self.render("-f", "1-2", "--progress", "ndjson", code=65)
        events = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertEqual(events[-1]["event"], "error")
        self.assertIn("burst_0002.vdb", events[-1]["text"])
        done = self.render("-f", "1-2", "--progress", "ndjson", "--keep-going", code=65)
        events = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertEqual((events[-1]["event"], events[-1]["written"], events[-1]["failed"]), ("summary", 1, 1))

    def test_percent_for_readers_of_alfred(self):
        lines = self.render("-f", "1-4", "--progress", "alfred").stderr.splitlines()
        percents = [int(line[len("ALF_PROGRESS "):-1]) for line in lines if line.startswith("ALF_PROGRESS ")]
        self.assertEqual(percents, sorted(set(percents)))
        self.assertEqual((percents[0], percents[-1]), (0, 100))
        self.assertIn(50, percents)

    def test_rate_and_time_left(self):
        said = self.render("-f", "1-3", "--progress", "plain").stderr
        self.assertRegex(said, r"(?m)^ +\d+\.\d s  2 of 3 frames, \S+ s a frame, \S+ s left$")
        self.assertRegex(said.splitlines()[-1], r"^3 frames written in \S+ s: \S+a\.0001\.exr to \S+a\.0003\.exr$")


class Cache(FarmCase):
    """What one process decides for all frames, another one takes over."""

    def setUp(self):
        super().setUp()
        self.cache = self.folder / "kept" / "results"

    def bits(self, *more, cached=True, says=()):
        """Files of two frames, which hold no time of their own."""
        cache = ["--cache", self.cache, "--explain"] if cached else []
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        done = self.expect(0, "render", *self.asked, *EXR_ONLY, "-f", "1-2", *cache, *more, env=environment, says=says)
        self.said = done.stderr
        return [self.exr(frame).read_bytes() for frame in (1, 2)]

    def test_the_second_process_finds_what_the_first_kept(self):
        without = self.bits(cached=False)
        self.assertEqual(self.bits(says="cache: 0 results found, 1 kept"), without)
        self.assertEqual(self.bits(says="cache: 1 result found, 0 kept"), without)
        self.assertIn("lattices of all frames", self.said, "what was said is said again")

    def test_other_settings_and_contents_are_other_results(self):
        self.bits()
        self.bits("--set", "smoke.albedo=0.31", says="cache: 0 results found, 1 kept")
        with (self.folder / "burst_0005.vdb").open("ab") as file:
            file.write(b"more")
        self.bits(says="cache: 0 results found, 1 kept")

    def test_a_damaged_result_is_made_anew(self):
        before = self.bits()
        for result in self.cache.glob("*.result"):
            result.write_bytes(result.read_bytes()[:-3])
        self.assertEqual(self.bits(says=["is damaged", "cache: 0 results found, 1 kept"]), before)
        self.bits(says="cache: 1 result found, 0 kept")

    def test_no_folder_is_one_line(self):
        file = self.write("file", "x")
        done = self.render(*EXR_ONLY, "--cache", file, code=73, says="it is no folder")
        self.assertEqual(done.stderr.count("error"), 1)
        self.render("--cache-limit", 5, code=2, says="--cache")


class Verify(FarmCase):
    def test_missing_and_damaged_frames(self):
        self.expect(1, "verify", *self.asked, "-f", "1-3", says="0 of 3 frames finished")
        self.render("-f", "1-4")
        self.expect(0, "verify", *self.asked, "-f", "1-4", says="4 of 4 frames finished")
        self.exr(2).unlink()
        self.exr(3).write_bytes(self.exr(3).read_bytes()[:-40])
        done = self.expect(1, "verify", *self.asked, says="2 of 5 frames finished")
        lines = done.stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines], ["frame 2", "frame 3", "frame 5"])
        self.assertIn("it is not there", lines[0])
        self.assertIn("damaged", lines[1])
        self.assertIn("2-3, 5", done.stderr)

    def test_a_certificate_that_was_asked_for(self):
        asked = [*self.asked, "-f", "1", "--certify", "--set", "certify.samples=1024"]
        self.expect(0, "render", *asked)
        self.expect(0, "verify", *asked)
        self.expect(1, "verify", *self.asked, "-f", "1")

    def test_frames_that_stand_out(self):
        shutil.copyfile(SOURCE / "volumes" / "explosion.vdb", self.folder / "burst_0003.vdb")
        self.render()
        steady = self.expect(0, "verify", *self.asked, says=["change against both neighbours: median", "at frame 3"])
        self.assertEqual(steady.stdout, "")
        done = self.expect(1, "verify", *self.asked, "--fail-above", 0)
        self.assertEqual([line.split(":")[0] for line in done.stdout.splitlines()], ["frame 2", "frame 3", "frame 4"])
        self.expect(2, "verify", *self.asked, "--fail-above", -1)
        self.assertNotIn("neighbours", self.expect(0, "verify", *self.asked, "-f", "1-2").stderr)

    def test_it_writes_nothing(self):
        self.expect(1, "verify", self.pattern, *SMALL, "-o", "absent/a.####.exr")
        self.assertFalse((self.folder / "absent").exists())


class Submit(FarmCase):
    def test_this_machine_is_the_default(self):
        self.expect(0, "submit", *self.asked, says="5 of 5 frames finished")
        first = {frame: self.exr(frame).stat().st_mtime_ns for frame in range(1, 6)}
        self.exr(3).unlink()
        self.expect(0, "submit", *self.asked, says="5 of 5 frames finished")
        self.assertEqual([frame for frame in first if self.exr(frame).stat().st_mtime_ns == first[frame]],
                         [1, 2, 4, 5])

    def test_tasks_have_the_bits_of_one_process(self):
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
        exrs = {}
        for tasks in (1, 3):
            done = self.expect(0, "submit", *self.asked, "--tasks", tasks, env=environment,
                               says="5 of 5 frames finished")
            self.assertEqual(sum(line.endswith(".exr") for line in done.stdout.split()), 5)
            exrs[tasks] = [self.exr(frame).read_bytes() for frame in range(1, 6)]
            for frame in range(1, 6):
                self.exr(frame).unlink()
        self.assertEqual(exrs[1], exrs[3])

    def test_a_task_that_is_killed_is_run_again(self):
        with subprocess.Popen([BINARY, "submit", *map(str, self.asked), "--set", "camera.width=640", "--set",
                               "camera.height=360", "-f", "1-3", *EXR_ONLY], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True) as process:
            first = process.stdout.readline()  # the first frame is done
            children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True,
                                      text=True, check=True).stdout.split()
            for child in children:
                os.kill(int(child), signal.SIGKILL)
            said = process.communicate(timeout=300)[1]
        self.assertTrue(first.strip().endswith(".exr"))
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("ended with exit code 137", said)
        self.assertIn("3 of 3 frames finished", said)

    def test_errors_that_come_again_are_not_tried_again(self):
        (self.folder / "burst_0002.vdb").write_text("damaged", encoding="utf-8")
        self.expect(65, "submit", *self.asked, says="burst_0002.vdb")

    def test_scripts_for_slurm(self):
        script = self.folder / "job.sbatch"
        done = self.expect(0, "submit", *self.asked, "--engine", "slurm", "--frames-per-task", 2, "--write", script,
                           "--memory", 500, "--retries", 4, "--certify")
        self.assertEqual(done.stdout.split(), [str(script), f"{script}.last"])
        for path in (script, self.folder / "job.sbatch.last"):
            subprocess.run(["bash", "-n", path], check=True)
        text = script.read_text(encoding="utf-8")
        for part in ("#SBATCH --array=0-2\n", "#SBATCH --mem=500M\n", "#SBATCH --requeue\n", "-f 1-5 ", "--certify ",
                     "--skip-existing", '--task-index "${SLURM_ARRAY_TASK_ID}" --task-count 3', "$(seq 0 4)"):
            self.assertIn(part, text)

    def test_scripts_run_without_slurm_too(self):
        """What a scheduler would do, by hand: names with spaces and quotes included."""
        odd = self.folder / "it's odd"
        odd.mkdir()
        asked = [self.pattern, *SMALL, *EXR_ONLY, "-o", odd / "a b.####.exr"]
        script = self.folder / "job.sbatch"
        self.expect(0, "submit", *asked, "--engine", "slurm", "--tasks", 2, "--write", script)
        environment = {**os.environ, "SLURM_ARRAY_TASK_ID": "1", "SLURM_CPUS_ON_NODE": "1"}
        subprocess.run(["bash", script], check=True, cwd=self.folder, env=environment, capture_output=True)
        self.assertEqual(sorted(path.name for path in odd.iterdir()), [f"a b.{n:04}.exr" for n in (3, 4, 5)])
        done = subprocess.run(["bash", f"{script}.last"], check=True, cwd=self.folder, env=environment,
                              capture_output=True, text=True)
        self.assertIn("5 of 5 frames finished", done.stderr)

    def test_no_slurm_is_one_line(self):
        done = self.expect(69, "submit", *self.asked, "--engine", "slurm", says="Slurm is not there",
                           env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual(sum("error" in line for line in done.stderr.splitlines()), 1)

    def test_templates_hold_every_task(self):
        lines = self.template("opencue").splitlines()
        self.assertEqual(len(lines), 3)
        for index, line in enumerate(lines):
            self.assertIn(f"--task-index {index} --task-count 3", line)
        job = json.loads(self.template("openjd"))
        self.assertEqual(job["specificationVersion"], "jobtemplate-2023-09")
        self.assertEqual(job["steps"][0]["parameterSpace"]["taskParameterDefinitions"],
                         [{"name": "Task", "type": "INT", "range": "0-2"}])
        self.assertIn("--task-index {{Task.Param.Task}} ", job["steps"][0]["script"]["actions"]["onRun"]["args"][1])
        self.assertEqual(job["steps"][1]["dependencies"], [{"dependsOn": "Render"}])
        self.assertEqual(self.template("flamenco").count("--task-count 3"), 3)

    def template(self, engine):
        file = self.folder / engine
        self.expect(2, "submit", *self.asked, "--engine", engine, says="--write")
        self.expect(0, "submit", *self.asked, "--engine", engine, "--tasks", 3, "--write", file)
        return file.read_text(encoding="utf-8")


if __name__ == "__main__":
    test_cli.main(sys.modules[__name__])
