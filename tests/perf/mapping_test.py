# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/peers/mapping.py: all libraries get the same readings, and the table is right for rows that are known. Runs without Open3D.
mapping_test.py PERF_FOLDER"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PEERS = pathlib.Path(sys.argv.pop(1)).resolve() / "peers"
sys.path.insert(0, str(PEERS))
import mapping  # noqa: E402
import mapping_methods  # noqa: E402
import viewgain  # noqa: E402


def ball(radius=.1, around=24):
    """A sphere of triangles."""
    polar, azimuth = np.meshgrid(np.linspace(0, np.pi, around), np.linspace(0, 2 * np.pi, 2 * around), indexing="ij")
    vertices = radius * np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1)
    n, m = polar.shape
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n - 1), np.arange(m - 1), indexing="ij"))
    a, b, c, d = i * m + j, (i + 1) * m + j, i * m + j + 1, (i + 1) * m + j + 1
    return vertices.reshape(-1, 3), np.concatenate([np.stack([a, b, c], 1), np.stack([c, b, d], 1)]).astype(np.uint32)


class Frames(unittest.TestCase):
    """Two frames of a ball of 0.1 m in front of a wall."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        vertices, triangles = ball()
        poses = list(viewgain.sphere_poses(2, .5))
        cls.scene = mapping.Scene("ball", vertices, triangles, poses, [[-.13] * 3, [.13] * 3], {"sr4000": .005})
        mapping.write_frames(cls.scene, "sr4000", True, cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_cropped_images_have_the_readings_in_the_workspace(self):
        depth, cropped = np.load(self.path / "depth.npy"), np.load(self.path / "cropped.npy")
        self.assertTrue((cropped[cropped > 0] == depth[cropped > 0]).all())
        # The ball is 0.4 m to 0.5 m away, the corners of the workspace 0.72 m, the background 1 m or more.
        self.assertGreater((cropped > 0).sum(), 1000)
        self.assertTrue((cropped[cropped > 0] < .73).all())
        self.assertTrue((depth[(cropped == 0) & (depth > 0)] > .27).all())
        self.assertGreater((depth > 1).sum(), 1000)
        self.assertTrue((cropped[depth > 1] == 0).all())

    def test_clouds_have_the_points_of_the_cropped_images(self):
        numbers, cropped = np.fromfile(self.path / "points.bin"), np.load(self.path / "cropped.npy")
        self.assertEqual([*numbers[:2], numbers[6]], [176, 144, 2])
        at = 7
        for pose, image in zip(self.scene.poses, cropped):
            T_world_camera, count = numbers[at:at + 16].reshape(4, 4), int(numbers[at + 16])
            points = numbers[at + 17:at + 17 + 3 * count].reshape(-1, 3)
            at += 17 + 3 * count
            np.testing.assert_array_equal(T_world_camera, pose)
            self.assertEqual(count, (image > 0).sum())
            z = (points - pose[:3, 3]) @ pose[:3, 2]
            np.testing.assert_allclose(z, image[image > 0], atol=1e-6)
            self.assertTrue((np.abs(points) < .13).all())
        self.assertEqual(at, len(numbers))

    def test_a_child_process_maps_the_frames(self):
        command = [sys.executable, str(PEERS / "mapping_methods.py"), "viewgain", str(self.path), "1"]
        cost = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        self.assertGreater(cost["seconds"], 0)
        self.assertGreaterEqual(cost["megabytes"], 0)
        surface = np.load(self.path / "surface.npz")
        radius = np.linalg.norm(surface["vertices"], axis=1)
        self.assertGreater(len(surface["triangles"]), 100)
        self.assertLess(abs(np.median(radius) - .1), .004)


class Table(unittest.TestCase):
    def test_means_and_ratios(self):
        row = lambda scene, method, seconds, rms: {"scene": scene, "sensor": "sr4000", "flying": True, "method": method, "seconds": seconds,
                                                   "megabytes": 10, "rms": rms, "within 0.002": None if rms is None else .5,
                                                   "within 0.005": None if rms is None else .75}
        rows = [row("camel", "viewgain", .004, .001), row("camel", mapping.REFERENCE, .002, .002), row("camel", "Bonxai", .008, None),
                row("hand", "viewgain", .008, .003), row("hand", mapping.REFERENCE, .001, .004), row("hand", "Bonxai", .001, None),
                row("room", "viewgain", .03, .005), row("room", mapping.REFERENCE, .01, .006)]
        lines = mapping.table(rows).splitlines()
        self.assertEqual(lines[2], "| camel, hand, sr4000, with flying pixels | viewgain | 6.0 | 4.00 | 10 | 2.00 | 50.0 | 75.0 |")
        self.assertEqual(lines[4], "| camel, hand, sr4000, with flying pixels | Bonxai | 4.5 | 2.00 | 10 | - | - | - |")
        self.assertEqual(lines[5], "| room, sr4000, with flying pixels | viewgain | 30.0 | 3.00 | 10 | 5.00 | 50.0 | 75.0 |")
        self.assertEqual(len(lines), 7)

    def test_methods_have_names_of_their_own(self):
        self.assertIn(mapping.REFERENCE, mapping_methods.METHODS)
        self.assertEqual(next(iter(mapping_methods.METHODS)), "viewgain")


if __name__ == "__main__":
    unittest.main()
