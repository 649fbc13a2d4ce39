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

import analysis
import matrix
from analysis import Row, select

# Okabe and Ito's palette, which can be distinguished with any colour vision. Markers differ as well.
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, RED, PINK = (
    "#000000", "#e69f00", "#56b4e9", "#009e73", "#d9c900", "#0072b2", "#d55e00", "#cc79a7"
)
PATH_STYLES = {
    "forward": (ORANGE, "o"), "tiled-forward": (YELLOW, "v"), "forward+": (RED, "^"), "deferred": (BLUE, "s"),
    "tiled-deferred": (SKY, "D"), "clustered-forward": (PINK, "P"), "clustered-deferred": (GREEN, "X"),
}
SERIES = [(BLUE, "o"), (RED, "s"), (GREEN, "^"), (ORANGE, "D"), (PINK, "v"), (SKY, "P"), (BLACK, "X")]

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8, "legend.framealpha": 0.9, "axes.grid": True,
    "grid.alpha": 0.25, "grid.linewidth": 0.6, "axes.spines.top": False, "axes.spines.right": False,
    "svg.fonttype": "none", "svg.hashsalt": "candela",
})

TIMES = {"frame_ms": "frame after a camera move, ms", "full_ms": "frame that recomputes everything, ms"}

Made = dict[str, str]  # file name without extension: caption


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


def family(row: Row) -> str:
    """What distinguishes a configuration from the default; `paths` if only its path does."""
    if row["bound"] != matrix.DEFAULT_BOUND:
        return "another bound"
    if row["bounces"] != matrix.DEFAULT_BOUNCES:
        return "other bounces"
    if row["visibility"] != matrix.DEFAULT_VISIBILITY:
        return "no visibility" if row["visibility"] == "none" else f"visibility: {row['visibility']}"
    return "paths" if row["lever"] == "none" else row["lever"]


def scatter(axes: Axes, rows: Sequence[Row], time: str, error: str) -> None:
    others = {"another bound": (".", 0.45), "other bounces": ("x", 0.45), "no visibility": ("+", 0.6)}
    for name, (marker, alpha) in others.items():
        chosen = [row for row in rows if family(row) == name]
        style = {"color": "#555555", "alpha": alpha, "linestyle": "none", "markersize": 5}
        axes.plot([row[time] for row in chosen], [row[error] for row in chosen], marker, label=name, **style)
    for path, (colour, marker) in PATH_STYLES.items():
        chosen = [row for row in rows if row["path"] == path and family(row) == "paths"]
        style = {"color": colour, "marker": marker, "linestyle": "none", "markersize": 5, "markeredgewidth": 0}
        axes.plot([row[time] for row in chosen], [row[error] for row in chosen], label=path, **style)
    surfels = sorted((row for row in rows if family(row) == "surfels"), key=lambda row: row["vpls"])
    axes.plot([row[time] for row in surfels], [row[error] for row in surfels], "-", color=PINK, marker="v",
              markersize=6, linewidth=1.3, label="surfels", zorder=4)
    kinds = [each for each in matrix.VISIBILITIES if each not in ("none", matrix.DEFAULT_VISIBILITY)]
    for kind, marker in zip(kinds, "<>dp"):
        chosen = [row for row in rows if family(row) == f"visibility: {kind}"]
        style = {"linestyle": "none", "markersize": 7, "markerfacecolor": "none", "markeredgewidth": 1}
        style |= {"marker": marker, "color": "#555555", "label": f"visibility: {kind}"}
        axes.plot([row[time] for row in chosen], [row[error] for row in chosen], **style)


def plain(axes: Axes, rows: Sequence[Row], time: str, error: str) -> None:
    """Instant radiosity as in the student report: all VPLs at every pixel, unbounded, without visibility."""
    for path, style in (("forward", ":"), ("deferred", "--")):
        chosen = select(rows, path=path, bound=matrix.UNBOUNDED, bounces=matrix.DEFAULT_BOUNCES, visibility="none")
        chosen = sorted(chosen, key=lambda row: row["vpls"])
        axes.plot([row[time] for row in chosen], [row[error] for row in chosen], style, color=ORANGE, linewidth=1.3,
                  label=f"plain instant radiosity, {path}", zorder=1)


def error_panel(axes: Axes, rows: Sequence[Row], tracer: Sequence[Row], time: str, part: str, best: str | None) -> None:
    error = f"{part}_rel_mse"
    rows = [row for row in rows if row[error] > 0]
    plain(axes, rows, time, error)
    scatter(axes, rows, time, error)
    front = analysis.pareto_front(rows, lambda row: row[time], lambda row: row[error])
    axes.step([row[time] for row in front], [row[error] for row in front], where="post", color=BLACK, linewidth=1.2,
              label="Pareto front", zorder=3)
    traced = sorted(tracer, key=lambda row: row["samples"])
    axes.plot([row["ms"] for row in traced], [row[error] for row in traced], "-", color=GREEN, marker="*", markersize=7,
              linewidth=1.3, label="path tracer, 1 sample and up", zorder=2)
    for row in [row for row in traced if row["samples"] in (1, 64, 4096)]:
        axes.annotate(str(row["samples"]), (row["ms"], row[error]), textcoords="offset points", xytext=(5, 4),
                      fontsize=7, color=GREEN)
    for row in [row for row in rows if row["id"] == best]:
        axes.plot(row[time], row[error], "o", markersize=13, markerfacecolor="none", markeredgecolor=RED,
                  markeredgewidth=1.6, label="best default", zorder=4)
    axes.set(xscale="log", yscale="log")
    axes.minorticks_off()
    axes.set_title({"indirect": "indirect light", "total": "total light"}[part])


def error_against_time(rows: Sequence[Row], tracer: Sequence[Row], best: str | None, out: pathlib.Path) -> Made:
    made = {}
    for scene in scenes_of(rows, "matrix"):
        chosen = [row for row in select(rows, suite="matrix", scene=scene) if row["bounces"] > 0]
        traced = [row for row in tracer if row["scene"] == scene and row["suite"] == "matrix"]
        figure, grid = plt.subplots(2, 2, figsize=(10, 8.6), sharey="col")
        for line, (time, label) in zip(grid, TIMES.items()):
            for axes, part in zip(line, ("indirect", "total")):
                error_panel(axes, chosen, traced, time, part, best)
                axes.set(xlabel=label, ylabel="relMSE")
        figure.suptitle(f"{scene}: error against time, {chosen[0]['width']} × {chosen[0]['height']} pixels")
        legend_below(figure, grid[0][1], 5)
        name = f"error-time-{scene}"
        save(figure, out, name)
        made[name] = f"{scene}: error against a reference with unlimited bounces, and time. A mark is a configuration."
    return made


def gather(rows: Sequence[Row], tracer: Sequence[Row], out: pathlib.Path) -> Made:
    """For each interleaving, the error of the total light over the frame time, for increasing numbers of VPLs."""
    made = {}
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
        name = f"gather-{scene}"
        save(figure, out, name)
        made[name] = f"{scene}: interleaved gathering of VPLs on paths, and of surfels. Numbers next to marks: VPLs."
    return made


def surfels(rows: Sequence[Row], out: pathlib.Path) -> Made:
    """The error of the indirect light and the time of gathering it over the number of surfels."""
    names = scenes_of(rows, "surfels")
    if not names:
        return {}
    figure, (error, time) = plt.subplots(1, 2, figsize=(10, 4.2))
    for scene, (colour, marker) in zip(names, SERIES):
        chosen = sorted(select(rows, suite="surfels", scene=scene), key=lambda row: row["vpls"])
        counts, style = [row["vpls"] for row in chosen], {"color": colour, "marker": marker, "markersize": 5}
        error.plot(counts, [row["indirect_rel_mse"] for row in chosen], label=scene, **style)
        error.axhline(chosen[0]["reference_noise"], color=colour, linestyle=":", linewidth=1)
        time.plot(counts, [row["gather_ms"] for row in chosen], **style)
    error.set(ylabel="relMSE of the indirect light\n(dotted: the reference's own noise)")
    time.set(ylabel="gathering after a camera move, ms")
    for axes in (error, time):
        axes.set(xscale="log", yscale="log", xlabel="surfels", xticks=matrix.SURFEL_COUNTS)
        axes.set_xticklabels([f"{count:,}" for count in matrix.SURFEL_COUNTS])
        axes.minorticks_off()
    legend_below(figure, error, 2)
    save(figure, out, "surfels")
    return {"surfels": f"Error and time of gathering, {rows[0]['width']} × {rows[0]['height']} pixels."}


def bound_label(bound: float | str) -> str:
    return "unbounded" if bound == matrix.UNBOUNDED else f"bound {bound:g}"


def convergence_panels(axes: Sequence[Axes], rows: Sequence[Row]) -> None:
    floor = rows[0]["reference_noise"]
    hidden = rows[0]["scene"] in matrix.HIDDEN
    main = matrix.DEFAULT_VISIBILITY if hidden else "none"
    lines = [(bound, main, style, "-") for bound, style in zip(matrix.BOUNDS, SERIES)]
    others = {"none": ":", "rays": "--"} if hidden else {}
    lines += [(matrix.DEFAULT_BOUND, visibility, SERIES[2], dashes) for visibility, dashes in others.items()]
    for bound, visibility, (colour, marker), dashes in lines:
        chosen = [row for row in rows if row["bound"] == bound and row["visibility"] == visibility]
        chosen.sort(key=lambda row: row["vpls"])
        found = analysis.slope_above(chosen, floor)
        label = bound_label(bound) + {"none": ", no visibility" if hidden else "", "rays": ", rays"}.get(visibility, "")
        label += "" if found is None else f", slope {found:.2f}"
        style = {"color": colour, "marker": marker, "markersize": 4, "linestyle": dashes, "label": label}
        for panel, column in zip(axes, ("indirect_rel_mse", "indirect_bias", "indirect_spikes")):
            panel.plot([row["vpls"] for row in chosen], [row[column] for row in chosen], **style)
    axes[0].axhline(floor, color="#777777", linestyle=":", linewidth=1, label="reference's own noise")
    axes[0].set(yscale="log", ylabel="relMSE of the indirect light")
    axes[1].set(ylabel="bias, share of the indirect light")
    axes[1].axhline(0, color="#777777", linewidth=0.8)
    spikes = [row["indirect_spikes"] for row in rows]
    axes[2].set(yscale="log" if max(spikes) > 10 * min(spikes) else "linear")
    axes[2].set(ylabel="largest spike, multiple of the\nreference's brightest pixel")
    axes[2].axhline(1, color="#777777", linewidth=0.8)
    for panel in axes:
        panel.set(xscale="log", xlabel="VPLs", xticks=matrix.COUNTS, xticklabels=[f"{n:,}" for n in matrix.COUNTS])
        panel.minorticks_off()


def convergence(rows: Sequence[Row], out: pathlib.Path) -> Made:
    made = {}
    for scene in scenes_of(rows, "convergence"):
        figure, axes = plt.subplots(1, 3, figsize=(12, 4.3))
        convergence_panels(axes, select(rows, suite="convergence", scene=scene))
        figure.suptitle(f"{scene}: indirect light with as many bounces as the reference")
        legend_below(figure, axes[0], 6)
        name = f"convergence-{scene}"
        save(figure, out, name)
        made[name] = f"{scene}: error over the number of VPLs, for each bound of the geometry term."
    return made


def table_cells(rows: Sequence[Row]) -> tuple[list[str], list[list[str]]]:
    """The report's figures, then ours: the frame time of each path as a multiple of forward's in the same round."""
    others = ["deferred", *[path for path in matrix.PATHS if path not in ("forward", "deferred")]]
    header = ["VPLs", "report:\nforward, ms", "report:\ndeferred\n/ forward", "forward, ms"]
    header += [path.replace("clustered-", "clustered-\n") + "\n/ forward" for path in others]
    lines = []
    for count, (forward_fps, deferred_fps) in REPORT_FPS.items():
        found = {row["path"]: row for row in rows if row["vpls"] == count and "frame_to_forward" in row}
        if "forward" not in found:
            continue
        ratios = [f"{found[path]['frame_to_forward']:.2f}" if path in found else "–" for path in others]
        report = [f"{1000 / forward_fps:.1f}", f"{forward_fps / deferred_fps:.2f}"]
        lines.append([str(count), *report, f"{found['forward']['frame_ms']:.1f}", *ratios])
    return header, lines


# Frames per second in "Instant Radiosity for Real-Time Global Illumination" (Chandran and Reddy), GeForce GTX Titan.
# Number of VPLs: (forward, deferred).
REPORT_FPS = {
    128: (252.75, 280.88), 192: (176.94, 216.57), 256: (135.73, 186.81), 320: (108.24, 160.84),
    384: (92.91, 141.29), 448: (80.76, 131.34), 512: (68.73, 120.28),
}


def report_table(rows: Sequence[Row], out: pathlib.Path) -> Made:
    chosen = select(rows, suite="table")
    header, lines = table_cells(chosen)
    if not lines:
        return {}
    figure, axes = plt.subplots(figsize=(11, 0.27 * len(lines) + 1.2))
    axes.axis("off")
    table = axes.table(lines, colLabels=header, bbox=(0, 0, 1, 1), cellLoc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(8.5)
    for (line, _), cell in table.get_celld().items():
        cell.set_edgecolor("#cccccc")
        cell.set_height(2.4 if line == 0 else 1.0)
        cell.set_facecolor("#eef2f6" if line == 0 else "white")
    axes.set_title(f"Cornell box, {chosen[0]['width']} × {chosen[0]['height']}: frame after a camera move")
    figure.tight_layout()
    save(figure, out, "report-table")
    names = [cell.replace("-\n", "-").replace("\n", " ") for cell in header]
    head = "| " + " | ".join(names) + " |"
    rule = "|" + "---|" * len(header)
    body = ["| " + " | ".join(line) + " |" for line in lines]
    (out / "report-table.md").write_text("\n".join([head, rule, *body]) + "\n", encoding="utf-8")
    return {"report-table": "The student report's table, as ratios, and the same ratios for every path of Candela."}


def growth_panel(axes: Axes, rows: Sequence[Row], x: str, label: str, time: str = "frame_ms") -> None:
    for path, (colour, marker) in PATH_STYLES.items():
        points = sorted((row[x], row[time]) for row in rows if row["path"] == path)
        if points:
            axes.plot(*zip(*points), color=colour, marker=marker, markersize=4.5, label=path)
    axes.set(xscale="log", yscale="log", xlabel=label, ylabel="ms")


def growth(rows: Sequence[Row], lights: Sequence[Row], out: pathlib.Path) -> Made:
    triangles = [{**row, "triangles": row["work_triangles"]} for row in select(rows, suite="triangles")]
    pixels = [{**row, "pixels": row["width"] * row["height"]} for row in select(rows, suite="pixels")]
    if not (triangles and pixels and lights):
        return {}
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.6))
    growth_panel(axes[0][0], lights, "lights", "lights, in a hall that grows with them")
    axes[0][0].set_title("direct light without shadows, 320 × 240 pixels")
    growth_panel(axes[0][1], pixels, "pixels", "pixels, Cornell box")
    axes[0][1].set_title("64 VPLs, after a camera move")
    growth_panel(axes[1][0], triangles, "triangles", "triangles, the same hills")
    axes[1][0].set_title("64 VPLs, 160 × 120 pixels, after a camera move")
    growth_panel(axes[1][1], triangles, "triangles", "triangles, the same hills", "full_ms")
    axes[1][1].set_title("the same, with everything recomputed")
    legend_below(figure, axes[0][0], 7)
    save(figure, out, "growth")
    return {"growth": "Frame time as lights, pixels and triangles grow."}


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


def energy(rows: Sequence[Row], out: pathlib.Path) -> Made:
    """Shares of the emitted flux over the number of bounces, one panel per scene."""
    vpls = 1024
    shown = [row for row in select(rows, suite="matrix", vpls=vpls, path=matrix.DEFAULT_PATH, visibility="none")
             if row["bound"] == matrix.DEFAULT_BOUND and "absorbed_share" in row]
    names = scenes_of(shown, "matrix")
    if not names:
        return {}
    columns = min(4, len(names))
    lines = -(-len(names) // columns)
    size = (max(2.7 * columns, 5.0), 2.6 * lines + 0.7)
    figure, grid = plt.subplots(lines, columns, figsize=size, sharey=True, squeeze=False)
    for axes in grid.flat[len(names):]:
        axes.axis("off")
    for axes, scene in zip(grid.flat, names):
        energy_panel(axes, sorted((row for row in shown if row["scene"] == scene), key=lambda row: row["bounces"]))
        axes.set_title(scene)
    for line in grid:
        line[0].set_ylabel("share of emitted flux")
    figure.suptitle(f"Where the light of {vpls:,} VPLs goes")
    legend_below(figure, grid[0][0], 4)
    save(figure, out, "energy")
    return {"energy": "The energy account. Bars differ from the emitted light by the random error of Russian roulette."}


def energy_panel(axes: Axes, rows: Sequence[Row]) -> None:
    places, base = range(len(rows)), [0.0] * len(rows)
    for name, colour in (("absorbed", BLUE), ("escaped", SKY), ("truncated", RED)):
        heights = [row[f"{name}_share"] for row in rows]
        axes.bar(places, heights, bottom=base, color=colour, width=0.85, label=name)
        base = [low + high for low, high in zip(base, heights)]
    axes.axhline(1, color=BLACK, linewidth=1, linestyle="--", label="emitted")
    axes.set_xticks(places, [str(row["bounces"]) for row in rows])
    axes.set(xlabel="bounces", ylim=(0, 1.08))


def direct_light(rows: Sequence[Row], out: pathlib.Path) -> Made:
    """The error of the direct light over the resolution of the shadow maps."""
    order = [("shadow-maps-half", "half"), ("none", "default"), ("shadow-maps-double", "double")]
    figure, axes = plt.subplots(figsize=(7, 4.8))
    for scene, (colour, marker) in zip(scenes_of(rows, "matrix"), SERIES * 2):
        default = {"path": matrix.DEFAULT_PATH, "bound": matrix.DEFAULT_BOUND, "bounces": matrix.DEFAULT_BOUNCES,
                   "visibility": "none"}
        chosen = select(rows, suite="matrix", scene=scene, vpls=256, **default)
        by_lever = {row["lever"]: row["direct_rel_mse"] for row in chosen}
        values = [max(by_lever.get(lever, float("nan")), 1e-8) for lever, _ in order]
        axes.plot(range(3), values, color=colour, marker=marker, markersize=5, label=scene)
    axes.axhline(0.01, color="#777777", linestyle=":", label="0.01")
    axes.set(yscale="log", ylabel="relMSE of the direct light", xlabel="resolution of the shadow maps")
    axes.set_xticks(range(3), [label for _, label in order])
    legend_below(figure, axes, 4)
    save(figure, out, "direct-light")
    return {"direct-light": "Error of the direct light against the reference, including shadow edges."}


def draw(
    rows: Sequence[Row], tracer: Sequence[Row], lights: Sequence[Row], best: str | None, out: pathlib.Path
) -> dict[str, Made]:
    """Draws all charts for which there are rows. Returns the written files by heading."""
    matrix_made = bool(scenes_of(rows, "matrix"))
    return {
        "Error against time": error_against_time(rows, tracer, best, out),
        "Interleaved gathering": gather(rows, tracer, out),
        "Error against the number of VPLs": convergence(rows, out),
        "Error against the number of surfels": surfels(rows, out),
        "Forward against deferred, and with lists": report_table(rows, out),
        "Growing numbers of lights, pixels and triangles": growth(rows, lights, out),
        "Where the light goes": energy(rows, out),
        "Direct light": direct_light(rows, out) if matrix_made else {},
    }
