#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Are the covariances of points and vertices honest?

    honesty.py [MESH...] [--voxel M] [--only NAME...]

The objects are a plate, a sphere, a cylinder and the meshes (OFF, scaled to 0.35 m). A simulated
SR4000 views them from 0.45 m, the plate from above and the others from all sides: 12 views, the
same 12 views four times, and 60 views. There are tables for

- points and vertices
- points at several distances from depth jumps
- points if one source of error is switched off

z is the distance to the mesh divided by the standard deviation in its direction. If standard
deviations are honest, the mean of min(z^2, 25) is 1 and the median of z^2 is 0.455. Points over
10 mm from the mesh are outliers, which are only counted.

Run it with PYTHONPATH=build/release/python. It takes two minutes per object.
"""
import argparse
import pathlib

import numpy as np
import viewgain
import viewgain.mesh
from scipy import ndimage, spatial

SIZE, DISTANCE = 0.35, 0.45                                              # [m]
SERIES = {"12 views": (12, 1), "x4": (12, 4), "60 views": (60, 1)}       # number of poses, repetitions
LEFT_OUT = {"nothing": {}, "axial noise": {"noise": False}, "lateral noise": {"lateral_noise": False},
            "mixed pixels": {"sub_rays": 1}, "all three": {"noise": False, "lateral_noise": False, "sub_rays": 1},
            "half of the voxel": {}}
JUMP, SEEN = 0.02, 0.01                                                  # differences of depth [m]


def grid_mesh(at, columns, rows):
    """The triangles of a surface at(u, v), u and v in [0, 1]."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1), indexing="ij")
    vertices = np.stack(at(u, v), axis=-1).reshape(-1, 3)
    corner = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    right, up = corner + rows + 1, corner + 1
    return vertices, np.concatenate([np.stack([corner, right, right + 1], 1), np.stack([corner, right + 1, up], 1)])


def joined(*parts):
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    return (np.concatenate([vertices for vertices, _ in parts]),
            np.concatenate([triangles + start for (_, triangles), start in zip(parts, starts)]))


def plate():
    return grid_mesh(lambda u, v: (SIZE * (u - 0.5), SIZE * (v - 0.5), 0 * u), 90, 90)


def sphere():
    r = 0.15
    return grid_mesh(lambda u, v: (r * np.cos(2 * np.pi * u) * np.sin(np.pi * v),
                                   r * np.sin(2 * np.pi * u) * np.sin(np.pi * v), -r * np.cos(np.pi * v)), 240, 120)


def cylinder():
    r, half = 0.1, 0.5 * SIZE

    def round_at(radius, z):
        return lambda u, v: (radius(v) * np.cos(2 * np.pi * u), radius(v) * np.sin(2 * np.pi * u), z(v) + 0 * u)
    return joined(grid_mesh(round_at(lambda v: r + 0 * v, lambda v: 2 * half * (v - 0.5)), 160, 90),
                  grid_mesh(round_at(lambda v: r * v, lambda v: half + 0 * v), 160, 25),
                  grid_mesh(round_at(lambda v: r * (1 - v), lambda v: -half + 0 * v), 160, 25))


def read_off(path):
    words = pathlib.Path(path).read_text().split()
    count, faces = int(words[1]), int(words[2])
    vertices = np.array(words[4:4 + 3 * count], float).reshape(-1, 3)
    triangles = np.array(words[4 + 3 * count:4 + 3 * count + 4 * faces], int).reshape(-1, 4)
    if words[0] != "OFF" or not (triangles[:, 0] == 3).all():
        raise SystemExit(f"{path}: expected an OFF file of triangles")
    low, high = vertices.min(0), vertices.max(0)
    return (vertices - 0.5 * (low + high)) * SIZE / (high - low).max(), triangles[:, 1:]


class Truth:
    """Exact distances to a mesh. To find the nearest triangles, edges are cut to 3 mm."""

    def __init__(self, vertices, triangles):
        corners = vertices[triangles]
        while True:
            edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
            long = edges.max(1) > 0.003
            if not long.any():
                break
            a, cut = corners[long], edges[long].argmax(1)
            p, q, r = (a[np.arange(len(a)), (cut + k) % 3] for k in range(3))
            middle = 0.5 * (p + q)
            corners = np.concatenate([corners[~long], np.stack([p, middle, r], 1), np.stack([middle, q, r], 1)])
        self.corners = corners
        self.tree = spatial.cKDTree(corners.mean(1))

    def nearest(self, points):
        """The point of the mesh nearest to each point."""
        best = np.full(len(points), np.inf)
        place = np.zeros((len(points), 3))
        for column in self.tree.query(points, k=16)[1].T:
            found = nearest_of_triangles(points, self.corners[column])
            distance = np.linalg.norm(points - found, axis=1)
            better = distance < best
            best[better], place[better] = distance[better], found[better]
        return place


def nearest_of_triangles(p, corners):
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    n = np.cross(b - a, c - a)
    area = (n * n).sum(1)
    inside = np.ones(len(p), bool)
    ends = np.full(len(p), np.inf)
    place = np.zeros_like(p)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        t = np.clip(((p - start) * edge).sum(1) / np.maximum((edge * edge).sum(1), 1e-30), 0, 1)
        on_edge = start + t[:, None] * edge
        distance = np.linalg.norm(p - on_edge, axis=1)
        place[distance < ends] = on_edge[distance < ends]
        ends = np.minimum(ends, distance)
        inside &= (np.cross(edge, p - start) * n).sum(1) >= 0
    within = inside & (area > 1e-24)
    height = ((p - a) * n).sum(1)[within] / area[within]
    place[within] = p[within] - height[:, None] * n[within]
    return place


def matrices(rows):
    xx, yy, zz, xy, xz, yz = rows.T
    return np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], 1).reshape(-1, 3, 3)


def squares(truth, positions, covariances):
    """Distance e [m] and z^2 of each position."""
    away = positions - truth.nearest(positions)
    e = np.linalg.norm(away, axis=1)
    n = away / np.maximum(e, 1e-12)[:, None]
    return e, e ** 2 / np.einsum("ni,nij,nj->n", n, covariances, n)


def figures(e, z2):
    good = e <= 0.01
    if not good.any():
        return "- | - | - | - | -"
    return (f"{np.minimum(z2, 25)[good].mean():.2f} | {np.median(z2[good]):.2f} | {100 * (z2[good] > 9).mean():.1f} | "
            f"{1e3 * np.sqrt((e[good] ** 2).mean()):.2f} | {100 * (~good).mean():.1f}")


def modelled(mesh, sensor, poses, times, voxel, left_out):
    settings = {"noise": True, "lateral_noise": True, "sub_rays": 3, "background_radius": 1.5, "seed": 1, **left_out}
    camera = viewgain.SimulatedSensor(*mesh, sensor, **settings)
    half = 0.5 * SIZE + 0.025
    planner = viewgain.ViewPlanner(sensor, voxel_size=voxel, workspace=[[-half] * 3, [half] * 3], gain="paper")
    for k in range(times * len(poses)):
        frame = camera.acquire(poses[k % len(poses)], k)
        planner.add(frame.depth, poses[k % len(poses)], amplitude=frame.amplitude)
    return planner.grid


def pixels_to_jumps(mesh, sensor, poses, points):
    """Median distance of each point's pixel from a depth jump [px], over the views that show it."""
    camera = viewgain.SimulatedSensor(*mesh, sensor, background_radius=1.5)
    pinhole = sensor.camera
    all_views = np.full((len(poses), len(points)), np.nan)
    for k, pose in enumerate(poses):
        depth = np.nan_to_num(camera.acquire(pose).depth, posinf=1e3)
        jumps = ndimage.maximum_filter(depth, 3) - ndimage.minimum_filter(depth, 3) > JUMP
        away = ndimage.distance_transform_edt(~jumps) if jumps.any() else np.full(depth.shape, np.inf)
        p = (points - pose[:3, 3]) @ pose[:3, :3]
        u = np.rint(pinhole.fx * p[:, 0] / p[:, 2] + pinhole.cx).astype(int)
        v = np.rint(pinhole.fy * p[:, 1] / p[:, 2] + pinhole.cy).astype(int)
        shown = (p[:, 2] > 0) & (u >= 0) & (v >= 0) & (u < pinhole.width) & (v < pinhole.height)
        shown[shown] = np.abs(depth[v[shown], u[shown]] - p[shown, 2]) < SEEN
        all_views[k, shown] = away[v[shown], u[shown]]
    seen = ~np.isnan(all_views).all(0)
    median = np.full(len(points), -1.0)
    median[seen] = np.nanmedian(all_views[:, seen], axis=0)
    return median


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="MESH", help="mesh files (OFF)")
    parser.add_argument("--voxel", type=float, default=0.003125, help="voxel size [m] (default: 0.003125)")
    parser.add_argument("--only", nargs="*", metavar="NAME", help="objects to measure (default: all)")
    arguments = parser.parse_args()
    objects = {"plate": plate, "sphere": sphere, "cylinder": cylinder}
    objects.update({pathlib.Path(m).stem: (lambda m=m: read_off(m)) for m in arguments.meshes})
    sensor = viewgain.sensor_preset("sr4000")
    tables = {"all": [], "jumps": [], "left out": []}
    for name, make in objects.items():
        if arguments.only and name not in arguments.only:
            continue
        mesh = make()
        truth = Truth(*mesh)
        around = viewgain.dome_poses if name == "plate" else viewgain.sphere_poses
        for series, (count, times) in SERIES.items():
            poses = around(count, DISTANCE)
            grid = modelled(mesh, sensor, poses, times, arguments.voxel, {})
            points = grid.points()
            covariances = matrices(points["covariance"])
            e, z2 = squares(truth, points["position"], covariances)
            surface = viewgain.mesh.surface_of_grid(grid)
            of_vertices = squares(truth, surface.vertices, covariances[surface.source])
            tables["all"].append(f"| {name}, {series} | {figures(e, z2)} | {figures(*of_vertices)} |")
            if times > 1:
                continue
            away = pixels_to_jumps(mesh, sensor, poses, points["position"])
            for low, high in ((-1, 0), (0, 2.5), (2.5, 5), (5, 10), (10, np.inf)):
                part = (away >= low) & (away < high)
                if part.any():
                    where = "in no view" if low < 0 else f"{low:g} to {high:g}" if high < np.inf else f"over {low:g}"
                    tables["jumps"].append(
                        f"| {name}, {series} | {where} | {100 * part.mean():.0f} | {figures(e[part], z2[part])} |")
        count, times = SERIES["60 views"]
        poses = around(count, DISTANCE)
        for what, settings in LEFT_OUT.items():
            voxel = arguments.voxel * (0.5 if what.startswith("half") else 1)
            points = modelled(mesh, sensor, poses, times, voxel, settings).points()
            found = squares(truth, points["position"], matrices(points["covariance"]))
            tables["left out"].append(f"| {name} | {what} | {figures(*found)} |")
    columns = "mean of min(z², 25) | median | over 9 [%] | RMS [mm] | outliers [%]"
    for head, key in ((f"| | points: {columns} | vertices: {columns} |", "all"),
                      (f"| | from a jump [px] | share [%] | {columns} |", "jumps"),
                      (f"| 60 views | left out | {columns} |", "left out")):
        print(head, "|" + "---|" * (head.count("|") - 1), *tables[key], "", sep="\n")


if __name__ == "__main__":
    main()
