#!/usr/bin/env python3
"""Speed against accuracy: measures a matrix of configurations against references and writes tables and charts.

Called by tests/study/run, which builds candela-study first. Results are recorded line by line in journal.jsonl in the
output folder; a study that is started again measures only what is missing there.
"""

import argparse
import pathlib
import subprocess
import sys

import analysis
import checks
import matrix
import motion
import results
import scale
import scenes
from analysis import Row
from matrix import Group
from motion import Motion
from measuring import measure
from session import ANIMATIONS, BUILD, SCENES, STUDY, Study

SUITES = ["scenes", "gather", "surfels", "motion"]
GATHER_SCENES = ["cornell", "two-rooms", "glass", "fins", "atrium"]
PROGRAM_PARTS = ["graph", "shading", "gather", "paths", "moves", "edits", "scale"]


def names(text: str) -> list[str]:
    """Splits an argument that is a list."""
    return text.split(",")


def arguments() -> argparse.Namespace:
    parts = list(dict.fromkeys(SUITES + PROGRAM_PARTS))
    parser = argparse.ArgumentParser(prog="tests/study/run", description="Charts Candela's speed against its accuracy.")
    parser.add_argument("--quick", action="store_true", help="a small matrix, and checks that must pass on any machine")
    parser.add_argument("--scenes", metavar="A,B", type=names, help="only these scenes")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, help="default: build/study/results")
    parser.add_argument("--part", metavar="A,B", type=names, help=f"only these, of {', '.join(parts)}; default: all")
    given = parser.parse_args()
    if given.quick and given.part:
        parser.error("--quick and --part cannot be combined")
    require_known(parser, "--part", given.part, parts)
    moving = [motion.scene_of(each, ANIMATIONS) for each in planned_motions(given.quick, given.part, None)]
    still = [group.scene for group in planned(given.quick, given.part, None)]
    require_known(parser, "--scenes", given.scenes, still + moving)
    given.out = (given.out or BUILD / "study" / "results").resolve()
    return given


def require_known(parser: argparse.ArgumentParser, flag: str, given: list[str] | None, known: list[str]) -> None:
    for name in given or []:
        if name not in known:
            parser.error(f"{flag}: '{name}' is not one of {', '.join(dict.fromkeys(known))}")


def planned(quick: bool, parts: list[str] | None, only: list[str] | None) -> list[Group]:
    """All groups to measure, in order."""
    groups: dict[str, list[Group]] = {
        "scenes": matrix.scene_groups(),
        "gather": matrix.gather_groups(),
        "surfels": matrix.surfel_groups(),
        "motion": [],
    }
    wanted = parts or SUITES
    chosen = matrix.quick_groups() if quick else [group for name in SUITES if name in wanted for group in groups[name]]
    return [group for group in chosen if only is None or group.scene in only]


def planned_motions(quick: bool, parts: list[str] | None, only: list[str] | None) -> list[Motion]:
    """All scripts to render, in order."""
    wanted = motion.motions() + motion.world_motions() if not parts or "motion" in parts else []
    wanted += motion.camera_motions() if not parts or "gather" in parts else []
    chosen = motion.quick_motions() if quick else wanted
    return [each for each in chosen if only is None or motion.scene_of(each, ANIMATIONS) in only]


def run_program_part(part: str, out: pathlib.Path) -> None:
    """The parts that only print a table; `scale` also draws a chart into `out`."""
    if part == "scale":
        scale.run(STUDY, out)
        return
    cornell, hall = scenes.SHIPPED / "cornell.gltf", scenes.SHIPPED / "hall-256.gltf"
    large = scenes.find("hall-4096", SCENES) if part == "paths" else hall
    commands = {
        "graph": [["graph", "--benchmark_counters_tabular=true"]],
        "shading": [["shading", cornell]],
        "gather": [["gather", scenes.find(name, SCENES)] for name in GATHER_SCENES],
        "moves": [["moves"]],
        "edits": [["edits"], ["edits", "--things", "100", "--things", "2000", "--things", "50000"]],
        "paths": [
            ["paths", cornell, "--vpls", "256"],
            ["paths", hall, "--rounds", "3"],
            ["paths", scenes.SHIPPED / "fins.gltf", "--rounds", "3"],
            ["paths", large, "--rounds", "1"],
        ],
    }
    for command in commands[part]:
        subprocess.run([STUDY, *command], check=True)


def number(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else f"{value:,}" if isinstance(value, int) else str(value)


def report(study: Study, groups: list[Group], motions: list[Motion]) -> None:
    """Writes tables and charts, and prints the tables. Only this function needs Matplotlib."""
    import charts
    import motion_charts

    rows, tracer = results.rows_of(study, groups), results.tracer_rows(study, groups)
    played = results.motion_rows(study, motions)
    tables = {
        "scenes": analysis.scene_table(rows),
        "gathering": analysis.gather_table(rows, tracer) + analysis.camera_flicker(played),
        "flicker": analysis.flicker_table(played),
        "walks": analysis.world_motion_table(played),
    }
    extra = results.rounded({"tracer": tracer, **tables, "motions": played})
    results.write_results(study, groups, rows, extra)
    charts.draw(rows, tracer, study.out)
    motion_charts.draw(played, study.out)
    for name, lines in tables.items():
        for line in lines:
            print(f"study: {name},", ", ".join(f"{column} {number(value)}" for column, value in line.items()))
    print(f"study: {study.out / 'results.json'}")


def main() -> int:
    given = arguments()
    given.out.mkdir(parents=True, exist_ok=True)
    study = Study(given.out)
    groups = planned(given.quick, given.part, given.scenes)
    motions = planned_motions(given.quick, given.part, given.scenes)
    measured = given.quick or not given.part or any(part in SUITES for part in given.part)
    if measured:
        measure(study, groups, motions)
    if given.quick:
        rows, tracer = results.rows_of(study, groups), results.tracer_rows(study, groups)
        played = results.motion_rows(study, motions)
        results.write_results(study, groups, rows, {"tracer": tracer, "motions": played})
        return checks.run(rows, tracer, played)
    if measured:
        report(study, groups, motions)
    for part in PROGRAM_PARTS:
        if not given.part or part in given.part:
            run_program_part(part, given.out)
    rows = results.rows_of(study, groups) if measured else []
    failed = [row for row in [*rows, *(results.motion_rows(study, motions) if measured else [])] if row["failed"]]
    for row in failed:
        print(f"study: {row['scene']} {row['id']} failed: {row['failed']}", file=sys.stderr)
    estimates = [row for row in rows if row["suite"] == "scenes"]
    wrong = checks.report(list(checks.errors_estimated(estimates))) if estimates else 0
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("study: interrupted; run it again to continue")
