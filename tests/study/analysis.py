"""Evaluates the measurements: slopes, and tables for people."""

import math
import statistics
from collections.abc import Iterable, Sequence
from typing import Any

from motion import AT_REST

Row = dict[str, Any]  # one point of results.csv
ENDS = ("absorbed", "escaped", "truncated", "roulette")  # of emitted light

def slope(xs: Sequence[float], ys: Sequence[float]) -> float:
    """The slope of the least-squares line of log y over log x. Needs at least two different x."""
    u, v = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mean_u, mean_v = sum(u) / len(u), sum(v) / len(v)
    spread = sum((a - mean_u) ** 2 for a in u)
    if spread == 0.0:
        raise ValueError("a slope needs points at two places at least")
    return sum((a - mean_u) * (b - mean_v) for a, b in zip(u, v)) / spread


def select(rows: Iterable[Row], **wanted: Any) -> list[Row]:
    """The rows that were measured successfully and have these values."""
    return [row for row in rows if not row["failed"] and all(row[name] == value for name, value in wanted.items())]


def excess_frames(row: Row, against: Row) -> int:
    """The number of frames with more than 1.2 times the error of another configuration in the same frame."""
    return sum(a > 1.2 * b for a, b in zip(row["indirect_rel_mse"], against["indirect_rel_mse"]))


def flicker_table(played: Sequence[Row]) -> list[Row]:
    """For each script, the flicker of the indirect light, and the ratios of surfels to the others."""
    table = []
    for script in dict.fromkeys(row["scene"] for row in played if row["suite"] != "refinement"):
        found = {row["id"]: row for row in select(played, scene=script)}
        if not {"fresh", "fixed", "surfels"} <= found.keys():
            continue
        flicker = {name: row["indirect_flicker"] for name, row in found.items()}
        line = {"script": script, **flicker}
        for name in ("fresh", "fixed"):
            line[f"surfels_to_{name}"] = flicker["surfels"] / max(flicker[name], 1e-30)
        line["excess_frames"] = excess_frames(found["surfels"], found["fixed"])
        table.append(line)
    return table


def scene_table(rows: Sequence[Row]) -> list[Row]:
    """For each scene: the mean of the indirect light as a multiple of the reference's, errors, the error that the renderer
    has estimated as a multiple of the measured one, and times as multiples of the Cornell box's: of a frame after a camera
    move, and of one that recomputes everything."""
    columns = ("direct_rel_mse", "indirect_rel_mse", "total_rel_mse", "indirect_blotch", "flip", "reference_noise")
    columns += ("frame_ms_to_beside", "full_ms_to_beside")
    table = []
    for row in select(rows, suite="scenes"):
        line = {"scene": row["scene"], "mean": 1 + row["indirect_bias"], **{name: row[name] for name in columns}}
        if "error_estimated" in row:
            line["estimated"] = row["error_estimated"] / max(row["error_measured"], 1e-30)
        table.append(line)
    return table


def world_motion_table(played: Sequence[Row]) -> list[Row]:
    """For each script: the slowest frame after the first, the flicker of the indirect light, also in the worst pair of
    frames, its error, and how fast that of all light settles."""
    table = []
    for row in select(played, suite="worlds"):
        times = row["full_ms"][1:]
        line = {"script": row["scene"], "id": row["id"], "worst_ms": max(times)}
        line["worst_to_median"] = max(times) / statistics.median(times)
        # Within a budget, direct light has fewer pixels, too, and indirect light is not the difference.
        if row["id"] != "budget":
            line["flicker"] = row["indirect_flicker"]
            line["worst_flicker"] = max(row["flicker_of_pairs"])
            line["rel_mse"] = statistics.mean(row["indirect_rel_mse"])
        if row["scene"] in AT_REST:
            line["settled_after"] = frames_until_settled(row["total_rel_mse"][AT_REST[row["scene"]] :])
        table.append(line)
    return table


def frames_until_settled(errors: Sequence[float]) -> int:
    """The number of frames before the error stays within 1.2 times that of the last frame."""
    return next((i + 1 for i in reversed(range(len(errors))) if errors[i] > 1.2 * errors[-1]), 0)


def time_to_error(curve: Sequence[tuple[float, float]], error: float) -> float | None:
    """The time at which a curve of points (time, error) first reaches an error; linear between logarithms. None if it
    never does."""
    points = sorted(curve)
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= error < e0:
            share = math.log(e0 / error) / math.log(e0 / e1)
            return t0 * (t1 / t0) ** share
    return points[0][0] if points and points[0][1] <= error else None


AIM = 0.03  # relMSE of the total light at which the times of the methods are compared


def gather_table(rows: Sequence[Row], tracer: Sequence[Row]) -> list[Row]:
    """For each scene: the error of 8 × 8 interleaving relative to none at 1,024 VPLs, the frame time after a camera
    move relative to that of 128 VPLs, and the shortest time to the error AIM relative to the path tracer's."""
    table = []
    for scene in dict.fromkeys(row["scene"] for row in select(rows, suite="gather")):
        found = {(row["vpls"], row["lever"]): row for row in select(rows, suite="gather", scene=scene)}
        if not {(1024, "none"), (1024, "interleave-8"), (128, "interleave-2")} <= found.keys():
            continue
        all_asked, shared, few = found[1024, "none"], found[1024, "interleave-8"], found[128, "interleave-2"]
        line: Row = {"scene": scene}
        for part in ("indirect", "total"):
            line[f"{part}_to_all"] = shared[f"{part}_rel_mse"] / all_asked[f"{part}_rel_mse"]
        line["frame_to_128"] = shared["frame_ms"] / few["frame_ms"]
        line["frame_to_all"] = shared["frame_ms"] / all_asked["frame_ms"]
        traced_here = [row for row in tracer if row["suite"] == "gather" and row["scene"] == scene]
        curve = [(row["ms"], row["total_rel_mse"]) for row in traced_here]
        traced = time_to_error(curve, AIM)
        for time in ("frame_ms", "full_ms"):
            least = min((row[time] for row in found.values() if row["total_rel_mse"] <= AIM), default=None)
            line[f"{time}_to_tracer"] = least / traced if least and traced else None
        table.append(line)
    return table


def camera_flicker(played: Sequence[Row]) -> list[Row]:
    """For each script in which the camera moves, the flicker of the indirect light if every pixel gathers all VPLs, and
    if every pixel gathers one in 64."""
    table = []
    for script in dict.fromkeys(row["scene"] for row in select(played, suite="camera")):
        found = {row["id"]: row["indirect_flicker"] for row in select(played, suite="camera", scene=script)}
        if {"all", "shared"} <= found.keys():
            ratio = found["shared"] / max(found["all"], 1e-30)
            table.append({"script": script, **found, "shared_to_all": ratio})
    return table
