"""Measures what is not yet in the journal, and records each result immediately."""

import json
import sys
import time
from typing import Any

import program
import progress
from matrix import Group, Point
from motion import Motion, Take
from session import STUDY, Study, pictures_of


def expect(study: Study, group: Group) -> None:
    """Adds the expected cost of the group to the forecast."""
    points = study.missing(group)
    if (points or study.misses_tracer(group)) and not study.reference(group).exists():
        study.forecast.expect("reference", progress.tracer_units(group, group.reference.samples))
    if study.misses_tracer(group):
        study.forecast.expect("tracer", progress.tracer_units(group, sum(group.tracer_samples)))
    for one in points:
        study.forecast.expect("errors", progress.errors_units(group, one))
        study.forecast.expect("time", progress.time_units(group, one))


def prepare_reference(study: Study, group: Group) -> None:
    if study.reference(group).exists():
        return
    started = time.monotonic()
    study.bar.show(f"{group.name}: reference")
    program.make_reference(str(STUDY), study.scene(group), group, study.reference(group))
    units = progress.tracer_units(group, group.reference.samples)
    study.forecast.record("reference", units, time.monotonic() - started)


def noise_of(study: Study, group: Group) -> dict[str, float]:
    """The reference's own relMSE of each part of the light, estimated from its two halves."""
    return json.loads((study.reference(group) / "reference.json").read_text(encoding="utf-8"))["noise"]


def trace_baseline(study: Study, group: Group) -> None:
    started, lines = time.monotonic(), []
    study.bar.show(f"{group.name}: path tracer")
    error = program.trace_baseline(
        str(STUDY), study.scene(group), study.reference(group), group.tracer_samples, lines.append
    )
    units = progress.tracer_units(group, sum(group.tracer_samples))
    study.forecast.record("tracer", units, time.monotonic() - started)
    if error:
        study.bar.clear()
        print(f"study: {group.name}: measuring the path tracer failed: {error}", file=sys.stderr)
    kind = {"kind": "failed", "message": error} if error else {"kind": "tracer", "lines": lines}
    study.note({"key": study.keys(group)["tracer"], "group": group.name, "id": "tracer", **kind})


def measure_points(study: Study, group: Group, points: list[Point]) -> None:
    keys, by_id, noise = study.keys(group), {one.id: one for one in points}, noise_of(study, group)
    last = time.monotonic()

    def take(line: dict[str, Any]) -> None:
        nonlocal last
        now, one = time.monotonic(), by_id[line["id"]]
        study.note({**line, "key": keys[one.id], "group": group.name, "noise": noise})
        if line["kind"] == "time":
            units = progress.time_units(group, one) / group.rounds
            study.forecast.record("time", units, now - last)
        else:
            study.forecast.record("errors", progress.errors_units(group, one), now - last)
        if line["kind"] == "failed":
            study.forecast.forget("time", progress.time_units(group, one))
        last = now
        announce_once(study)
        study.bar.show(f"{group.name} {one.id}")

    folders = study.reference(group), pictures_of(group)
    program.measure(str(STUDY), study.scene(group), *folders, group, points, take, study.beside(group))


def announce_once(study: Study) -> None:
    """Prints the estimate for the whole study once a few seconds of pictures have shown the speed of this machine."""
    if not study.announced and study.forecast.took["errors"] > 5.0:
        study.announced = True
        left = progress.clock(study.forecast.seconds_left())
        study.bar.clear()
        print(f"study: about {left} min left, estimated from the first points", file=sys.stderr)


def expect_motion(study: Study, motion: Motion) -> None:
    for take in study.missing_takes(motion):
        study.forecast.expect("motion", progress.motion_units(motion, take))
    if study.missing_takes(motion) and not study.frame_references(motion).exists():
        study.forecast.expect("reference", progress.tracer_units(motion, motion.reference.samples * motion.frames))


def play(study: Study, motion: Motion, take: Take) -> None:
    """Renders one configuration with the script; the recorded line contains all frames."""
    lines: list[dict[str, Any]] = []
    last = time.monotonic()

    def listen(line: dict[str, Any]) -> None:
        nonlocal last
        now = time.monotonic()
        if line["kind"] == "reference":
            study.forecast.record("reference", progress.tracer_units(motion, motion.reference.samples), now - last)
        elif line["kind"] == "frame":
            study.forecast.record("motion", progress.motion_units(motion, take) / motion.frames, now - last)
        last = now
        lines.append(line)
        study.bar.show(f"{motion.name} {take.id}")

    error = program.animate(
        str(STUDY), study.script(motion), study.frame_references(motion), motion, take, listen
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
        expect(study, group)
    for motion in motions:
        expect_motion(study, motion)
    if study.forecast.seconds_left() > 0:
        left = progress.clock(study.forecast.seconds_left())
        print(f"study: about {left} min, a rough guess until the first points are measured", file=sys.stderr)
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
    study.bar.clear()


def fail_all(study: Study, group: Group, points: list[Point], message: str) -> None:
    """Records that all points of the group failed, because it has no reference. Other groups can still be measured."""
    keys = study.keys(group)
    for one in points:
        study.note({"id": one.id, "kind": "failed", "message": message, "key": keys[one.id], "group": group.name})
        study.forecast.forget("errors", progress.errors_units(group, one))
        study.forecast.forget("time", progress.time_units(group, one))
