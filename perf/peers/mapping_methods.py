#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Maps the frames of mapping.py with one library. mapping.py starts this as a process for each row.

    mapping_methods.py METHOD FOLDER THREADS

Reads depth.npy or cropped.npy, poses.npy and scene.json from FOLDER. Writes surface.npz and prints time and memory.
"""
import json
import os
import pathlib
import sys
import time

import numpy as np


class Viewgain:
    def __init__(self, scene, threads):
        import viewgain

        sensor = viewgain.sensor_preset(scene["sensor"])
        self.threads = threads
        self.grid = viewgain.BeliefGrid(voxel_size=scene["voxel"], workspace=scene["workspace"], sensor=sensor)
        self.integrator = viewgain.FrameIntegrator(sensor, num_threads=threads)

    def prepared(self, depth, T_world_camera):
        return depth, T_world_camera

    def add(self, depth, T_world_camera):
        self.integrator.integrate(self.grid, depth, T_world_camera)

    def surface(self):
        import viewgain.mesh

        surface = viewgain.mesh.surface_of_grid(self.grid, num_threads=self.threads)
        return surface.vertices, surface.triangles


class ScalableTsdf:
    def __init__(self, scene, truncation):
        import open3d as o3d

        self.o3d, self.max_range = o3d, scene["max_range"]
        self.intrinsic = o3d.camera.PinholeCameraIntrinsic(*(scene[key] for key in ("width", "height", "fx", "fy", "cx", "cy")))
        self.volume = o3d.pipelines.integration.ScalableTSDFVolume(
            voxel_length=scene["voxel"], sdf_trunc=truncation * scene["voxel"], color_type=o3d.pipelines.integration.TSDFVolumeColorType.NoColor)

    def prepared(self, depth, T_world_camera):
        grey = self.o3d.geometry.Image(np.zeros((*depth.shape, 3), np.uint8))
        image = self.o3d.geometry.RGBDImage.create_from_color_and_depth(
            grey, self.o3d.geometry.Image(depth), depth_scale=1., depth_trunc=self.max_range, convert_rgb_to_intensity=False)
        return image, np.linalg.inv(T_world_camera)

    def add(self, image, T_camera_world):
        self.volume.integrate(image, self.intrinsic, T_camera_world)

    def surface(self):
        mesh = self.volume.extract_triangle_mesh()
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)


class VoxelBlocks:
    TRUNCATION = 2.  # [voxels]; Debian's 0.16.1 fails an assertion at 4 and 8

    def __init__(self, scene):
        import open3d as o3d

        core = self.core = o3d.core
        self.o3d, self.max_range = o3d, scene["max_range"]
        self.intrinsic = core.Tensor([[scene["fx"], 0, scene["cx"]], [0, scene["fy"], scene["cy"]], [0, 0, 1]], core.float64)
        self.blocks = o3d.t.geometry.VoxelBlockGrid(("tsdf", "weight"), (core.float32, core.float32), ((1), (1)), scene["voxel"], 16, 10000)

    def prepared(self, depth, T_world_camera):
        return self.o3d.t.geometry.Image(self.core.Tensor(depth)), self.core.Tensor(np.linalg.inv(T_world_camera))

    def add(self, image, T_camera_world):
        blocks = self.blocks.compute_unique_block_coordinates(image, self.intrinsic, T_camera_world, 1., self.max_range, self.TRUNCATION)
        self.blocks.integrate(blocks, image, self.intrinsic, T_camera_world, 1., self.max_range, self.TRUNCATION)

    def surface(self):
        mesh = self.blocks.extract_triangle_mesh(weight_threshold=0.)
        return mesh.vertex.positions.numpy(), mesh.triangle.indices.numpy()


METHODS = {
    "viewgain": Viewgain,
    **{f"Open3D ScalableTSDF, {t} voxels": lambda scene, _, t=t: ScalableTsdf(scene, t) for t in (2, 4, 8)},
    "Open3D VoxelBlockGrid, 2 voxels": lambda scene, _: VoxelBlocks(scene),
}


def memory(key):
    """VmRSS or VmHWM of this process [MB]."""
    line = next(line for line in pathlib.Path("/proc/self/status").read_text(encoding="utf-8").splitlines() if line.startswith(key))
    return int(line.split()[1]) / 1024


def main(method, folder, threads):
    os.environ["OMP_NUM_THREADS"] = threads
    folder = pathlib.Path(folder)
    scene = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
    __import__("viewgain.mesh" if method == "viewgain" else "open3d")
    before = memory("VmRSS")
    mapper = METHODS[method](scene, int(threads))
    allocated = memory("VmRSS") - before
    depth, poses = np.load(folder / ("depth.npy" if method == "viewgain" else "cropped.npy")), np.load(folder / "poses.npy")
    frames = [mapper.prepared(*frame) for frame in zip(depth, poses)]
    pathlib.Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")  # peak = now
    before, start = memory("VmRSS"), time.perf_counter()
    for frame in frames:
        mapper.add(*frame)
    seconds = (time.perf_counter() - start) / len(frames)
    megabytes = allocated + memory("VmHWM") - before
    vertices, triangles = mapper.surface()
    np.savez(folder / "surface.npz", vertices=vertices, triangles=triangles)
    print(json.dumps({"seconds": seconds, "megabytes": megabytes}))


if __name__ == "__main__":
    main(*sys.argv[1:])
