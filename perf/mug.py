#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""A mug on a table in a room, coarse and fine in one map. Prints Markdown.

    mug.py [--picture PNG]

A simulated Kinect v1 with all its noise views a room of 4 x 3 x 2.5 m: 24 frames of the room, then
16 of the mug, from the side away from its handle. The same frames go into four maps:

- voxels of 2.5 mm, with cells of 20 mm except around the mug
- cells as large as the pixels' footprint, except around the mug
- the mug alone
- the room at one scale

The first table shows the cost of each map, and how completely and accurately it shows the mug. The
second shows how much of the handle the best next view sees, with and without task weights that make
only the handle count. Needs PYTHONPATH=build/release/python.
"""
import argparse
import time

import numpy as np
import viewgain
from scipy.spatial import cKDTree

import visibility

VOXEL, COARSEST, SAMPLES, NEAR = 0.0025, 3, 40000, 0.0025
ROOM, TABLE_Z, TABLE = (4.0, 3.0, 2.5), 0.75, (1.2, 0.8)
RADIUS, HEIGHT, WALL = 0.04, 0.1, 0.004
HANDLE_RADIUS, HANDLE_THICKNESS = 0.028, 0.006
AWAY = np.radians(180)  # azimuth of the frames of the mug; the handle is at 0
MUG_BOX = [[-0.06, -0.06, TABLE_Z - 0.02], [0.1, 0.06, TABLE_Z + HEIGHT + 0.02]]
HANDLE_BOX = [[RADIUS + 0.004, -0.02, TABLE_Z], [0.09, 0.02, TABLE_Z + HEIGHT]]


def box(low, high, inwards=False):
    corners = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)])
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return corners, triangles[:, ::-1] if inwards else triangles


def lattice(points, closed_v):
    """The triangles of an (n, m, 3) lattice of points. Its second direction is closed or open."""
    n, m = points.shape[:2]
    i, j = np.meshgrid(np.arange(n - 1), np.arange(m if closed_v else m - 1), indexing="ij")
    a, b, c, d = (x.ravel() for x in (i * m + j, (i + 1) * m + j, (i + 1) * m + (j + 1) % m, i * m + (j + 1) % m))
    return points.reshape(-1, 3), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def mug():
    """A mug on the table at x = y = 0, open at the top, with its handle towards +x."""
    inner, bottom = RADIUS - WALL, TABLE_Z + 1e-4
    profile = [(0, 0), (RADIUS, 0), (RADIUS, HEIGHT), (inner, HEIGHT), (inner, WALL), (0, WALL)]
    around = np.radians(np.arange(0, 360, 5))
    body = np.array([[(r * np.cos(a), r * np.sin(a), bottom + z) for a in around] for r, z in profile])
    along, across = np.radians(np.arange(-100, 101, 10)), np.radians(np.arange(0, 360, 30))
    handle = np.array([[(RADIUS + (HANDLE_RADIUS + HANDLE_THICKNESS * np.cos(b)) * np.cos(a), HANDLE_THICKNESS * np.sin(b),
                         TABLE_Z + HEIGHT / 2 + (HANDLE_RADIUS + HANDLE_THICKNESS * np.cos(b)) * np.sin(a))
                        for b in across] for a in along])
    return lattice(body, True), lattice(handle, True)


def together(parts):
    vertices, triangles, count = [], [], 0
    for v, t in parts:
        vertices.append(v)
        triangles.append(t + count)
        count += len(v)
    return np.concatenate(vertices), np.concatenate(triangles).astype(np.uint32)


def room_around(body, handle):
    """The whole scene. The mug's triangles are the last."""
    x, y, z = ROOM
    w, d = TABLE
    legs = [box((sx * (w / 2 - 0.04) - 0.03, sy * (d / 2 - 0.04) - 0.03, 0), (sx * (w / 2 - 0.04) + 0.03, sy * (d / 2 - 0.04) + 0.03, 0.71))
            for sx in (-1, 1) for sy in (-1, 1)]
    return together([box((-x / 2, -y / 2, 0), (x / 2, y / 2, z), inwards=True),
                     box((-w / 2, -d / 2, TABLE_Z - 0.04), (w / 2, d / 2, TABLE_Z)), *legs,
                     box((-1.9, -1.4, 0), (-1.5, -0.4, 1.8)), box((1.2, 0.9, 0), (1.9, 1.4, 0.9)), body, handle])


def room_poses():
    """24 poses that look around the room."""
    poses = []
    for angle in np.radians(np.arange(0, 360, 15)):
        eye = np.array([1.1 * np.cos(angle), 1.1 * np.sin(angle), 1.5])
        poses.append(viewgain.look_at(eye, eye + [np.cos(angle + 1), np.sin(angle + 1), -0.45]))
    return poses


def frames_of(camera):
    """Poses and depth images: first the room, then the mug from the side away from its handle."""
    poses = room_poses()
    for k in range(16):
        angle, up = AWAY + np.radians(70 * np.sin(k)), np.radians(20 + 25 * (k % 3))
        eye = [0.65 * np.cos(angle) * np.cos(up), 0.65 * np.sin(angle) * np.cos(up), TABLE_Z + HEIGHT / 2 + 0.65 * np.sin(up)]
        poses.append(viewgain.look_at(eye, [0, 0, TABLE_Z + HEIGHT / 2]))
    return [(pose, camera.acquire(pose, i).depth) for i, pose in enumerate(poses)]


def model(sensor, frames, workspace, coarsest, fine, finest):
    """The map, and the CPU time that its frames took [s]."""
    grid = viewgain.BeliefGrid(voxel_size=VOXEL, workspace=workspace, sensor=sensor)
    integrator = viewgain.FrameIntegrator(sensor, coarsest=coarsest, fine=fine, finest=finest, num_threads=1)
    start = time.process_time()
    for pose, depth in frames:
        integrator.integrate(grid, depth, pose)
    return grid, time.process_time() - start


def points_of_mug(grid):
    points = grid.points()["position"]
    low, high = np.array(MUG_BOX)
    return points[((points > low) & (points < high)).all(axis=1) & (points[:, 2] > TABLE_Z + 0.006)]


def knowledge(grid, samples):
    """Share of the samples with a point near by, and RMS distance of the points from the mug [m]."""
    points = points_of_mug(grid)
    near = cKDTree(points).query(samples, distance_upper_bound=NEAR)[0] < NEAR
    distance = cKDTree(samples).query(points)[0]
    return near.mean(), np.sqrt((distance**2).mean())


def draw(path, grid):
    import matplotlib
    matplotlib.use("agg")
    import matplotlib.pyplot as plt
    points = grid.points()["position"]
    scales = grid.scale(grid.index_of(points))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), dpi=110)
    colours = ["#0b7a3b", "#1f4fe0", "#f9922d", "#d81b8a"]
    for scale, colour in enumerate(colours):
        part = points[(scales == scale) & (points[:, 2] < 2.3)]
        axes[0].plot(part[:, 0], part[:, 1], ".", ms=1, mew=0, color=colour, label=f"{VOXEL * 2000 * 2**scale / 2:g} mm")
    own = points_of_mug(grid)
    axes[1].plot(own[:, 0], own[:, 2] - TABLE_Z, ".", ms=3, mew=0, color=colours[0])
    axes[0].set(xlabel="x [m]", ylabel="y [m]", title="surface points of one map, by their cells")
    axes[1].set(xlabel="x [m]", ylabel="above the table [m]", title="the mug in it, from the side")
    axes[0].legend(markerscale=12, loc="upper left", framealpha=1)
    for axis in axes:
        axis.set_aspect("equal")
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--picture", metavar="PNG", help="draw the points of the map to this file")
    arguments = parser.parse_args()
    sensor = viewgain.sensor_preset("kinect_v1")
    body, handle = mug()
    scene = room_around(body, handle)
    camera = viewgain.SimulatedSensor(*scene, sensor, noise=True, lateral_noise=True, seed=1)
    frames = frames_of(camera)
    samples = visibility.KnownObject(*together([body, handle]), sensor, SAMPLES).points
    samples = samples[samples[:, 2] > TABLE_Z + 0.006]
    room = [[-ROOM[0] / 2 - 0.1, -ROOM[1] / 2 - 0.1, -0.1], [ROOM[0] / 2 + 0.1, ROOM[1] / 2 + 0.1, ROOM[2] + 0.1]]

    print("| map | MB | integration, CPU s | mug within 2.5 mm | RMS [mm] |", "|---|---|---|---|---|", sep="\n")
    maps = {}
    for name, workspace, coarsest, fine, finest in (("room 20 mm, mug 2.5 mm", room, COARSEST, [MUG_BOX], COARSEST),
                                                    ("room by footprint, mug 2.5 mm", room, COARSEST, [MUG_BOX], 0),
                                                    ("the mug alone, 2.5 mm", MUG_BOX, 0, None, 0),
                                                    ("room and mug, 2.5 mm", room, 0, None, 0)):
        maps[name], seconds = model(sensor, frames, workspace, coarsest, fine, finest)
        covered, rms = knowledge(maps[name], samples)
        print(f"| {name} | {maps[name].statistics().bytes / 1e6:.1f} | {seconds:.1f} | {100 * covered:.1f} % | {1000 * rms:.2f} |", flush=True)

    grid = maps["room 20 mm, mug 2.5 mm"]
    if arguments.picture:
        draw(arguments.picture, grid)
    # Which samples of the handle the frames have seen, and which one more view would see.
    of_handle = visibility.KnownObject(*together([body, handle]), sensor, SAMPLES)
    of_handle.simulated = viewgain.SimulatedSensor(*scene, of_handle.sensor)
    low, high = np.array(HANDLE_BOX)
    is_handle = ((of_handle.points > low) & (of_handle.points < high)).all(axis=1)
    of_handle.points, of_handle.normals = of_handle.points[is_handle], of_handle.normals[is_handle]
    seen = np.any([of_handle.sees(pose) for pose, _ in frames], axis=0)
    poses = viewgain.sphere_poses(400, 0.65)
    poses = poses[poses[:, 2, 3] > 0.1]
    poses[:, 2, 3] += TABLE_Z + HEIGHT / 2
    brings = np.array([(of_handle.sees(pose) & ~seen).mean() for pose in poses])
    voxels = viewgain.VoxelScene(grid)
    print(f"\n{100 * seen.mean():.0f} % of the handle is seen. One more view can show {100 * brings.max():.0f} % more; "
          f"the mean is {100 * brings.mean():.0f} %.\n")
    print("| best view by | newly seen part of the handle |", "|---|---|", sep="\n")
    for name, weights in (("combined", []), ("combined, the task: the handle", [(room, 0.0), (HANDLE_BOX, 1.0)])):
        evaluator = viewgain.GainEvaluator(voxels, sensor, weights=weights)
        print(f"| {name} | {100 * brings[evaluator.best(poses, 1).indices[0]]:.0f} % |")


if __name__ == "__main__":
    main()
