"""Charts of animations, and of still scenes while sets of VPLs are averaged."""

import itertools
import pathlib
import statistics
from collections.abc import Sequence

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

import charts
from analysis import Row, select
from charts import BLUE, GREEN, ORANGE, RED
from motion import VPLS

STYLES = {
    "fresh": (ORANGE, f"all {VPLS} VPLs traced again, fresh samples"),
    "fixed": (BLUE, f"all {VPLS} VPLs traced again, fixed samples"),
    "surfels": (RED, f"{VPLS} surfels"),
}
REFINED = {"refined-64": (GREEN, "o", "sets of 64 VPLs"), "refined-256": (BLUE, "s", "sets of 256 VPLs")}


def scripts_panels(error: Axes, flicker: Axes, rows: Sequence[Row]) -> None:
    """One column of the chart: one script."""
    for row in rows:
        colour, label = STYLES[row["id"]]
        error.plot(row["indirect_rel_mse"], color=colour, linewidth=1.3, label=label)
        pairs = [max(value, 1e-7) for value in row["flicker_of_pairs"]]
        flicker.plot(range(1, len(pairs) + 1), pairs, color=colour, linewidth=1.1)
    error.set(yscale="log", title=rows[0]["scene"])
    flicker.set(yscale="log", xlabel="frame", ylim=(1e-7, None))
    for axes in (error, flicker):
        axes.minorticks_off()


def scripts(played: Sequence[Row], out: pathlib.Path) -> None:
    rows = select(played, suite="motion")
    names = list(dict.fromkeys(row["scene"] for row in rows))
    if not names:
        return
    size = (max(3.0 * len(names), 6.0), 6.0)
    figure, grid = plt.subplots(2, len(names), figsize=size, squeeze=False, sharex="col")
    for column, name in enumerate(names):
        scripts_panels(grid[0][column], grid[1][column], select(rows, scene=name))
    grid[0][0].set_ylabel("relMSE of the indirect light")
    grid[1][0].set_ylabel("flicker since the previous frame")
    charts.legend_below(figure, grid[0][0], 3)
    charts.save(figure, out, "motion")


def worlds(played: Sequence[Row], out: pathlib.Path) -> None:
    rows = select(played, suite="worlds", id="surfels")
    if not rows:
        return
    figure, grid = plt.subplots(3, len(rows), figsize=(max(5.0 * len(rows), 6.0), 7.0), squeeze=False, sharex="col")
    for column, row in zip(grid.T, rows):
        times = row["full_ms"][1:]
        lines = [[ms / statistics.median(times) for ms in times], row["indirect_rel_mse"][1:], row["flicker_of_pairs"]]
        for axes, line in zip(column, lines):
            axes.plot(range(1, len(line) + 1), line, color=RED, linewidth=1.3)
            axes.set(yscale="log")
            axes.minorticks_off()
        column[0].set(yscale="linear", ylim=(0, None), title=row["scene"])
        column[2].set_xlabel("frame")
    grid[0][0].set_ylabel("time of the frame / median")
    grid[1][0].set_ylabel("relMSE of the indirect light")
    grid[2][0].set_ylabel("flicker since the previous frame")
    figure.tight_layout()
    charts.save(figure, out, "worlds")


def refinement(played: Sequence[Row], out: pathlib.Path) -> None:
    rows = select(played, suite="refinement")
    names = list(dict.fromkeys(row["scene"] for row in rows))
    if not names:
        return
    size = (max(5.4 * len(names), 6.0), 3.7)
    figure, grid = plt.subplots(1, 2 * len(names), figsize=size, sharey=True, squeeze=False)
    for (frames, time), name in zip(grid[0].reshape(-1, 2), names):
        for row in select(rows, scene=name):
            colour, marker, label = REFINED[row["id"]]
            errors = row["indirect_rel_mse"]
            style = {"color": colour, "marker": marker, "markersize": 3, "linewidth": 1.1, "label": label}
            frames.plot(range(1, len(errors) + 1), errors, **style)
            time.plot(list(itertools.accumulate(row["full_ms"])), errors, **style)
        frames.set(xlabel="frames")
        time.set(xlabel="ms, summed")
        for axes in (frames, time):
            axes.set(xscale="log", yscale="log", title=name.removeprefix("still-"))
    grid[0][0].set_ylabel("relMSE of the indirect light")
    charts.legend_below(figure, grid[0][0], 2)
    charts.save(figure, out, "refinement")


def draw(played: Sequence[Row], out: pathlib.Path) -> None:
    """Draws all charts for which there are rows."""
    scripts(played, out)
    worlds(played, out)
    refinement(played, out)
