# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/covers.py, meshes.py, tammes.py, visibility.py and objview.py against brute force, known optima and closed forms, and
limits.py on a small study. limits_test.py PERF_FOLDER VIEWGAIN"""
import itertools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PERF, VIEWGAIN = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
del sys.argv[1:3]
sys.path.insert(0, PERF)
import covers  # noqa: E402
import meshes  # noqa: E402
import tammes  # noqa: E402


def instances(count):
    """Small ones at random: a matrix, areas and, half of the time, a first view."""
    random = np.random.default_rng(7)
    for case in range(count):
        views, cells = random.integers(2, 8), random.integers(1, 25)
        seen = random.random((views, cells)) < random.choice([0.15, 0.3, 0.5])
        yield seen, random.integers(1, 9, cells).astype(float), None if case % 2 else int(random.integers(views))


def subsets(views, size, first):
    return (s for s in itertools.combinations(range(views), size) if first is None or first in s)


class Covers(unittest.TestCase):
    def test_least_views_is_that_of_all_subsets(self):
        cases = unreachable = 0
        for seen, area, first in instances(40):
            for share in (0.3, 0.8, 0.9, 1.0):
                sizes = [k for k in range(1, len(seen) + 1) for s in subsets(len(seen), k, first)
                         if covers.share_of(seen, area, s) >= share - covers.SLACK]
                found = covers.least_views(seen, area, share, first=first)
                cases += 1
                if not sizes:
                    self.assertIsNone(found.views)
                    unreachable += 1
                    continue
                self.assertEqual(len(found.views), sizes[0])
                self.assertEqual(len(set(found.views)), sizes[0])
                self.assertEqual(found.bound, sizes[0])
                self.assertLessEqual(found.lp_bound, found.bound)
                self.assertGreaterEqual(covers.share_of(seen, area, found.views), share - 1e-6)
                self.assertTrue(first is None or found.views[0] == first)
        self.assertEqual(cases, 160)
        self.assertGreater(unreachable, 15)
        self.assertLess(unreachable, 145)

    def test_best_of_is_that_of_all_subsets_and_not_under_greedy(self):
        cases = above = 0
        for seen, area, first in instances(40):
            for k in range(1, len(seen) + 1):
                most = max(covers.share_of(seen, area, s) for s in subsets(len(seen), k, first))
                found = covers.best_of(seen, area, k, first=first)
                self.assertLessEqual(len(found.views), k)
                self.assertAlmostEqual(found.share, most, places=9)
                self.assertAlmostEqual(found.share, covers.share_of(seen, area, found.views), places=12)
                self.assertAlmostEqual(found.bound, most, places=3)  # HiGHS's gap
                self.assertGreaterEqual(found.bound, found.share)
                if first is None:
                    simple = covers.share_of(seen, area, covers.greedy(seen, area, k))
                    self.assertLessEqual(simple, most + 1e-9)
                    self.assertGreaterEqual(simple, (1 - 1 / np.e) * most - 1e-9)
                    above += most > simple + 1e-9
                cases += 1
        self.assertGreater(cases, 100)
        self.assertGreater(above, 0)  # greedy is not always best

    def test_without_time_bounds_stand(self):
        random = np.random.default_rng(5)
        seen, area = random.random((60, 400)) < 0.12, np.ones(400)
        found, proven = covers.least_views(seen, area, 0.9, seconds=1e-3), covers.least_views(seen, area, 0.75)
        self.assertLessEqual(found.bound, len(found.views))
        self.assertGreaterEqual(covers.share_of(seen, area, found.views), 0.9 - 1e-6)
        self.assertLessEqual(proven.bound, len(found.views))
        best = covers.best_of(seen, area, 5, seconds=1e-3)
        self.assertGreaterEqual(best.bound, best.share)


class Tammes(unittest.TestCase):
    def test_known_optima(self):
        # n = 2 to 14 and 24 are proven.
        known = {2: 180, 3: 120, 4: 109.471, 5: 90, 6: 90, 7: 77.870, 8: 74.858, 9: 70.529, 10: 66.147, 11: 63.435, 12: 63.435,
                 13: 57.137, 14: 55.671, 24: 43.691}
        for count, angle in known.items():
            points = tammes.tammes(count)
            self.assertEqual(points.shape, (count, 3))
            np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1, atol=1e-12)
            self.assertAlmostEqual(tammes.least_angle(points), angle, delta=0.01)
        self.assertEqual(len(known), 14)

    def test_bad_counts_and_seeds(self):
        with self.assertRaisesRegex(ValueError, "1 directions"):
            tammes.tammes(1)
        np.testing.assert_array_equal(tammes.tammes(9, starts=1), tammes.tammes(9, starts=1))


class Visibility(unittest.TestCase):
    def test_a_sphere(self):
        import viewgain
        import visibility

        # A sphere of 10 cm round the origin, seen from 0.5 m: what lies at under 72 deg, which no part of it hides.
        sphere = visibility.KnownObject(*globe(0.1), viewgain.Sensor.load("sr4000"), 4000)
        self.assertAlmostEqual(sphere.area, 4 * np.pi * 0.1**2, delta=1e-3 * sphere.area + 4e-4)
        checked = 0
        for pose in viewgain.sphere_poses(5, 0.5):
            sight = sphere.points - pose[:3, 3]
            cosine = -(sight * sphere.points).sum(axis=1) / np.linalg.norm(sight, axis=1) / np.linalg.norm(sphere.points, axis=1)
            seen, steepest = sphere.sees(pose), visibility.LEAST_COSINE
            clear = np.abs(cosine - steepest) > 0.03  # the mesh has facets
            np.testing.assert_array_equal(seen[clear], cosine[clear] > steepest)
            checked += clear.sum()
        self.assertGreater(checked, 4 * 4000)

    def test_what_hides_and_what_is_out_of_the_image(self):
        import viewgain
        import visibility

        # A square behind a smaller one, from where the smaller one hides a part that is known.
        def square(half, x):
            return [[x, s * half, t * half] for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]

        vertices = np.array(square(0.3, -0.1) + square(0.05, 0.1))
        triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.uint32)
        sensor = viewgain.Sensor.load("sr4000")
        plates = visibility.KnownObject(vertices, triangles, sensor, 20000)
        pose = viewgain.look_at([0.5, 0, 0], [0, 0, 0])
        behind, across = plates.points[:, 0] < 0, np.abs(plates.points[:, 1:])
        hidden = behind & (across.max(axis=1) < 0.05 * 0.6 / 0.4)
        edge = behind & (np.abs(across.max(axis=1) - 0.05 * 0.6 / 0.4) < 0.002)
        camera = sensor.camera
        border = [0.6 * camera.width / 2 / camera.fx, 0.6 * camera.height / 2 / camera.fy]
        edge |= behind & (np.abs(across - border) < 0.002).any(axis=1)
        inside = ~behind | (across < border).all(axis=1)
        seen = plates.sees(np.asarray(pose))
        np.testing.assert_array_equal(seen[~edge], (inside & ~hidden)[~edge])
        self.assertGreater(hidden.sum(), 500)
        self.assertGreater((~inside).sum(), 500)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            files = {"a.off": "OFF # a comment\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
                     "b.off": "OFF 4 1 0 0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3\n",
                     "c.obj": "v 0 0 0\nv 1 0 0 # x\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n",
                     "d.obj": "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n"}
            for name, text in files.items():
                path = pathlib.Path(folder, name)
                path.write_text(text, encoding="utf-8")
                vertices, triangles = meshes.read_mesh(path)
                self.assertEqual((vertices.tolist()[2], triangles.tolist()), ([1, 1, 0], [[0, 1, 2], [0, 2, 3]]), name)
                np.testing.assert_allclose(meshes.scaled(vertices, 0.5).max(axis=0), [0.25, 0.25, 0])
                for wrong in ("", "OFF 3 1", "OFF 4 1 0 0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 4", "STL 0 0 0", "v 0 0 0\nf 1 2 3", "f 1 2 0"):
                    path.write_text(wrong, encoding="utf-8")
                    with self.assertRaisesRegex(SystemExit, name):
                        meshes.read_mesh(path)


BOX = "OFF\n8 6 0\n" + "".join(f"{x} {y} {z}\n" for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) + "".join(
    "4 " + face + "\n" for face in ("0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"))


class Program(unittest.TestCase):
    def test_objview_of_a_box(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "box.off").write_text(BOX, encoding="utf-8")
            corners = "".join(f"{x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
            pathlib.Path(folder, "views.txt").write_text(corners, encoding="utf-8")
            pathlib.Path(folder, "bad.txt").write_text("1 2\n", encoding="utf-8")

            def objview(*more):
                return subprocess.run([sys.executable, f"{PERF}/objview.py", "box.off", "--views", "views.txt", "--observable",
                                       "views.txt", "--budget", "3", *more], cwd=folder, capture_output=True, text=True)

            done = objview("--sectors", "hemi,eighth")
            self.assertEqual(done.returncode, 0, done.stderr)
            # From a corner three of six sides are seen; two of the upper four corners see all five sides that any does.
            # The eighth has one view, which sees all that it can.
            rows = re.findall(r"^\| (\w+) \| (\w+) \| ([\d. |]+) \|$", done.stdout, re.M)
            self.assertEqual(len(rows), 10, done.stdout)
            for sector, policy, values in rows:
                values = [float(value) for value in values.split("|")]
                self.assertEqual(len(values), 7)
                if sector == "eighth" or policy == "oracle":
                    self.assertEqual(values[0], 100, (sector, policy))
            self.assertIn("| hemi | 100.0 | 2 | 2 | 2 | 2 |", done.stdout)
            self.assertIn("| eighth | 100.0 | 1 | 1 | 1 | 1 |", done.stdout)
            self.assertIn("bad.txt", objview("--starts", "bad.txt").stderr)
            self.assertEqual(objview("--sectors", "third").returncode, 2)

    def test_limits_of_a_small_study(self):
        spec = '''objects = ["box.off"]
policies = ["frontier", "random"]
seeds = [1, 2]
sensors = ["sr4000"]
voxels = [0.02]
sizes = [0.3]
max_views = 4
tolerance = 0.02
'''
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "box.off").write_text(BOX, encoding="utf-8")

            def limits(name, text):
                pathlib.Path(folder, f"{name}.toml").write_text(text, encoding="utf-8")
                subprocess.run([sys.executable, "-m", "viewgain.study", f"{name}.toml", "--out", name, "--program", VIEWGAIN, "--quiet"], cwd=folder, check=True,
                               stdout=subprocess.DEVNULL)
                return lambda *more: subprocess.run([sys.executable, f"{PERF}/limits.py", f"{name}.toml", name, "--samples", "150",
                                                     "--dense", "20", *more], cwd=folder, capture_output=True, text=True)

            run = limits("kept", "kept_candidates = 6\n" + spec)
            done = run()
            self.assertEqual(done.returncode, 0, done.stderr)
            # A view sees at most three of six sides, the start less, and not all of each: one more does not do, three do.
            proven = re.findall(r"proven for 2 of 2 starts.*for (\d) of 4 runs.*; (\d) of these cannot", done.stdout)
            self.assertEqual([int(own) + int(never) for own, never in proven], [4, 4, 4], done.stdout)
            for seed in (1, 2):
                self.assertRegex(done.stdout, rf"\| box \| {seed} \| [34], \d, \d\.\d+ \|")
            self.assertEqual(len(re.findall(r"^\| (?:frontier|random) \| \d\d % \|", done.stdout, re.M)), 6, done.stdout)
            self.assertEqual(len(re.findall(r"^\| \d+ (?:\| \d+\.\d ){6}\|", done.stdout, re.M)), 12, done.stdout)
            self.assertNotIn("nan", done.stdout)
            again = run()  # from the matrices that are kept
            self.assertEqual(again.stdout, done.stdout)
            self.assertEqual(len(list(pathlib.Path(folder, "kept/visibility").iterdir())), 5)
            bare = limits("bare", spec)()
            self.assertNotEqual(bare.returncode, 0)
            self.assertIn("kept_candidates", bare.stderr)


def globe(radius, rows=60):
    """Vertices and triangles of a sphere."""
    latitude, longitude = np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, 2 * rows, endpoint=False)
    t, p = np.meshgrid(latitude, longitude, indexing="ij")
    vertices = radius * np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    at = lambda i, j: i * 2 * rows + j % (2 * rows)
    triangles = [t for i in range(rows) for j in range(2 * rows)
                 for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))
                 if np.linalg.norm(np.cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]])) > 1e-12]
    return vertices, np.array(triangles, np.uint32)


if __name__ == "__main__":
    unittest.main()
