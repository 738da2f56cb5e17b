# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""A surface in Open3D itself, where that is installed (Debian: python3-open3d), and both in one process."""
import subprocess
import sys

import numpy as np
import pytest

import viewgain.mesh

VOXEL = 0.01


def plate():
    """A surface through a plate of points, z up."""
    x, y = np.meshgrid(np.arange(12) * VOXEL, np.arange(12) * VOXEL)
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    return viewgain.mesh.reconstruct_surface(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), spacing=VOXEL)


def test_open3d_gets_vertices_normals_and_triangles():
    pytest.importorskip("open3d")
    surface = plate()
    mesh = surface.to_open3d()
    assert np.array_equal(np.asarray(mesh.vertices), surface.vertices) and len(surface.vertices) == 144
    assert np.array_equal(np.asarray(mesh.triangles), surface.triangles) and len(surface.triangles) == 242
    assert np.array_equal(np.asarray(mesh.vertex_normals), surface.normals)
    assert mesh.has_vertex_normals() and not mesh.has_vertex_colors()
    assert mesh.is_edge_manifold() and mesh.is_orientable() and mesh.get_surface_area() == pytest.approx(0.11**2)
    mesh.compute_triangle_normals()
    assert np.allclose(np.asarray(mesh.triangle_normals), [0, 0, 1])  # towards free space, as the surface's
    # A copy: neither changes the other.
    mesh.translate([1.0, 0, 0])
    mesh.paint_uniform_color([0.5, 0.5, 0.5])
    assert surface.vertices.max() < 0.2 and mesh.has_vertex_colors()


def test_open3d_gets_a_surface_without_vertices():
    pytest.importorskip("open3d")
    mesh = viewgain.mesh.reconstruct_surface(np.zeros((0, 3)), spacing=VOXEL).to_open3d()
    assert mesh.is_empty() and len(mesh.vertices) == len(mesh.triangles) == 0


def test_open3d_reads_what_save_wrote(tmp_path):
    open3d = pytest.importorskip("open3d")
    surface = plate()
    surface.save(tmp_path / "surface.ply")
    mesh = open3d.io.read_triangle_mesh(str(tmp_path / "surface.ply"))
    assert np.allclose(np.asarray(mesh.vertices), surface.vertices, atol=1e-6)
    assert np.array_equal(np.asarray(mesh.triangles), surface.triangles)
    assert np.allclose(np.asarray(mesh.vertex_normals), surface.normals, atol=1e-6)


PROGRAM = """
import numpy
sensor = viewgain.sensor_preset("sr4000")
sphere = open3d.geometry.TriangleMesh.create_sphere(0.1)
vertices, triangles = numpy.asarray(sphere.vertices), numpy.asarray(sphere.triangles)
camera = viewgain.SimulatedSensor(vertices, triangles, sensor, background_radius=1.5)
start = viewgain.look_at([0.45, 0.2, 0.25], [0, 0, 0])
workspace = [[-0.15] * 3, [0.15] * 3]
result = viewgain.mesh.reconstruct(camera.acquire, sensor, start, voxel_size=0.01, workspace=workspace, max_views=2)
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(result.grid, boxes=[[[-1, -1, -0.2], [1, 1, -0.15]]]), sensor)
assert numpy.isfinite(evaluator.evaluate(viewgain.sphere_poses(20, 0.5))).all()
assert viewgain.BeliefGrid.from_bytes(result.grid.to_bytes()) == result.grid
mesh = result.surface.to_open3d()
mesh.compute_triangle_normals()
tree = open3d.geometry.KDTreeFlann(sphere.sample_points_uniformly(20000))
apart = [tree.search_knn_vector_3d(vertex, 1)[2][0] ** 0.5 for vertex in mesh.vertices]
assert len(apart) > 100 and numpy.median(apart) < 0.005
try:
    viewgain.BeliefGrid.from_bytes(b"no map")
except viewgain.Error:
    print("well")
"""


@pytest.mark.parametrize("imports", ["import open3d, viewgain.mesh", "import viewgain.mesh, open3d"])
def test_both_work_in_one_process(imports):
    pytest.importorskip("open3d")
    done = subprocess.run([sys.executable, "-c", f"{imports}\n{PROGRAM}"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and done.stdout.endswith("well\n"), done.stderr


BITS = """
import hashlib, numpy, viewgain
sensor = viewgain.sensor_preset("sr4000")
labels = numpy.zeros((48, 48, 48), int)
labels[16:32, 16:32, 16:32] = 2
scene = viewgain.VoxelScene(viewgain.BeliefGrid.from_labels(labels, voxel_size=0.01, origin=[-0.24] * 3, sensor=sensor))
gains = [viewgain.GainEvaluator(scene, sensor, gain=gain, pixel_stride=2).evaluate(viewgain.sphere_poses(30, 0.7))
         for gain in ("paper", "combined")]
print(hashlib.sha256(numpy.concatenate(gains).tobytes()).hexdigest())
"""


def test_gains_have_the_same_bits_beside_open3d():
    pytest.importorskip("open3d")
    hashes = [subprocess.run([sys.executable, "-c", f"{imports}\n{BITS}"], capture_output=True, text=True, timeout=300, check=True).stdout
              for imports in ("", "import open3d", "import viewgain, open3d")]
    assert len(hashes[0]) == 65 and len(set(hashes)) == 1
