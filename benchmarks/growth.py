#!/usr/bin/env python3
"""How cost grows with the resolution of a volume: the lighting grid beside the path tracer, in one run.

The volume of a shot is refined 1, 2, 4, ... times along each axis (brisance_refine adds deterministic detail), rendered
by both methods, and certified. One row for each refinement: active voxels, pixels, CPU seconds, peak memory, certified
error with its 95 % interval, and what paths would need for the grid's error: their tracing grows as the inverse square
of the error, the rest of the run stays.

    benchmarks/growth.py --factors 1 2 4 > growth.md
    benchmarks/growth.py --shot shots/explosion.json --size 640x360 --factors 1 2

CPU seconds and memory are those of runs without the certificate, as the operating system counts them.
"""

import argparse
import math
import pathlib

from measurement import ROOT, Measurement, Paths, add_options, print_table, run, set_keys, size_keys, stage


def row(arguments, factor, folder):
    volume = folder / f"refined{factor}.vdb"
    run([str(arguments.build / "benchmarks/brisance_refine"), str(arguments.volume), str(volume), str(factor)])
    settings = [str(arguments.shot), *set_keys([f"volume.file={volume}", *size_keys(arguments.size)])]
    grid = Measurement(arguments.build, [*settings, *set_keys(arguments.grid)], folder, f"grid{factor}")
    paths = Paths(arguments.build, [*settings, "--set", f"tracing.samples={arguments.samples}"], folder,
                  f"paths{factor}")
    voxels = stage(grid.statistics, "medium")["detail"]["absorbing_nodes"]
    pixels = math.prod(int(side) for side in arguments.size.split("x"))
    needed = paths.cpu_to(grid.error)
    volume.unlink()
    return (f"| {voxels:,} | {pixels:,} | {grid.text()} | {paths.text()} | {needed:,.0f} | "
            f"{needed / grid.cpu:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shot", type=pathlib.Path, default=ROOT / "shots/explosion.json")
    parser.add_argument("--volume", type=pathlib.Path, default=ROOT / "volumes/explosion.vdb", help="the shot's")
    parser.add_argument("--factors", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--samples", type=int, default=2, help="paths per pixel")
    add_options(parser, "1280x720")
    arguments = parser.parse_args()
    print_table(["active voxels", "pixels", "grid: CPU s", "memory", "error", "paths: CPU s", "memory", "error",
                 "paths to the grid's error, CPU s", "ratio"],
                arguments.factors, lambda factor, folder: row(arguments, factor, folder))


if __name__ == "__main__":
    main()
