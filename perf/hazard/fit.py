#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Fits the constants of HazardConfig::Model.

    fit.py VIEWGAIN MESH... [--size M] [--voxel M] [--seed N] [--work DIR]

Models each mesh with `reconstruct` and keeps the maps after views 1, 3 and 5. Noise-free rays from
80 poses on a sphere then run through each map's unknown voxels. The script counts how many
metres the rays pass and how often they meet the true surface. It does so per distance d from known
surface, elevation s above known surface, and share o of directions that are open to free space. It
prints the most likely model of the form

    h = h_inf + h_0 exp(-d / lambda) c(s) g(o)

and, for each mesh, the log-likelihood per ray that meets surface, if this mesh is left out of the
fit.

d, s and o are those of HazardField. Distances are to voxels with three hits. Their normal points to
where more of 7^3 voxels is free. A direction is open if free space is within a tenth of the
object's size.

Run it with PYTHONPATH=build/release/python. It takes a minute per mesh. The constants in
grid/src/hazard are from CGAL's camel, lion-head, mannequin-devil, elephant, armadillo, bear and
bull, seeds 1 to 4.
"""
import argparse
import pathlib
import subprocess

import numpy as np
import viewgain
from scipy import ndimage

VIEWS = (1, 3, 5)
STRIDE = 5                                  # every 5th pixel and row
DISTANCES = 1e-3 * np.array([0, 5.05, 7.5, 10.05, 15, 20, 25, 30, 40, 50, 65, 85, 110, 140])  # at 0.35 m
ELEVATIONS = np.linspace(-1.1, 1.1, 12)
OPEN = 14                                   # classes of open directions: 0 of 26, 1 or 2, 3 or 4, ...
OPEN_REACH = 0.1                            # [object sizes]
PRIOR = 40                                  # weight of the prior that factors are 1 [meetings]


def run(*words):
    subprocess.run([str(word) for word in words], check=True, capture_output=True)


def open_directions(states, reach):
    """For each voxel, the number of 26 directions with free space within `reach` voxels, seen from it."""
    free, unknown = (states == viewgain.VoxelState.FREE), (states == viewgain.VoxelState.UNKNOWN)
    most = int(reach)
    count = np.zeros(states.shape, int)
    padded = [np.pad(mask, most) for mask in (free, unknown)]
    for by in np.ndindex(3, 3, 3):
        by = np.array(by) - 1
        if not by.any():
            continue
        is_open, is_closed = np.zeros(states.shape, bool), np.zeros(states.shape, bool)
        for k in range(1, max(1, int(reach / np.linalg.norm(by))) + 1):
            there = tuple(slice(most + k * b, most + k * b + n) for b, n in zip(by, states.shape))
            is_open |= ~is_closed & padded[0][there]
            is_closed |= ~padded[1][there]
        count += is_open
    return count


def features(grid, size):
    """State, distance, elevation and number of open directions of all voxels."""
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
    return states, distance * V, sine, open_directions(states, OPEN_REACH * size / V)


def counts(grid, sensor, frames, size):
    """Metres passed and meetings, by [distance, elevation, open]."""
    scale = size / 0.35
    states, distance, sine, is_open = features(grid, size)
    V, low = grid.voxel_size, np.asarray(grid.min_index)
    cls = (np.clip(np.digitize(distance / scale, DISTANCES) - 1, 0, len(DISTANCES) - 1) * (len(ELEVATIONS) - 1)
           + np.clip(np.digitize(sine, ELEVATIONS) - 1, 0, len(ELEVATIONS) - 2)) * OPEN + (is_open + 1) // 2
    classes_of_all = len(DISTANCES) * (len(ELEVATIONS) - 1) * OPEN
    passed, met = np.zeros(classes_of_all), np.zeros(classes_of_all)
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
        passed += step * np.bincount(classes[counted], minlength=classes_of_all)
        met += np.bincount(classes[counted & is_met], minlength=classes_of_all)
    return np.stack([passed, met]).reshape(2, len(DISTANCES), -1, OPEN)


def fit(data):
    """(log-likelihood, lambda, h_inf, h_0, c, g, rates).

    A grid search finds lambda and h_inf. Expectation and maximisation find c and g, alternately. The
    maxima of c and g are 1.
    """
    passed, met = data
    middle = np.append((DISTANCES[:-1] + DISTANCES[1:]) / 2, 1.2 * DISTANCES[-1])
    best = None
    for decay in 1e-3 * np.array([14, 16, 18, 20, 22, 25, 28]):
        for far in (0, 0.01, 0.03, 0.1):
            c, g = np.ones(met.shape[1]), np.ones(OPEN)
            near = np.exp(-middle / decay)[:, None, None]
            h = met.sum() / (passed * near).sum()
            for _ in range(40):
                for axes, factor in (((0, 2), c), ((0, 1), g)):
                    rates = h * near * c[:, None] * g
                    own = np.divide(met * rates, far + rates, out=np.zeros(met.shape), where=rates > 0)
                    factor *= (own.sum(axes) + PRIOR) / ((passed * rates).sum(axes) + PRIOR)
                h *= c.max() * g.max()
                c /= c.max()
                g /= g.max()
            rates = far + h * near * c[:, None] * g
            value = likelihood(data, rates)
            if best is None or value > best[0]:
                best = (value, decay, far, h, c, g, rates)
    return best


def likelihood(data, rates):
    """Log-likelihood ratio per meeting, compared with one rate everywhere."""
    passed, met = data
    mean = met.sum() / passed.sum()
    return ((met * np.log(np.maximum(rates, 1e-9) / mean)).sum() - (passed * (rates - mean)).sum()) / met.sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="VIEWGAIN", help="the program viewgain")
    parser.add_argument("mesh", nargs="+", type=pathlib.Path, metavar="MESH", help="mesh files")
    parser.add_argument("--size", type=float, default=0.35, help="longest side of the objects [m] (default: 0.35)")
    parser.add_argument("--voxel", type=float, default=0.005, help="voxel size [m] (default: 0.005)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the runs (default: 1)")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("hazard"),
                        help="folder for maps and frames (default: hazard)")
    args = parser.parse_args()
    args.work.mkdir(parents=True, exist_ok=True)
    sensor = viewgain.sensor_preset("sr4000")
    data = {}
    for mesh in args.mesh:
        maps, truth = args.work / mesh.stem, args.work / (mesh.stem + ".frames")
        run(args.program, "reconstruct", mesh, "--size", args.size, "--sensor", "sr4000", "--voxel", args.voxel,
            "--max-views", max(VIEWS), "--stop", "area=0", "--seed", args.seed, "--pictures", "off", "--save-maps", "on",
            "--out", maps)
        run(args.program, "simulate", mesh, "--poses", f"sphere:80,{1.7 * args.size}", "--size", args.size, "--place", "center",
            "--sensor", "sr4000", "--noise", "off", "--background", 0, "--out", truth)
        frames = [(f.T_world_camera, f.depth) for f in viewgain.read_frames(truth)]
        grids = [maps / "maps" / f"{view:02}.vdb" for view in VIEWS]
        data[mesh.stem] = sum(counts(viewgain.BeliefGrid.load(g), sensor, frames, args.size)
                              for g in grids if g.exists())
    value, decay, far, h, c, g, _ = fit(sum(data.values()))
    print(f"near_rate {h * 0.35:.3g} / size, decay_length {decay / 0.35:.3g} size, far_rate {far * 0.35:.3g} / size: "
          f"{value:.3f} nat per meeting")
    print("c", " ".join(f"{factor:.3g}" for factor in c))
    print("g", " ".join(f"{factor:.3g}" for factor in g))
    for name, own in data.items():
        others = sum(counted for other, counted in data.items() if other != name)
        if len(data) > 1:
            print(f"{name}: {likelihood(own, fit(others)[-1]):.3f} nat per meeting")


if __name__ == "__main__":
    main()
