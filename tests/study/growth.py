#!/usr/bin/env python3
"""Times the shading paths in halls of 64 to 16,384 lights that grow with their lights, and charts the frame times.

usage: growth.py STUDY_EXECUTABLE OUTPUT_DIRECTORY

Writes growth.csv and growth.png there. Paths that visit all lights are left out where a frame of theirs would take minutes.
"""

import csv
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LIGHTS = [64, 256, 1024, 4096, 16384]
MOST_FOR_ALL = 256
ALL = ["forward", "deferred"]
LISTED = ["tiled-forward", "forward+", "tiled-deferred", "clustered-forward", "clustered-deferred"]
SIZE = ["--width", "320", "--height", "240"]


def measure(study: str, scene: pathlib.Path, lights: int, table: pathlib.Path) -> None:
    paths = (ALL if lights <= MOST_FOR_ALL else []) + LISTED
    subprocess.run(
        [study, "paths", str(scene), *SIZE, "--rounds", "3", "--paths", ",".join(paths), "--csv", str(table)],
        check=True,
    )


def chart(table: pathlib.Path, picture: pathlib.Path) -> None:
    with table.open() as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for path in ALL + LISTED:
        points = sorted((int(row["lights"]), float(row["frame_ms"])) for row in rows if row["path"] == path)
        axes.plot(*zip(*points), marker="o", label=path, linestyle="--" if path in ALL else "-")
    axes.set(xscale="log", yscale="log", xlabel="lights in the hall", ylabel="frame, ms (llvmpipe, 320 × 240)")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=120)


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit("usage: growth.py STUDY_EXECUTABLE OUTPUT_DIRECTORY")
    study, out = sys.argv[1], pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    table = out / "growth.csv"
    table.unlink(missing_ok=True)
    generator = pathlib.Path(__file__).resolve().parents[2] / "sandbox" / "scenes" / "generate.py"
    for lights in LIGHTS:
        subprocess.run([sys.executable, generator, "--out", out, "hall", "--lights", str(lights)], check=True)
        scene = out / f"hall-{lights}.gltf"
        measure(study, scene, lights, table)
        scene.unlink()
    chart(table, out / "growth.png")


if __name__ == "__main__":
    main()
