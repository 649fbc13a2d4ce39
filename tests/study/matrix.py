"""What is measured: groups of points. A point is one configuration. A group is measured together, with times in
interleaved rounds: one scene at one size against one reference.

A new setting ("lever") of the renderer needs a line in LEVERS, and a member in the line "none", which turns it off.
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
DEFAULT_PATH, DEFAULT_BOUNCES, DEFAULT_BOUND, DEFAULT_VISIBILITY = "deferred", 64, 1.0, "maps"
UNBOUNDED = "infinity"

# name: the part of the configuration that it sets. "none", with which the others are compared, turns every lever off
# explicitly, so that measurements do not depend on the app's defaults.
LEVERS: dict[str, Config] = {
    "none": {
        "shadows": {"cube_resolution": 512, "map_resolution": 1024},
        "vpls": {"placement": "paths", "visibility": "none", "interleave": 1},
        "refinement": {"enabled": False},
    },
    "surfels": {"vpls": {"placement": "surfels", "interleave": "auto"}},
    "interleave-2": {"vpls": {"interleave": 2}},
    "interleave-4": {"vpls": {"interleave": 4}},
    "interleave-8": {"vpls": {"interleave": 8}},
}

# The VPL visibility is a separate axis of the matrix.
VISIBILITIES: dict[str, Config] = {"none": {"visibility": "none"}, "maps": {"visibility": "maps", "map_resolution": 48}}

# An odd width and an even height: the camera looks straight into the Cornell box, whose edges run from the corners of
# the picture at 45 degrees. With both even or both odd they would pass through pixel centres, where rounding decides
# which wall is seen, and the renderer and the reference could see different walls.
SIZE, SMALL, QUICK, LARGE, WIDE = (127, 96), (63, 48), (63, 64), (511, 512), (193, 192)


@dataclass(frozen=True)
class Point:
    """`axes`: its position in the matrix; `config`: the differences from the defaults, for --config."""

    axes: Config
    config: Config
    seeds: tuple[int, ...]

    @property
    def id(self) -> str:
        return point_id(self.axes)


@dataclass(frozen=True)
class Reference:
    """`bounces`: indirect bounces; None: unlimited. `caustics`: light that glossy surfaces throw on others as they are,
    rather than as Lambertian ones of equal albedo, as the renderer has it."""

    samples: int
    bounces: int | None = None
    seed: int = 1
    caustics: bool = True


@dataclass(frozen=True)
class Group:
    suite: str
    scene: str
    size: tuple[int, int]
    reference: Reference
    rounds: int  # of time measurements; 0: errors only
    points: tuple[Point, ...]
    tracer_samples: tuple[int, ...] = field(default=())
    beside: str = ""  # a scene that is timed in turns with this one

    @property
    def name(self) -> str:
        return f"{self.suite}/{self.scene}/{self.size[0]}x{self.size[1]}"


def point_id(axes: Config) -> str:
    """The name of a point within its group and in file names; has no characters that are special in file systems."""
    bound = "none" if axes["bound"] == UNBOUNDED else f"{axes['bound']:g}"
    name = f"{axes['path']}-v{axes['vpls']}-b{axes['bounces']}-g{bound}-{axes['visibility']}".replace("+", "-plus")
    return name if axes["lever"] == "none" else f"{name}-{axes['lever']}"


def merged(base: Config, change: Config) -> Config:
    """`base` with its members replaced by those of `change`, recursively."""
    result = dict(base)
    for name, value in change.items():
        both = isinstance(value, dict) and isinstance(result.get(name), dict)
        result[name] = merged(result[name], value) if both else value
    return result


def seeds_of(vpls: int) -> tuple[int, ...]:
    """Fewer VPLs are noisier and get more seeds. Depends on nothing else, so that no configuration has an advantage."""
    return tuple(range(8 if vpls <= 64 else 4 if vpls <= 1024 else 2))


def point(
    vpls: int,
    path: str = DEFAULT_PATH,
    bounces: int = DEFAULT_BOUNCES,
    bound: float | str = DEFAULT_BOUND,
    visibility: str = DEFAULT_VISIBILITY,
    lever: str = "none",
    seeds: tuple[int, ...] | None = None,
) -> Point:
    axes = {"path": path, "vpls": vpls, "bounces": bounces, "bound": bound, "visibility": visibility, "lever": lever}
    config = merged(LEVERS["none"], LEVERS[lever])
    vpls_config = {"count": vpls, "bounces": bounces, "geometry_bound": bound, **VISIBILITIES[visibility]}
    config = merged(config, {"path": path, "vpls": vpls_config})
    return Point(axes, config, seeds_of(vpls) if seeds is None else seeds)


def distinct(points: Iterable[Point]) -> tuple[Point, ...]:
    """The points without duplicates, in order."""
    return tuple({each.id: each for each in points}.values())


def blind(vpls: int, path: str = DEFAULT_PATH, **axes: Any) -> Point:
    """A point without VPL visibility."""
    return point(vpls, path=path, visibility="none", **axes)


OPEN = ("plates", "sphere", "corner", "furnace")  # scenes without occlusion
GLOSSY = ("metals", "bath", "helmet")  # scenes of metal, plastic and mirrors


def interleaved(vpls: int, n: int) -> Point:
    return point(vpls, lever="none" if n == 1 else f"interleave-{n}", seeds=tuple(range(4 if vpls <= 1024 else 1)))


SURFELS = [128, 256, 512, 1024, 4096]  # interleaved as in the app
# Numbers of VPLs on paths, by interleaving: limited, because a frame could take minutes.
GATHERED = {1: [64, 128, 256, 1024], 2: [64, 128, 256, 1024], 4: [256, 1024, 4096], 8: [1024, 4096, 16384]}


def gather_groups() -> list[Group]:
    """Error against time for interleavings and numbers of VPLs, at a size at which per-pixel work dominates. In scenes
    with many triangles, the maps of the largest numbers of VPLs would take minutes."""
    most = {"cornell": 16384, "two-rooms": 16384, "glass": 4096, "fins": 4096, "atrium": 4096}
    return [
        Group(
            "gather",
            scene,
            LARGE,
            Reference(samples=256),
            2,
            tuple(interleaved(vpls, n) for n, counts in GATHERED.items() for vpls in counts if vpls <= limit)
            + tuple(point(vpls, lever="surfels", seeds=(0,)) for vpls in SURFELS),
            (1, 4, 16, 64),
        )
        for scene, limit in most.items()
    ]


SCENES = (
    "cornell", "two-rooms", "corner", "furnace", "plates", "sphere", "glass", "hall-256", "fins", "atrium", "lamp", "neon",
    "court", *GLOSSY, "house@inside", "house@outside", "plane", "boxes", "apartment", "rooms-12@room-2",
    "rooms-12@room-3", "rooms-6@room-6", "street@street", "street@room",
)
QUICK_WORLDS = ("house@inside", "apartment", "rooms-12@room-2")


def as_app(vpls: int, seeds: tuple[int, ...] = (0,)) -> Point:
    """The app's defaults, with this number of surfels."""
    return point(vpls, lever="surfels", seeds=seeds)


def scene_groups() -> list[Group]:
    """All scenes with the app's defaults; their times are divided by the Cornell box's, measured in turns."""
    references = {scene: Reference(samples=1024, caustics=scene not in GLOSSY) for scene in SCENES}
    return [
        Group("scenes", scene, WIDE, reference, 3, (as_app(512),), beside="cornell")
        for scene, reference in references.items()
    ]


SURFEL_COUNTS = [4**i for i in range(4, 9)]


def surfel_groups() -> list[Group]:
    """What more surfels do for the error, and what they cost."""
    points, exact = tuple(as_app(vpls) for vpls in SURFEL_COUNTS), Reference(samples=1024)
    return [Group("surfels", scene, WIDE, exact, 1, points) for scene in ("cornell", "house@inside")]


def quick_groups() -> list[Group]:
    """The points that the checks of --quick use. The references have enough samples that their noise stays below the
    limits of the checks.

    No check uses times: they are measured in one scene only to test measuring them."""
    samples = {"plates": 8192, "sphere": 1024, "cornell": 1024, "corner": 1024, "furnace": 1024, "two-rooms": 256}
    counts = [16, 64, 256, 1024]
    blind_too = distinct(
        [blind(n) for n in counts]
        + [blind(n, bound=UNBOUNDED) for n in counts]
        + [blind(256, path) for path in PATHS]
    )
    seeing = distinct([point(n) for n in counts] + [point(256, path=path) for path in PATHS] + [blind(1024)])
    four = as_app(512, seeds=(0, 1, 2, 3))
    worlds = [Group("quick-worlds", scene, QUICK, Reference(512), 0, (four,)) for scene in QUICK_WORLDS]
    return worlds + [
        Group(
            "quick",
            scene,
            QUICK,
            Reference(count, DEFAULT_BOUNCES),
            1 if scene == "plates" else 0,
            (*(blind_too if scene in OPEN else seeing), as_app(512)),
            (1, 4, 16, 64),
        )
        for scene, count in samples.items()
    ]


def key_of(group: Group, one: Point, circumstances: Config) -> str:
    """Identifies a measurement under its circumstances: content of the scene, machine, program."""
    request = {
        "suite": group.suite,
        "size": group.size,
        "reference": vars(group.reference),
        "rounds": group.rounds,
        "beside": group.beside,
        "config": one.config,
        "seeds": one.seeds,
        **circumstances,
    }
    return digest(request)


def digest(value: Any) -> str:
    """Identifies a JSON value."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]
