"""Frame times of the shading paths in halls with 64 to 16,384 lights, whose size grows with the number of lights."""

import csv
import pathlib
import subprocess
import tempfile

import scenes

LIGHTS = [64, 256, 1024, 4096, 16384]
MOST_FOR_ALL = 256  # with more lights, paths that visit all of them would take minutes per frame
ALL = ["forward", "deferred"]
LISTED = ["tiled-forward", "forward+", "tiled-deferred", "clustered-forward", "clustered-deferred"]
SIZE = ["--width", "320", "--height", "240"]


def measure(study: pathlib.Path, lights: int, folder: pathlib.Path) -> list[dict[str, str | int | float]]:
    """One row per path: direct light only, without shadows, medians of interleaved rounds."""
    paths = (ALL if lights <= MOST_FOR_ALL else []) + LISTED
    scene = scenes.find(f"hall-{lights}", folder)
    with tempfile.TemporaryDirectory() as scratch:
        table = pathlib.Path(scratch) / "paths.csv"
        options = [*SIZE, "--rounds", "3", "--paths", ",".join(paths), "--csv", table]
        subprocess.run([study, "paths", scene, *options], check=True, stdout=subprocess.DEVNULL)
        with table.open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    return [{"lights": lights, "path": row["path"], "frame_ms": float(row["frame_ms"])} for row in rows]
