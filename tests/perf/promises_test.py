# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/promises.py: what it sums as promised is the gain's refinement, what it says was kept is a count by hand.
promises_test.py PERF_FOLDER VIEWGAIN"""
import itertools
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PERF, VIEWGAIN = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
del sys.argv[1:3]
sys.path.insert(0, PERF)
import promises  # noqa: E402
import viewgain  # noqa: E402

WEDGE = ("OFF\n6 8 0\n0 0 0\n3 0 0\n0 2 0\n0 0 1\n3 0 1\n0 2 1\n3 0 2 1\n3 3 4 5\n3 0 1 4\n3 0 4 3\n3 0 3 5\n3 0 5 2\n"
         "3 1 2 5\n3 1 5 4\n")


def entropy_by_hand(grid, voxel):
    low, states = np.array(grid.min_index), np.asarray(grid.states())
    beliefs = {tuple(row["voxel"] - low): row for row in grid.beliefs()}
    pool = np.eye(3) / grid.prior_sigma**2
    for step in itertools.product((-1, 0, 1), repeat=3):
        at = tuple(np.add(voxel, step))
        belief = beliefs.get(at)
        if belief is not None and belief["hits"] > 0 and states[at] == viewgain.VoxelState.OCCUPIED:
            xx, yy, zz, xy, xz, yz = map(float, belief["information"])
            pool += [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    return sum(0.5 * math.log(variance + grid.voxel_size**2) for variance in np.diag(np.linalg.inv(pool)))


class Promises(unittest.TestCase):
    def test_promised_is_refinement_and_kept_is_what_points_lost(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh, run = pathlib.Path(folder, "wedge.off"), pathlib.Path(folder, "run")
            mesh.write_text(WEDGE)
            subprocess.run([VIEWGAIN, "reconstruct", mesh, "--sensor", "sr4000", "--size", "0.2", "--voxel", "0.008", "--max-views", "4",
                            "--save-maps", "on", "--pictures", "off", "--stop", "area=0,idle=0,promises=0", "--out", run, "--quiet"],
                           check=True, capture_output=True)
            sensor, poses = viewgain.sensor_preset("sr4000"), viewgain.read_poses(run / "views.txt")
            rows = promises.promised_and_kept(run, sensor)
            grids = [viewgain.BeliefGrid.load(run / "maps" / f"{number:02d}.vdb") for number in range(4)]
            for number, (promised, _) in enumerate(rows, 1):
                evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grids[number - 1]), sensor, gain="combined")
                refinement = evaluator.evaluate_detailed(poses[number])["refinement_saturated"]
                self.assertGreater(refinement, 0.1)
                self.assertAlmostEqual(promised / refinement, 1, delta=1e-5)
            self.assertEqual(len(rows), 3)
            parts = viewgain.GainEvaluator(viewgain.VoxelScene(grids[0]), sensor).contributions(poses[1])
            lost = sum(entropy_by_hand(grids[0], voxel) - entropy_by_hand(grids[1], voxel)
                       for voxel, state, gain in zip(parts["voxel"] - np.array(grids[0].min_index), parts["state"], parts["gain"])
                       if state == viewgain.VoxelState.OCCUPIED and gain > 0)
            self.assertAlmostEqual(rows[0, 1], lost, delta=1e-9 * abs(lost))
            known = promises.information(grids[1])
            voxels = np.argwhere(known.any(axis=-1))[::40]
            self.assertGreater(len(voxels), 20)
            for voxel, value in zip(voxels, promises.entropy(grids[1], known, voxels)):
                self.assertAlmostEqual(value, entropy_by_hand(grids[1], voxel), delta=1e-9)


if __name__ == "__main__":
    unittest.main()
