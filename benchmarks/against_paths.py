#!/usr/bin/env python3
"""What shots cost by the lighting grid and by paths to the same error, and what the grid believes of its own error.

One row for each shot: CPU seconds, peak memory, certified error with its 95 % interval, the error that the frame
believed, and over the certified one; what paths have after some seconds, and what they would need for the grid's error.

    benchmarks/against_paths.py > shots.md                        # all that come with Brisance, at 160 x 90
    benchmarks/against_paths.py shots/hall.json --size 640x360 --grid lighting.error=0.01

CPU seconds and memory are those of runs without the certificate, as the operating system counts them.
"""

import argparse
import pathlib

from measurement import ROOT, Measurement, Paths, add_options, print_table, set_keys, size_keys


def believed(grid):
    """Error that the frame believed of its picture, and over the certified one."""
    picture = grid.statistics["believed_error"]["picture"]
    ratio = "-" if grid.bounded else f"{picture['error'] / grid.error:.2f}"
    return f"{100.0 * picture['error']:.1f} % | {ratio}"


def row(arguments, shot, folder):
    settings = [str(shot), *set_keys(size_keys(arguments.size))]
    grid = Measurement(arguments.build, [*settings, "--method", "lighting_grid", *set_keys(arguments.grid)], folder,
                       "grid")
    until = ["tracing.samples=none", f"tracing.seconds={arguments.seconds}"]
    paths = Paths(arguments.build, [*settings, *set_keys(until)], folder, "paths")
    needed = paths.cpu_to(grid.error)
    return (f"| `{shot.stem}` | {grid.text()} | {believed(grid)} | {paths.cpu:.0f} | "
            f"{paths.error_text()} | {needed:,.0f} | {needed / grid.cpu:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ours = [ROOT / "shots" / f"{name}.json" for name in ("explosion", "fire_room", "hall", "street")]
    parser.add_argument("shots", type=pathlib.Path, nargs="*", help="all that come with Brisance by default",
                        default=ours + sorted((ROOT / "shots/media").glob("*.json")))
    parser.add_argument("--seconds", type=float, default=30.0, help="of wall time for paths")
    add_options(parser, "160x90")
    arguments = parser.parse_args()
    print_table(["shot", "grid: CPU s", "memory", "error", "believed", "over certified", "paths: CPU s", "error",
                 "paths to the grid's error, CPU s", "ratio"],
                arguments.shots, lambda shot, folder: row(arguments, shot, folder))


if __name__ == "__main__":
    main()
