#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How much surface do wrong frames carve away, and is it noticed?

    contradictions.py VIEWGAIN MESH... [--seed N] [--every K]

Simulates a room of boxes, a shelf, a bin and each mesh, with a time-of-flight and a stereo camera.
Then it changes poses, images or intrinsics in growing steps. For each change it prints:

- carved: the share of the surface in the correct map that is free in the wrong map; also with a
  tolerance of one voxel
- in free space: the share of points in space that other frames saw as free
- seen past: the share of earlier points that later frames look through
- noticed: how often there was a warning

Folders without a mistake come first. They have all noise that the sensor file declares. Needs
PYTHONPATH=build/release/python.
"""
import argparse
import collections
import json
import math
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

import mistakes
import viewgain
from meshes import box, write_off


def room(_):
    return [box([-.1, -.12, -.1], [.1, .12, .1]), box([.1, -.02, -.1], [.2, .06, .02]), box([-.9, -1, -.3], [-.8, .2, .5]),
            box([-1, -1, -.35], [1, 1, -.3]), box([-.6, .7, -.3], [.1, .8, .3])]


def shelf(rng):
    parts = [box([-.4, -.15, z - .005], [.4, .15, z + .005]) for z in (-.3, -.05, .2, .45)]
    parts += [box([-.41, -.15, -.35], [-.4, .15, .5]), box([.4, -.15, -.35], [.41, .15, .5]), box([-.41, .14, -.35], [.41, .15, .5])]
    for z in (-.3, -.05, .2):
        for k in range(4):
            x, w, d, h = -.33 + .18 * k + rng.uniform(-.03, .03), *rng.uniform(.03, .07, 2), rng.uniform(.05, .18)
            parts.append(box([x - w, -.05 - d / 2, z + .005], [x + w, -.05 + d / 2, z + .005 + h]))
    return parts


def bin_of_boxes(rng):
    parts = [box([-.3, -.2, -.16], [.3, .2, -.15]), box([-.3, -.2, -.15], [-.29, .2, .1]), box([.29, -.2, -.15], [.3, .2, .1]),
             box([-.3, -.2, -.15], [.3, -.19, .1]), box([-.3, .19, -.15], [.3, .2, .1])]
    for k in range(8):
        x, y = rng.uniform(-.22, .22), rng.uniform(-.13, .13)
        a, b, c = rng.uniform(.03, .07, 3)
        parts.append(box([x - a / 2, y - b / 2, -.15], [x + a / 2, y + b / 2, -.15 + c + .02 * k]))
    return parts


def look(eye, at):
    return viewgain.look_at(np.array(eye, float), np.array(at, float))


# Pose of the camera at time k [frames].
def before_a_table(k):
    a = .16 * k - .8
    return look([.7 * math.cos(a), .7 * math.sin(a), .25 + .05 * math.sin(5 * a)], [.02, .03, 0])


def before_a_shelf(k):
    return look([.6 * math.sin(.5 * k - 2.5), -.9 + .1 * math.cos(k), .1 + .25 * math.sin(1.1 * k)], [.1 * math.sin(k), 0, .08])


def over_a_bin(k):
    return look([.35 * math.cos(.55 * k), .35 * math.sin(.55 * k), .65], [.05 * math.cos(k), 0, -.1])


def round_an_object(k):
    a = 2 * math.pi * k / 12
    return look([.53 * math.cos(a), .53 * math.sin(a), .28 + .03 * math.sin(1.7 * k)], [0, 0, 0])


Scene = collections.namedtuple("Scene", "name mesh path box voxel sensor extra")


class Folder:
    """Frames of a scene, and the maps that the program makes from them."""

    def __init__(self, program, scene, root):
        self.program, self.scene, self.root = program, scene, root

    def run(self, *words):
        return subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)

    def simulate(self, seed, *flags):
        poses = np.stack([self.scene.path(k) for k in range(12)])
        viewgain.write_poses(self.root / "asked.txt", poses, timestamps=np.arange(12.0))
        shutil.rmtree(self.root / "right", ignore_errors=True)
        result = self.run("simulate", self.scene.mesh, "--poses", self.root / "asked.txt", "--sensor", self.scene.sensor,
                          "--noise", "on", "--seed", seed, *self.scene.extra, *flags, "--out", self.root / "right")
        assert result.returncode == 0, result.stderr
        return self.root / "right"

    def declare(self, line):
        path = self.root / "right" / "sensor.toml"
        path.write_text(line + "\n" + path.read_text())

    def integrate(self, folder):
        """Shares, warning and states of the map. Shares and states are None if the folder is refused."""
        result = self.run("integrate", folder, "--voxel", self.scene.voxel, "--workspace=" + self.scene.box, "--out",
                          self.root / "map.vdb", "--json", "--quiet")
        if result.returncode:
            return None, result.stderr, None
        return json.loads(result.stdout)["contradiction"], result.stderr, viewgain.BeliefGrid.load(self.root / "map.vdb").states()


def turn(axis, degrees):
    matrix, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)]["xyz".index(axis)]
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def shift(axis, metres):
    matrix = np.eye(4)
    matrix["xyz".index(axis), 3] = metres
    return matrix


def changes(scene):
    def poses(change):
        def apply(folder):
            own, times = viewgain.read_timed_poses(folder / "poses.txt")
            viewgain.write_poses(folder / "poses.txt", np.stack([change(i, pose, own) for i, pose in enumerate(own)]), timestamps=times)
        return apply

    def intrinsics(keys, factor):
        def apply(folder):
            lines = (folder / "sensor.toml").read_text().splitlines()
            for i, line in enumerate(lines):
                key = line.split(" = ")[0]
                if key in keys:
                    lines[i] = f"{key} = {float(line.split(' = ')[1].split('#')[0]) * factor}"
            (folder / "sensor.toml").write_text("\n".join(lines) + "\n")
        return apply

    def images(change):
        def apply(folder):
            for path in folder.glob("*.png"):
                mistakes.write_png(path, [list(map(int, row)) for row in change(np.array(mistakes.read_png(path)))])
        return apply

    def hangs(folder):
        for path in folder.glob("frame-000004.*"):
            for i in range(5, 10):
                shutil.copy(path, folder / path.name.replace("000004", f"{i:06d}"))

    for axis in "xyz":
        for a in (.5, 1, 2, 3, 5, 8, 15, 30, 60, 90, 135, 180):
            yield f"camera turned about {axis} [deg]", a, poses(lambda i, T, all: T @ turn(axis, a))
    for axis in "xyz":
        for a in (.5, 1, 2, 3, 4, 6, 10, 15, 20):
            yield f"camera shifted along {axis} [cm]", a, poses(lambda i, T, all: T @ shift(axis, a / 100))
    for a in (1, 2, 3, 5, 10, 20):
        yield "second half shifted [cm]", a, poses(lambda i, T, all: (shift("y", a / 100) if i > 5 else np.eye(4)) @ T)
    for a in (.05, .1, .2, .4, .6, .8, 1):
        yield "poses late [frames]", a, poses(lambda i, T, all: scene.path(i + a))
    for a in (.5, .67, .8, .9, .95, 1.05, 1.1, 1.25, 1.5, 2):
        yield "fx and fy times", a, intrinsics(("fx", "fy"), a)
    for a in (.5, .67, .8, .9, .95, 1.05, 1.1, 1.25, 1.5, 2):
        yield "fx times", a, intrinsics(("fx",), a)
    yield "images", "mirrored", images(lambda image: image[:, ::-1])
    yield "images", "upside down", images(lambda image: image[::-1])
    yield "images", "turned by 180", images(lambda image: image[::-1, ::-1])
    for a in (1, 2, 3):
        yield "numbers shifted by", a, poses(lambda i, T, all: all[(i + a) % len(all)])
    yield "images", "camera hangs", hangs


def grown(states):
    """For each voxel: is it or one of its 26 neighbours occupied?"""
    occupied = np.pad(states == 2, 1)
    for axis in range(3):
        occupied = occupied | np.roll(occupied, 1, axis) | np.roll(occupied, -1, axis)
    return occupied[1:-1, 1:-1, 1:-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="VIEWGAIN", help="the program viewgain")
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, metavar="MESH", help="mesh files of objects")
    parser.add_argument("--seed", type=int, default=1, help="seed of scenes and noise (default: 1)")
    parser.add_argument("--every", type=int, default=1, help="apply only every K-th change (default: 1)")
    options = parser.parse_args()
    rows, alarms, right = collections.defaultdict(list), 0, 0
    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        rng = np.random.default_rng(options.seed)
        own = {}
        for make in (room, shelf, bin_of_boxes):
            own[make] = root / f"{make.__name__}.off"
            write_off(own[make], make(rng))
        s = dict(w=160, h=120, f=140, cx=79.5, cy=59.5, lo=.1, hi=6, wd=.6, s=.002)
        (root / "probe.toml").write_text(mistakes.SENSOR.format(**s))
        scenes = [Scene("room", own[room], before_a_table, "-1,-1,-.4,1,1,.6", .02, root / "probe.toml", ("--background", 3)),
                  Scene("shelf", own[shelf], before_a_shelf, "-.5,-.3,-.45,.5,.2,.6", .01, root / "probe.toml", ()),
                  Scene("bin", own[bin_of_boxes], over_a_bin, "-.4,-.3,-.2,.4,.3,.2", .005, "sr4000", ())]
        for n, mesh in enumerate(options.meshes):
            scenes.append(Scene(mesh.stem, mesh.resolve(), round_an_object, "-.25,-.25,-.25,.25,.25,.25", .005,
                                ["sr4000", "d435"][n % 2], ("--size", .35, "--place", "center")))
        for scene in scenes:
            folder = Folder(options.program, scene, root)
            for flags, line in (((), ""), (("--noise", "plain"), ""), (("--noise", "on,scale=0.01"), "scale_sigma = 0.01"),
                                (("--noise", "on,pose=.005/.5"), "pose_sigma_rad = [0.005, 0.0087]")):
                for seed in range(3):
                    path = folder.simulate(options.seed + seed, *flags)
                    folder.declare(line)
                    shares, said, _ = folder.integrate(path)
                    right += 1
                    if shares is None or said:
                        alarms += 1
                        print("false alarm:", scene.name, flags, seed, said.strip()[:200], flush=True)
            _, _, truth = folder.integrate(folder.simulate(options.seed))
            for number, (kind, amount, apply) in enumerate(changes(scene)):
                if number % options.every:
                    continue
                shutil.rmtree(root / "wrong", ignore_errors=True)
                shutil.copytree(root / "right", root / "wrong")
                apply(root / "wrong")
                shares, said, states = folder.integrate(root / "wrong")
                if shares is None:
                    rows[kind, amount].append((math.nan, math.nan, math.nan, math.nan, True))
                    continue
                surface = truth == 2
                carved = surface & (states == 1)
                rows[kind, amount].append((carved.sum() / surface.sum(), (carved & ~grown(states)).sum() / surface.sum(),
                                           shares["share_in_free"], shares["share_seen_past"], bool(said)))
    print(f"\nright folders: {alarms} of {right} with a warning\n")
    print("| change | by | carved [%] | by over a voxel [%] | in free space [%] | seen past [%] | noticed |\n|---|---|---|---|---|---|---|")
    for (kind, amount), all in rows.items():
        part = [" to ".join(f"{100 * f([row[k] for row in all if not math.isnan(row[k])] or [math.nan]):.1f}" for f in (min, max)) for k in range(4)]
        print(f"| {kind} | {amount} | {' | '.join(part)} | {sum(row[4] for row in all)} of {len(all)} |")


if __name__ == "__main__":
    main()
