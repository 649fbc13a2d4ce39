"""The study's charts, each as PNG and as SVG."""

import io
import pathlib
import re
from collections.abc import Sequence

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

import matrix
from analysis import Row, select

# Okabe and Ito's palette, which can be distinguished with any colour vision. Markers differ as well.
BLACK, ORANGE, SKY, GREEN, BLUE, RED, PINK = (
    "#000000", "#e69f00", "#56b4e9", "#009e73", "#0072b2", "#d55e00", "#cc79a7"
)
SERIES = [(BLUE, "o"), (RED, "s"), (GREEN, "^"), (ORANGE, "D"), (PINK, "v"), (SKY, "P"), (BLACK, "X")]

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8, "legend.framealpha": 0.9, "axes.grid": True,
    "grid.alpha": 0.25, "grid.linewidth": 0.6, "axes.spines.top": False, "axes.spines.right": False,
    "svg.fonttype": "none", "svg.hashsalt": "candela",
})

TIMES = {"frame_ms": "frame after a camera move, ms", "full_ms": "frame that recomputes everything, ms"}

def legend_below(figure: Figure, axes: Axes, columns: int) -> None:
    """One legend for all panels, below them."""
    handles, labels = axes.get_legend_handles_labels()
    lines = -(-len(labels) // columns)
    figure.tight_layout(rect=(0, (0.2 * lines + 0.12) / figure.get_figheight(), 1, 1))
    figure.legend(handles, labels, loc="lower center", ncols=columns, frameon=False)


def save(figure: Figure, out: pathlib.Path, name: str) -> None:
    """Saves as PNG and SVG. The PNG has a palette: a third of the size, without a visible difference."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=110)
    Image.open(drawn).convert("RGB").quantize(96).save(out / f"{name}.png", optimize=True)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    # Two decimals of a point are enough; matplotlib writes six.
    (out / f"{name}.svg").write_text(re.sub(r"(\.\d\d)\d+", r"\1", text.getvalue()), encoding="utf-8")
    plt.close(figure)


def scenes_of(rows: Sequence[Row], suite: str) -> list[str]:
    return list(dict.fromkeys(row["scene"] for row in rows if row["suite"] == suite and not row["failed"]))


def gather(rows: Sequence[Row], tracer: Sequence[Row], out: pathlib.Path) -> None:
    """For each interleaving, the error of the total light over the frame time, for increasing numbers of VPLs."""
    for scene in scenes_of(rows, "gather"):
        chosen = select(rows, suite="gather", scene=scene)
        traced = sorted((row for row in tracer if row["scene"] == scene and row["suite"] == "gather"),
                        key=lambda row: row["samples"])
        figure, panels = plt.subplots(1, 2, figsize=(10, 4.6), sharey=True)
        for axes, (time, time_label) in zip(panels, TIMES.items()):
            levers = {matrix.interleaved(64, n).axes["lever"]: f"paths, one in {n * n}" for n in matrix.GATHERED}
            levers |= {"none": "paths, every pixel uses all", "surfels": "surfels, as the app does"}
            for (lever, label), (colour, marker) in zip(levers.items(), SERIES):
                points = sorted(select(chosen, lever=lever), key=lambda row: row["vpls"])
                axes.plot([row[time] for row in points], [row["total_rel_mse"] for row in points], color=colour,
                          marker=marker, markersize=5, label=label)
                for row in points:
                    axes.annotate(f"{row['vpls']:,}", (row[time], row["total_rel_mse"]), textcoords="offset points",
                                  xytext=(4, 4), fontsize=6.5, color=colour)
            axes.plot([row["ms"] for row in traced], [row["total_rel_mse"] for row in traced], "--", color=BLACK,
                      marker="*", markersize=7, label="path tracer (Embree, the same cores), 1 sample and up")
            axes.set(xscale="log", yscale="log", xlabel=time_label, ylabel="relMSE of the total light")
        figure.suptitle(f"{scene}: {chosen[0]['width']} × {chosen[0]['height']} pixels, VPLs with depth maps")
        legend_below(figure, panels[0], 3)
        save(figure, out, f"gather-{scene}")


def surfels(rows: Sequence[Row], out: pathlib.Path) -> None:
    """Errors, measured and seen, and the time of gathering over the number of surfels."""
    names = scenes_of(rows, "surfels")
    if not names:
        return
    figure, (error, seen, time) = plt.subplots(1, 3, figsize=(13, 4.2))
    for scene, (colour, marker) in zip(names, SERIES):
        chosen = sorted(select(rows, suite="surfels", scene=scene), key=lambda row: row["vpls"])
        counts, style = [row["vpls"] for row in chosen], {"color": colour, "marker": marker, "markersize": 5}
        error.plot(counts, [row["indirect_rel_mse"] for row in chosen], label=scene, **style)
        error.plot(counts, [row["indirect_blotch"] for row in chosen], linestyle="--", **style)
        seen.plot(counts, [row["flip"] for row in chosen], **style)
        time.plot(counts, [row["gather_ms"] for row in chosen], **style)
    error.set(ylabel="relMSE of the indirect light; dashed: blotch")
    seen.set(ylabel="FLIP of all light")
    time.set(ylabel="gathering after a camera move, ms")
    for axes in (error, seen, time):
        axes.set(xscale="log", yscale="log", xlabel="surfels", xticks=matrix.SURFEL_COUNTS)
        axes.set_xticklabels([f"{count:,}" for count in matrix.SURFEL_COUNTS])
        axes.minorticks_off()
    legend_below(figure, error, 2)
    save(figure, out, "surfels")


def scale(rows: Sequence[Row], out: pathlib.Path) -> None:
    """Time and memory of large scenes, over the number of whatever grows."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for kind, (colour, marker) in zip(dict.fromkeys(row["kind"] for row in rows), SERIES):
        chosen = [row for row in rows if row["kind"] == kind]
        counts = [row["count"] for row in chosen]
        seconds = [row["load_s"] + row["frame_s"] for row in chosen]
        axes[0].plot(counts, seconds, color=colour, marker=marker, markersize=4.5, label=kind)
        axes[1].plot(counts, [row["peak_bytes"] / 2**20 for row in chosen], color=colour, marker=marker, markersize=4.5)
    axes[0].set(xscale="log", yscale="log", xlabel="number", ylabel="s", title="loading and the first frame")
    axes[1].set(xscale="log", yscale="log", xlabel="number", ylabel="MiB", title="largest memory")
    legend_below(figure, axes[0], 5)
    save(figure, out, "scale")


def draw(rows: Sequence[Row], tracer: Sequence[Row], out: pathlib.Path) -> None:
    """Draws all charts for which there are rows."""
    gather(rows, tracer, out)
    surfels(rows, out)
