"""The study as one HTML page, in a folder with everything that it shows."""

import html
import pathlib
import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from PIL import Image

import matrix
from analysis import AIM, Row, select

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem; padding: 0 1rem; color: #222 }
h1, h2, h3 { line-height: 1.2 } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ddd }
figure { margin: 1rem 0 } figure img.chart { max-width: 100% } figcaption { color: #555 }
.pictures { display: flex; flex-wrap: wrap; gap: .6rem } .pictures figure { margin: 0; width: 192px }
.pictures img { width: 192px; image-rendering: pixelated; display: block } .pictures figcaption { font-size: 12px }
table { border-collapse: collapse; font-size: 12.5px } td, th { padding: .15rem .5rem; text-align: right }
th { position: sticky; top: 0; background: #eef2f6 } tr:nth-child(even) { background: #f7f7f7 }
td:nth-child(-n+3), th:nth-child(-n+3) { text-align: left } details { margin: 1rem 0 } .failed { color: #b00 }
"""
COLUMNS = {
    "suite": "",
    "scene": "",
    "id": "configuration",
    "total_rel_mse": "relMSE, total",
    "indirect_rel_mse": "relMSE, indirect",
    "direct_rel_mse": "relMSE, direct",
    "total_blotch": "blotch, total",
    "indirect_blotch": "blotch, indirect",
    "indirect_bias": "bias, indirect",
    "indirect_spikes": "spikes, indirect",
    "flip": "FLIP",
    "frame_ms": "frame, ms",
    "full_ms": "everything recomputed, ms",
    "alive": "VPLs alive",
    "work_vpl_pixels": "VPL · pixel",
    "memory_bytes": "memory, bytes",
}
SHOWN_COUNTS = [64, 1024]


def element(name: str, content: str, **attributes: str) -> str:
    given = "".join(f' {key.rstrip("_")}="{html.escape(value)}"' for key, value in attributes.items())
    return f"<{name}{given}>{content}</{name}>"


def picture(source: str, caption: str) -> str:
    return element("figure", f'<img src="{source}" alt="{html.escape(caption)}">' + element("figcaption", caption))


def copied(source: str, out: pathlib.Path, name: str) -> str | None:
    """Copies a picture to the page's folder, with a palette, which halves its size. Returns its relative path."""
    path = pathlib.Path(source)
    if not source or not path.is_file():
        return None
    with Image.open(path) as shown:
        shown.convert("RGB").quantize(128).save(out / "pictures" / name, optimize=True)
    return f"pictures/{name}"


def shown_points(rows: Sequence[Row], best: str | None) -> list[Row]:
    """The default with few and many VPLs, one point unbounded, one without visibility, and the best default."""
    wanted = [matrix.point(count).id for count in SHOWN_COUNTS]
    wanted += [matrix.point(256, bound=matrix.UNBOUNDED).id, matrix.blind(256).id, *([best] if best else [])]
    found = {row["id"]: row for row in rows}
    return [found[name] for name in dict.fromkeys(wanted) if name in found]


def strip(out: pathlib.Path, scene: str, rows: Sequence[Row], best: str | None) -> str:
    """The reference of a scene, followed by pictures with their heat maps."""
    reference = copied(str(pathlib.Path(rows[0]["picture"]).parent / "reference.png"), out, f"{scene}-reference.png")
    figures = [picture(reference, "reference")] if reference else []
    for row in shown_points(rows, best):
        name = f"{row['id']}, relMSE {row['total_rel_mse']:.3g}"
        for kind, caption in (("picture", name), ("heat", "its relative error")):
            source = copied(row[kind], out, f"{scene}-{row['id']}-{kind}.png")
            figures += [picture(source, caption)] if source else []
    return element("h3", scene) + element("div", "".join(figures), class_="pictures")


def pictures(out: pathlib.Path, rows: Sequence[Row], best: str | None) -> str:
    chosen = select(rows, suite="matrix")
    by_scene = {scene: select(chosen, scene=scene) for scene in dict.fromkeys(row["scene"] for row in chosen)}
    strips = [strip(out, scene, of_scene, best) for scene, of_scene in by_scene.items()]
    note = "Heat maps: a pixel's error relative to its brightness, from black at 0 to pale yellow at 0.5 and above."
    return element("h2", "Pictures and their references") + element("p", note) + "".join(strips) if strips else ""


def number(value: Any) -> str:
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.4g}"
    return f"{value:,}" if isinstance(value, int) else html.escape(str(value))


OPENING = """Candela lights a scene with virtual point lights (VPLs): points on its surfaces that pass on the light that
reaches them. This page compares pictures of many configurations with those of a path tracer, and shows the time that
they took. relMSE, the error on this page, is the mean over all pixels of the squared difference from the path tracer's
picture, divided by the square of that picture's brightness there: 0 is no difference, 1 is that of a black picture."""


def opening(out: pathlib.Path, rows: Sequence[Row]) -> str:
    """The introduction of the page, and one picture next to its reference."""
    shown = next((row for row in rows if row["scene"] == "cornell" and not row["failed"] and row["vpls"] == 1024), None)
    figures = []
    if shown:
        reference = str(pathlib.Path(shown["picture"]).parent / "reference.png")
        caption = f"1,024 VPLs: relMSE {shown['total_rel_mse']:.3g}"
        sources = {"opening": (shown["picture"], caption), "opening-reference": (reference, "the path tracer")}
        for name, (source, words) in sources.items():
            path = copied(source, out, f"{name}.png")
            figures += [picture(path, words)] if path else []
    return element("p", OPENING) + element("div", "".join(figures), class_="pictures")


def table(columns: dict[str, str], rows: Iterable[Row]) -> str:
    head = "".join(element("th", label or name) for name, label in columns.items())
    body = []
    for row in rows:
        cells = [element("td", number(row.get(name, ""))) for name in columns]
        if row.get("failed"):
            cells = cells[:3] + [f'<td class="failed" colspan="{len(columns) - 3}">{html.escape(row["failed"])}</td>']
        body.append(element("tr", "".join(cells)))
    return element("table", element("tr", head) + "".join(body))


def left_over(rows: Sequence[Row]) -> str:
    """The error that is left with the largest number of VPLs."""
    found = []
    for scene in dict.fromkeys(row["scene"] for row in rows if row["suite"] == "convergence"):
        visibility = matrix.DEFAULT_VISIBILITY if scene in matrix.HIDDEN else "none"
        axes = {"scene": scene, "bound": matrix.DEFAULT_BOUND, "visibility": visibility}
        chosen = select(rows, suite="convergence", **axes)
        found += [max(chosen, key=lambda row: row["vpls"])] if chosen else []
    columns = {"scene": "", "id": "configuration", "vpls": "VPLs", "indirect_rel_mse": "relMSE, indirect",
               "indirect_bias": "bias, indirect", "reference_noise": "the reference's own noise, relMSE"}
    note = (
        "With the largest number of VPLs, against a reference with as many bounces: what is left is noise, the light "
        "that bounding the geometry term removes, and the light that leaks through depth maps with few texels."
    )
    heading = element("h2", "The error with the largest number of VPLs")
    return heading + element("p", note) + table(columns, found) if found else ""


def visibility_costs(out: pathlib.Path, rows: Sequence[Row], costs: Sequence[Row]) -> str:
    """The error of VPLs without visibility, as figures and as pictures."""
    if not costs:
        return ""
    columns = {"scene": "", "vpls": "VPLs", "none": "relMSE, no visibility", "maps": "maps", "rays": "rays",
               "none_to_maps": "no visibility / maps", "reference_noise": "the reference's own noise, relMSE"}
    strips = [visibility_strip(out, line["scene"], rows) for line in costs]
    note = "Indirect light against a reference with as many bounces."
    heading = element("h2", "The error without VPL visibility")
    return heading + element("p", note) + table(columns, costs) + "".join(strips)


def visibility_strip(out: pathlib.Path, scene: str, rows: Sequence[Row]) -> str:
    found = {row["id"]: row for row in select(rows, suite="matrix", scene=scene)}
    figures = []
    for visibility in ("none", "maps", "rays"):
        row = found.get(matrix.point(256, visibility=visibility).id)
        for kind, caption in (("picture", f"256 VPLs, visibility: {visibility}"), ("heat", "its relative error")):
            source = copied(row[kind], out, f"{scene}-visibility-{visibility}-{kind}.png") if row else None
            figures += [picture(source, caption)] if source else []
    return element("h3", scene) + element("div", "".join(figures), class_="pictures") if figures else ""


def flicker(table_rows: Sequence[Row]) -> str:
    if not table_rows:
        return ""
    columns = {"script": "", "fresh": "fresh samples", "fixed": "fixed samples", "surfels": "surfels",
               "surfels_to_fresh": "surfels / fresh", "surfels_to_fixed": "surfels / fixed",
               "noise": "noise of the reference", "excess_frames": "frames above 1.2 × the error of fixed samples"}
    note = (
        "Flicker of the indirect light: relMSE between its changes from frame to frame and those of the reference. "
        "With fresh or fixed samples, paths are traced again whenever something moves; surfels stay where they are."
    )
    return element("h2", "Flicker") + element("p", note) + table(columns, table_rows)


def placement(table_rows: Sequence[Row]) -> str:
    if not table_rows:
        return ""
    columns = {"scene": "", "vpls": "VPLs", "paths": "relMSE, paths", "surfels": "relMSE, surfels",
               "surfels_to_paths": "surfels / paths", "paths_bias": "bias, paths", "surfels_bias": "bias, surfels",
               "noise": "the reference's own noise, relMSE"}
    note = "Indirect light with depth maps, for each placement of VPLs, against a reference with unlimited bounces."
    return element("h2", "Paths and surfels") + element("p", note) + table(columns, table_rows)


def lights_of(title: str, table_rows: Sequence[Row]) -> str:
    if not table_rows:
        return ""
    columns = {"scene": "", "vpls": "surfels", "direct_rel_mse": "relMSE, direct", "indirect_rel_mse": "relMSE, indirect",
               "total_rel_mse": "relMSE, total", "total_bias": "bias, total",
               "reference_noise": "the reference's own noise, relMSE"}
    return element("h2", title) + table(columns, table_rows)


def worlds(table_rows: Sequence[Row], walks: Sequence[Row]) -> str:
    if not table_rows:
        return ""
    columns = {"scene": "", "mean": "mean of indirect light / the reference's", "indirect_rel_mse": "relMSE, indirect",
               "reference_noise": "the reference's own noise, relMSE",
               "frame_ms_to_beside": "frame after a camera move / the Cornell box's",
               "full_ms_to_beside": "the same, everything recomputed"}
    moving = {"script": "", "id": "", "worst_ms": "slowest frame, ms", "worst_to_median": "slowest frame / median",
              "flicker_to_own": "flicker / that of a picture that does not change",
              "noise_to_own": "the same of the reference's noise",
              "worst_flicker": "flicker of the worst pair of frames",
              "rel_mse": "relMSE, indirect, mean of the frames",
              "settled_after": "frames at rest until the error of all light is within 1.2 times the last one's"}
    heading = element("h2", "Worlds larger than the room that is seen")
    return heading + table(columns, table_rows) + (table(moving, walks) if walks else "")


def gathering(table_rows: Sequence[Row], camera: Sequence[Row]) -> str:
    if not table_rows:
        return ""
    columns = {"scene": "", "indirect_to_all": "relMSE, indirect", "total_to_all": "relMSE, total",
               "frame_to_all": "frame", "frame_to_128": "frame of 1,024 VPLs / of 128",
               "frame_ms_to_tracer": f"shortest time to relMSE {AIM} / the path tracer's",
               "full_ms_to_tracer": "the same, everything recomputed"}
    note = (
        "1,024 VPLs with depth maps: values if each pixel uses one VPL in 64, as multiples of those if it uses all. "
        "Frames are those after a camera move."
    )
    heading = element("h2", "The error and the time of interleaving")
    moving = {"script": "", "all": "flicker, each pixel uses all VPLs", "shared": "one in 64", "shared_to_all": "ratio"}
    return heading + element("p", note) + table(columns, table_rows) + (table(moving, camera) if camera else "")


def charts(made: dict[str, dict[str, str]]) -> str:
    parts = []
    for heading, files in made.items():
        parts += [element("h2", heading)] if files else []
        for name, caption in files.items():
            link = f'<a href="{name}.svg"><img class="chart" src="{name}.png" alt="{html.escape(caption)}"></a>'
            parts.append(element("figure", link + element("figcaption", caption)))
    return "".join(parts)


def default_choice(best: dict[str, Any] | None) -> str:
    if best is None:
        return ""
    same = "It is the app's default." if best["is_default_of_app"] else "The app's default is a different one."
    text = f"{element('b', best['id'])}: {html.escape(best['reason'])}. {same}"
    return element("h2", "The best default") + element("p", text)


@dataclass(frozen=True)
class Findings:
    """Charts by heading, the best default, and small tables."""

    charts: dict[str, dict[str, str]]
    best: dict[str, Any] | None
    flicker: Sequence[Row]
    visibility: Sequence[Row]
    gathering: Sequence[Row]
    camera: Sequence[Row]
    placement: Sequence[Row]
    emitters: Sequence[Row]
    gloss: Sequence[Row]
    worlds: Sequence[Row]
    walks: Sequence[Row]


def write(
    out: pathlib.Path, rows: Sequence[Row], found: Findings, machine: dict[str, Any], provenance: dict[str, Any]
) -> None:
    """Writes index.html, and to pictures/ what it shows in addition to charts."""
    facts = {**machine, **provenance}
    about = ", ".join(f"{name.replace('_', ' ')}: {html.escape(str(value))}" for name, value in facts.items())
    points = element("summary", f"All {len(rows)} points") + table(COLUMNS, rows)
    shutil.rmtree(out / "pictures", ignore_errors=True)
    (out / "pictures").mkdir()
    body = [
        element("h1", "Candela: speed against accuracy"),
        opening(out, rows),
        element("p", about),
        element("p", 'All figures: <a href="results.csv">results.csv</a>, <a href="results.json">results.json</a>.'),
        default_choice(found.best),
        charts(found.charts),
        placement(found.placement),
        lights_of("Scenes lit by surfaces or by the sky", found.emitters),
        lights_of("Scenes of metal, plastic and mirrors", found.gloss),
        worlds(found.worlds, found.walks),
        gathering(found.gathering, found.camera),
        flicker(found.flicker),
        visibility_costs(out, rows, found.visibility),
        left_over(rows),
        pictures(out, rows, found.best["id"] if found.best else None),
        element("h2", "Points"),
        element("details", points),
    ]
    head = '<meta charset="utf-8"><title>Candela: speed against accuracy</title>' + element("style", STYLE)
    text = f"<!doctype html>\n<html lang=\"en\"><head>{head}</head>\n<body>\n" + "\n".join(body) + "\n</body></html>\n"
    (out / "index.html").write_text(text, encoding="utf-8")
