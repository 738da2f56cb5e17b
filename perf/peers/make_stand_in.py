#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a stand-in for NBV-Simulation's data, in the same layout, from a mesh.

    apps/extract_mesh.sh armadillo.off build/meshes
    perf/peers/make_stand_in.py build/meshes/armadillo.off FOLDER [--points 47705] [--views 5000]
                                [--seed 1]

Writes two files by that project's rules:

FOLDER/3d_models/Armadillo.pcd: uniform points on the surface, ASCII, x y z in the mesh's unit.
FOLDER/3d_models/Armadillo.txt: number of views, centre, size and positions of the views [m].

- The centre is the mean of the points.
- The size is 1.2 times half the side of a cube around the centre. The side is halved until the
  share of the points inside, with a target of 0.95, changes by less than 0.001.
- Positions are uniform between the cube of two sizes and the sphere of four. No two are in the same
  voxel of 1 cm. The first is 2.5 sizes before the centre along x.

Points and positions differ from the original. Figures are therefore figures of a stand-in.
"""

import argparse
import bisect
import itertools
import math
import os
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import meshes  # noqa: E402


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def area(a, b, c):
    u, v = sub(b, a), sub(c, a)
    return 0.5 * math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def sample(vertices, triangles, count, generator):
    """Uniform points on the surface."""
    corners = [tuple(vertices[i] for i in t) for t in triangles]
    sums = list(itertools.accumulate(area(*t) for t in corners))
    points = []
    for _ in range(count):
        a, b, c = corners[min(bisect.bisect(sums, generator.random() * sums[-1]), len(corners) - 1)]
        root, share = math.sqrt(generator.random()), generator.random()
        weights = (1 - root, root * (1 - share), root * share)
        points.append(tuple(sum(w * p[k] for w, p in zip(weights, (a, b, c))) for k in range(3)))
    return points


def predicted_size(points, centre, aim):
    """1.2 times half the side of the cube that contains a share of about `aim` of the points."""
    reach = [max(abs(x) for x in sub(p, centre)) for p in points]
    low, high = 0.0, max(math.dist(p, centre) for p in points)
    before = None
    while True:
        middle = 0.5 * (low + high)
        share = sum(r <= middle for r in reach) / len(reach)
        if before is not None and abs(before - share) < 0.001:
            return 1.2 * middle
        before = share
        if share > aim:
            high = middle
        else:
            low = middle


def mean(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


def positions(centre, size, count, generator):
    found = [(centre[0] - 2.5 * size, 0.0, 0.0)]
    taken = {tuple(math.floor(x / 0.01) for x in found[0])}
    while len(found) < count:
        offset = tuple(generator.uniform(-4 * size, 4 * size) for _ in range(3))
        eye = tuple(c + o for c, o in zip(centre, offset))
        voxel = tuple(math.floor(x / 0.01) for x in eye)
        if max(abs(o) for o in offset) < 2 * size or math.hypot(*offset) > 4 * size or voxel in taken:
            continue
        found.append(eye)
        taken.add(voxel)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="mesh file (OFF)")
    parser.add_argument("folder", help="folder to write to")
    parser.add_argument("--points", type=int, default=47705, help="number of points (default: 47705)")
    parser.add_argument("--views", type=int, default=5000, help="number of views (default: 5000)")
    parser.add_argument("--seed", type=int, default=1, help="seed of points and positions (default: 1)")
    arguments = parser.parse_args()
    generator = random.Random(arguments.seed)
    points = sample(*(part.tolist() for part in meshes.read_mesh(arguments.mesh)), arguments.points, generator)
    unit = 0.001 if any(abs(x) >= 10 for p in points for x in p) else 1.0
    metres = [tuple(unit * x for x in p) for p in points]
    # Larger objects are scaled down to this size.
    scale = min(1.0, 0.1 / predicted_size(metres, mean(metres), 0.92))
    metres = [tuple(scale * x for x in p) for p in metres]
    centre = mean(metres)
    size = predicted_size(metres, centre, 0.95)
    folder = os.path.join(arguments.folder, "3d_models")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "Armadillo.pcd"), "w", encoding="utf-8") as file:
        file.write("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
                   f"COUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\n"
                   "DATA ascii\n")
        file.writelines(f"{p[0]:.8g} {p[1]:.8g} {p[2]:.8g}\n" for p in points)
    with open(os.path.join(folder, "Armadillo.txt"), "w", encoding="utf-8") as file:
        file.write(f"{arguments.views}\n{centre[0]:.6g} {centre[1]:.6g} {centre[2]:.6g}\n{size:.6g}\n")
        file.writelines(f"{p[0]:.6g} {p[1]:.6g} {p[2]:.6g}\n"
                        for p in positions(centre, size, arguments.views, generator))
    print(f"scale {scale:.6g}, centre {centre[0]:.6g} {centre[1]:.6g} {centre[2]:.6g} m, size {size:.6g} m")


if __name__ == "__main__":
    main()
