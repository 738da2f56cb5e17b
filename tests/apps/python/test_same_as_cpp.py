# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess

import numpy as np

import viewgain


def test_bits_are_those_of_cpp(tmp_path, grid, sensor):
    poses = np.concatenate([viewgain.sphere_poses(200, 0.6), viewgain.shell_poses(200, 0.05, 1.0)])
    poses[7, 0, 0] = np.nan
    grid.save(tmp_path / "map.vdb")
    np.ascontiguousarray(poses[:, :3]).tofile(tmp_path / "poses")
    subprocess.run([os.environ["VIEWGAIN_GAINS"], tmp_path / "map.vdb", tmp_path / "poses",
                    tmp_path / "gains"], check=True, stdout=subprocess.DEVNULL)
    cpp = np.fromfile(tmp_path / "gains")
    python = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, gain="paper").evaluate(poses)
    assert cpp.shape == python.shape == (400,)
    assert np.isnan(cpp[7]) and np.count_nonzero(cpp > 0) > 300
    assert np.delete(cpp, 7).tobytes() == np.delete(python, 7).tobytes()
