#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The example reach_from_ik: its arm's inverse kinematics, and the reach file that it writes.

    reach_from_ik_test.py SOURCE_FOLDER (with the package in PYTHONPATH)
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import viewgain

example = pathlib.Path(sys.argv[1], "apps/examples/reach_from_ik.py")
sys.path.insert(0, str(example.parent))
sys.dont_write_bytecode = True
import reach_from_ik  # noqa: E402

# Every pose that joints make has solutions, those joints among them.
random = np.random.default_rng(3)
checked = 0
for joints in random.uniform(-np.pi, np.pi, (200, 6)):
    T = reach_from_ik.forward(joints)[-1]
    solutions = list(reach_from_ik.arm_solutions(T))
    exact = [q for q in solutions if np.allclose(reach_from_ik.forward(q)[-1], T, atol=1e-6)]
    if abs(np.sin(joints[4])) < 0.05:
        continue  # near the wrist's singularity
    assert any(np.allclose(np.cos(q - joints), 1, atol=1e-6) for q in exact), joints
    checked += 1
assert checked > 150
assert reach_from_ik.ik(np.eye(4) + np.array([[0, 0, 0, 3]] + [[0] * 4] * 3)) is None  # 3 m away

with tempfile.TemporaryDirectory() as folder:
    out = pathlib.Path(folder, "arm.toml")
    subprocess.run([sys.executable, example, out, "600"], check=True, stdout=subprocess.DEVNULL)
    reach = viewgain.ReachRegion.load(out)
    poses = viewgain.read_poses(out.with_suffix(".poses.txt"))
    assert 60 < len(poses) < 600 and np.all(reach.contains(poses))
    for T in poses:
        T_flange = np.linalg.inv(reach_from_ik.T_WORLD_BASE) @ T @ np.linalg.inv(reach_from_ik.T_FLANGE_CAMERA)
        assert reach_from_ik.ik(T_flange) is not None
print("ok")
