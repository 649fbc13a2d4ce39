"""What is measured: groups of points. A point is one configuration; a group is what is measured in one go, its times
in interleaved rounds: one scene at one size against one reference.

A lever that the renderer gains joins the matrix as one line of LEVERS, and as one member of what "none" turns off.
"""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

Config = dict[str, Any]

FORWARD = ["forward", "tiled-forward", "forward+", "clustered-forward"]
DEFERRED = ["deferred", "tiled-deferred", "clustered-deferred"]
PATHS = FORWARD + DEFERRED
DEFAULT_PATH, DEFAULT_BOUNCES, DEFAULT_BOUND = "deferred", 3, 1.0
UNBOUNDED = "infinity"

# name: the part of the configuration that it sets. "none", against which the others are measured, has every lever off,
# and says so: what is measured must not change with the app's defaults.
LEVERS: dict[str, Config] = {
    "none": {"shadows": {"cube_resolution": 512, "map_resolution": 1024}},
    "shadow-maps-half": {"shadows": {"cube_resolution": 256, "map_resolution": 512}},
    "shadow-maps-double": {"shadows": {"cube_resolution": 1024, "map_resolution": 2048}},
}

COUNTS = [16, 64, 256, 1024, 4096, 16384]
BOUNDS = [0.1, 0.3, 1.0, 3.0, UNBOUNDED]
BOUNCES = [0, 1, 2, 3, 5, 8]
TABLE_COUNTS = [128, 192, 256, 320, 384, 448, 512]  # of the student report
TRACER_SAMPLES = [4**i for i in range(7)]


@dataclass(frozen=True)
class Point:
    """`axes`: where it stands in the matrix; `config`: what --config takes, beyond the defaults."""

    axes: Config
    config: Config
    seeds: tuple[int, ...]

    @property
    def id(self) -> str:
        return point_id(self.axes)


@dataclass(frozen=True)
class Reference:
    """`bounces`: indirect ones; None: any depth."""

    samples: int
    bounces: int | None = None
    seed: int = 1


@dataclass(frozen=True)
class Group:
    suite: str
    scene: str
    size: tuple[int, int]
    reference: Reference
    rounds: int  # of times; 0: errors only
    points: tuple[Point, ...]
    tracer_samples: tuple[int, ...] = field(default=())

    @property
    def name(self) -> str:
        return f"{self.suite}/{self.scene}/{self.size[0]}x{self.size[1]}"


def point_id(axes: Config) -> str:
    """Names a point within its group, and its files: no character in it is special to file systems."""
    bound = "none" if axes["bound"] == UNBOUNDED else f"{axes['bound']:g}"
    name = f"{axes['path']}-v{axes['vpls']}-b{axes['bounces']}-g{bound}".replace("+", "-plus")
    return name if axes["lever"] == "none" else f"{name}-{axes['lever']}"


def merged(base: Config, change: Config) -> Config:
    """`base` with the members of `change` put over it, group by group."""
    result = dict(base)
    for name, value in change.items():
        both = isinstance(value, dict) and isinstance(result.get(name), dict)
        result[name] = merged(result[name], value) if both else value
    return result


def seeds_of(vpls: int) -> tuple[int, ...]:
    """Fewer VPLs scatter more. It depends on nothing else, so that no configuration gains from its seeds."""
    return tuple(range(8 if vpls <= 64 else 4 if vpls <= 1024 else 2))


def point(
    vpls: int,
    path: str = DEFAULT_PATH,
    bounces: int = DEFAULT_BOUNCES,
    bound: float | str = DEFAULT_BOUND,
    lever: str = "none",
    seeds: tuple[int, ...] | None = None,
) -> Point:
    axes = {"path": path, "vpls": vpls, "bounces": bounces, "bound": bound, "lever": lever}
    config = {"path": path, "vpls": {"count": vpls, "bounces": bounces, "geometry_bound": bound}}
    config = merged(merged(config, LEVERS["none"]), LEVERS[lever])
    return Point(axes, config, seeds_of(vpls) if seeds is None else seeds)


def distinct(points: Iterable[Point]) -> tuple[Point, ...]:
    """Without repetition, in order."""
    return tuple({each.id: each for each in points}.values())


def sweep(counts: list[int]) -> tuple[Point, ...]:
    """Every axis by itself around the default, for each number of VPLs, and plain instant radiosity: all VPLs,
    unbounded, forward and deferred."""
    return distinct(
        [point(n, path=path) for path in PATHS for n in counts if n <= dearest(path)]
        + [point(n, bound=bound) for bound in BOUNDS for n in counts]
        + [point(n, path="forward", bound=UNBOUNDED) for n in counts if n <= dearest("forward")]
        + [point(n, bounces=bounces) for bounces in BOUNCES for n in counts if 64 <= n <= 4096]
        + [point(n, lever=lever) for lever in LEVERS for n in counts if n in (256, 1024)]
    )


def dearest(path: str) -> int:
    """The most VPLs of the matrix that a path is asked for: forward ones take several times as long, and what is
    learnt from 16,384 VPLs is learnt from one of them."""
    return 16384 if path in DEFERRED else 4096


def paths_only(counts: list[int]) -> tuple[Point, ...]:
    return distinct(point(n, path=path) for path in PATHS for n in counts)


def matrix_groups() -> list[Group]:
    """Error against a reference of any depth, and time. The scenes that few VPLs settle get all counts."""
    size, reference = (128, 96), Reference(samples=4096)
    in_full = [
        Group("matrix", scene, size, reference, 3, sweep(COUNTS), tuple(TRACER_SAMPLES))
        for scene in ("cornell", "corner", "two-rooms", "furnace")
    ]
    in_short = [
        Group("matrix", scene, size, Reference(samples=1024), 3, sweep([64, 256, 1024]), tuple(TRACER_SAMPLES[:5]))
        for scene in ("fins", "glass", "hall-256", "atrium")
    ]
    return in_full + in_short


def convergence_groups() -> list[Group]:
    """Error against a reference of the same number of bounces: all that is left is the VPLs' noise, what bounding
    the geometry term takes away, and what shines through walls."""
    points = distinct(point(n, bound=bound) for bound in BOUNDS for n in COUNTS)
    reference = Reference(samples=4096, bounces=DEFAULT_BOUNCES)
    scenes = ("plates", "sphere", "corner", "furnace", "cornell", "two-rooms")
    return [Group("convergence", scene, (64, 48), reference, 0, points) for scene in scenes]


def table_groups() -> list[Group]:
    """The student report's table. Its times count, not its errors: the reference is a mere sketch."""
    points = tuple(point(n, path=path, seeds=(0,)) for n in TABLE_COUNTS for path in PATHS)
    return [Group("table", "cornell", (320, 240), Reference(samples=16), 3, points)]


def growth_groups() -> list[Group]:
    """Times as triangles and as pixels grow; the references are mere sketches."""
    points = tuple(point(64, path=path, seeds=(0,)) for path in ("forward", "forward+", "deferred", "tiled-deferred"))
    triangles = [
        Group("triangles", f"hills-{cells}", (160, 120), Reference(samples=2), 3, points)
        for cells in (8, 32, 128, 256)
    ]
    pixels = [
        Group("pixels", "cornell", (80 * scale, 60 * scale), Reference(samples=2), 3, points)
        for scale in (1, 2, 4, 8)
    ]
    return triangles + pixels


def quick_groups() -> list[Group]:
    """What the checks of --quick look at. Samples: so many that the reference's noise stays below what is asserted."""
    samples = {"plates": 8192, "sphere": 1024, "cornell": 1024, "corner": 1024, "furnace": 1024, "two-rooms": 256}
    counts = [16, 64, 256, 1024]
    points = distinct(
        [point(n) for n in counts]
        + [point(n, bound=UNBOUNDED) for n in counts]
        + [point(256, path=path) for path in PATHS]
    )
    return [
        Group("quick", scene, (64, 64), Reference(count, DEFAULT_BOUNCES), 1, points, (1, 4, 16, 64))
        for scene, count in samples.items()
    ]


def key_of(group: Group, one: Point, circumstances: Config) -> str:
    """The same for the same measurement under the same circumstances: scene's content, machine, program."""
    request = {
        "suite": group.suite,
        "size": group.size,
        "reference": vars(group.reference),
        "rounds": group.rounds,
        "config": one.config,
        "seeds": one.seeds,
        **circumstances,
    }
    return digest(request)


def digest(value: Any) -> str:
    """Stands for a value of JSON's kinds."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]
