#!/usr/bin/env python3
"""Light between surfaces by virtual lights and by paths: mean square error times processor time.

Both are rendered several times with other random numbers and compared with a reference of paths in two independent
halves, whose own noise is thereby removed. One row for each shot and cell: processor seconds and error of either, and
the ratio of mean square error times processor seconds. ± is the standard error of the mean over the repeats. What
virtual lights have of bias counts as their error.

    benchmarks/between_surfaces.py > between_surfaces.md          # `SS` of three shots that come with Brisance
    benchmarks/between_surfaces.py shots/street.json --cells SS SM --reference-samples 256

Seconds are those of whole frames: virtual lights pay for all light of the picture, not for these cells alone.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys

from measurement import ROOT, add_options, print_table, run, set_keys, size_keys

REFERENCE_SEEDS = (101, 102)


def render(arguments, shot, keys, image, *options):
    """Processor seconds of one picture, which does not ask for its own error."""
    settings = [*size_keys(arguments.size), "certify.belief=0", *keys]
    cpu, _ = run([str(arguments.build / "bin/brisance"), "render", str(shot), *set_keys(settings), *options,
                  "--progress", "none", "-o", str(image)])
    return cpu


def mean_square_error(arguments, image, reference, cell):
    """Over the reference's mean square, without the reference's noise."""
    command = [str(arguments.build / "bin/brisance"), "compare", str(image), *map(str, reference), "--force",
               "--layers", cell, "--json"]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    if finished.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{finished.stderr}")
    error = json.loads(finished.stdout)["frames"][0]["layers"][0]["noise_free"]
    if not error:
        sys.exit(f"{image.name}: {cell}: the error is below the reference's noise; use more --reference-samples")
    return error * error


class Repeats:
    """One method, several times."""

    def __init__(self, arguments, shot, reference, folder, label, keys_of, *options):
        self.errors = {cell: [] for cell in arguments.cells}
        cpu = []
        for seed in range(1, arguments.repeats + 1):
            image = folder / f"{label}.exr"
            cpu.append(render(arguments, shot, keys_of(seed), image, *options))
            for cell in arguments.cells:
                self.errors[cell].append(mean_square_error(arguments, image, reference, cell))
        self.cpu = statistics.mean(cpu)

    def mean(self, cell):
        return statistics.mean(self.errors[cell])

    def relative_spread(self, cell):
        """Standard error of the mean square error, over it."""
        deviation = statistics.stdev(self.errors[cell]) / math.sqrt(len(self.errors[cell]))
        return deviation / self.mean(cell)

    def text(self, cell):
        error = math.sqrt(self.mean(cell))
        return f"{self.cpu:.0f} | {100.0 * error:.1f} ± {50.0 * error * self.relative_spread(cell):.1f} %"


def rows(arguments, shot, folder):
    reference = []
    for seed in REFERENCE_SEEDS:
        reference.append(folder / f"reference{seed}.exr")
        render(arguments, shot, [f"tracing.seed={seed}", f"tracing.samples={arguments.reference_samples}"],
               reference[-1], "--method", "path")
    lights = Repeats(arguments, shot, reference, folder, "lights",
                     lambda seed: [f"virtual_lights.seed={seed}", "correction.samples=0", *arguments.grid])
    paths = Repeats(arguments, shot, reference, folder, "paths",
                    lambda seed: [f"tracing.seed={seed}", f"tracing.samples={arguments.samples}"], "--method", "path")
    out = []
    for cell in arguments.cells:
        ratio = paths.mean(cell) * paths.cpu / (lights.mean(cell) * lights.cpu)
        spread = ratio * math.hypot(lights.relative_spread(cell), paths.relative_spread(cell))
        out.append(f"| `{shot.stem}` | `{cell}` | {lights.text(cell)} | {paths.text(cell)} | "
                   f"{ratio:.0f} ± {spread:.0f} |")
    return "\n".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ours = [ROOT / "shots" / f"{name}.json" for name in ("fire_room", "hall", "media/door_ajar")]
    parser.add_argument("shots", type=pathlib.Path, nargs="*", help="three of ours by default", default=ours)
    parser.add_argument("--cells", nargs="+", default=["SS"], help="of the ledger; default SS")
    parser.add_argument("--repeats", type=int, default=3, help="of either method, 2 at least")
    parser.add_argument("--samples", type=int, default=32, help="of a pixel, by paths that compete")
    parser.add_argument("--reference-samples", type=int, default=1024, help="of a pixel, of each half")
    add_options(parser, "160x90")
    arguments = parser.parse_args()
    if arguments.repeats < 2:
        parser.error("--repeats: 2 at least, for an error of the mean")
    print_table(["shot", "cell", "virtual lights: CPU s", "error", "paths: CPU s", "error",
                 "mean square error x time, paths over lights"],
                arguments.shots, lambda shot, folder: rows(arguments, shot, folder))


if __name__ == "__main__":
    main()
