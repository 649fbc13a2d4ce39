"""Runs candela-study, which prints JSON lines, and handles its failures and crashes."""

import json
import pathlib
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from matrix import Group, Point
from motion import Motion, Take

Line = dict[str, Any]
OnLine = Callable[[Line], None]

# Seconds without output after which the program is assumed to hang. The longest step is a reference.
SILENCE = 600.0


@dataclass(frozen=True)
class End:
    """How the program ended: `error` is empty on success; `crashed` distinguishes a crash from a reported error."""

    error: str
    crashed: bool


def end_of(status: int, stderr: str) -> End:
    if status == 0:
        return End("", crashed=False)
    if status == -signal.SIGKILL:
        return End(f"killed: no output for {SILENCE:.0f} s, or out of memory", crashed=True)
    if status < 0:
        return End(f"crashed: {signal.Signals(-status).name}", crashed=True)
    said = stderr.strip().splitlines()[-1:] or [f"exit status {status}"]
    return End(said[0], crashed=False)


def lines_of(process: subprocess.Popen[str]) -> Iterator[str]:
    """The output of the process, line by line; kills a process that prints nothing for too long."""
    while True:
        watch = threading.Timer(SILENCE, process.kill)
        watch.start()
        try:
            text = process.stdout.readline()
        finally:
            watch.cancel()
        if not text:
            return
        yield text


def stream(command: Sequence[str], on_line: OnLine) -> End:
    """Runs a command and passes on each line immediately, except lines that are not JSON objects."""
    with tempfile.TemporaryFile("w+") as errors:
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True) as process:
            try:
                for text in lines_of(process):
                    if text.startswith("{"):
                        on_line(json.loads(text))
            except BaseException:
                process.kill()
                raise
        errors.seek(0)
        return end_of(process.returncode, errors.read())


def make_reference(program: str, scene: pathlib.Path, group: Group, folder: pathlib.Path) -> None:
    """Raises RuntimeError with the program's message."""
    wanted = group.reference
    bounces = [] if wanted.bounces is None else ["--bounces", str(wanted.bounces)]
    size = f"{group.size[0]}x{group.size[1]}"
    options = ["--size", size, "--samples", str(wanted.samples), "--seed", str(wanted.seed), *bounces]
    options += [] if wanted.caustics else ["--no-caustics"]
    folder.parent.mkdir(parents=True, exist_ok=True)
    end = stream([program, "reference", str(scene), *options, "--out", str(folder)], lambda line: None)
    if end.error:
        raise RuntimeError(f"no reference for {group.name}: {end.error}")


def trace_baseline(
    program: str, scene: pathlib.Path, reference: pathlib.Path, samples: Sequence[int], on_line: OnLine
) -> str:
    """Measures the path tracer itself; small numbers of samples in several rounds. Returns the error, empty if none."""
    command = [program, "baseline", str(scene), "--reference", str(reference)]
    few = [count for count in samples if count <= 64]
    many = [count for count in samples if count > 64]
    for counts, rounds in ((few, 3), (many, 1)):
        listed = ",".join(str(count) for count in counts)
        end = stream([*command, "--samples", listed, "--rounds", str(rounds)], on_line) if counts else End("", False)
        if end.error:
            return end.error
    return ""


def animate(
    program: str, script: pathlib.Path, references: pathlib.Path, motion: Motion, take: Take, on_line: OnLine
) -> str:
    """Renders one configuration with the script. Returns the error, empty if none."""
    wanted = motion.reference
    size = f"{motion.size[0]}x{motion.size[1]}"
    options = ["--size", size, "--samples", str(wanted.samples), "--seed", str(wanted.seed)]
    options += [] if wanted.bounces is None else ["--bounces", str(wanted.bounces)]
    with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="utf-8") as points:
        json.dump([{"id": take.id, "config": take.config, "fresh_seeds": take.fresh_seeds}], points)
        points.flush()
        command = [program, "animate", str(script), "--reference-dir", str(references), "--points", points.name]
        return stream([*command, *options, "--frames", str(motion.frames)], on_line).error


def running(order: Sequence[str], lines: Sequence[Line]) -> str:
    """The point that the program was measuring when it ended: first the errors of all points, then rounds of times."""
    told = {line["id"] for line in lines if line["kind"] != "time"}
    failed = {line["id"] for line in lines if line["kind"] == "failed"}
    untold = [name for name in order if name not in told]
    if untold:
        return untold[0]
    timed = [name for name in order if name not in failed] or list(order)
    times = [line["id"] for line in lines if line["kind"] == "time"]
    return timed[(timed.index(times[-1]) + 1) % len(timed)] if times else timed[0]


def is_finished(name: str, lines: Sequence[Line], rounds: int) -> bool:
    kinds = [line["kind"] for line in lines if line["id"] == name]
    return "failed" in kinds or ("errors" in kinds and kinds.count("time") >= rounds)


def measure(
    program: str,
    scene: pathlib.Path,
    reference: pathlib.Path,
    pictures: pathlib.Path,
    group: Group,
    points: Sequence[Point],
    on_line: OnLine,
    beside: pathlib.Path | None = None,
) -> None:
    """Measures the points, with times in turns with those of the scene `beside`. If the program crashes, the point that
    it was measuring fails and the others continue. If it reports an error, all remaining points fail with its
    message."""
    waiting = list(points)
    pictures.mkdir(parents=True, exist_ok=True)
    while waiting:
        seen: list[Line] = []

        def take(line: Line, seen: list[Line] = seen) -> None:
            seen.append(line)
            on_line(line)

        request = pictures / "points.json"
        request.write_text(
            json.dumps([{"id": one.id, "config": one.config, "seeds": one.seeds} for one in waiting]), encoding="utf-8"
        )
        command = [program, "measure", str(scene), "--reference", str(reference), "--points", str(request)]
        command += ["--beside", str(beside)] if beside else []
        end = stream([*command, "--rounds", str(group.rounds), "--pictures", str(pictures)], take)
        left = [one for one in waiting if not is_finished(one.id, seen, group.rounds)]
        lost = left
        if end.crashed:
            culprit = running([one.id for one in waiting], seen)
            lost = [one for one in waiting if one.id == culprit]
        for one in lost:
            on_line({"id": one.id, "kind": "failed", "message": end.error or "was not measured"})
        waiting = [one for one in left if one not in lost]
