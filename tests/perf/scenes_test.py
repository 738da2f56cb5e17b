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


def write_wedge(path):
    path.write_text("OFF\n6 8 0\n0 0 0\n3 0 0\n0 2 0\n0 0 1\n3 0 1\n0 2 1\n3 0 2 1\n3 3 4 5\n3 0 1 4\n3 0 4 3\n3 0 3 5\n3 0 5 2\n"
                    "3 1 2 5\n3 1 5 4\n")


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        write_wedge(self.root / "wedge.off")
        self.paths = [str(self.root / "wedge.off")] * 6

    def test_objects_stand_free_inside(self):
        pairs = 0
        for seed, (name, make) in itertools.product(range(3), scenes.KINDS.items()):
            parts, _, _ = make(np.random.default_rng(seed), self.paths)
            objects = [vertices for vertices, faces in parts if len(faces) == 8]
            walls = np.concatenate([np.array(vertices, float) for vertices, faces in parts if len(faces) == 6])
            self.assertEqual(len(objects), 6, name)
            for vertices in objects:
                self.assertTrue((vertices[:, :2] > walls.min(axis=0)[:2]).all() and (vertices[:, :2] < walls.max(axis=0)[:2]).all())
            for a, b in itertools.combinations(objects + [np.array(v, float) for v, t in parts if len(t) == 6], 2):
                if len(a) == 8 and len(b) == 8:
                    continue  # two walls
                apart = np.maximum(a.min(axis=0) - b.max(axis=0), b.min(axis=0) - a.max(axis=0)).max()
                self.assertGreater(apart, 0, name)
                pairs += 1
        self.assertGreater(pairs, 200)

    def test_the_program_looks_at_a_scene_from_within_reach(self):
        for name in scenes.KINDS:
            out = self.root / name
            subprocess.run([sys.executable, f"{PERF}/scenes.py", name, "3", *self.paths, "--out", out], check=True)
            flags = tomllib.loads((out / "flags.toml").read_text())
            reach = tomllib.loads((out / "reach.toml").read_text())["box"][0]
            eye = np.array(flags["from"][:3])
            self.assertTrue((eye > reach["min"]).all() and (eye < reach["max"]).all())
            vertices, _ = meshes.read_mesh(out / "scene.off")
            low, high = np.reshape(flags["workspace"], (2, 3))
            self.assertTrue((vertices > low).all() and (vertices < high).all())
        run = subprocess.run([VIEWGAIN, "reconstruct", "--config", out / "flags.toml", "--max-views", "1", "--out", out / "run", "--json",
                              "--quiet"], check=True, capture_output=True, text=True)
        self.assertGreater(json.loads(run.stdout)["coverage_visible"], 0.2)


if __name__ == "__main__":
    unittest.main()
