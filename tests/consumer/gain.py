#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What a planner's author writes first: gain.cpp in Python."""
import numpy as np

import viewgain

labels = np.ones((8, 8, 8), np.uint8)  # all free
labels[:, :, 0] = 0  # but the lowest layer
grid = viewgain.BeliefGrid.from_labels(
    labels, voxel_size=0.05, origin=(-0.2, -0.2, -0.2), prior_sigma=0.025)
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), viewgain.sensor_preset("sr4000"))
print("%.17g" % evaluator.evaluate(viewgain.look_at((0.013, 0.007, 0.6), (0, 0, 0))))
