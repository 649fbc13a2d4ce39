"""The study as one page of a folder that holds all it shows."""

import html
import pathlib
import shutil
from collections.abc import Iterable, Sequence
from typing import Any

from PIL import Image

import matrix
from analysis import Row, select

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
    "indirect_bias": "bias, indirect",
    "indirect_spikes": "spikes, indirect",
    "flip": "FLIP",
    "frame_ms": "frame, ms",
    "full_ms": "all anew, ms",
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
    """Takes a picture over into the page's folder, with a palette, which makes half of it."""
    path = pathlib.Path(source)
    if not source or not path.is_file():
        return None
    with Image.open(path) as shown:
        shown.convert("RGB").quantize(128).save(out / "pictures" / name, optimize=True)
    return f"pictures/{name}"


def shown_points(rows: Sequence[Row], best: str | None) -> list[Row]:
    """The default with few and many VPLs, some VPLs unbounded, and the best default."""
    wanted = [matrix.point(count).id for count in SHOWN_COUNTS]
    wanted += [matrix.point(256, bound=matrix.UNBOUNDED).id, *([best] if best else [])]
    found = {row["id"]: row for row in rows}
    return [found[name] for name in dict.fromkeys(wanted) if name in found]


def strip(out: pathlib.Path, scene: str, rows: Sequence[Row], best: str | None) -> str:
    """Pictures of a scene with their heat maps, after the reference."""
    reference = copied(str(pathlib.Path(rows[0]["picture"]).parent / "reference.png"), out, f"{scene}-reference.png")
    figures = [picture(reference, "reference")] if reference else []
    for row in shown_points(rows, best):
        name = f"{row['id']}, relMSE {row['total_rel_mse']:.3g}"
        for kind, caption in (("picture", name), ("heat", "its relative error")):
            source = copied(row[kind], out, f"{scene}-{row['id']}-{kind}.png")
            figures += [picture(source, caption)] if source else []
    return element("h3", scene) + element("div", "".join(figures), class_="pictures")


def pictures(out: pathlib.Path, rows: Sequence[Row], best: str | None) -> str:
    shutil.rmtree(out / "pictures", ignore_errors=True)
    (out / "pictures").mkdir()
    chosen = select(rows, suite="matrix")
    by_scene = {scene: select(chosen, scene=scene) for scene in dict.fromkeys(row["scene"] for row in chosen)}
    strips = [strip(out, scene, of_scene, best) for scene, of_scene in by_scene.items()]
    note = "Heat maps: a pixel's error relative to its brightness, from black at 0 to pale yellow at 0.5 and above."
    return element("h2", "Pictures beside the reference") + element("p", note) + "".join(strips) if strips else ""


def number(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return f"{value:,}" if isinstance(value, int) else html.escape(str(value))


def table(columns: dict[str, str], rows: Iterable[Row]) -> str:
    head = "".join(element("th", label or name) for name, label in columns.items())
    body = []
    for row in rows:
        cells = [element("td", number(row.get(name, ""))) for name in columns]
        if row.get("failed"):
            cells = cells[:3] + [f'<td class="failed" colspan="{len(columns) - 3}">{html.escape(row["failed"])}</td>']
        body.append(element("tr", "".join(cells)))
    return element("table", element("tr", head) + "".join(body))


def without_visibility(rows: Sequence[Row]) -> str:
    """What VPLs that shine through walls cost: the error that their number does not take away."""
    found = []
    for scene in dict.fromkeys(row["scene"] for row in rows if row["suite"] == "convergence"):
        chosen = select(rows, suite="convergence", scene=scene, bound=matrix.DEFAULT_BOUND)
        found += [max(chosen, key=lambda row: row["vpls"])] if chosen else []
    columns = {"scene": "", "id": "configuration", "vpls": "VPLs", "indirect_rel_mse": "relMSE, indirect",
               "indirect_bias": "bias, indirect", "reference_noise": "the reference's own noise, relMSE"}
    note = (
        "With the most VPLs, against a reference of as many bounces: what is left is what shines through walls, where "
        "there are any, and what bounding the geometry term takes away."
    )
    return element("h2", "What is left at the most VPLs") + element("p", note) + table(columns, found) if found else ""


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
    same = "It is what the app does by default." if best["is_default_of_app"] else "The app's default is another."
    text = f"{element('b', best['id'])}: {html.escape(best['reason'])}. {same}"
    return element("h2", "The best default") + element("p", text)


def write(
    out: pathlib.Path,
    rows: Sequence[Row],
    made: dict[str, dict[str, str]],
    best: dict[str, Any] | None,
    machine: dict[str, Any],
    provenance: dict[str, Any],
) -> None:
    """index.html, and in pictures/ what it shows besides charts."""
    facts = {**machine, **provenance}
    about = ", ".join(f"{name.replace('_', ' ')}: {html.escape(str(value))}" for name, value in facts.items())
    points = element("summary", f"All {len(rows)} points") + table(COLUMNS, rows)
    body = [
        element("h1", "Candela: speed against accuracy"),
        element("p", about),
        element("p", 'All figures: <a href="results.csv">results.csv</a>, <a href="results.json">results.json</a>.'),
        default_choice(best),
        charts(made),
        without_visibility(rows),
        pictures(out, rows, best["id"] if best else None),
        element("h2", "Points"),
        element("details", points),
    ]
    head = '<meta charset="utf-8"><title>Candela: speed against accuracy</title>' + element("style", STYLE)
    text = f"<!doctype html>\n<html lang=\"en\"><head>{head}</head>\n<body>\n" + "\n".join(body) + "\n</body></html>\n"
    (out / "index.html").write_text(text, encoding="utf-8")
