"""One run of the study: where files are, and what has been measured so far."""

import pathlib
from typing import Any

import journal
import machine
import matrix
import motion
import scenes
from matrix import Group, Point
from motion import Motion, Take

BUILD = scenes.ROOT / "build"
STUDY = BUILD / "release" / "candela-study"
ANIMATIONS = scenes.ROOT / "sandbox" / "animations"
SCENES = BUILD / "study" / "scenes"  # scenes that are not shipped


def pictures_of(group: Group) -> pathlib.Path:
    """The folder for the group's pictures and heat maps."""
    return BUILD / "study" / "pictures" / group.name.replace("/", "-")


class Study:
    """`out` contains the journal. Its results for this machine and this program are not measured again."""

    def __init__(self, out: pathlib.Path) -> None:
        self.out = out
        self.journal = out / "journal.jsonl"
        self.records = journal.fold(journal.read(self.journal))
        self.machine = machine.machine()
        self.program = machine.file_hash(STUDY)

    def scene(self, group: Group) -> pathlib.Path:
        return scenes.find(group.scene, SCENES)

    def beside(self, group: Group) -> pathlib.Path | None:
        return scenes.find(group.beside, SCENES) if group.beside else None

    def circumstances(self, group: Group) -> dict[str, Any]:
        content = scenes.content_hash(self.scene(group))
        return {"scene": content, "machine": self.machine, "program": self.program}

    def keys(self, group: Group) -> dict[str, str]:
        """The keys of the group's points and, as 'tracer', of its baseline."""
        circumstances = self.circumstances(group)
        keys = {one.id: matrix.key_of(group, one, circumstances) for one in group.points}
        samples = Point({}, {"tracer": group.tracer_samples}, ())
        return {**keys, "tracer": matrix.key_of(group, samples, circumstances)}

    def reference(self, group: Group) -> pathlib.Path:
        """The folder of the group's reference; its name is a hash of what is asked of the path tracer."""
        request = {**vars(group.reference), "size": group.size}
        name = matrix.digest({**request, "scene": scenes.content_hash(self.scene(group))})
        return BUILD / "study" / "references" / name

    def missing(self, group: Group) -> list[Point]:
        keys = self.keys(group)
        return [one for one in group.points if not journal.is_done(self.records.get(keys[one.id]), group.rounds)]

    def misses_tracer(self, group: Group) -> bool:
        found = self.records.get(self.keys(group)["tracer"], {})
        return bool(group.tracer_samples) and "tracer" not in found

    def motion_key(self, played: Motion, take: Take) -> str:
        """The key of one configuration in one script; depends on the text of the script."""
        content = scenes.content_hash(scenes.find(motion.scene_of(played, ANIMATIONS), SCENES))
        text = motion.script_text(played, ANIMATIONS)
        circumstances = {"scene": content, "script": text, "machine": self.machine, "program": self.program}
        return motion.key_of(played, take, circumstances)

    def missing_takes(self, played: Motion) -> list[Take]:
        known = lambda take: "motion" in self.records.get(self.motion_key(played, take), {})  # noqa: E731
        return [take for take in played.takes if not known(take)]

    def script(self, played: Motion) -> pathlib.Path:
        """The file of the script; writes it if it is not shipped."""
        shipped = ANIMATIONS / f"{played.script}.json"
        if shipped.exists():
            return shipped
        written = BUILD / "study" / "scripts" / f"{played.script}.json"
        written.parent.mkdir(parents=True, exist_ok=True)
        written.write_text(motion.script_text(played, ANIMATIONS), encoding="utf-8")
        return written

    def frame_references(self, played: Motion) -> pathlib.Path:
        """The folder of the frames' references, whose names within it are hashes of what they show."""
        request = {**vars(played.reference), "size": played.size}
        return BUILD / "study" / "references" / f"frames-{matrix.digest(request)}"

    def note(self, line: dict[str, Any]) -> None:
        journal.append(self.journal, line)
