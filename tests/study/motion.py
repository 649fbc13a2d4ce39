"""Animations: scripts, each rendered with several configurations against a reference of every frame."""

import json
import pathlib
from dataclasses import dataclass

import matrix
from matrix import Config, Reference

SCRIPTS = {"orbit-light": 60, "flicker-walk": 60, "door-opens": 60, "teleport": 60, "toggle": 60}  # frames
VPLS = 256
STILL_FRAMES = 64  # averaged by refinement
AT_REST = {"boxes-fall": 24}  # the frame from which on nothing moves


@dataclass(frozen=True)
class Take:
    """One configuration in one script; `fresh_seeds`: different VPLs in every frame, even if nothing moves."""

    id: str
    config: Config
    fresh_seeds: bool = False


@dataclass(frozen=True)
class Motion:
    """`script` is the name of a shipped script, or "still-SCENE": a scene in which nothing moves."""

    suite: str
    script: str
    size: tuple[int, int]
    reference: Reference
    frames: int
    takes: tuple[Take, ...]

    @property
    def name(self) -> str:
        return f"{self.suite}/{self.script}/{self.size[0]}x{self.size[1]}"


def config(vpls: int, placement: str = "paths", refined: bool = False) -> Config:
    """The default configuration of the matrix, with this placement of VPLs."""
    base = matrix.point(vpls).config
    return matrix.merged(base, {"vpls": {"placement": placement}, "refinement": {"enabled": refined}})


def takes() -> tuple[Take, ...]:
    """Paths that are traced again with every move, with new samples or the same ones; and surfels, which are kept."""
    return (
        Take("fresh", config(VPLS), fresh_seeds=True),
        Take("fixed", config(VPLS)),
        Take("surfels", config(VPLS, "surfels")),
    )


def motions() -> list[Motion]:
    """The references have as many bounces as the VPLs, so that only noise is left."""
    reference = Reference(samples=256, bounces=matrix.DEFAULT_BOUNCES)
    moving = [Motion("motion", script, matrix.SMALL, reference, frames, takes()) for script, frames in SCRIPTS.items()]
    refined = tuple(Take(f"refined-{vpls}", config(vpls, refined=True)) for vpls in (64, 256))
    exact = Reference(samples=2048, bounces=matrix.DEFAULT_BOUNCES)
    still = [
        Motion("refinement", f"still-{scene}", matrix.SMALL, exact, STILL_FRAMES, refined) for scene in ("cornell", "two-rooms")
    ]
    return moving + still


def camera_motions() -> list[Motion]:
    """A moving camera: patterns fixed to pixels could crawl over surfaces."""
    takes = tuple(Take(name, matrix.interleaved(1024, n).config) for name, n in (("all", 1), ("shared", 8)))
    reference = Reference(samples=64, bounces=matrix.DEFAULT_BOUNCES)
    return [Motion("camera", "orbit-camera", matrix.SIZE, reference, 30, takes)]


def world_motions() -> list[Motion]:
    """Scripts in worlds larger than a room, as the app plays them."""
    config, reference = matrix.as_app(512).config, Reference(samples=256)
    all_of_it, in_time = Take("surfels", config), Take("budget", matrix.merged(config, {"frame_budget_ms": 60}))
    return [
        Motion("worlds", "walk-in", matrix.SMALL, reference, 120, (all_of_it,)),
        Motion("worlds", "lamp-in-rooms", matrix.SMALL, reference, 60, (all_of_it,)),
        Motion("worlds", "boxes-fall", matrix.SMALL, reference, 40, (all_of_it, in_time)),
    ]


def quick_motions() -> list[Motion]:
    """Few samples are enough: their noise is almost the same in all frames, 1/20 of the limits of the checks."""
    reference = Reference(samples=256, bounces=matrix.DEFAULT_BOUNCES)
    return [Motion("quick", "flicker-walk", (47, 36), reference, 12, takes())]


def scene_of(motion: Motion, shipped: pathlib.Path) -> str:
    """The name of the animated scene. `shipped` is the folder of scripts."""
    if motion.script.startswith("still-"):
        return motion.script.removeprefix("still-")
    return json.loads((shipped / f"{motion.script}.json").read_text(encoding="utf-8"))["scene"]


def script_text(motion: Motion, shipped: pathlib.Path) -> str:
    if motion.script.startswith("still-"):
        return json.dumps({"scene": motion.script.removeprefix("still-"), "frames": motion.frames, "tracks": []})
    return (shipped / f"{motion.script}.json").read_text(encoding="utf-8")


def key_of(motion: Motion, take: Take, circumstances: Config) -> str:
    request = {
        "motion": motion.suite,
        "size": motion.size,
        "reference": vars(motion.reference),
        "frames": motion.frames,
        "take": vars(take),
        **circumstances,
    }
    return matrix.digest(request)
