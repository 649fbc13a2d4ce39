"""Converts measurements to rows, tables and files."""

import csv
import json
import math
import pathlib
import statistics
from typing import Any

import journal
import machine
import matrix
from analysis import Row
from matrix import Group, Point
from motion import Motion, Take
from session import STUDY, Study, pictures_of

FILES = ("picture", "heat")  # columns with files in the build folder


def flat(prefix: str, values: dict[str, Any]) -> Row:
    """The numbers and strings of a JSON object as columns; names of nested members are joined by _."""
    row: Row = {}
    for name, value in values.items():
        if isinstance(value, dict):
            row.update(flat(f"{prefix}{name}_", value))
        elif isinstance(value, (int, float, str)) and not isinstance(value, bool):
            row[prefix + name] = value
    return row


def shares(flux: dict[str, list[float]]) -> Row:
    """The energy account as shares of the flux that the traced paths emitted; colours summed."""
    emitted = sum(flux.get("emitted", [0.0]))
    return {f"{name}_share": sum(flux[name]) / emitted for name in flux if name != "emitted" and emitted > 0}


def row_of(group: Group, one: Point, record: journal.Record | None) -> Row:
    row: Row = {"suite": group.suite, "scene": group.scene, "width": group.size[0], "height": group.size[1]}
    row.update({"id": one.id, **one.axes, "seeds": len(one.seeds), "failed": ""})
    row.update({"reference_samples": group.reference.samples, "reference_bounces": group.reference.bounces})
    if not journal.is_done(record, group.rounds):
        return {**row, "failed": (record or {}).get("failed", {}).get("message", "was not measured")}
    line = record["errors"]
    row["reference_noise"] = line["noise"]["indirect"]
    for part, errors in line["errors"].items():
        row.update(flat(f"{part}_", errors or {}))  # null if there are no pixels off edges
    row.update(flat("error_", line.get("estimate") or {}))
    row.update(flat("", {name: line[name] for name in ("flip", "work", "memory")}))
    vpls = line.get("vpls") or {"alive": 0, "paths": 0, "flux": {}}
    row.update({"alive": vpls["alive"], "paths": vpls["paths"], **shares(vpls["flux"])})
    for name in ("frame_ms", "full_ms", "cpu_ms", "gpu_ms", "gather_ms") if record["times"] else ():
        row[name] = statistics.median(each[name] for each in record["times"])
    turns = [line for line in record["times"] if "beside" in line]
    for name in ("frame_ms", "full_ms") if turns else ():
        row[f"{name}_to_beside"] = statistics.median(line[name] / line["beside"][name] for line in turns)
    row["rounds"] = len(record["times"])
    return {**row, **{kind: str(pictures_of(group) / line[kind]) for kind in ("picture", "heat")}}


def rows_of(study: Study, groups: list[Group]) -> list[Row]:
    study.records = journal.fold(journal.read(study.journal))
    rows = []
    for group in groups:
        keys = study.keys(group)
        records = {one.id: study.records.get(keys[one.id]) for one in group.points}
        for one in group.points:
            rows.append(row_of(group, one, records[one.id]))
    return rows


def tracer_rows(study: Study, groups: list[Group]) -> list[Row]:
    """The points of the path tracer itself."""
    rows = []
    for group in groups:
        record = study.records.get(study.keys(group)["tracer"], {}) if group.tracer_samples else {}
        for line in record.get("tracer", {}).get("lines", []):
            row = {"suite": group.suite, "scene": group.scene, "samples": line["samples"], "ms": line["ms"]}
            errors = {f"{part}_rel_mse": line["errors"][part]["rel_mse"] for part in ("indirect", "total")}
            rows.append({**row, **errors})
    return rows


FRAME_FIGURES = ("full_ms", "refined")


def motion_row(motion: Motion, take: Take, record: journal.Record | None) -> Row:
    """One configuration in one script; values per frame are lists."""
    row: Row = {"suite": motion.suite, "scene": motion.script, "id": take.id, "failed": ""}
    row.update({"width": motion.size[0], "height": motion.size[1], "config": take.config})
    if record is None or "motion" not in record:
        return {**row, "failed": (record or {}).get("failed", {}).get("message", "was not measured")}
    line = record["motion"]
    for part in ("indirect", "total"):
        row[f"{part}_flicker"] = line["flicker"][part]
        row[f"{part}_rel_mse"] = [frame["errors"][part]["rel_mse"] for frame in line["frames"]]
    row["flicker_of_pairs"] = line["flicker"]["indirect_pairs"]
    return {**row, **{name: [frame[name] for frame in line["frames"]] for name in FRAME_FIGURES}}


def motion_rows(study: Study, motions: list[Motion]) -> list[Row]:
    study.records = journal.fold(journal.read(study.journal))
    return [
        motion_row(motion, take, study.records.get(study.motion_key(motion, take)))
        for motion in motions
        for take in motion.takes
    ]


def rounded(value: Any) -> Any:
    """Rounds floats to five digits, more than is reproducible."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, dict):
        return {name: rounded(item) for name, item in value.items()}
    if isinstance(value, list):
        return [rounded(item) for item in value]
    return value


def columns(rows: list[Row]) -> list[str]:
    return list(dict.fromkeys(name for row in rows for name in row if name not in FILES))


def write_csv(path: pathlib.Path, rows: list[Row]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns(rows), extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rounded(row) for row in rows)


def describe(group: Group) -> dict[str, Any]:
    reference = vars(group.reference)
    points = {one.id: {"config": one.config, "seeds": one.seeds} for one in group.points}
    shape = {"suite": group.suite, "scene": group.scene, "size": group.size, "rounds": group.rounds}
    return {**shape, "reference": reference, "points": points}


def write_results(study: Study, groups: list[Group], rows: list[Row], extra: dict[str, Any]) -> None:
    write_csv(study.out / "results.csv", rows)
    renderers = {record["errors"]["gl_renderer"] for record in study.records.values() if "errors" in record}
    names = columns(rows)
    content = {
        "machine": study.machine,
        "gl_renderer": sorted(renderers),
        **machine.provenance(STUDY),
        **extra,
        "groups": [describe(group) for group in groups],
        "columns": names,
        "points": [[rounded(row.get(name)) for name in names] for row in rows],
    }
    (study.out / "results.json").write_text(by_lines(content) + "\n", encoding="utf-8")


def by_lines(content: dict[str, Any]) -> str:
    """JSON with one line for each member, and for each item of a member that is a list."""
    members = []
    for name, value in content.items():
        items = [json.dumps(item, separators=(",", ":")) for item in value] if isinstance(value, list) else []
        text = "[\n" + ",\n".join(items) + "\n]" if items else json.dumps(value, separators=(",", ":"))
        members.append(f"{json.dumps(name)}: {text}")
    return "{\n" + ",\n".join(members) + "\n}"
