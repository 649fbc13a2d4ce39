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
# explicitly, so that measurements do not depend on the app's defaults. The memory budgets must be sufficient for the
# shadow maps of all lights: twice the resolution needs four times the memory, and the large hall has 256 cube maps.
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
    "interleave-auto": {"vpls": {"interleave": "auto"}},
    "shadow-maps-half": {"shadows": {"cube_resolution": 256, "map_resolution": 512, "budget_mib": 8192}},
    "shadow-maps-double": {"shadows": {"cube_resolution": 1024, "map_resolution": 2048, "budget_mib": 8192}},
}

# The lever with which each placement is measured.
PLACEMENTS = {"paths": "interleave-auto", "surfels": "surfels"}

# The VPL visibility is a separate axis of the matrix.
MAP_RESOLUTION = 48  # texels per side of a VPL's map
VISIBILITIES: dict[str, Config] = {
    "none": {"visibility": "none"},
    "maps": {"visibility": "maps", "map_resolution": MAP_RESOLUTION},
    "maps-16": {"visibility": "maps", "map_resolution": 16},
    "maps-32": {"visibility": "maps", "map_resolution": 32},
    "maps-128": {"visibility": "maps", "map_resolution": 128},
    "rays": {"visibility": "rays"},
}

COUNTS = [16, 64, 256, 512, 1024, 4096, 16384]
SEEING_COUNTS = [16, 64, 256, 1024]  # of VPLs with visibility
BOUNDS = [0.1, 0.3, 1.0, 3.0, UNBOUNDED]
BOUNCES = [0, 1, 2, 3, 5, 8, DEFAULT_BOUNCES]
TABLE_COUNTS = [128, 192, 256, 320, 384, 448, 512]  # of the student report
TRACER_SAMPLES = [4**i for i in range(7)]

# An odd width and an even height: the camera looks straight into the Cornell box, whose edges run from the corners of
# the picture at 45 degrees. With both even or both odd they would pass through pixel centres, where rounding decides
# which wall is seen, and the renderer and the reference could see different walls.
SIZE, SMALL, QUICK, LARGE, SQUARE = (127, 96), (63, 48), (63, 64), (511, 512), (191, 192)
WIDE = (193, 192)


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


def plain(counts: list[int]) -> list[Point]:
    """Instant radiosity as in the student report, forward and deferred: all VPLs, unbounded, without visibility.
    Forward takes several times as long, so 16,384 VPLs are measured only with deferred."""
    largest = {"forward": 4096, "deferred": 16384}
    return [blind(n, path, bound=UNBOUNDED) for path, most in largest.items() for n in counts if n <= most]


def short_sweep() -> tuple[Point, ...]:
    """The points measured on every scene, from which the default is chosen: every path, and variations of one axis at a
    time around the default."""
    return distinct(
        [point(n, path=path) for path in PATHS for n in (64, 256)]
        + [point(16)]
        + [point(256, bound=bound) for bound in BOUNDS]
        + [point(256, bounces=bounces) for bounces in (1, 3)]
        + [point(256, visibility="maps-32")]
        + [point(n, lever=lever) for n in (256, 512, 1024) for lever in PLACEMENTS.values()]
        + [blind(n) for n in (64, 256, 1024)]
        + [blind(256, path) for path in PATHS]
        + [blind(256, lever=lever) for lever in LEVERS]
        + plain([64, 256, 1024])
    )


def sweep() -> tuple[Point, ...]:
    """The same with more VPLs, with every kind of visibility, and without visibility for the energy account."""
    return distinct(
        [
            *short_sweep(),
            *[point(n, bound=bound) for bound in (DEFAULT_BOUND, UNBOUNDED) for n in SEEING_COUNTS],
            *[point(256, bounces=bounces) for bounces in BOUNCES],
            *[point(256, visibility=visibility) for visibility in VISIBILITIES],
            *[point(n, visibility="rays") for n in (16, 64)],
            *[blind(n) for n in COUNTS],
            *[blind(1024, bounces=bounces) for bounces in BOUNCES],
            *plain(COUNTS),
        ]
    )


def every_path() -> tuple[Point, ...]:
    """A comparison of the paths, for scenes so large that a frame takes a second with a software driver."""
    return distinct([point(64, path=path, seeds=(0,)) for path in PATHS] + [blind(64, seeds=(0,))])


def matrix_groups() -> list[Group]:
    """Error against a reference with unlimited bounces, and time. Small scenes get more samples, points and rounds."""
    exact, sketch = Reference(samples=2048), Reference(samples=512)
    in_full = [
        Group("matrix", scene, SIZE, exact, 3, sweep(), tuple(samples))
        for scene, samples in {
            "cornell": TRACER_SAMPLES,
            "corner": TRACER_SAMPLES[:6],
            "two-rooms": TRACER_SAMPLES[:6],
            "furnace": TRACER_SAMPLES[:6],
        }.items()
    ]
    in_short = [Group("matrix", "glass", SIZE, sketch, 3, short_sweep(), tuple(TRACER_SAMPLES[:4]))]
    large = [
        Group("matrix", scene, SIZE, sketch, 2, every_path(), tuple(TRACER_SAMPLES[:3]))
        for scene in ("fins", "hall-256", "atrium")
    ]
    return in_full + in_short + large


def convergence_groups() -> list[Group]:
    """Error against a reference with the same number of bounces, so that only the noise of VPLs and the light removed
    by bounding the geometry term are left. Scenes without occlusion need no visibility, which allows many VPLs. Scenes
    with occlusion are measured both with and without visibility."""
    reference = Reference(samples=2048, bounces=DEFAULT_BOUNCES)
    all_blind = tuple(blind(n, bound=bound) for bound in BOUNDS for n in COUNTS)
    seeing = tuple(point(n, bound=bound) for bound in BOUNDS for n in SEEING_COUNTS)
    default_blind = tuple(blind(n) for n in COUNTS)
    points = {scene: all_blind for scene in OPEN}
    points |= {scene: distinct([*seeing, *default_blind, point(4096), *rays()]) for scene in HIDDEN}
    return [Group("convergence", scene, SMALL, reference, 0, of_scene) for scene, of_scene in points.items()]


def rays() -> list[Point]:
    return [point(n, visibility="rays") for n in (64, 256, 1024)]


OPEN = ("plates", "sphere", "corner", "furnace")  # scenes without occlusion
EMITTERS = ("lamp", "neon", "court")  # scenes that only surfaces or the sky light
GLOSSY = ("metals", "bath", "helmet")  # scenes of metal, plastic and mirrors
HIDDEN = ("cornell", "two-rooms")  # scenes in which walls and blocks occlude light


def table_groups() -> list[Group]:
    """The student report's table, without visibility as in the report. Only times matter: the reference is coarse."""
    points = tuple(blind(n, path, seeds=(0,)) for n in TABLE_COUNTS for path in PATHS)
    return [Group("table", "cornell", (320, 240), Reference(samples=16), 3, points)]


def growth_groups() -> list[Group]:
    """Times for growing numbers of triangles and of pixels; the references are coarse."""
    points = tuple(blind(64, path, seeds=(0,)) for path in ("forward", "forward+", "deferred", "tiled-deferred"))
    triangles = [
        Group("triangles", f"hills-{cells}", (160, 120), Reference(samples=2), 3, points)
        for cells in (8, 32, 128, 256)
    ]
    pixels = [
        Group("pixels", "cornell", (80 * scale, 60 * scale), Reference(samples=2), 3, points)
        for scale in (1, 2, 4, 8)
    ]
    return triangles + pixels


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
            tuple(TRACER_SAMPLES[:4]),
        )
        for scene, limit in most.items()
    ]


def placement_groups() -> list[Group]:
    """Paths against surfels, with the app's interleaving."""
    points = tuple(point(vpls, lever=lever) for vpls in (256, 1024) for lever in PLACEMENTS.values())
    scenes = ("cornell", "two-rooms", "corner", "furnace", "glass", "hall-256", "fins", "atrium")
    return [Group("placement", scene, SQUARE, Reference(samples=512), 0, points) for scene in scenes]


def emitter_groups() -> list[Group]:
    """Scenes that only surfaces or the sky light."""
    points = tuple(point(vpls, lever="surfels") for vpls in (256, 512, 1024))
    return [Group("emitters", scene, SQUARE, Reference(samples=2048), 0, points) for scene in EMITTERS]


def gloss_groups() -> list[Group]:
    """Scenes with glossy surfaces, one frame with the app's defaults."""
    reference = Reference(samples=256, caustics=False)
    return [Group("gloss", scene, (256, 256), reference, 0, (as_app(512),)) for scene in GLOSSY]


WORLDS = (
    "house@inside", "house@outside", "plane", "boxes", "apartment", "rooms-12@room-2", "rooms-12@room-3",
    "rooms-6@room-6", "street@street", "street@room",
)


QUICK_WORLDS = ("house@inside", "apartment", "rooms-12@room-2")


def as_app(vpls: int, seeds: tuple[int, ...] = (0,)) -> Point:
    """The app's defaults, with this number of surfels."""
    return point(vpls, lever="surfels", seeds=seeds)


def world_groups() -> list[Group]:
    """Worlds larger than the room that is seen; their times are divided by the Cornell box's."""
    points, exact = (as_app(512),), Reference(samples=1024)
    return [Group("worlds", scene, WIDE, exact, 5, points, beside="cornell") for scene in WORLDS]


def estimate_groups() -> list[Group]:
    """The error of the app's defaults as the renderer estimates it, and as it is; that of `worlds` belongs to it, too."""
    scenes = ("cornell", "two-rooms", "corner", "furnace", "glass", "hall-256", "fins", "atrium", "plates", "sphere")
    points, exact = (as_app(512),), Reference(samples=512)
    return [Group("estimate", scene, SQUARE, exact, 0, points) for scene in (*scenes, *EMITTERS)]


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
