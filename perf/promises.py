#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What views promise of known surface, and what their frames keep of it (apps/docs/guide/surface_gain.md).

    promises.py SENSOR RUN...    RUN: a folder of `viewgain reconstruct --save-maps on`; SENSOR: its preset

For each run the refinement in nats that the combined gain promises of the views after the first, summed, and how much
of it the points at those voxels then lost in entropy.
"""
import argparse
import pathlib

import numpy as np
import viewgain

POOLED = 9  # voxels of a piece of surface, as in the gain


def information(grid):
    """Of each voxel of the workspace that is occupied and has readings: xx yy zz xy xz yz [1/m^2]; else 0."""
    states, beliefs = np.asarray(grid.states()), grid.beliefs()
    voxels = beliefs["voxel"] - np.array(grid.min_index)
    inside = np.all((voxels >= 0) & (voxels < states.shape), axis=1)
    voxels, beliefs = voxels[inside], beliefs[inside]
    measured = (beliefs["hits"] > 0) & (states[tuple(voxels.T)] == viewgain.VoxelState.OCCUPIED)
    result = np.zeros((*states.shape, 6))
    result[tuple(voxels[measured].T)] = beliefs["information"][measured]
    return result


def entropy(grid, known, voxels):
    """Of the points at voxels, each pooling the 27 around [nat]."""
    padded = np.pad(known, [(1, 1)] * 3 + [(0, 0)])
    x, y, z = voxels.T
    pool = sum(padded[x + i, y + j, z + k] for i in range(3) for j in range(3) for k in range(3))
    xx, yy, zz, xy, xz, yz = pool.T
    matrices = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    covariances = np.linalg.inv(matrices + POOLED / grid.prior_sigma**2 * np.eye(3))
    return 0.5 * np.log(np.einsum("nii->ni", covariances) + grid.voxel_size**2).sum(axis=1)


def promised_and_kept(run, sensor):
    """[nat], one row for each view after the first."""
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
    parser.add_argument("sensor", help="one of " + ", ".join(viewgain.sensor_preset_names()))
    parser.add_argument("runs", nargs="+", type=pathlib.Path, metavar="RUN")
    options = parser.parse_args()
    sensor = viewgain.sensor_preset(options.sensor)
    print("| run | promised [nat] | kept | of the first, second ... view |\n|---|---|---|---|")
    for run in options.runs:
        rows = promised_and_kept(run, sensor)
        promised, kept = rows.sum(axis=0)
        shares = ", ".join(f"{share:.2f}" for share in rows[:, 1] / rows[:, 0])
        print(f"| {run.name} | {promised:.0f} | {kept / promised:.2f} | {shares} |", flush=True)


if __name__ == "__main__":
    main()
