"""Tests of the study's arithmetic and bookkeeping, without rendering. Run with `python3 -m unittest`."""

import json
import math
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import analysis  # noqa: E402
import checks  # noqa: E402
import journal  # noqa: E402
import matrix  # noqa: E402
import measuring  # noqa: E402
import motion  # noqa: E402
import program  # noqa: E402
import results  # noqa: E402
import scenes  # noqa: E402


class Slopes(unittest.TestCase):
    def test_of_a_power_law_is_its_exponent(self) -> None:
        for exponent in (-1.0, -0.5, 2.0):
            self.assertAlmostEqual(analysis.slope([16, 64, 256], [3 * n**exponent for n in (16, 64, 256)]), exponent)

    def test_points_at_a_single_x_are_refused(self) -> None:
        with self.assertRaises(ValueError):
            analysis.slope([16, 16], [1, 2])


class Gathering(unittest.TestCase):
    def test_time_to_an_error_is_interpolated_linearly_in_logarithms(self) -> None:
        curve = [(4.0, 0.01), (1.0, 0.04), (16.0, 0.0025)]  # error = 0.04 / time
        self.assertAlmostEqual(analysis.time_to_error(curve, 0.02), 2.0)
        self.assertAlmostEqual(analysis.time_to_error(curve, 0.04), 1.0)
        self.assertIsNone(analysis.time_to_error(curve, 0.001))
        self.assertIsNone(analysis.time_to_error([], 0.001))

    def test_table_has_ratios_to_other_configurations_and_the_tracer(self) -> None:
        def one(vpls: int, lever: str, frame: float, error: float) -> dict[str, object]:
            found = row("a", f"{vpls}-{lever}", frame, error, vpls=vpls, lever=lever)
            return {**found, "suite": "gather", "full_ms": 10 * frame, "indirect_rel_mse": 2 * error}

        rows = [one(1024, "none", 40, 0.02), one(1024, "interleave-8", 4, 0.022), one(128, "interleave-2", 5, 0.1)]
        tracer = [{"suite": "gather", "scene": "a", "ms": ms, "total_rel_mse": 3.0 / ms} for ms in (10.0, 1000.0)]
        (line,) = analysis.gather_table(rows, tracer)
        self.assertAlmostEqual(line["indirect_to_all"], 1.1)
        self.assertAlmostEqual(line["frame_to_all"], 0.1)
        self.assertAlmostEqual(line["frame_to_128"], 0.8)
        self.assertAlmostEqual(line["frame_ms_to_tracer"], 4 / 100)
        self.assertAlmostEqual(line["full_ms_to_tracer"], 40 / 100)
        self.assertEqual(analysis.gather_table(rows[:2], tracer), [])

    def test_flicker_with_a_moving_camera_is_compared(self) -> None:
        def take(name: str, flicker: float) -> dict[str, object]:
            return {"suite": "camera", "scene": "orbit", "id": name, "failed": "", "indirect_flicker": flicker}

        (line,) = analysis.camera_flicker([take("all", 0.02), take("shared", 0.03)])
        self.assertAlmostEqual(line["shared_to_all"], 1.5)
        self.assertEqual(analysis.camera_flicker([take("all", 0.02)]), [])


def row(scene: str, name: str, cost: float, error: float, **axes: object) -> dict[str, object]:
    base = {"path": "deferred", "vpls": 256, "bounces": matrix.DEFAULT_BOUNCES, "bound": 1.0}
    base |= {"visibility": "maps", "lever": "none"}
    figures = {"frame_ms": cost, "full_ms": cost, "total_rel_mse": error}
    return {"suite": "matrix", "scene": scene, "id": name, "failed": "", **base, **figures, **axes}


class Matrix(unittest.TestCase):
    def groups(self) -> list[matrix.Group]:
        return matrix.scene_groups() + matrix.gather_groups() + matrix.surfel_groups() + matrix.quick_groups()

    def test_ids_are_distinct_and_valid_file_names(self) -> None:
        for group in self.groups():
            names = [one.id for one in group.points]
            self.assertEqual(len(names), len(set(names)), group.name)
            for name in names:
                self.assertRegex(name, r"^[a-z][a-z0-9.-]*$")

    def test_names_of_groups_are_distinct(self) -> None:
        names = [group.name for group in self.groups()]
        self.assertEqual(len(names), len(set(names)))

    def test_merging_keeps_other_members_of_a_group(self) -> None:
        base = {"vpls": {"count": 1}, "path": "forward"}
        change = {"vpls": {"bounces": 2}, "show": "direct"}
        expected = {"vpls": {"count": 1, "bounces": 2}, "path": "forward", "show": "direct"}
        self.assertEqual(matrix.merged(base, change), expected)
        self.assertEqual(base, {"vpls": {"count": 1}, "path": "forward"})

    def test_keys_differ_between_points_and_circumstances(self) -> None:
        group = matrix.surfel_groups()[0]
        one, other = group.points[:2]
        key = matrix.key_of(group, one, {"scene": "a"})
        self.assertEqual(key, matrix.key_of(group, one, {"scene": "a"}))
        self.assertNotEqual(key, matrix.key_of(group, one, {"scene": "b"}))
        self.assertNotEqual(key, matrix.key_of(group, other, {"scene": "a"}))


def take_row(name: str, errors: list[float], flicker: float) -> dict[str, object]:
    base = {"suite": "motion", "scene": "walk", "id": name, "failed": ""}
    return {**base, "indirect_rel_mse": errors, "indirect_flicker": flicker}


class Motions(unittest.TestCase):
    def rows(self) -> list[dict[str, object]]:
        return [
            take_row("fresh", [0.1, 0.1, 0.1], 4.0),
            take_row("fixed", [0.1, 0.1, 0.1], 0.5),
            take_row("surfels", [0.1, 0.13, 0.11], 0.125),
        ]

    def test_the_table_has_ratios_and_the_number_of_worse_frames(self) -> None:
        (line,) = analysis.flicker_table(self.rows())
        self.assertAlmostEqual(line["surfels_to_fresh"], 0.125 / 4.0)
        self.assertAlmostEqual(line["surfels_to_fixed"], 0.25)
        self.assertEqual(line["excess_frames"], 1)

    def test_a_script_with_a_missing_take_is_excluded(self) -> None:
        self.assertEqual(analysis.flicker_table(self.rows()[:2]), [])

    def test_too_much_flicker_of_surfels_fails_the_check(self) -> None:
        self.assertTrue(all(holds for _, holds, _ in checks.flicker_falls(self.rows())))
        rows = self.rows()
        rows[2]["indirect_flicker"] = 0.6
        self.assertEqual([holds for _, holds, _ in checks.flicker_falls(rows)], [True, False])
        rows[2]["failed"] = "crashed"
        self.assertEqual([holds for _, holds, _ in checks.flicker_falls(rows)], [False, False])

    def test_a_take_without_flicker_counts_as_failed(self) -> None:
        frame, flicker = {"kind": "frame"}, {"kind": "flicker"}
        self.assertEqual(measuring.told([frame, frame, flicker], "")["frames"], [frame, frame])
        self.assertEqual(measuring.told([frame], "")["kind"], "failed")
        self.assertEqual(measuring.told([frame, flicker], "crashed")["message"], "crashed")
        own_words = {"kind": "failed", "message": "its own words"}
        self.assertEqual(measuring.told([frame, own_words], "")["message"], "its own words")

    def test_takes_differ_only_in_placement_and_seeds(self) -> None:
        fresh, fixed, surfels = motion.takes()
        self.assertEqual(fresh.config, fixed.config)
        self.assertEqual(matrix.merged(surfels.config, {"vpls": {"placement": "paths"}}), fixed.config)

    def test_keys_differ_between_takes_and_scripts(self) -> None:
        walk = motion.quick_motions()[0]
        keys = {motion.key_of(walk, take, {"script": text}) for take in walk.takes for text in ("a", "b")}
        self.assertEqual(len(keys), 6)


class Worlds(unittest.TestCase):
    def test_times_are_compared_within_a_round(self) -> None:
        group = matrix.scene_groups()[0]
        one = group.points[0]
        errors = {part: {"rel_mse": 0.02, "bias": -0.25, "blotch": 0.01} for part in ("direct", "indirect", "total")}
        line = {"noise": {"indirect": 0.001}, "errors": errors, "flip": 0, "work": {}, "memory": {}}
        line |= {"picture": "a.png", "heat": "b.png"}

        def time(frame: float, slower: float) -> dict[str, object]:
            names = ("frame_ms", "full_ms", "cpu_ms", "gpu_ms", "gather_ms")
            beside = dict.fromkeys(names, frame)
            return {**dict.fromkeys(names, slower * frame), "beside": beside}

        # Another program makes the second round ten times slower.
        times = [time(1.0, 1.5), time(10.0, 1.4), time(1.1, 1.6), time(1.0, 1.7), time(1.0, 1.3)]
        row = results.row_of(group, one, {"errors": line, "times": times})
        (found,) = analysis.scene_table([row])
        self.assertAlmostEqual(found["frame_ms_to_beside"], 1.5)
        self.assertAlmostEqual(found["full_ms_to_beside"], 1.5)
        self.assertAlmostEqual(found["mean"], 0.75)

    def test_the_first_frame_of_a_script_is_not_its_slowest(self) -> None:
        take = take_row("surfels", [0.1, 0.3], 0.5)
        take |= {"suite": "worlds", "full_ms": [100.0, 2.0, 2.0, 5.0], "flicker_of_pairs": [0.2, 0.7, 0.6]}
        (line,) = analysis.world_motion_table([take])
        self.assertAlmostEqual(line["worst_to_median"], 2.5)
        self.assertAlmostEqual(line["flicker"], 0.5)
        self.assertAlmostEqual(line["worst_flicker"], 0.7)
        self.assertAlmostEqual(line["rel_mse"], 0.2)

    def test_an_error_has_settled_when_it_stays_within_a_fifth_of_the_last(self) -> None:
        self.assertEqual(analysis.frames_until_settled([0.5, 0.11, 0.3, 0.12, 0.1]), 3)
        self.assertEqual(analysis.frames_until_settled([0.1, 0.1]), 0)
        self.assertEqual(analysis.frames_until_settled([]), 0)


class Journal(unittest.TestCase):
    def written(self, *texts: str) -> dict[str, journal.Record]:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "journal.jsonl"
            path.write_text("".join(texts), encoding="utf-8")
            return journal.fold(journal.read(path))

    def line(self, kind: str, key: str = "k", end: str = "\n") -> str:
        return json.dumps({"kind": kind, "key": key}) + end

    def test_appended_lines_are_read_back(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "journal.jsonl"
            self.assertEqual(journal.read(path), [])
            journal.append(path, {"kind": "errors", "key": "a"})
            journal.append(path, {"kind": "time", "key": "a"})
            self.assertEqual([line["kind"] for line in journal.read(path)], ["errors", "time"])

    def test_a_point_is_done_after_its_last_round(self) -> None:
        record = self.written(self.line("errors"), self.line("time"), self.line("time"))["k"]
        self.assertTrue(journal.is_done(record, 2))
        self.assertFalse(journal.is_done(record, 3))
        self.assertFalse(journal.is_done(None, 0))

    def test_an_incomplete_line_does_not_count(self) -> None:
        record = self.written(self.line("errors"), self.line("time"), '{"kind": "ti')["k"]
        self.assertEqual(len(record["times"]), 1)

    def test_a_line_after_an_incomplete_line_counts(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "journal.jsonl"
            path.write_text('{"kind": "ti', encoding="utf-8")
            journal.append(path, {"kind": "errors", "key": "a"})
            self.assertEqual(journal.read(path), [{"kind": "errors", "key": "a"}])

    def test_new_errors_discard_the_times_of_a_point(self) -> None:
        record = self.written(self.line("errors"), self.line("time"), self.line("errors"))["k"]
        self.assertEqual(record["times"], [])

    def test_failed_points_are_tried_again(self) -> None:
        record = self.written(self.line("errors"), self.line("failed"))["k"]
        self.assertFalse(journal.is_done(record, 0))
        again = self.written(self.line("failed"), self.line("errors"))["k"]
        self.assertTrue(journal.is_done(again, 0))


# Replaces candela-study: "measures" all points, and crashes at the points whose names say so.
FAKE = """#!{python}
import json, os, sys
points = json.load(open(sys.argv[sys.argv.index("--points") + 1]))
rounds = int(sys.argv[sys.argv.index("--rounds") + 1])
if any("refuse" in point["id"] for point in points):
    sys.exit("fake: refused")
for point in points:
    if "crash-at-errors" in point["id"]:
        os.abort()
    kind = "failed" if "fail" in point["id"] else "errors"
    print(json.dumps({{"id": point["id"], "kind": kind, "message": "its own words"}}), flush=True)
for round in range(rounds):
    for point in points:
        if "fail" in point["id"]:
            continue
        if "crash-at-time" in point["id"] and round == 1:
            os.abort()
        print(json.dumps({{"id": point["id"], "kind": "time", "round": round}}), flush=True)
"""


class Program(unittest.TestCase):
    def measured(self, *names: str) -> dict[str, list[str]]:
        """For each point, the kinds of its lines; for failures, the message."""
        plain = {"vpls": 1, "bounces": 1, "bound": 1, "visibility": "none", "lever": "none"}
        axes = [{"path": name, **plain} for name in names]
        points = tuple(matrix.Point(each, {}, (0,)) for each in axes)
        group = matrix.Group("suite", "scene", (4, 4), matrix.Reference(2), 2, points)
        found: dict[str, list[str]] = {name: [] for name in names}

        def take(line: dict[str, str]) -> None:
            told = line["message"] if line["kind"] == "failed" else line["kind"]
            found[line["id"].removesuffix("-v1-b1-g1-none")].append(told)

        with tempfile.TemporaryDirectory() as folder:
            fake = pathlib.Path(folder) / "fake"
            fake.write_text(FAKE.format(python=sys.executable), encoding="utf-8")
            fake.chmod(0o755)
            paths = pathlib.Path("scene"), pathlib.Path("reference"), pathlib.Path(folder)
            program.measure(str(fake), *paths, group, points, take)
        return found

    def test_all_points_are_measured(self) -> None:
        self.assertEqual(self.measured("a", "b"), {name: ["errors", "time", "time"] for name in ("a", "b")})

    def test_a_failed_point_does_not_affect_the_others(self) -> None:
        found = self.measured("a", "fail", "b")
        self.assertEqual(found["fail"], ["its own words"])
        self.assertEqual(found["b"], ["errors", "time", "time"])

    def test_after_a_crash_only_the_running_point_fails(self) -> None:
        for name in ("crash-at-errors", "crash-at-time"):
            found = self.measured("a", name, "b")
            self.assertEqual(found[name][-1], "crashed: SIGABRT")
            for other in ("a", "b"):
                self.assertEqual(found[other][-3:], ["errors", "time", "time"])

    def test_after_a_refusal_all_remaining_points_fail(self) -> None:
        self.assertEqual(self.measured("a", "refuse"), {"a": ["fake: refused"], "refuse": ["fake: refused"]})


class Checks(unittest.TestCase):
    def test_nan_and_infinity_fail_the_check(self) -> None:
        for value in (math.nan, math.inf):
            found = list(checks.all_measured([row("a", "p", 1.0, value)]))
            self.assertEqual([holds for _, holds, _ in found], [True, False])

    def test_a_failed_point_fails_the_check(self) -> None:
        found = list(checks.all_measured([row("a", "p", 1.0, 0.5, failed="crashed")]))
        self.assertFalse(found[0][1])

    def test_light_leaks_fail_the_check(self) -> None:
        def rows(seeing: float) -> list[dict[str, object]]:
            return [
                row("two-rooms", f"p-{visibility}", 1.0, 0.5, vpls=1024, visibility=visibility, indirect_rel_mse=error)
                for visibility, error in (("none", 1.0), ("maps", seeing))
            ]

        self.assertTrue(all(holds for _, holds, _ in checks.obstacles_seen(rows(0.19))))
        self.assertFalse(all(holds for _, holds, _ in checks.obstacles_seen(rows(0.21))))
        self.assertFalse(all(holds for _, holds, _ in checks.obstacles_seen(rows(0.19)[1:])))

    def test_too_dark_and_too_wrong_a_world_fails_the_check(self) -> None:
        def holds(bias: float, error: float, blotch: float = 0.002, flip: float = 0.07) -> bool:
            seen = {"indirect_blotch": blotch, "flip": flip}
            one = row("apartment", "p", 1.0, 0.5, indirect_bias=bias, indirect_rel_mse=error, **seen)
            return all(right for _, right, _ in checks.worlds_right([one]))

        self.assertTrue(holds(-0.05, 0.003))
        self.assertFalse(holds(-0.07, 0.003))
        self.assertFalse(holds(0.0, 0.006))
        self.assertFalse(holds(0.0, 0.003, blotch=0.005))
        self.assertFalse(holds(0.0, 0.003, flip=0.11))

    def test_every_quick_world_has_limits(self) -> None:
        self.assertEqual(set(matrix.QUICK_WORLDS), set(checks.WORLDS))

    def test_nine_of_ten_estimates_are_within_a_factor_of_two(self) -> None:
        def rows(wrong: int) -> list[dict[str, object]]:
            right = [{"scene": "right", "vpls": i, "error_estimated": 0.19, "error_measured": 0.1} for i in range(18)]
            far = [{"scene": "wrong", "vpls": i, "error_estimated": 0.1, "error_measured": 0.21} for i in range(wrong)]
            small = [{"scene": "small", "vpls": 1, "error_estimated": 0.0, "error_measured": 0.0019}]
            return [*right, *far, *small, {"scene": "paths", "vpls": 1}]

        self.assertTrue(all(holds for _, holds, _ in checks.errors_estimated(rows(2))))
        self.assertFalse(all(holds for _, holds, _ in checks.errors_estimated(rows(3))))

    def test_a_path_with_a_different_error_fails_the_check(self) -> None:
        rows = [row("a", path, 1.0, 0.5, path=path) for path in matrix.PATHS]
        self.assertTrue(all(holds for _, holds, _ in checks.paths_agree(rows)))
        rows[2]["total_rel_mse"] = 0.52
        self.assertFalse(all(holds for _, holds, _ in checks.paths_agree(rows)))
        self.assertFalse(all(holds for _, holds, _ in checks.paths_agree(rows[:5])))


class OwnScenes(unittest.TestCase):
    def test_spheres_face_inwards_and_are_closed(self) -> None:
        surface = scenes.sphere_inwards(2.0, 8)
        edges: dict[tuple[tuple[float, ...], ...], int] = {}
        for triangle in zip(*[iter(surface.indices)] * 3):
            a, b, c = (surface.positions[i] for i in triangle)
            u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            self.assertLess(sum(x * y for x, y in zip(cross, a)), 0.0)
            for start, end in ((a, b), (b, c), (c, a)):
                key = tuple(tuple(round(x, 9) + 0.0 for x in each) for each in (start, end))
                edges[key] = edges.get(key, 0) + 1
        for (start, end), count in edges.items():
            self.assertEqual(count, edges.get((end, start)))

    def test_a_scene_is_seen_by_the_camera_that_is_asked_for(self) -> None:
        nodes = [{"name": "wall", "mesh": 0}, {"name": "in", "camera": 0}, {"name": "out", "camera": 1}]
        text = json.dumps({"scenes": [{"nodes": [0, 1, 2]}], "nodes": nodes})
        seen = json.loads(scenes.only_camera(text, "out"))
        self.assertEqual(seen, {"scenes": [{"nodes": [0, 2]}], "nodes": nodes})

    def test_hash_includes_the_content_of_referenced_files(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path, data = pathlib.Path(folder) / "a.gltf", pathlib.Path(folder) / "a.bin"
            path.write_text(json.dumps({"buffers": [{"uri": "a.bin"}]}), encoding="utf-8")
            hashes = set()
            for content in (b"1", b"2"):
                data.write_bytes(content)
                scenes.content_hash.cache_clear()
                hashes.add(scenes.content_hash(path))
            self.assertEqual(len(hashes), 2)


if __name__ == "__main__":
    unittest.main()
