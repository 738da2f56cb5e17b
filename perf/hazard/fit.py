#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""fit.py VIEWGAIN MESH... [--size M] [--voxel M] [--seed N] [--work DIR]: the constants of HazardConfig::Model.

Models each mesh by `reconstruct`, keeps the maps after views 1, 3 and 5, and lets noise-free rays from 80 poses of a
sphere run through each map's unknown voxels: by distance d and elevation s over what is known, how many metres they
pass and how often the true surface meets them there. Prints the model of the form

    h = h_inf + h_0 c(s) exp(-d / lambda), beyond 5 lambda h_inf

that makes this likeliest, and its log-likelihood per meeting on each mesh when it is left out of the fit. d and s are
as HazardField has them: to voxels with three hits, whose normal leads to where more of 7^3 voxels is free. Run it with
PYTHONPATH=build/release/python; it takes a minute a mesh. The constants in grid/src/hazard are of camel, lion-head,
mannequin-devil, elephant, armadillo, bear and bull (CGAL's), seeds 1 and 2.
"""
import argparse
import pathlib
import subprocess

import numpy as np
import viewgain
from scipy import ndimage

VIEWS = (1, 3, 5)
STRIDE = 5                                  # of pixels
DISTANCES = 1e-3 * np.array([0, 5.05, 7.5, 10.05, 15, 20, 25, 30, 40, 50, 65, 85, 110, 140])  # at 0.35 m
ELEVATIONS = np.linspace(-1.1, 1.1, 12)
CUT = 5                                     # decay lengths to which h_0 c(s) counts, HazardConfig::Model::kCut
PRIOR = 40                                  # meetings by which a factor is held to 1


def run(*words):
    subprocess.run([str(word) for word in words], check=True, capture_output=True)


def features(grid):
    """State, and by bins the distance and elevation, of all voxels."""
    states, V = grid.states(), grid.voxel_size
    occupied = grid.occupied()
    evidence = np.zeros(states.shape, bool)
    at = (occupied["voxel"] - np.asarray(grid.min_index))[occupied["hits"] >= 3]
    evidence[tuple(at.T)] = True
    free = ndimage.uniform_filter((states == viewgain.VoxelState.FREE).astype(float), 7, mode="nearest")
    pad = np.pad(free, 1, mode="edge")
    normal = np.stack([pad[2:, 1:-1, 1:-1] - pad[:-2, 1:-1, 1:-1], pad[1:-1, 2:, 1:-1] - pad[1:-1, :-2, 1:-1],
                       pad[1:-1, 1:-1, 2:] - pad[1:-1, 1:-1, :-2]])
    distance, nearest = ndimage.distance_transform_edt(~evidence, return_indices=True)
    away = np.indices(states.shape) - nearest
    n = normal[(slice(None), *nearest)]
    product = np.linalg.norm(n, axis=0) * np.linalg.norm(away, axis=0)
    sine = np.divide((n * away).sum(0), product, out=np.zeros(states.shape), where=product > 1e-12)
    return states, distance * V, sine


def counts(grid, sensor, frames, scale):
    """[distance, elevation]: metres passed and meetings."""
    states, distance, sine = features(grid)
    V, low = grid.voxel_size, np.asarray(grid.min_index)
    cls = (np.clip(np.digitize(distance / scale, DISTANCES) - 1, 0, len(DISTANCES) - 1) * (len(ELEVATIONS) - 1)
           + np.clip(np.digitize(sine, ELEVATIONS) - 1, 0, len(ELEVATIONS) - 2))
    size = len(DISTANCES) * (len(ELEVATIONS) - 1)
    passed, met = np.zeros(size), np.zeros(size)
    camera = sensor.camera
    v, u = np.mgrid[STRIDE // 2:camera.height:STRIDE, STRIDE // 2:camera.width:STRIDE]
    rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)], -1).reshape(-1, 3)
    lengths = np.linalg.norm(rays, axis=1)
    T_grid_world = np.linalg.inv(grid.T_world_grid)
    step = V / 4
    for T_world_camera, depth in frames:
        z = depth[STRIDE // 2::STRIDE, STRIDE // 2::STRIDE].ravel()
        T = T_grid_world @ T_world_camera
        directions = (rays / lengths[:, None]) @ T[:3, :3].T
        end = np.where(z > 0, z * lengths, 0)
        t = np.arange(0.2 * scale, 1.2 * scale, step) + step / 2
        p = T[:3, 3] + t[None, :, None] * directions[:, None, :]
        index = np.floor(p / V).astype(int) - low
        inside = ((index >= 0) & (index < states.shape)).all(-1)
        index = np.where(inside[..., None], index, 0)
        where = tuple(np.moveaxis(index, -1, 0))
        state = np.where(inside, states[where], viewgain.VoxelState.FREE)
        before = np.cumsum(state == viewgain.VoxelState.OCCUPIED, axis=1) == 0
        is_met = (t[None] - step / 2 <= end[:, None]) & (end[:, None] < t[None] + step / 2)
        counted = (state == viewgain.VoxelState.UNKNOWN) & before & (t[None] - step / 2 <= end[:, None])
        classes = cls[where]
        passed += step * np.bincount(classes[counted], minlength=size)
        met += np.bincount(classes[counted & is_met], minlength=size)
    return np.stack([passed, met]).reshape(2, len(DISTANCES), -1)


def fit(data):
    """(log-likelihood, lambda, h_0, h_inf, c, rates): by a grid of lambda and, in it, by the EM algorithm for which of
    the two terms each meeting is of."""
    passed, met = data
    middle = np.append((DISTANCES[:-1] + DISTANCES[1:]) / 2, 1.2 * DISTANCES[-1])
    best = None
    for decay in 1e-3 * np.array([12, 14, 16, 18, 20, 22, 25]):
        falls = np.where(middle <= CUT * decay, np.exp(-middle / decay), 0)[:, None]
        exposed = (passed * falls).sum(0)
        near, far = np.full(passed.shape[1], met.sum() / exposed.sum()), 0.5 * met.sum() / passed.sum()
        for _ in range(300):
            of_near = met * near * falls / (near * falls + far)
            mean = of_near.sum() / exposed.sum()
            near = (of_near.sum(0) + PRIOR) / (exposed + PRIOR / mean)
            far = (met - of_near).sum() / passed.sum()
        rates = near * falls + far
        value = likelihood(data, rates)
        if best is None or value > best[0]:
            best = (value, decay, near.max(), far, near / near.max(), rates)
    return best


def likelihood(data, rates):
    """Per meeting, against one rate everywhere."""
    passed, met = data
    mean = met.sum() / passed.sum()
    return ((met * np.log(np.maximum(rates, 1e-9) / mean)).sum() - (passed * (rates - mean)).sum()) / met.sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("mesh", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", type=float, default=0.35)
    parser.add_argument("--voxel", type=float, default=0.005)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("hazard"))
    args = parser.parse_args()
    args.work.mkdir(parents=True, exist_ok=True)
    sensor = viewgain.sensor_preset("sr4000")
    data = {}
    for mesh in args.mesh:
        maps, truth = args.work / mesh.stem, args.work / (mesh.stem + ".frames")
        run(args.program, "reconstruct", mesh, "--size", args.size, "--sensor", "sr4000", "--voxel", args.voxel,
            "--max-views", max(VIEWS), "--stop-area", 0, "--seed", args.seed, "--pictures", "off", "--save-maps", "on",
            "--out", maps)
        run(args.program, "simulate", mesh, "--sphere", f"80,{1.7 * args.size}", "--size", args.size, "--recenter", "on",
            "--sensor", "sr4000", "--noise", "off", "--background", 0, "--out", truth)
        frames = [(f.T_world_camera, f.depth) for f in viewgain.read_frames(truth)]
        grids = [maps / "maps" / f"{view:02}.vdb" for view in VIEWS]
        data[mesh.stem] = sum(counts(viewgain.BeliefGrid.load(g), sensor, frames, args.size / 0.35)
                              for g in grids if g.exists())
    _, decay, near, far, c, _ = fit(sum(data.values()))
    print(f"near_rate {near * 0.35:.3g} / size, decay_length {decay / 0.35:.3g} size, far_rate {far * 0.35:.3g} / size")
    print("c", " ".join(f"{value:.3g}" for value in c))
    for name, own in data.items():
        others = sum(counted for other, counted in data.items() if other != name)
        if len(data) > 1:
            print(f"{name}: {likelihood(own, fit(others)[5]):.3f} nat a meeting")


if __name__ == "__main__":
    main()
