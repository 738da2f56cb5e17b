# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/scenes.py: objects stand free and inside, the camera begins within reach, and the program looks at a scene.
scenes_test.py PERF_FOLDER VIEWGAIN"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import numpy as np

PERF, VIEWGAIN = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
del sys.argv[1:3]
sys.path.insert(0, PERF)
import meshes  # noqa: E402
import scenes  # noqa: E402

HAS_MESHES = meshes.CGAL.exists() and meshes.FURNITURE.is_dir()


def write_wedge(path):
    path.write_text("OFF\n6 8 0\n0 0 0\n3 0 0\n0 2 0\n0 0 1\n3 0 1\n0 2 1\n3 0 2 1\n3 3 4 5\n3 0 1 4\n3 0 4 3\n3 0 3 5\n3 0 5 2\n"
                    "3 1 2 5\n3 1 5 4\n")


def crossings(a, b):
    """Number of pairs of a triangle of `a` and one of `b`, (n, 3, 3) each, that meet: no axis separates their corners."""
    low_a, high_a, low_b, high_b = a.min(axis=1), a.max(axis=1), b.min(axis=1), b.max(axis=1)
    a_near = ((low_a <= high_b.max(axis=0)) & (high_a >= low_b.min(axis=0))).all(axis=1)
    b_near = ((low_b <= high_a.max(axis=0)) & (high_b >= low_a.min(axis=0))).all(axis=1)
    count = 0
    for i in np.flatnonzero(a_near):
        other = b[b_near & ((low_b <= high_a[i]) & (high_b >= low_a[i])).all(axis=1)]
        if len(other) == 0:
            continue
        edges_a = np.roll(a[i], -1, axis=0) - a[i]
        edges_b = np.roll(other, -1, axis=1) - other
        normal_a, normals_b = np.cross(edges_a[0], edges_a[1]), np.cross(edges_b[:, 0], edges_b[:, 1])
        axes = [np.broadcast_to(normal_a, normals_b.shape), normals_b]
        axes += [np.cross(edges_a[k], edges_b[:, m]) for k in range(3) for m in range(3)]
        axes += [np.cross(normal_a, edges_a[k])[None].repeat(len(other), 0) for k in range(3)]  # for triangles in one plane
        axes += [np.cross(normals_b, edges_b[:, k]) for k in range(3)]
        apart = np.zeros(len(other), bool)
        for axis in axes:
            on_a, on_b = axis @ a[i].T, np.einsum("nk,nck->nc", axis, other)
            apart |= (on_a.max(axis=1) < on_b.min(axis=1)) | (on_b.max(axis=1) < on_a.min(axis=1))
        count += int((~apart).sum())
    return count


def triangles_of(part):
    vertices, faces = np.array(part[0], float), part[1]
    return vertices[[[face[0], face[k], face[k + 1]] for face in faces for k in range(1, len(face) - 1)]]


def is_wall(part):
    return isinstance(part[0], list)


def inside(reach, eye):
    """The reach file as its documentation says: in a box or shell, and in every half-space."""
    boxes, shells = reach.get("box", []), reach.get("shell", [])
    distances = [np.linalg.norm(eye - np.array(one["center"])) for one in shells]
    within = [all(np.array(one["min"]) <= eye) and all(eye <= np.array(one["max"])) for one in boxes]
    within += [one["min_radius"] <= distance <= one["max_radius"] for one, distance in zip(shells, distances)]
    return any(within) and all(np.dot(one["normal"], eye) >= one["offset"] for one in reach.get("half_space", []))


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        write_wedge(self.root / "wedge.off")
        self.paths = [str(self.root / "wedge.off")] * 6

    def call(self, *words):
        return subprocess.run([sys.executable, f"{PERF}/scenes.py", *map(str, words)], capture_output=True, text=True, check=False)

    def test_the_check_of_crossings_finds_them(self):
        triangle = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], float)
        through = np.array([[[.2, .2, -1], [.2, .2, 1], [.3, .2, 1]]])
        self.assertEqual(crossings(triangle, through), 1)
        self.assertEqual(crossings(triangle, triangle + [.1, .1, 0]), 1)  # in one plane
        self.assertEqual(crossings(triangle, triangle + [0, 0, 1e-3]), 0)
        self.assertEqual(crossings(triangle, through + [.8, 0, 0]), 0)

    def check_parts(self, name, parts, count):
        objects, walls = [part for part in parts if not is_wall(part)], [part for part in parts if is_wall(part)]
        self.assertEqual(len(objects), count, name)
        low, high = (of([of(np.array(vertices, float), axis=0) for vertices, _ in walls], axis=0) for of in (np.min, np.max))
        for a in objects:
            self.assertTrue((a[0][:, :2] > low[:2]).all() and (a[0][:, :2] < high[:2]).all(), name)
        pairs = list(itertools.combinations(objects, 2)) + list(itertools.product(objects, walls))
        for a, b in pairs:
            self.assertEqual(crossings(triangles_of(a), triangles_of(b)), 0, name)
            # Nor does one contain the other.
            apart = np.maximum(a[0].min(axis=0) - np.max(b[0], axis=0), np.min(b[0], axis=0) - a[0].max(axis=0)).max()
            self.assertGreater(apart, 0, name)
        return len(pairs)

    def test_objects_stand_free_inside(self):
        pairs = 0
        for seed, (name, make) in itertools.product(range(3), scenes.KINDS.items()):
            parts, reach, view = make(np.random.default_rng(seed), self.paths)
            pairs += self.check_parts(name, parts, 6)
            for start in scenes.starts(view):
                self.assertTrue(reach.contains(start[:3]), name)
        self.assertGreater(pairs, 400)

    def test_a_scene_follows_from_its_seed(self):
        for name in scenes.KINDS:
            for seed, out in ((3, "a"), (3, "b"), (4, "c")):
                scenes.write(name, seed, self.paths, self.root / name / out)
            a, b, c = ((self.root / name / out / "scene.off").read_bytes() for out in "abc")
            self.assertTrue(a == b and a != c, name)

    @unittest.skipUnless(HAS_MESHES, "needs libcgal-demo and sweethome3d-furniture")
    def test_the_listed_scenes(self):
        listed = scenes.listed()
        uses = [scene["use"] for scene in listed.values()]
        self.assertGreaterEqual(uses.count("report"), 6)
        self.assertEqual(uses.count("tuning"), 3)
        self.assertEqual({scene["kind"] for scene in listed.values()}, set(scenes.KINDS))
        tuned = {mesh for scene in listed.values() if scene["use"] == "tuning" for mesh in scene["meshes"]}
        for name, scene in listed.items():
            parts, _, _ = scenes.KINDS[scene["kind"]](np.random.default_rng(scene["seed"]), scene["meshes"])
            self.check_parts(name, parts, len(scene["meshes"]))
            self.assertFalse(scene["use"] == "report" and tuned & set(scene["meshes"]), f"{name} has an object that was tuned on")

    def test_the_program_looks_at_a_scene_from_within_reach(self):
        for name in scenes.KINDS:
            out = self.root / name
            self.assertEqual(self.call(name, 3, *self.paths, "--out", out).returncode, 0)
            flags = tomllib.loads((out / "flags.toml").read_text())
            reach = tomllib.loads((out / "reach.toml").read_text())
            starts = np.loadtxt(out / "starts.txt")
            self.assertEqual(starts.shape, (3, 8))
            self.assertTrue(np.allclose(starts[0, 1:], flags["from"]))
            for start in starts:
                self.assertTrue(inside(reach, start[1:4]), name)
            vertices, _ = meshes.read_mesh(out / "scene.off")
            low, high = np.reshape(flags["workspace"], (2, 3))
            self.assertTrue((vertices > low).all() and (vertices < high).all())
            self.assertTrue(np.allclose(vertices.min(axis=0), -vertices.max(axis=0), atol=1e-6))
            run = subprocess.run([VIEWGAIN, "reconstruct", "--config", out / "flags.toml", "--max-views", "1", "--out", out / "run", "--json",
                                  "--quiet"], check=True, capture_output=True, text=True)
            self.assertGreater(json.loads(run.stdout)["coverage_visible"], 0.2, name)

    def test_degenerate_calls_end_with_a_message(self):
        (self.root / "point.off").write_text("OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n")
        (self.root / "empty.off").write_text("")
        out = ["--out", self.root / "out"]
        for words, message in (((["bin", 1, *self.paths * 12, *out]), "no free place is left"),
                               (["plant", 1, *self.paths[:2], *out], "requires three meshes"),
                               (["bin", 1, self.root / "point.off", *out], "has no extent"),
                               (["bin", 1, self.root / "empty.off", *out], "expected a mesh"),
                               (["bin", 1, self.root / "none.off", *out], "expected a mesh"),
                               (["bin", 1, "Nobody:chair", *out], "expected a mesh"),
                               (["bin", 1, *out], "are required"),
                               (["--listed", "attic-1", *out], "no scene attic-1"),
                               (["bin", "--listed", *out], "cannot be used with")):
            call = self.call(*words)
            self.assertNotEqual(call.returncode, 0, words)
            self.assertIn(message, call.stderr)
            self.assertNotIn("Traceback", call.stderr)
        self.assertFalse((self.root / "out").exists())

    def test_one_object_and_flat_ones(self):
        (self.root / "sheet.off").write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
        for name in ("bin", "table", "shelf", "kitchen"):
            for path in (self.paths[0], str(self.root / "sheet.off")):
                parts, _, _ = scenes.KINDS[name](np.random.default_rng(1), [path])
                self.check_parts(name, parts, 1)

    def test_corners_that_no_face_has_do_not_count(self):
        text = (self.root / "wedge.off").read_text().replace("OFF\n6 8 0\n", "OFF\n7 8 0\n").split("\n")
        (self.root / "far.off").write_text("\n".join(text[:8] + ["90 90 90"] + text[8:]))
        plain, far = (scenes.standing(str(self.root / f"{name}.off"), .1, .5)[0] for name in ("wedge", "far"))
        self.assertTrue(np.allclose(plain, far))


if __name__ == "__main__":
    unittest.main()
