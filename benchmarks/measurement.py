"""What a render costs and how far it is from the truth: for the benchmarks beside it."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def add_options(parser, size):
    """Those of every table of grid and paths. `size`: the default."""
    parser.add_argument("--size", default=size, help="of the picture")
    parser.add_argument("--grid", nargs="*", default=[], metavar="KEY=VALUE", help="of the lighting grid's shot")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")


def set_keys(keys):
    """Options of `brisance render` for KEY=VALUE."""
    return [option for key in keys for option in ("--set", key)]


def size_keys(size):
    width, height = size.split("x")
    return [f"camera.width={width}", f"camera.height={height}"]


def print_table(columns, of, row):
    """Markdown, row by row: row(one of `of`, a folder for its files)."""
    print(f"| {' | '.join(columns)} |")
    print("|" + " --- |" * len(columns), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for each in of:
            print(row(each, pathlib.Path(folder)), flush=True)


def run(command):
    """Runs a command to its end. Returns its processor time [s] and peak memory [bytes]."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    message = process.stderr.read().decode(errors="replace")
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"{' '.join(command)}\n{message}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def stage(statistics, name):
    """The first stage of that name; one that cost nothing where there is none."""
    return next((s for s in statistics["stages"] if s["name"] == name), {"seconds": 0.0, "detail": {}})


class Measurement:
    """One method on one shot: cost without the certificate, error with it."""

    def __init__(self, build, settings, folder, label):
        command = [str(build / "bin/brisance"), "render", *settings, "--progress", "none", "-o"]
        self.cpu, self.memory = run([*command, str(folder / f"{label}.exr")])
        run([*command, str(folder / f"{label}.certified.exr"), "--certify"])
        self.statistics = json.loads((folder / f"{label}.certified.stats.json").read_text())
        picture = self.statistics["certificate"]["picture"]
        self.interval = picture["error_interval"]
        # Errors below the certificate's noise have an upper bound only.
        self.bounded = picture["error"] is None
        self.error = self.interval[1] if self.bounded else picture["error"]

    def error_text(self):
        if self.bounded:
            return f"below {100.0 * self.error:.1f} %"
        return "{:.1f} % ({:.1f} to {:.1f})".format(*(100.0 * x for x in (self.error, *self.interval)))

    def text(self):
        return f"{self.cpu:.0f} | {self.memory / 2**30:.2f} GiB | {self.error_text()}"


class Paths(Measurement):
    """Traced until they have done something; what they would take to another error, by the law of large numbers."""

    def __init__(self, build, settings, folder, label):
        super().__init__(build, [*settings, "--method", "path"], folder, label)
        self.tracing = stage(self.statistics, "path tracing")["detail"]["cpu_seconds"]

    def cpu_to(self, error):
        """CPU seconds. Tracing grows as the inverse square of the error, the rest of the run stays."""
        return self.cpu + self.tracing * ((self.error / error) ** 2 - 1.0)
