"""The machine and the program of a study: everything that is needed to repeat it."""

import datetime
import hashlib
import os
import pathlib
import platform
import shutil
import subprocess
import sys
from typing import Any

from scenes import ROOT

SOURCES = ("engine", "renderer", "sandbox", "shaders", "tests/study/*.[ch]pp")


def cpu_model() -> str:
    """The name that the kernel reports."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def machine() -> dict[str, Any]:
    return {
        "name": platform.node(),
        "cpu": cpu_model(),
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.platform(),
    }


def git(*arguments: str) -> str:
    """The output of git; empty if it is not installed."""
    if shutil.which("git") is None:
        return ""
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True).stdout.strip()


def provenance(program: pathlib.Path) -> dict[str, Any]:
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "commit": git("rev-parse", "HEAD") or "unknown",
        "changed_since_commit": bool(git("status", "--porcelain", "--", *SOURCES)),
        "command": " ".join(["tests/study/run", *sys.argv[1:]]),
        "program_sha256": file_hash(program),
        "python": platform.python_version(),
    }


def file_hash(path: pathlib.Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]
