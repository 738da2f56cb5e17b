#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""draw_choosing.py CAMEL.off OUT.png: how well rankings hold for voxel sizes, priors, criteria and strides, measured.

The camel at 0.35 m and a simulated SR4000 with noise. After 1, 3 and 5 views (of 40 on a sphere of 0.6 m, far from one another) each
of 60 views is taken in a trial: what it truly shows are the voxels of a map with 5 mm that become occupied. Spearman's
correlations with that, or with the gains of all rays, are means over the three. Prints what it draws. About half a minute.
"""
import sys
import time

import matplotlib.pyplot as plt
import numpy as np

import viewgain

SENSOR = viewgain.sensor_preset("sr4000")
WORKSPACE = [[-0.2, -0.2, -0.2], [0.2, 0.2, 0.2]]
CANDIDATES = viewgain.sphere_poses(60, 0.6)


def read_off(path):
    with open(path, encoding="ascii") as file:
        words = [line.split() for line in file if line.strip() and not line.startswith("#")]
    vertices, faces = int(words[1][0]), int(words[1][1])
    points = np.array(words[2:2 + vertices], float)[:, [0, 2, 1]] * [1, -1, 1]  # y up becomes z up
    triangles = np.array(words[2 + vertices:2 + vertices + faces], int)[:, 1:]
    low, high = points.min(axis=0), points.max(axis=0)
    return (points - (low + high) / 2) * 0.35 / (high - low).max(), triangles


def spearman(a, b):
    ranks = [np.argsort(np.argsort(x)) for x in (a, b)]
    return float(np.corrcoef(ranks)[0, 1])


def new_grid(voxel, sigma=None):
    return viewgain.BeliefGrid(voxel_size=voxel, workspace=WORKSPACE, sensor=SENSOR, prior_sigma=sigma)


def main():
    camera = viewgain.SimulatedSensor(*read_off(sys.argv[1]), SENSOR, noise=True, background_radius=1.5)
    integrator = viewgain.FrameIntegrator(SENSOR)
    ring = viewgain.sphere_poses(40, 0.6)
    taken = [ring[0]]
    while len(taken) < 5:  # the one that is farthest from those so far
        away = [min(np.linalg.norm(pose[:3, 3] - other[:3, 3]) for other in taken) for pose in ring]
        taken.append(ring[int(np.argmax(away))])
    frames = [(*camera.acquire(pose, i), pose) for i, pose in enumerate(taken)]
    trials = [(*camera.acquire(pose, 100 + i), pose) for i, pose in enumerate(CANDIDATES)]

    def map_after(views, voxel, sigma=None):
        grid = new_grid(voxel, sigma)
        for depth, amplitude, pose in frames[:views]:
            integrator.integrate(grid, depth, pose, amplitude=amplitude)
        return grid

    def shown_after(views):
        before = map_after(views, 0.005)
        shown = []
        for depth, amplitude, pose in trials:
            after = before.clone()
            integrator.integrate(after, depth, pose, amplitude=amplitude)
            shown.append(np.count_nonzero((after.states() == 2) & (before.states() != 2)))
        return np.array(shown)

    states = {views: shown_after(views) for views in (1, 3, 5)}

    def score(views, voxel=0.005, sigma=None, **settings):
        evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(map_after(views, voxel, sigma)), SENSOR, **settings)
        evaluator.evaluate(CANDIDATES)
        begin = time.perf_counter()
        gains = evaluator.evaluate(CANDIDATES)
        return gains, len(CANDIDATES) / (time.perf_counter() - begin)

    def agreement(**settings):
        return float(np.mean([spearman(score(views, **settings)[0], shown) for views, shown in states.items()]))

    figure, (of_voxel, of_prior, of_stride) = plt.subplots(1, 3, figsize=(13, 3.8), layout="constrained")

    voxels = [0.0025, 0.004, 0.005, 0.008, 0.0125, 0.02]
    for gain in ("combined", "surface", "paper"):
        values = [agreement(voxel=voxel, gain=gain) for voxel in voxels]
        print("voxel", gain, dict(zip(voxels, np.round(values, 3))))
        of_voxel.plot(1e3 * np.array(voxels), values, "o-", label=gain)
    of_voxel.axvline(1e3 * 0.6 / SENSOR.camera.fx, color="grey", linestyle=":", label="a pixel's footprint")
    of_voxel.set(xlabel="voxel [mm]", ylabel="rank correlation with what views show", xscale="log", ylim=(0, 1))
    of_voxel.set_xticks([2.5, 5, 10, 20], ["2.5", "5", "10", "20"])
    of_voxel.minorticks_off()
    of_voxel.legend()

    sigmas = [0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.064]
    for criterion in viewgain.criterion_names():
        values = [agreement(sigma=sigma, gain="paper", criterion=criterion) for sigma in sigmas]
        print("sigma_0", criterion, dict(zip(sigmas, np.round(values, 3))))
        of_prior.plot(1e3 * np.array(sigmas), values, "o-", label=criterion)
    default = viewgain.default_prior_sigma(0.005, SENSOR)
    print("default sigma_0", default, "noise", SENSOR.sigmas(0.6))
    of_prior.axvline(1e3 * default, color="grey", linestyle=":", label="the default")
    of_prior.set(xlabel="σ₀ [mm], gain paper", xscale="log", ylim=(0, 1))
    of_prior.legend()

    strides = [1, 2, 4, 8, 16]
    for gain in ("combined", "surface", "paper"):
        full = {views: score(views, gain=gain) for views in states}
        rows = []
        for stride in strides:
            strided = {views: score(views, gain=gain, pixel_stride=stride) for views in states}
            rows.append((np.mean([spearman(full[v][0], strided[v][0]) for v in states]),
                         np.mean([1 - full[v][0][np.argmax(strided[v][0])] / full[v][0].max() for v in states]),
                         np.median([strided[v][1] / full[v][1] for v in states])))
        print("stride", gain, [(s, *np.round(row, 3)) for s, row in zip(strides, rows)])
        of_stride.plot(strides, [row[0] for row in rows], "o-", label=gain)
    of_stride.set(xlabel="pixel stride", ylabel="rank correlation with all rays", xscale="log", ylim=(0, 1))
    of_stride.set_xticks(strides, [str(s) for s in strides])
    of_stride.minorticks_off()
    of_stride.legend()
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
