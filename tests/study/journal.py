"""The journal of a study: JSON lines in the order of measurement. With it an interrupted study can be continued."""

import json
import pathlib
from typing import Any

Line = dict[str, Any]
Record = dict[str, Any]  # "errors": a line, or "failed": a line; "times": lines


def append(path: pathlib.Path, line: Line) -> None:
    """Starts a new line first, because the last line may be incomplete."""
    with path.open("a", encoding="utf-8") as file:
        file.write("\n" + json.dumps(line))


def read(path: pathlib.Path) -> list[Line]:
    """All lines, except those that are incomplete because the study was interrupted."""
    lines = []
    for text in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
        try:
            lines.append(json.loads(text))
        except json.JSONDecodeError:
            continue
    return lines


def fold(lines: list[Line]) -> dict[str, Record]:
    """The last measurement for each key. Errors start a new measurement: times before them belong to an earlier run."""
    records: dict[str, Record] = {}
    for line in lines:
        kind, key = line["kind"], line["key"]
        if kind == "time":
            records.setdefault(key, {"times": []})["times"].append(line)
        else:
            records[key] = {kind: line, "times": []}
    return records


def is_done(record: Record | None, rounds: int) -> bool:
    """Whether nothing is left to measure. Failed points are tried again."""
    return record is not None and "errors" in record and len(record["times"]) >= rounds
