#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Composes a cluttered scene from thin walls and the objects in mesh files.

    scenes.py KIND SEED MESH... --out DIR
    scenes.py --listed [NAME...] --out DIR
    viewgain reconstruct --config DIR/flags.toml --out RUN

    kind     scene                                                 reach of the camera
    shelf    two levels, three columns, boards of 10 mm            a box in front
    bin      an open box with walls of 6 mm                        a box above
    table    a slab                                                a box above
    kitchen  a worktop in a corner, a cupboard and a board above   an arm's shell, in front and above
    plant    objects on a slab behind two plants, the first two    an arm's shell, in front
             meshes

Each object is scaled, turned about the vertical at random (SEED) and placed in free space. In the
meshes, y is up. MESH is an OFF or OBJ file, cgal:NAME for a mesh of Debian's libcgal-demo, or
LIBRARY:NAME for one of sweethome3d-furniture.

Writes scene.off, reach.toml, flags.toml and starts.txt. The last command then takes ten views with a
D435 and voxels of 5 mm, from the first of the three starts (TUM). --listed writes scenes of
scenes.toml (default: all) to DIR/NAME.
"""
import argparse
import dataclasses
import functools
import pathlib
import sys
import tomllib

import numpy as np
import scipy.spatial.transform

import meshes
from meshes import box

Y_TO_Z = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
APART = 0.008     # minimum gap between the boxes of two objects [m]
SIZES = .09, .15  # longest sides of objects [m]
MARGIN = .03      # of the workspace around the scene [m]
ASIDE = .2        # between the start poses [m]

read_mesh = functools.lru_cache(meshes.read_mesh)


@dataclasses.dataclass
class Reach:
    """Where the camera's centre may be: in a box or in a shell, and in all half-spaces (normal, offset) [m]."""
    box: tuple = None    # lowest and highest corner
    shell: tuple = None  # centre, least and largest radius
    half_spaces: list = ()

    def contains(self, eye):
        if self.box and not ((np.array(self.box[0]) <= eye) & (eye <= np.array(self.box[1]))).all():
            return False
        if self.shell and not self.shell[1] <= np.linalg.norm(eye - np.array(self.shell[0])) <= self.shell[2]:
            return False
        return all(np.dot(normal, eye) >= offset for normal, offset in self.half_spaces)

    def toml(self, middle):
        """The file, in a world with its origin at `middle`."""
        text = ""
        if self.box:
            text += f"[[box]]\nmin = {numbers(self.box[0] - middle)}\nmax = {numbers(self.box[1] - middle)}\n"
        if self.shell:
            centre, least, largest = self.shell
            text += f"[[shell]]\ncenter = {numbers(centre - middle)}\nmin_radius = {least}\nmax_radius = {largest}\n"
        for normal, offset in self.half_spaces:
            text += f"[[half_space]]\nnormal = {numbers(normal)}\noffset = {offset - np.dot(normal, middle):.6f}\n"
        return text


def standing(path, size, turn):
    """Vertices and triangles, at most `size` [m] large, with the centre of the underside at the origin."""
    vertices, triangles = read_mesh(path)
    used, triangles = np.unique(triangles, return_inverse=True)
    vertices, triangles = vertices[used], triangles.reshape(-1, 3)
    if not np.ptp(vertices, axis=0).max() > 0:
        sys.exit(f"{path}: the mesh has no extent")
    c, s = np.cos(turn), np.sin(turn)
    vertices = meshes.scaled(vertices, None) @ Y_TO_Z.T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T
    vertices *= size / np.ptp(vertices, axis=0).max()
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return vertices - [*(low[:2] + high[:2]) / 2, low[2]], triangles


def place(rng, paths, areas, sizes=SIZES):
    """Places objects on rectangles (x0, y0, x1, y1, z, headroom) [m], with gaps of at least APART."""
    parts, taken = [], [[] for _ in areas]
    for k, path in enumerate(paths):
        x0, y0, x1, y1, z, headroom = areas[k % len(areas)]
        for attempt in range(200):
            largest = min(rng.uniform(*sizes), headroom) * .97 ** (attempt // 10)
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
    return Reach(box=([-2, -2, z], [2, 2, 3]))


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
    return boards + place(rng, paths, areas), Reach(box=([-.55, -.9, -.05], [.55, -.3, .6])), ([0, -.7, .35], [0, 0, .22])


def kitchen_scene(rng, paths):
    w, d, h, t = .7, .32, .5, .01  # width of each wall, depth of the worktop, height of the walls, thickness
    walls = [box([0, 0, -.03], [w, d, 0]), box([0, d, -.03], [d, w, 0]),  # the worktop's legs
             box([-t, -t, -.03], [w, 0, h]), box([-t, 0, -.03], [0, w, h]),
             box([.3, 0, .34], [w, .16, h]), box([0, .3, .3], [.16, w, .3 + t])]  # a cupboard, a board
    areas = [(.02, .02, w - .02, d - .02, .001, .31), (.02, d + .02, d - .02, w - .02, .001, .27),
             (.02, .32, .15, w - .02, .3 + t + .001, .18)]
    arm = Reach(shell=([.85, .85, .1], .25, .8), half_spaces=[([1, 0, 0], .1), ([0, 1, 0], .1), ([0, 0, 1], .05)])
    return walls + place(rng, paths, areas, (.13, .24)), arm, ([.8, .8, .5], [.2, .2, .12])


def plant_scene(rng, paths):
    if len(paths) < 3:
        sys.exit("a plant scene requires three meshes or more: two plants, and what is behind them")
    w, d = .32, .25
    top = [box([-w, -d, -.02], [w, d, 0])]
    plants = place(rng, paths[:2], [(-w + .02, -d + .01, w - .02, -.02, .001, 1)], (.22, .3))
    objects = place(rng, paths[2:], [(-w + .03, 0, w - .03, d - .02, .001, 1)], (.12, .2))
    arm = Reach(shell=([0, -.6, .1], .2, .75), half_spaces=[([0, -1, 0], .05), ([0, 0, 1], .05)])
    return top + plants + objects, arm, ([0, -.75, .35], [0, .03, .1])


KINDS = {"bin": bin_scene, "table": table_scene, "shelf": shelf_scene, "kitchen": kitchen_scene, "plant": plant_scene}


def numbers(values):
    return f"[{', '.join(f'{v:.6f}' for v in values)}]"


def quaternion(eye, at):
    """Orientation (x, y, z, w) of a camera at `eye` that looks at `at`, with level image rows."""
    forward = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    return scipy.spatial.transform.Rotation.from_matrix(np.column_stack([right, np.cross(forward, right), forward])).as_quat()


def starts(view):
    """Three start poses (x, y, z, quaternion): the scene's, and ASIDE to its right and left."""
    eye, at = np.array(view, float)
    right = np.cross(at - eye, [0, 0, 1])
    right *= ASIDE / np.linalg.norm(right)
    return [np.array([*there, *quaternion(there, at)]) for there in (eye, eye + right, eye - right)]


def write(kind, seed, paths, out):
    """Writes the files of one scene to the folder `out`."""
    parts, reach, view = KINDS[kind](np.random.default_rng(seed), paths)
    vertices = np.concatenate([corners for corners, _ in parts])
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2  # reconstruct puts the world's origin here
    vertices = vertices - middle
    low, high = vertices.min(axis=0) - MARGIN, vertices.max(axis=0) + MARGIN
    out.mkdir(parents=True, exist_ok=True)
    meshes.write_off(out / "scene.off", [(np.round(corners - middle, 7).tolist(), faces) for corners, faces in parts])
    (out / "reach.toml").write_text(reach.toml(middle))
    all_starts = starts(np.array(view, float) - middle)
    (out / "starts.txt").write_text("".join(f"{k} {' '.join(f'{v:.6f}' for v in pose)}\n" for k, pose in enumerate(all_starts, 1)))
    (out / "flags.toml").write_text(
        f'mesh = "{out / "scene.off"}"\nreach = "{out / "reach.toml"}"\nsensor = "d435"\nvoxel = 0.005\n'
        f"workspace = {numbers([*low, *high])}\nfrom = {numbers(all_starts[0])}\n"
        "max-views = 10\nstop = \"area=0,idle=0,promises=0\"\npictures = false\n")


def listed():
    """The scenes of scenes.toml by name: tables with use, kind, seed and meshes."""
    return tomllib.loads(pathlib.Path(__file__).with_name("scenes.toml").read_text(encoding="utf-8"))


def write_listed(names, out):
    scenes = listed()
    for name in names or scenes:
        if name not in scenes:
            sys.exit(f"no scene {name} in scenes.toml; there are {', '.join(scenes)}")
        write(scenes[name]["kind"], scenes[name]["seed"], scenes[name]["meshes"], out / name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", nargs="?", choices=KINDS, help="kind of scene")
    parser.add_argument("seed", nargs="?", type=int, metavar="SEED", help="seed of sizes, rotations and places")
    parser.add_argument("meshes", nargs="*", metavar="MESH", help="meshes of objects")
    parser.add_argument("--listed", nargs="*", metavar="NAME", help="write scenes of scenes.toml instead (default: all)")
    parser.add_argument("--out", required=True, type=pathlib.Path, metavar="DIR", help="folder to write to")
    args = parser.parse_args()
    if args.listed is not None:
        if args.kind:
            parser.error("--listed cannot be used with KIND")
        write_listed(args.listed, args.out)
    elif args.kind is None or args.seed is None or not args.meshes:
        parser.error("KIND, SEED and at least one MESH are required, or --listed")
    else:
        write(args.kind, args.seed, args.meshes, args.out)


if __name__ == "__main__":
    main()
