#!/usr/bin/env python3
"""Speed against accuracy: measures a matrix of configurations against references and writes tables, charts and a page.

Called by tests/study/run, which builds candela-study first. Results are recorded line by line in journal.jsonl in the
output folder; a study that is started again measures only what is missing there.
"""

import argparse
import pathlib
import subprocess
import sys

import analysis
import checks
import growth
import journal
import machine
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

SUITES = ["matrix", "table", "growth", "gather", "placement", "emitters", "gloss", "worlds", "surfels", "estimate", "motion"]
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
        "matrix": matrix.matrix_groups() + matrix.convergence_groups(),
        "table": matrix.table_groups(),
        "growth": matrix.growth_groups(),
        "gather": matrix.gather_groups(),
        "placement": matrix.placement_groups(),
        "emitters": matrix.emitter_groups(),
        "gloss": matrix.gloss_groups(),
        "worlds": matrix.world_groups(),
        "surfels": matrix.surfel_groups(),
        "estimate": matrix.estimate_groups(),
        "motion": [],
    }
    wanted = parts or SUITES
    chosen = matrix.quick_groups() if quick else [group for name in SUITES if name in wanted for group in groups[name]]
    return [group for group in chosen if only is None or group.scene in only]


def planned_motions(quick: bool, parts: list[str] | None, only: list[str] | None) -> list[Motion]:
    """All scripts to render, in order."""
    wanted = motion.motions() if not parts or "motion" in parts else []
    wanted += motion.camera_motions() if not parts or "gather" in parts else []
    wanted += motion.world_motions() if not parts or "worlds" in parts else []
    chosen = motion.quick_motions() if quick else wanted
    return [each for each in chosen if only is None or motion.scene_of(each, ANIMATIONS) in only]


def lights_rows(study: Study) -> list[Row]:
    """Frame times for growing numbers of lights; measures those that are not in the journal."""
    rows = []
    for lights in growth.LIGHTS:
        key = matrix.digest({"lights": lights, "machine": study.machine, "program": study.program})
        if key not in study.records:
            print(f"study: timing {lights} lights", file=sys.stderr)
            study.note({"kind": "lights", "key": key, "rows": growth.measure(STUDY, lights, SCENES)})
            study.records = journal.fold(journal.read(study.journal))
        rows += study.records[key]["lights"]["rows"]
    return rows


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


def report(study: Study, groups: list[Group], motions: list[Motion], lights: list[Row]) -> None:
    """Writes tables, charts and the page. Only this function needs Matplotlib."""
    import charts
    import motion_charts
    import page

    rows, tracer = results.rows_of(study, groups), results.tracer_rows(study, groups)
    best = results.choice(rows, groups)
    played = results.motion_rows(study, motions)
    flicker, costs = analysis.flicker_table(played), analysis.visibility_costs(rows)
    gathering, camera = analysis.gather_table(rows, tracer), analysis.camera_flicker(played)
    extra = {"tracer": tracer, "lights": lights, "best": best, "flicker": flicker, "visibility": costs}
    placement = analysis.placement_table(rows, matrix.PLACEMENTS)
    emitters, gloss = analysis.light_table(rows, "emitters"), analysis.light_table(rows, "gloss")
    worlds, walks = analysis.world_table(rows), analysis.world_motion_table(played)
    extra |= {"worlds": worlds, "walks": walks}
    extra |= {"placement": placement, "gathering": gathering, "camera": camera, "emitters": emitters, "gloss": gloss}
    results.write_results(study, groups, rows, {**results.rounded(extra), "motions": results.rounded(played)})
    made = charts.draw(rows, tracer, lights, best["id"] if best else None, study.out)
    made |= motion_charts.draw(played, study.out)
    found = page.Findings(made, best, flicker, costs, gathering, camera, placement, emitters, gloss, worlds,
                          walks)
    page.write(study.out, rows, found, study.machine, machine.provenance(STUDY))
    printed = {"gathering": gathering + camera, "placement": placement, "emitters": emitters, "gloss": gloss}
    printed |= {"worlds": worlds + walks}
    for part, lines in printed.items():
        for line in lines:
            print(f"study: {part},", ", ".join(f"{name} {page.number(value)}" for name, value in line.items()))
    print(f"study: {study.out / 'index.html'}")
    if best:
        same = "the app's default" if best["is_default_of_app"] else "NOT the app's default"
        print(f"study: the best default is {best['id']}, {same}: {best['reason']}")


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
        whole = given.scenes is None and (not given.part or "growth" in given.part)
        report(study, groups, motions, lights_rows(study) if whole else [])
    for part in PROGRAM_PARTS:
        if not given.part or part in given.part:
            run_program_part(part, given.out)
    rows = results.rows_of(study, groups) if measured else []
    failed = [row for row in [*rows, *(results.motion_rows(study, motions) if measured else [])] if row["failed"]]
    for row in failed:
        print(f"study: {row['scene']} {row['id']} failed: {row['failed']}", file=sys.stderr)
    estimates = [row for row in rows if row["suite"] in ("estimate", "worlds")]
    wrong = checks.report(list(checks.errors_estimated(estimates))) if estimates else 0
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("study: interrupted; run it again to continue")
