"""Measures what is not yet in the journal, and records each result immediately."""

import json
import sys
from typing import Any

import program
from matrix import Group, Point
from motion import Motion, Take
from session import STUDY, Study, pictures_of


def say(text: str) -> None:
    print(f"study: {text}", file=sys.stderr, flush=True)


def prepare_reference(study: Study, group: Group) -> None:
    """Traces nothing if the folder contains this reference, made by the same path tracer."""
    say(f"{group.name}: reference")
    program.make_reference(str(STUDY), study.scene(group), group, study.reference(group))


def noise_of(study: Study, group: Group) -> dict[str, float]:
    """The reference's own relMSE of each part of the light, estimated from its two halves."""
    return json.loads((study.reference(group) / "reference.json").read_text(encoding="utf-8"))["noise"]


def trace_baseline(study: Study, group: Group) -> None:
    say(f"{group.name}: path tracer")
    lines: list[dict[str, Any]] = []
    error = program.trace_baseline(
        str(STUDY), study.scene(group), study.reference(group), group.tracer_samples, lines.append
    )
    if error:
        say(f"{group.name}: measuring the path tracer failed: {error}")
    kind = {"kind": "failed", "message": error} if error else {"kind": "tracer", "lines": lines}
    study.note({"key": study.keys(group)["tracer"], "group": group.name, "id": "tracer", **kind})


def measure_points(study: Study, group: Group, points: list[Point]) -> None:
    keys, noise = study.keys(group), noise_of(study, group)

    def take(line: dict[str, Any]) -> None:
        study.note({**line, "key": keys[line["id"]], "group": group.name, "noise": noise})

    say(f"{group.name}: points to measure: {len(points)}")
    folders = study.reference(group), pictures_of(group)
    program.measure(str(STUDY), study.scene(group), *folders, group, points, take, study.beside(group))


def play(study: Study, motion: Motion, take: Take) -> None:
    """Renders one configuration with the script; the recorded line contains all frames."""
    say(f"{motion.name} {take.id}")
    lines: list[dict[str, Any]] = []
    error = program.animate(
        str(STUDY), study.script(motion), study.frame_references(motion), motion, take, lines.append
    )
    study.note({"key": study.motion_key(motion, take), "group": motion.name, "id": take.id, **told(lines, error)})


def told(lines: list[dict[str, Any]], error: str) -> dict[str, Any]:
    """The result of a take: its frames and flicker, or the error."""
    of_kind = {kind: [line for line in lines if line["kind"] == kind] for kind in ("frame", "flicker", "failed")}
    if error or of_kind["failed"] or not of_kind["flicker"]:
        words = [line["message"] for line in of_kind["failed"]]
        return {"kind": "failed", "message": error or (words + ["was not measured"])[0]}
    return {"kind": "motion", "frames": of_kind["frame"], "flicker": of_kind["flicker"][0]}


def measure(study: Study, groups: list[Group], motions: list[Motion]) -> None:
    for group in groups:
        points = study.missing(group)
        if not points and not study.misses_tracer(group):
            continue
        try:
            prepare_reference(study, group)
            if study.misses_tracer(group):
                trace_baseline(study, group)
            measure_points(study, group, points)
        except RuntimeError as error:
            fail_all(study, group, points, str(error))
    for motion in motions:
        for take in study.missing_takes(motion):
            play(study, motion, take)


def fail_all(study: Study, group: Group, points: list[Point], message: str) -> None:
    """Records that all points of the group failed, because it has no reference. Other groups can still be measured."""
    keys = study.keys(group)
    for one in points:
        study.note({"id": one.id, "kind": "failed", "message": message, "key": keys[one.id], "group": group.name})
