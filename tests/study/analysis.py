"""What the figures say: the Pareto front, slopes, the best default."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

Row = dict[str, Any]  # one point of results.csv
T = TypeVar("T")

ENDS = ("absorbed", "escaped", "truncated", "roulette")  # of emitted light

# A frame may cost this many times what the yardstick's does: instant radiosity of 256 VPLs, deferred, unbounded,
# without visibility. Twice buys a lever or two, and no more than one doubling of the VPLs.
COST_FACTOR = 2.0
YARDSTICK = {"path": "deferred", "vpls": 256, "bounces": 3, "bound": "infinity", "lever": "none"}


def pareto_front(items: Iterable[T], cost: Callable[[T], float], error: Callable[[T], float]) -> list[T]:
    """Those that nothing beats in one without losing in the other, cheapest first. Of equals, the first."""
    front: list[T] = []
    for item in sorted(items, key=lambda each: (cost(each), error(each))):
        if not front or error(item) < error(front[-1]):
            front.append(item)
    return front


def slope(xs: Sequence[float], ys: Sequence[float]) -> float:
    """Of the straight line through log y against log x, by least squares. Needs two different x."""
    u, v = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mean_u, mean_v = sum(u) / len(u), sum(v) / len(v)
    spread = sum((a - mean_u) ** 2 for a in u)
    if spread == 0.0:
        raise ValueError("a slope needs points at two places at least")
    return sum((a - mean_u) * (b - mean_v) for a, b in zip(u, v)) / spread


def slope_above(rows: Sequence[Row], floor: float) -> float | None:
    """Slope of the indirect light's relMSE over the VPLs, over the points well above the reference's own noise: it
    adds to the measured error, and at a quarter of it bends the slope by less than a tenth."""
    clear = [row for row in rows if row["indirect_rel_mse"] > 4 * floor]
    if len({row["vpls"] for row in clear}) < 3:
        return None
    return slope([row["vpls"] for row in clear], [row["indirect_rel_mse"] for row in clear])


def geometric_mean(values: Sequence[float]) -> float:
    return math.exp(sum(math.log(max(value, 1e-30)) for value in values) / len(values))


def select(rows: Iterable[Row], **wanted: Any) -> list[Row]:
    """Rows that were measured and have these values."""
    return [row for row in rows if not row["failed"] and all(row[name] == value for name, value in wanted.items())]


def candidates(rows: Sequence[Row]) -> list[Row]:
    """The configurations measured on every scene of the matrix: geometric means of their error, and of their cost as a
    multiple of the yardstick's on the same scene, be it after a move of the camera or with all made anew."""
    yardsticks = {row["scene"]: row for row in select(rows, suite="matrix", **YARDSTICK)}
    by_id: dict[str, list[Row]] = {}
    for row in select(rows, suite="matrix"):
        if row["scene"] in yardsticks:
            by_id.setdefault(row["id"], []).append(row)
    found = []
    for name, group in by_id.items():
        if len(group) < len(yardsticks) or group[0]["bounces"] == 0:
            continue
        ratios = {
            time: geometric_mean([row[time] / yardsticks[row["scene"]][time] for row in group])
            for time in ("frame_ms", "full_ms")
        }
        error = geometric_mean([row["total_rel_mse"] for row in group])
        found.append({"id": name, "cost": max(ratios.values()), **ratios, "error": error, "scenes": len(group)})
    return found


def best_default(rows: Sequence[Row]) -> Row | None:
    """Of the front over all scenes, the least error whose cost is at most COST_FACTOR."""
    front = pareto_front(candidates(rows), lambda each: each["cost"], lambda each: each["error"])
    within = [each for each in front if each["cost"] <= COST_FACTOR]
    return min(within, key=lambda each: each["error"]) if within else None
