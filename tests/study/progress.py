"""Estimates the remaining time of a study with a cost model that learns from measurements, and shows a progress bar."""

import sys
import time
from dataclasses import dataclass, field

from matrix import Group, Point
from motion import Motion, Take

# Initial guesses of seconds per unit of each kind of work, from four cores of a server.
GUESSES = {"reference": 2e-7, "tracer": 2e-7, "errors": 1.0, "time": 1.0, "motion": 1.0}
FRAME_OVERHEAD = 0.012  # s, for a frame that shades nothing
SECONDS_PER_EVALUATION = {"none": 1.0e-9, "maps": 5.0e-9, "rays": 4.0e-8}  # one VPL at one pixel, deferred
FORWARD = 3.0  # time relative to deferred
SECONDS_PER_TEXEL = 9.0e-8  # drawn into a VPL's map


def frame_seconds(group: Group, one: Point) -> float:
    """The estimated time of a frame that keeps its VPLs. Only ratios matter once frames have been measured."""
    each = SECONDS_PER_EVALUATION[one.axes["visibility"].partition("-")[0]]
    each *= 1.0 if "deferred" in one.axes["path"] else FORWARD
    n = one.config["vpls"]["interleave"]
    asked = one.axes["vpls"] / (n * n if isinstance(n, int) else 64)
    return FRAME_OVERHEAD + group.size[0] * group.size[1] * asked * each


def drawing_seconds(one: Point) -> float:
    """The estimated time for drawing the maps of all VPLs."""
    vpls = one.config["vpls"]
    texels = vpls["map_resolution"] ** 2 if vpls["visibility"] == "maps" else 0
    return vpls["count"] * texels * SECONDS_PER_TEXEL


def errors_units(group: Group, one: Point) -> float:
    """One frame of indirect light for every seed, and one of all light."""
    return (len(one.seeds) + 1) * (frame_seconds(group, one) + drawing_seconds(one))


def time_units(group: Group, one: Point) -> float:
    """Three frames per round: one to warm up, one from another view and one that recomputes everything."""
    return group.rounds * (3 * frame_seconds(group, one) + 2 * drawing_seconds(one))


def motion_units(motion: Motion, take: Take) -> float:
    """Assumes that all maps are drawn in every frame."""
    vpls = take.config["vpls"]
    shading = motion.size[0] * motion.size[1] * vpls["count"] * SECONDS_PER_EVALUATION["maps"]
    drawing = vpls["count"] * vpls["map_resolution"] ** 2 * SECONDS_PER_TEXEL
    return motion.frames * (2 * FRAME_OVERHEAD + shading + drawing)


def tracer_units(group: Group | Motion, samples: int) -> float:
    return float(group.size[0] * group.size[1] * samples)


@dataclass
class Forecast:
    """For each kind of work: units left, units done, and the seconds that those took."""

    left: dict[str, float] = field(default_factory=lambda: dict.fromkeys(GUESSES, 0.0))
    done: dict[str, float] = field(default_factory=lambda: dict.fromkeys(GUESSES, 0.0))
    took: dict[str, float] = field(default_factory=lambda: dict.fromkeys(GUESSES, 0.0))

    def expect(self, kind: str, units: float) -> None:
        self.left[kind] += units

    def record(self, kind: str, units: float, seconds: float) -> None:
        self.left[kind] = max(self.left[kind] - units, 0.0)
        self.done[kind] += units
        self.took[kind] += seconds

    def forget(self, kind: str, units: float) -> None:
        """Removes work that will not be done."""
        self.left[kind] = max(self.left[kind] - units, 0.0)

    def rate(self, kind: str) -> float:
        """Seconds per unit. Frames for errors and for times are used to estimate each other."""
        seen = [kind] if self.done[kind] > 0 else ["errors", "time"] if kind in ("errors", "time") else []
        done = sum(self.done[each] for each in seen)
        return sum(self.took[each] for each in seen) / done if done > 0 else GUESSES[kind]

    def seconds_left(self) -> float:
        return sum(units * self.rate(kind) for kind, units in self.left.items())

    def share_done(self) -> float:
        took = sum(self.took.values())
        return took / max(took + self.seconds_left(), 1e-9)


def clock(seconds: float) -> str:
    return f"{int(seconds) // 60}:{int(seconds) % 60:02}"


@dataclass
class Bar:
    """On a terminal one line that is overwritten; otherwise a line every 15 seconds or so."""

    forecast: Forecast
    started: float = field(default_factory=time.monotonic)
    shown: float = 0.0

    def show(self, doing: str) -> None:
        now, terminal = time.monotonic(), sys.stderr.isatty()
        if now - self.shown < (0.2 if terminal else 15.0):
            return
        self.shown = now
        share = self.forecast.share_done()
        left = clock(self.forecast.seconds_left())
        filled = "#" * round(24 * share)
        line = f"[{filled:<24}] {share:4.0%}  {clock(now - self.started)} so far, about {left} left  {doing}"
        print(f"\r\033[K{line[:110]}" if terminal else line, end="" if terminal else "\n", file=sys.stderr, flush=True)

    def clear(self) -> None:
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)
