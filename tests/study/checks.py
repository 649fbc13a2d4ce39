"""The checks of --quick, which must hold on any machine. They do not involve times."""

import math
from collections.abc import Iterator, Sequence

import analysis
import matrix
from analysis import Row, select

Check = tuple[str, bool, str]  # what must hold, whether it does, the values

# Scenes in which light reaches everything: only noise of VPLs and the light removed by bounding are left as errors.
OPEN = matrix.OPEN
# N independent samples have a variance of 1/N: a slope of -1. The samples of VPLs and of the path tracer are scrambled
# nets, whose variance falls as N^-3 at best (Owen, "Scrambled net variance for integrals of smooth functions", 1997).
# A flatter slope means convergence to an integral other than the reference's. For VPLs this holds if nothing is
# occluded and no two surfaces that light each other touch.
SLOPES = (-3.0, -0.9)
# At 1,024 VPLs the plates have a relMSE of 0.004. Even if all of that were a uniform shift of the picture, its mean
# over four seeds would have a standard deviation of √0.004 / 2 = 0.03.
UNBIASED = 0.03
# Bounding removes light where surfaces meet: less than this in the furnace and the corner with 1,024 VPLs.
BOUNDED_BIAS = (-0.15, 0.03)
# All paths use the same evaluator, and G-buffers hold all its inputs: they differ only by rounding.
PATHS_AGREE = 1e-3
# Away from shadow edges, shadow maps are exact. Direct light differs only by rounding, mainly of positions.
DIRECT_OFF_EDGES = 1e-4
# The largest error of the indirect light with 1,024 VPLs with visibility, as a share of the error without. What remains
# is the noise of the VPLs. In the Cornell box it is a share of 0.17, with a standard deviation of 0.02 for the mean of
# four seeds (measured over 16 seeds); the limit is four standard deviations above.
SEEN_SHARES = {"cornell": 0.25, "two-rooms": 0.2}
# In worlds larger than the room that is seen, with the app's defaults, means over four seeds: the largest relative error of
# the mean of the indirect light, the largest relMSE and blotch of the indirect light and the largest FLIP of all light. Light
# that comes through a door or a window is the hardest. Surfels that are spread evenly over the whole world have a relMSE above
# 0.9 in the house. A seed's bias, relMSE, blotch and FLIP have standard deviations of up to 0.025, 0.0008, 0.0011 and 0.016
# in the house, of a third of that elsewhere. Each limit is more than three deviations of a mean of four above the figure,
# and about twice the figure, as any change of where surfels are is another draw.
WORLDS = {
    "house@inside": (0.09, 0.005, 0.005, 0.14),
    "apartment": (0.06, 0.005, 0.004, 0.10),
    "rooms-12@room-2": (0.04, 0.004, 0.003, 0.085),
}
# The largest residual of the energy account, as a share of the emitted flux: sums of thousands of 32-bit floats.
ENERGY = 1e-3
# The renderer's estimate of its error is within this factor of the measured one, in this share of all cases. Errors below
# 4 %, a relMSE of 0.002, are equally invisible. They are not told apart: in them, what all sets of surfels have in common
# outweighs what differs.
ESTIMATE_FACTOR, ESTIMATE_SHARE, INVISIBLE = 2.0, 0.9, 0.002


def series(rows: Sequence[Row], scene: str, bound: float | str) -> list[Row]:
    """The points of a scene by number of VPLs; with VPL visibility if the scene has occlusion."""
    visibility = "none" if scene in OPEN else matrix.DEFAULT_VISIBILITY
    chosen = select(rows, scene=scene, path=matrix.DEFAULT_PATH, bound=bound, visibility=visibility, lever="none")
    return sorted(chosen, key=lambda row: row["vpls"])


def figures(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.3g}" for value in values)


def all_measured(rows: Sequence[Row]) -> Iterator[Check]:
    for scene in names(rows):
        failed = [f"{row['id']}: {row['failed']}" for row in rows if row["scene"] == scene and row["failed"]]
        yield f"{scene}: every point is measured", not failed, "; ".join(failed)
    strange = [f"{row['id']}: {name}" for row in rows for name, value in row.items() if not is_finite(value)]
    yield "no value is NaN or infinite", not strange, ", ".join(strange)


def is_finite(value: object) -> bool:
    return not isinstance(value, float) or math.isfinite(value)


def names(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(row["scene"] for row in rows))


def errors_fall(rows: Sequence[Row]) -> Iterator[Check]:
    """With the default bound."""
    for scene in names(rows):
        errors = [row["indirect_rel_mse"] for row in series(rows, scene, matrix.DEFAULT_BOUND)]
        falls = len(errors) > 1 and all(after < before for before, after in zip(errors, errors[1:]))
        yield f"{scene}: the error of the indirect light decreases with the number of VPLs", falls, figures(errors)


def obstacles_seen(rows: Sequence[Row]) -> Iterator[Check]:
    def error(scene: str, visibility: str) -> float:
        axes = {"path": matrix.DEFAULT_PATH, "vpls": 1024, "bound": matrix.DEFAULT_BOUND, "visibility": visibility}
        return next((row["indirect_rel_mse"] for row in select(rows, scene=scene, **axes)), math.inf)

    for scene in [name for name in SEEN_SHARES if name in names(rows)]:
        seeing, blind = error(scene, "maps"), error(scene, "none")
        holds = math.isfinite(blind) and seeing <= SEEN_SHARES[scene] * blind
        yield f"{scene}: maps leave at most {SEEN_SHARES[scene]} of the error", holds, figures([seeing, blind])


def flicker_falls(played: Sequence[Row]) -> Iterator[Check]:
    """Surfels flicker less than VPLs on paths that are traced again in every frame."""
    for script in names(played):
        failed = [f"{row['id']}: {row['failed']}" for row in played if row["scene"] == script and row["failed"]]
        yield f"{script}: every configuration is rendered", not failed, "; ".join(failed)
        found = {row["id"]: row["indirect_flicker"] for row in select(played, scene=script)}
        holds = len(found) == 3 and found["surfels"] < min(found["fresh"], found["fixed"])
        yield f"{script}: surfels flicker least", holds, figures(list(found.values()))


def direct_light_right(rows: Sequence[Row]) -> Iterator[Check]:
    for scene in names(rows):
        measured = select(rows, scene=scene)
        errors = [row["direct_off_edges_rel_mse"] for row in measured if "direct_off_edges_rel_mse" in row]
        holds = max(errors, default=1) <= DIRECT_OFF_EDGES
        yield f"{scene}: direct light is correct away from shadow edges", holds, figures(errors[:1])


def energy_accounted(rows: Sequence[Row]) -> Iterator[Check]:
    """Of VPLs on paths."""
    for scene in names(rows):
        measured = select(rows, scene=scene, lever="none")
        sums = [sum(row[f"{end}_share"] for end in analysis.ENDS) for row in measured]
        worst = max((abs(share - 1) for share in sums), default=1.0)
        yield f"{scene}: emitted light is accounted for", worst <= ENERGY, f"off by {worst:.2g}"


def slopes_in_band(rows: Sequence[Row]) -> Iterator[Check]:
    for bound in (matrix.DEFAULT_BOUND, matrix.UNBOUNDED) if "plates" in names(rows) else ():
        chosen = series(rows, "plates", bound)
        errors = [(row["vpls"], row["indirect_rel_mse"]) for row in chosen]
        measured = len(errors) > 2 and all(error > 0 for _, error in errors)
        found = analysis.slope(*zip(*errors)) if measured else math.nan
        holds = SLOPES[0] <= found <= SLOPES[1]
        yield f"plates, bound {bound}: the slope is from {SLOPES[0]} to {SLOPES[1]}", holds, str(found)


def worlds_right(rows: Sequence[Row]) -> Iterator[Check]:
    for row in select(rows):
        found = [abs(row["indirect_bias"]), row["indirect_rel_mse"], row["indirect_blotch"], row["flip"]]
        holds = all(value <= most for value, most in zip(found, WORLDS[row["scene"]]))
        yield f"{row['scene']}: bias, relMSE, blotch and FLIP are within limits", holds, figures(found)


def tracer_slopes(tracer: Sequence[Row]) -> Iterator[Check]:
    for scene in names(tracer):
        chosen = [row for row in tracer if row["scene"] == scene]
        found = analysis.slope([row["samples"] for row in chosen], [row["indirect_rel_mse"] for row in chosen])
        least, most = SLOPES
        yield f"{scene}: the path tracer's slope is from {least} to {most}", least <= found <= most, figures([found])


def biases_bounded(rows: Sequence[Row]) -> Iterator[Check]:
    bands = {matrix.UNBOUNDED: (-UNBIASED, UNBIASED), matrix.DEFAULT_BOUND: BOUNDED_BIAS}
    for scene in [name for name in names(rows) if name in OPEN]:
        for bound, (least, most) in bands.items():
            bias = [row["indirect_bias"] for row in series(rows, scene, bound)][-1:]
            holds = bool(bias) and least <= bias[0] <= most
            yield f"{scene}, bound {bound}: bias from {least} to {most}", holds, figures(bias)


def paths_agree(rows: Sequence[Row]) -> Iterator[Check]:
    for scene in names(rows):
        visibility = "none" if scene in OPEN else matrix.DEFAULT_VISIBILITY
        chosen = select(rows, scene=scene, vpls=256, bound=matrix.DEFAULT_BOUND, visibility=visibility)
        errors = {row["path"]: row["total_rel_mse"] for row in chosen}
        holds = len(errors) == len(matrix.PATHS) and max(errors.values()) <= min(errors.values()) * (1 + PATHS_AGREE)
        yield f"{scene}: all paths have the same error", holds, figures(list(errors.values()))


def errors_estimated(rows: Sequence[Row]) -> Iterator[Check]:
    """Of all points with surfels."""
    ratios = {}
    for row in rows:
        if "error_estimated" in row:
            estimated, measured = (max(row[f"error_{name}"], INVISIBLE) for name in ("estimated", "measured"))
            ratios[f"{row['scene']}, {row['vpls']}"] = estimated / measured
    within = [ratio for ratio in ratios.values() if 1 / ESTIMATE_FACTOR <= ratio <= ESTIMATE_FACTOR]
    seen = "; ".join(f"{name}: {ratio:.2f}" for name, ratio in ratios.items())
    yield "the error is estimated within a factor of 2", len(within) >= ESTIMATE_SHARE * len(ratios), seen


def run(rows: Sequence[Row], tracer: Sequence[Row], played: Sequence[Row]) -> int:
    """All checks of --quick: see report."""
    worlds = [row for row in rows if row["suite"] == "quick-worlds"]
    rows = [row for row in rows if row["suite"] == "quick"]
    found: list[Check] = []
    errors = (errors_fall, obstacles_seen, slopes_in_band, biases_bounded, direct_light_right)
    for make in (all_measured, *errors, paths_agree, energy_accounted, errors_estimated):
        found += make(rows)
    found += [*all_measured(worlds), *worlds_right(worlds)]
    found += tracer_slopes(tracer)
    found += flicker_falls(played)
    return report(found)


def report(found: Sequence[Check]) -> int:
    """Prints the failed checks and the number of passed ones. Returns the exit status."""
    failed = [check for check in found if not check[1]]
    for what, _, seen in failed:
        print(f"study: FAILED {what} ({seen})")
    print(f"study: {len(found) - len(failed)} checks passed" + (f", {len(failed)} failed" if failed else ""))
    return 1 if failed else 0
