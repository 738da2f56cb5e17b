#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the refinement that the combined gain predicts with the refinement that frames bring.

    promises.py SENSOR RUN...

See apps/docs/guide/surface_gain.md.

SENSOR is the preset of the runs. RUN is a folder from `viewgain reconstruct --save-maps on`. For
each run, the table has the refinement [nat] predicted for the views after the first. The next
column has the decrease in entropy of the points in the same voxels, divided by the prediction.
Supports maps of one scale, without obstacles and support plane.
"""
import argparse
import pathlib

import numpy as np
import viewgain


def information(grid):
    """Information per voxel: xx yy zz xy xz yz [1/m^2]; 0 if it is not occupied or has no readings."""
    states, beliefs = np.asarray(grid.states()), grid.beliefs()
    voxels = beliefs["voxel"] - np.array(grid.min_index)
    inside = np.all((voxels >= 0) & (voxels < states.shape), axis=1)
    voxels, beliefs = voxels[inside], beliefs[inside]
    measured = (beliefs["hits"] > 0) & (states[tuple(voxels.T)] == viewgain.VoxelState.OCCUPIED)
    result = np.zeros((*states.shape, 6))
    result[tuple(voxels[measured].T)] = beliefs["information"][measured]
    return result


def entropy(grid, known, voxels):
    """Entropy [nat] of the point at each voxel, which pools the 27 voxels around it."""
    padded = np.pad(known, [(1, 1)] * 3 + [(0, 0)])
    x, y, z = voxels.T
    pool = sum(padded[x + i, y + j, z + k] for i in range(3) for j in range(3) for k in range(3))
    xx, yy, zz, xy, xz, yz = pool.T
    matrices = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    covariances = np.linalg.inv(matrices + np.eye(3) / grid.prior_sigma**2)
    return 0.5 * np.log(np.einsum("nii->ni", covariances) + grid.voxel_size**2).sum(axis=1)


def promised_and_kept(run, sensor):
    """Promised and lost entropy [nat] in two columns, with a row per view after the first."""
    poses = viewgain.read_poses(run / "views.txt")
    rows = []
    after = viewgain.BeliefGrid.load(run / "maps" / "00.vdb")
    for number in range(1, len(poses)):
        before, after = after, viewgain.BeliefGrid.load(run / "maps" / f"{number:02d}.vdb")
        evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(before), sensor, gain="combined")
        parts = evaluator.contributions(poses[number])
        parts = parts[(parts["state"] == viewgain.VoxelState.OCCUPIED) & (parts["gain"] > 0)]
        voxels = parts["voxel"] - np.array(before.min_index)
        lost = entropy(before, information(before), voxels) - entropy(after, information(after), voxels)
        rows.append((parts["gain"].sum(), lost.sum()))
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sensor", help="sensor preset: " + ", ".join(viewgain.sensor_preset_names()))
    parser.add_argument("runs", nargs="+", type=pathlib.Path, metavar="RUN", help="folders from reconstruct --save-maps on")
    options = parser.parse_args()
    sensor = viewgain.sensor_preset(options.sensor)
    print("| run | promised [nat] | kept | of the 2nd, 3rd, ... view |\n|---|---|---|---|")
    for run in options.runs:
        rows = promised_and_kept(run, sensor)
        promised, lost = rows.sum(axis=0)
        shares = ", ".join(f"{share:.2f}" for share in rows[rows[:, 0] > 0, 1] / rows[rows[:, 0] > 0, 0])
        print(f"| {run.name} | {promised:.0f} | {lost / promised:.2f} | {shares} |" if promised > 0 else f"| {run.name} | 0 | | |", flush=True)


if __name__ == "__main__":
    main()
