#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Composes a cluttered scene from thin walls and the objects in mesh files.

    scenes.py KIND SEED MESH... --out DIR
    viewgain reconstruct --config DIR/flags.toml --out RUN

    shelf    two levels, three columns, boards of 10 mm
    bin      an open box with walls of 6 mm
    table    a slab

Each object is scaled, turned about the vertical at random (SEED) and placed in free space. Writes
scene.off, reach.toml and flags.toml. The second command then takes ten views with a D435 and voxels
of 5 mm. The views are above the bin or table, or in front of the shelf. In the meshes (OFF, OBJ), y is
up.
"""
import argparse
import pathlib
import sys

import numpy as np
import scipy.spatial.transform

import meshes
from meshes import box

Y_TO_Z = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
APART = 0.008     # minimum gap between the boxes of two objects [m]
SIZES = .09, .15  # longest sides of objects [m]


def standing(path, size, turn):
    """Vertices and triangles, at most `size` [m] large, with the centre of the underside at the origin."""
    vertices, triangles = meshes.read_mesh(path)
    c, s = np.cos(turn), np.sin(turn)
    vertices = meshes.scaled(vertices, None) @ Y_TO_Z.T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T
    spans = np.ptp(vertices, axis=0)
    vertices *= np.min(size / spans)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return vertices - [*(low[:2] + high[:2]) / 2, low[2]], triangles


def place(rng, paths, areas):
    """Places objects on rectangles (x0, y0, x1, y1, z, headroom) [m], with gaps of at least APART."""
    parts, taken = [], [[] for _ in areas]
    for k, path in enumerate(paths):
        x0, y0, x1, y1, z, headroom = areas[k % len(areas)]
        for attempt in range(200):
            largest = min(rng.uniform(*SIZES), headroom) * .97 ** (attempt // 10)
            vertices, triangles = standing(path, largest, rng.uniform(0, 2 * np.pi))
            half = np.ptp(vertices, axis=0)[:2] / 2 + APART / 2
            if (2 * half >= [x1 - x0, y1 - y0]).any():
                continue
            at = rng.uniform([x0, y0] + half, [x1, y1] - half)
            if all((np.abs(at - other) >= half + size).any() for other, size in taken[k % len(areas)]):
                taken[k % len(areas)].append((at, half))
                parts.append((vertices + [*at, z], triangles))
                break
        else:
            sys.exit(f"{path}: no free place is left; pass fewer meshes")
    return parts


def above(z):
    return [-2, -2, z], [2, 2, 3]


def bin_scene(rng, paths):
    w, d, h, t = .25, .18, .20, .006
    walls = [box([-w, -d, -t], [w, d, 0]), box([-w, -d, 0], [-w + t, d, h]), box([w - t, -d, 0], [w, d, h]),
             box([-w + t, -d, 0], [w - t, -d + t, h]), box([-w + t, d - t, 0], [w - t, d, h])]
    inside = (-w + .02, -d + .02, w - .02, d - .02, .001, .19)
    return walls + place(rng, paths, [inside]), above(.35), ([0, -.01, .6], [0, 0, .1])


def table_scene(rng, paths):
    w, d = .32, .24
    top = [box([-w, -d, -.02], [w, d, 0])]
    areas = [(-w + .03, -d + .03, w - .03, d - .03, .001, 1)]
    return top + place(rng, paths, areas), above(.05), ([.45, 0, .35], [0, 0, .06])


def shelf_scene(rng, paths):
    w, d, level, t = .36, .13, .22, .01
    boards = [box([-w, -d, k * (level + t) - t], [w, d, k * (level + t)]) for k in range(3)]
    top = 2 * (level + t) - t
    for k in range(4):
        x = -w + k * (2 * w - t) / 3
        boards += [box([x, -d, j * (level + t)], [x + t, d, j * (level + t) + level]) for j in range(2)]
    boards += [box([-w, d, -t], [w, d + t, top + t])]
    columns = [-w + k * (2 * w - t) / 3 + t for k in range(3)]
    wide = (2 * w - t) / 3 - t
    areas = [(x + .01, -d + .01, x + wide - .01, d - .02, j * (level + t) + .001, level - .04) for j in range(2) for x in columns]
    return boards + place(rng, paths, areas), ([-.55, -.9, -.05], [.55, -.3, .6]), ([0, -.7, .35], [0, 0, .22])


KINDS = {"bin": bin_scene, "table": table_scene, "shelf": shelf_scene}


def numbers(values):
    return f"[{', '.join(f'{v:.6f}' for v in values)}]"


def quaternion(eye, at):
    """Orientation (x, y, z, w) of a camera at `eye` that looks at `at`, with level image rows."""
    forward = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    return scipy.spatial.transform.Rotation.from_matrix(np.column_stack([right, np.cross(forward, right), forward])).as_quat()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS, help="kind of scene")
    parser.add_argument("seed", type=int, metavar="SEED", help="seed of sizes, rotations and places")
    parser.add_argument("meshes", nargs="+", metavar="MESH", help="mesh files of objects")
    parser.add_argument("--out", required=True, type=pathlib.Path, metavar="DIR", help="folder to write to")
    args = parser.parse_args()
    parts, reach, view = KINDS[args.kind](np.random.default_rng(args.seed), args.meshes)
    vertices = np.concatenate([corners for corners, _ in parts])
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2  # reconstruct puts the world's origin here
    vertices = vertices - middle
    low, high = vertices.min(axis=0) - .03, vertices.max(axis=0) + .03
    eye, at = np.array(view, float) - middle
    args.out.mkdir(parents=True, exist_ok=True)
    meshes.write_off(args.out / "scene.off", [(np.round(corners - middle, 7).tolist(), faces) for corners, faces in parts])
    (args.out / "reach.toml").write_text(f"[[box]]\nmin = {numbers(reach[0] - middle)}\nmax = {numbers(reach[1] - middle)}\n")
    (args.out / "flags.toml").write_text(
        f'mesh = "{args.out / "scene.off"}"\nreach = "{args.out / "reach.toml"}"\nsensor = "d435"\nvoxel = 0.005\n'
        f"workspace = {numbers([*low, *high])}\nfrom = {numbers([*eye, *quaternion(eye, at)])}\n"
        "max-views = 10\nstop = \"area=0,idle=0,promises=0\"\npictures = false\n")


if __name__ == "__main__":
    main()
