#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How fast and how exact are maps of the same simulated frames, compared with other libraries?

    mapping.py [--only WORD...] [--threads N] [--repetitions N] [--json FILE]
               [--vdbfusion CHECKOUT] [--bonxai CHECKOUT] [--wavemap CHECKOUT]

Prints the table of results/mapping.md: three objects and a room, two sensors, with and without flying
pixels. Each library runs in a process of its own and gets the same frames from memory. The time of a
frame excludes the surface. Peak memory is the growth of the process while frames are added. RMS is
the distance of points on the surface from the ground truth. Completeness is the share of the ground
truth that a frame saw and that lies within 2 or 5 mm of the surface. Open3D computes the distances.

Needs Debian's python3-open3d, and PYTHONPATH=build/release/python. VDBFusion, Bonxai and
wavemap are compared if checkouts of their repositories are given. They get the frames as points.
"""
import argparse
import dataclasses
import itertools
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import mapping_methods  # noqa: E402
import meshes  # noqa: E402
import mug  # noqa: E402
import viewgain  # noqa: E402
import visibility  # noqa: E402

OBJECTS = ["camel", "elephant", "hand"]
SIZE, DISTANCE, VIEWS = .35, .6, 14  # of an object [m], of the camera from its middle [m], number of frames
BACKGROUND = 1.5       # radius of what stands behind an object [m]
SENSORS = {"sr4000": .005, "d435": .003125}  # voxel for an object [m]
STEREO = {"d435"}                            # has no flying pixels: the simulation mixes only returns of modulated light
ROOM_VOXEL = .01                             # [m]
SAMPLES = 20000                              # points for RMS and completeness
TOLERANCES = [.002, .005]                    # of completeness [m]
REFERENCE = "Open3D ScalableTSDF, 4 voxels"
HERE = pathlib.Path(__file__).resolve().parent
LEAST_COSINE = np.cos(np.radians(80))        # of the angle of incidence at which a frame sees a point


@dataclasses.dataclass
class Scene:
    name: str
    vertices: np.ndarray   # (n, 3), world frame [m]
    triangles: np.ndarray
    poses: list            # T_world_camera
    workspace: list        # [m]
    voxels: dict           # by sensor [m]


def scenes():
    for name in OBJECTS:
        vertices, triangles = meshes.read_mesh(f"cgal:{name}")
        vertices = meshes.scaled(vertices, SIZE)
        half = np.abs(vertices).max(axis=0) + .03
        yield Scene(name, vertices, triangles, list(viewgain.sphere_poses(VIEWS, DISTANCE)), [list(-half), list(half)], SENSORS)
    vertices, triangles = mug.room_around(*mug.mug())
    margin, (x, y, z) = .05, mug.ROOM
    yield Scene("room", vertices, triangles, mug.room_poses(), [[-x / 2 - margin, -y / 2 - margin, -margin], [x / 2 + margin, y / 2 + margin, z + margin]],
                {sensor: ROOM_VOXEL for sensor in SENSORS})


def write_frames(scene, sensor_name, flying, folder):
    """The input of all methods: depth.npy [m], cropped.npy, poses.npy, scene.json, and points.bin for mapping_rivals.cpp.

    Libraries without a workspace get cropped.npy or points.bin, which have only the readings in the workspace."""
    sensor = viewgain.sensor_preset(sensor_name)
    camera = viewgain.SimulatedSensor(scene.vertices, scene.triangles, sensor, noise=True, lateral_noise=True, sub_rays=3 if flying else 1,
                                      background_radius=0 if scene.name == "room" else BACKGROUND)
    depth = np.array([camera.acquire(pose, i).depth for i, pose in enumerate(scene.poses)], np.float32)
    cropped, clouds = np.zeros_like(depth), []
    low, high = scene.workspace
    for pose, image, crop in zip(scene.poses, depth, cropped):
        row, column = np.nonzero(np.isfinite(image) & (image > 0))
        points = points_of(sensor.camera, row, column, image[row, column], pose)
        inside = ((points > low) & (points < high)).all(axis=1)
        crop[row[inside], column[inside]] = image[row[inside], column[inside]]
        clouds.append(points[inside])
    np.save(folder / "depth.npy", depth)
    np.save(folder / "cropped.npy", cropped)
    np.save(folder / "poses.npy", np.array(scene.poses))
    c = sensor.camera
    numbers = [[c.width, c.height, c.fx, c.fy, c.cx, c.cy, len(depth)]]
    for pose, points in zip(scene.poses, clouds):
        numbers += [pose.ravel(), [len(points)], points.ravel()]
    np.concatenate(numbers).astype(float).tofile(folder / "points.bin")
    (folder / "scene.json").write_text(json.dumps({
        "sensor": sensor_name, "voxel": scene.voxels[sensor_name], "workspace": scene.workspace, "max_range": sensor.max_range,
        "width": c.width, "height": c.height, "fx": c.fx, "fy": c.fy, "cx": c.cx, "cy": c.cy}), encoding="utf-8")


def points_of(camera, row, column, z, T_world_camera):
    """World frame [m]."""
    at_camera = np.stack([(column - camera.cx) / camera.fx * z, (row - camera.cy) / camera.fy * z, z], axis=1)
    return at_camera @ T_world_camera[:3, :3].T + T_world_camera[:3, 3]


class Referee:
    """Compares surfaces with the part of the ground truth that the frames saw."""

    def __init__(self, scene, sensor_name):
        known = visibility.KnownObject(scene.vertices, scene.triangles, viewgain.sensor_preset(sensor_name), SAMPLES)
        seen = np.any([known.sees(pose, LEAST_COSINE) for pose in scene.poses], axis=0)
        self.seen, self.truth = known.points[seen], distance_to(scene.vertices, scene.triangles)

    def figures(self, vertices, triangles):
        if len(triangles) == 0:
            return {"rms": None, **{f"within {t}": None for t in TOLERANCES}}
        corners = vertices[triangles]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        random = np.random.default_rng(1)
        of = random.choice(len(triangles), SAMPLES, p=areas / areas.sum())
        s, t = np.sqrt(random.random(SAMPLES))[:, None], random.random(SAMPLES)[:, None]
        points = (1 - s) * corners[of, 0] + s * (1 - t) * corners[of, 1] + s * t * corners[of, 2]
        to_surface = distance_to(vertices, triangles)(self.seen)
        return {"rms": float(np.sqrt((self.truth(points) ** 2).mean())),
                **{f"within {t}": float((to_surface <= t).mean()) for t in TOLERANCES}}


def distance_to(vertices, triangles):
    """A function that returns the distances of points from the mesh."""
    import open3d as o3d

    corners = vertices.astype(np.float32)
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    has_area = np.cross(b - a, c - a).any(axis=1)  # without area, Open3D's distances can fail an assertion
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(o3d.core.Tensor(corners), o3d.core.Tensor(triangles[has_area].astype(np.uint32)))
    return lambda points: scene.compute_distance(o3d.core.Tensor(points.astype(np.float32))).numpy()


class Python:
    """A library with Python bindings, in a process of mapping_methods.py."""

    def __init__(self, name):
        self.name = name

    def run(self, folder, threads):
        return output_of([sys.executable, str(HERE / "mapping_methods.py"), self.name, str(folder), str(threads)])

    def surface(self, folder):
        arrays = np.load(folder / "surface.npz")
        return arrays["vertices"], arrays["triangles"]


class Compiled:
    """A library without a Debian package: mapping_rivals.cpp compiled against its checkout."""

    def __init__(self, name, program, method):
        self.name, self.program, self.method = name, program, method

    def run(self, folder, _):
        voxel = json.loads((folder / "scene.json").read_text(encoding="utf-8"))["voxel"]
        return output_of([str(self.program), self.method, str(voxel), str(folder / "points.bin"), str(folder / "surface.bin")])

    def surface(self, folder):
        data = (folder / "surface.bin").read_bytes()
        vertices, triangles = np.frombuffer(data, np.int64, 2)
        end = 16 + 24 * vertices
        return (np.frombuffer(data[16:end], np.float64).reshape(-1, 3), np.frombuffer(data[end:end + 12 * triangles], np.int32).reshape(-1, 3))


def output_of(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"mapping.py: {' '.join(command)} failed with exit code {done.returncode}:\n{done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


def compiled(macro, checkout, includes, sources, libraries, folder):
    """mapping_rivals.cpp for one library. Exits with the compiler's message if it fails."""
    program = folder / macro
    command = ["g++", "-O3", "-march=native", "-DNDEBUG", "-std=c++17", f"-D{macro}", "-I/usr/include/eigen3",
               *(f"-I{checkout / path}" for path in includes), str(HERE / "mapping_rivals.cpp"),
               *(str(path) for pattern in sources for path in sorted(checkout.glob(pattern))), *libraries, "-pthread", "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"mapping.py: {checkout} cannot be compiled:\n{done.stderr[-2000:]}")
    return program


def methods_of(args, folder):
    yield from map(Python, mapping_methods.METHODS)
    if args.vdbfusion:
        program = compiled("MAPPING_VDBFUSION", args.vdbfusion, ["src/vdbfusion"], ["src/vdbfusion/vdbfusion/*.cpp"], ["-lopenvdb", "-ltbb"], folder)
        yield Compiled("VDBFusion, 2 voxels", program, "surface")
        yield Compiled("VDBFusion with carving, 2 voxels", program, "carving")
    if args.bonxai:
        yield Compiled("Bonxai", compiled("MAPPING_BONXAI", args.bonxai, ["bonxai_map/include", "bonxai_core/include"],
                                          ["bonxai_map/src/probabilistic_map.cpp"], [], folder), "occupancy")
    if args.wavemap:  # its logging needs libgoogle-glog-dev
        yield Compiled("wavemap", compiled("MAPPING_WAVEMAP", args.wavemap, ["library/cpp/include"], ["library/cpp/src/core/**/*.cc"], ["-lglog"], folder),
                       "occupancy")


def compare(scene, sensor_name, flying, methods, args):
    """A row per method."""
    with tempfile.TemporaryDirectory() as path:
        folder = pathlib.Path(path)
        write_frames(scene, sensor_name, flying, folder)
        referee = Referee(scene, sensor_name)
        costs, figures = {method: [] for method in methods}, {}
        for _ in range(args.repetitions):  # in turn, so that a slow minute of the machine meets all
            for method in methods:
                costs[method].append(method.run(folder, args.threads))
                figures[method] = figures.get(method) or referee.figures(*method.surface(folder))
        for method in methods:
            yield {"scene": scene.name, "sensor": sensor_name, "flying": flying, "method": method.name,
                   "seconds": statistics.median(cost["seconds"] for cost in costs[method]),
                   "megabytes": statistics.median(cost["megabytes"] for cost in costs[method]), **figures[method]}


def table(rows):
    """Means over the objects, and the room."""
    text = ("| frames | library, truncation | time per frame [ms] | / ScalableTSDF, 4 voxels | peak memory [MB] | RMS [mm] | "
            "within 2 mm [%] | within 5 mm [%] |\n" + "|---" * 8 + "|\n")
    groups = {}
    for row in rows:
        kind = "room" if row["scene"] == "room" else "objects"
        groups.setdefault((kind, row["sensor"], row["flying"]), {}).setdefault(row["method"], []).append(row)
    for (kind, sensor, flying), methods in groups.items():
        names = ", ".join(row["scene"] for row in next(iter(methods.values())))
        for method, own in methods.items():
            mean = lambda key, unit=1, digits=1: "-" if own[0][key] is None else f"{unit * statistics.mean(row[key] for row in own):.{digits}f}"
            ratios = [a["seconds"] / b["seconds"] for a, b in zip(own, methods[REFERENCE])]
            text += (f"| {names}, {sensor}, {'with' if flying else 'without'} flying pixels | {method} | {mean('seconds', 1e3)} | "
                     f"{statistics.geometric_mean(ratios):.2f} | {mean('megabytes', 1, 0)} | {mean('rms', 1e3, 2)} | "
                     f"{mean('within 0.002', 100)} | {mean('within 0.005', 100)} |\n")
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD", choices=[*OBJECTS, "room", *SENSORS],
                        help="scenes and sensors to include, of %(choices)s (default: all)")
    parser.add_argument("--threads", type=int, default=2, help="number of threads of each library (default: 2)")
    parser.add_argument("--repetitions", type=int, default=3, help="timed runs per row, of which the median is printed (default: 3)")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all rows, by scene")
    parser.add_argument("--vdbfusion", type=pathlib.Path, metavar="CHECKOUT", help="folder of github.com/PRBonn/vdbfusion")
    parser.add_argument("--bonxai", type=pathlib.Path, metavar="CHECKOUT", help="folder of github.com/facontidavide/Bonxai")
    parser.add_argument("--wavemap", type=pathlib.Path, metavar="CHECKOUT", help="folder of github.com/ethz-asl/wavemap; needs libgoogle-glog-dev")
    args = parser.parse_args()
    try:
        import open3d  # noqa: F401
    except ImportError as error:
        sys.exit(f"mapping.py needs Open3D: apt-get install python3-open3d, and run this with /usr/bin/python3 ({error})")
    wanted = lambda name, names: name in args.only or not set(names) & set(args.only)
    rows = []
    with tempfile.TemporaryDirectory() as programs:
        methods = list(methods_of(args, pathlib.Path(programs)))
        for scene, sensor, flying in itertools.product(scenes(), SENSORS, (True, False)):
            if wanted(scene.name, [*OBJECTS, "room"]) and wanted(sensor, SENSORS) and not (flying and sensor in STEREO):
                for row in compare(scene, sensor, flying, methods, args):
                    print(json.dumps(row), file=sys.stderr, flush=True)
                    rows.append(row)
    print(table(rows), end="")
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
