# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: GPL-3.0-or-later
import copy
import importlib.util
import pickle
import sys
import threading
import types

import numpy as np
import pytest
from conftest import box_mesh

import viewgain
import viewgain.mesh

VOXEL = 0.01
WORKSPACE = np.array([[-0.2] * 3, [0.2] * 3])


@pytest.fixture(scope="module")
def camera(sensor):
    return viewgain.SimulatedSensor(*box_mesh([-0.1] * 3, [0.1] * 3), sensor, background_radius=1.5)


@pytest.fixture(scope="module")
def start():
    return viewgain.look_at([0.45, 0.2, 0.25], [0, 0, 0])


def reconstruct(camera, sensor, start, **settings):
    def acquire(T_world_camera):
        return camera.acquire(T_world_camera)

    settings = {"voxel_size": VOXEL, "workspace": WORKSPACE, "max_views": 4, **settings}
    return viewgain.mesh.reconstruct(settings.pop("acquire", acquire), sensor, start, **settings)


def test_the_loop_with_a_camera_in_python(camera, sensor, start, tmp_path):
    seen = []
    result = reconstruct(camera, sensor, start, stop_gain=0.0, observer=seen.append)
    assert result.reason in ("max_views", "idle", "no_candidates", "area")
    assert 2 <= len(result.views) <= 4 and seen == result.views
    assert np.allclose(result.views[0]["T_world_camera"], start)
    assert result.views[0]["generator"] == "start" == result.views[0].generator
    assert pickle.loads(pickle.dumps(result.views[1]))._fields == viewgain.mesh.ViewRecord._fields
    assert {view["generator"] for view in result.views[1:]} == {"boundary"}
    unknown = [view["unknown_voxels"] for view in result.views]
    assert all(b < a for a, b in zip(unknown, unknown[1:]))
    assert len(result.grid.views()) == len(result.views)
    distance = np.abs(np.max(np.abs(result.surface.vertices), axis=1) - 0.1)
    assert len(distance) > 500 and np.median(distance) < 0.005
    assert f"{len(result.views)} views" in repr(result) and "vertices" in repr(result.surface)
    for tracer in ("embree", "sweep"):
        again = reconstruct(camera, sensor, start, stop_gain=0.0, num_threads=1, tracer=tracer)
        assert again.grid.content_hash() == result.grid.content_hash()
    result.surface.save(tmp_path / "surface.ply")
    header = (tmp_path / "surface.ply").read_bytes()[:400].decode("latin1")
    assert f"element vertex {len(result.surface.vertices)}\n" in header
    assert f"element face {len(result.surface.triangles)}\n" in header


def test_the_gain_of_the_loop(camera, sensor, start):
    def gains(**settings):
        result = reconstruct(camera, sensor, start, max_views=2, **settings)
        return result.views[1]["predicted_gain"], result.views[1]["predicted_area"]

    assert gains() == gains(gain="combined") != gains(gain="surface")
    for settings, text in [(dict(gain="paper", stop_area=0.1), "stop_area"), (dict(stop_area=1.0), "stop_area"),
                           (dict(stop_gain=1.0), "stop_gain"), (dict(criterion="trace"), "criterion"), (dict(gain="area"), "combined")]:
        with pytest.raises(ValueError, match=text):
            gains(**settings)


def test_candidates_of_ones_own_and_reach(camera, sensor, start):
    candidates = viewgain.sphere_poses(40, 0.5)
    reach = viewgain.ReachRegion(half_spaces=[[0, 0, 1, 0.1]])
    result = reconstruct(camera, sensor, start, boundary=False, candidates=candidates, reach=reach,
                         stop_gain=0.0, policy="frontier")
    assert len(result.views) > 1
    for view in result.views[1:]:
        assert np.any(np.all(view["T_world_camera"] == candidates, axis=(1, 2)))
        assert view["T_world_camera"][2, 3] >= 0.1
    assert result.views[0]["dropped"]["unreachable"] > 10


def test_policies_with_a_set_of_their_own_leave_boundaries_out(camera, sensor, start):
    candidates = viewgain.sphere_poses(9, 0.5)[::2]
    settings = {"candidates": candidates, "stop_gain": 0.0, "idle_views": 0}
    for policy in ("random", "sequence"):
        views = reconstruct(camera, sensor, start, policy=policy, max_views=3, **settings).views
        assert [view["generator"] for view in views] == ["start", "candidates", "candidates"]
        with pytest.raises(ValueError, match=f'policy "{policy}" requires candidates'):
            reconstruct(camera, sensor, start, policy=policy)
    with pytest.raises(ValueError, match="requires candidates"):
        reconstruct(camera, sensor, start, boundary=False)


def test_what_the_camera_returns_is_checked(camera, sensor, start):
    depth, amplitude = camera.acquire(start)
    moved = start.copy()
    moved[0, 3] += 0.01
    for answer in (depth, depth.astype(float).tolist(), (depth, None), (depth, moved, amplitude)):
        result = reconstruct(camera, sensor, start, acquire=lambda pose: answer, max_views=1)
        assert result.reason == "max_views" and len(result.views) == 1
    assert np.allclose(result.grid.views()[0], moved)
    for answer, text in [(depth[1:], r"\(143, 176\)"), ((depth, moved, amplitude, 1), "tuple of 4"), ((depth, amplitude, moved), "T_world_camera"),
                         (None, "depth"), ((1000 * depth).astype(np.uint16), "dtype uint16"),
                         (1000 * depth, "metres"), ((depth, 0 * moved, amplitude), "T_world_camera"),
                         (np.zeros_like(depth), "shows nothing in the workspace")]:
        with pytest.raises(ValueError, match=text):
            reconstruct(camera, sensor, start, acquire=lambda pose: answer)

    def broken(pose):
        raise KeyError("arm")

    with pytest.raises(KeyError, match="arm"):
        reconstruct(camera, sensor, start, acquire=broken)
    with pytest.raises(KeyError, match="arm"):
        reconstruct(camera, sensor, start, observer=broken)
    with pytest.raises(KeyboardInterrupt):
        reconstruct(camera, sensor, start, acquire=lambda pose: (_ for _ in ()).throw(KeyboardInterrupt))


def test_wrong_settings_are_named(camera, sensor, start):
    for settings, text in [({"policy": "best"}, "best"), ({"criterion": "x"}, "'x'"), ({"tracer": "bvh"}, "valid values: automatic"),
                           ({"voxel_size": 0.0}, "voxel"), ({"workspace": [0, 1]}, r"\(2,\)"),
                           ({"max_views": 0}, "max_views"), ({"candidates": start}, r"\(4, 4\)")]:
        with pytest.raises(ValueError, match=text):
            reconstruct(camera, sensor, start, **settings)
    with pytest.raises(TypeError):
        reconstruct(camera, sensor, start, acquire=3)
    with pytest.raises(ValueError, match="start"):
        reconstruct(camera, sensor, 2 * start)


def test_a_stop_keeps_what_was_measured(camera, sensor, start):
    control = viewgain.BatchControl()
    views = []

    def acquire(pose):
        views.append(pose)
        if len(views) == 2:
            thread = threading.Thread(target=control.stop)
            thread.start()
            thread.join()
        return camera.acquire(pose)

    result = reconstruct(camera, sensor, start, acquire=acquire, control=control, stop_gain=0.0)
    assert result.reason == "interrupted" and len(result.grid.views()) == 2


def test_surface_and_boundaries(camera, sensor, start):
    grid = viewgain.BeliefGrid(voxel_size=VOXEL, workspace=WORKSPACE, sensor=sensor)
    viewgain.FrameIntegrator(sensor).integrate(grid, camera.acquire(start)[0], start)
    surface = viewgain.mesh.surface_of_grid(grid, min_hits=1)
    points = grid.points(min_hits=1)
    again = viewgain.mesh.reconstruct_surface(
        points["position"], points["toward_free"], spacing=VOXEL)
    assert np.array_equal(again.vertices, surface.vertices)
    assert np.array_equal(again.triangles, surface.triangles)
    assert surface.triangles.max() < len(surface.vertices) == len(surface.normals)
    assert surface.source.max() < len(points)
    assert grid.pooling_length() == VOXEL
    poses, reasons = viewgain.mesh.boundary_candidates(surface, [start], sensor, spacing=VOXEL)
    assert poses.shape == (len(reasons), 4, 4) and len(reasons) > 10
    assert {viewgain.mesh.BoundaryClass(int(code)).name.lower() for code in reasons["boundary_class"]} <= set(viewgain.mesh.BOUNDARY_CLASS_NAMES)
    assert reasons["nominal"].any() and np.all(reasons["run_length"] > 0)
    few, _ = viewgain.mesh.boundary_candidates(
        surface, [start], sensor, spacing=VOXEL, tilts=[0.0], rolls=[0.0], distances=[1.0])
    assert 0 < len(few) < len(poses)
    for call, text in [
            (lambda: viewgain.mesh.boundary_candidates(surface, start, sensor, spacing=VOXEL), r"\(4, 4\)"),
            (lambda: viewgain.mesh.boundary_candidates(surface, [start], sensor, spacing=VOXEL, overlap=2.0),
             "overlap"),
            (lambda: viewgain.mesh.boundary_candidates(surface, [start], sensor, spacing=0.0), "spacing"),
            (lambda: viewgain.mesh.reconstruct_surface(np.zeros((3, 2)), spacing=VOXEL), r"\(3, 2\)"),
            (lambda: viewgain.mesh.reconstruct_surface(np.zeros((3, 3)), np.zeros((2, 3)), spacing=VOXEL),
             "rows: 2"),
            (lambda: viewgain.mesh.reconstruct_surface(np.zeros((3, 3)), spacing=0.0), "spacing")]:
        with pytest.raises(ValueError, match=text):
            call()


@pytest.fixture(scope="module")
def plate():
    """A surface through a plate of points, z up."""
    x, y = np.meshgrid(np.arange(12) * VOXEL, np.arange(12) * VOXEL)
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    return viewgain.mesh.reconstruct_surface(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), spacing=VOXEL)


class Trimesh:
    """Of the stand-in for trimesh: what its constructor is given."""

    def __init__(self, **given):
        self.__dict__.update(given)


def stand_ins():
    """Modules as trimesh and Open3D, as far as a surface calls them."""
    vectors = types.SimpleNamespace(Vector3dVector=lambda a: np.array(a, np.float64), Vector3iVector=lambda a: np.array(a, copy=True))
    return {"trimesh": types.SimpleNamespace(Trimesh=Trimesh),
            "open3d": types.SimpleNamespace(utility=vectors, geometry=types.SimpleNamespace(TriangleMesh=types.SimpleNamespace))}


# The real ones too, where they are: tests/portability.sh installs what the release has.
@pytest.mark.parametrize("name, real", [
    (name, real) for name in ("trimesh", "open3d") for real in (False, True) if not real or importlib.util.find_spec(name)])
def test_a_surface_goes_to_other_packages(plate, monkeypatch, name, real):
    monkeypatch.setitem(sys.modules, name, importlib.import_module(name) if real else stand_ins()[name])
    mesh = getattr(plate, f"to_{name}")()
    normals, triangles = mesh.vertex_normals, mesh.faces if name == "trimesh" else mesh.triangles
    assert np.array_equal(mesh.vertices, plate.vertices) and np.allclose(normals, plate.normals, atol=1e-12)
    assert np.array_equal(triangles, plate.triangles) and len(plate.triangles) > 200
    if not real:
        assert mesh.process is False if name == "trimesh" else triangles.dtype == np.int32


def test_surfaces_are_equal_by_value_and_not_pickled(plate):
    empty = viewgain.mesh.reconstruct_surface(np.zeros((0, 3)), spacing=VOXEL)
    again = viewgain.mesh.reconstruct_surface(np.zeros((0, 3)), spacing=2 * VOXEL)
    assert empty == again and plate == plate and plate != empty and plate != "surface"
    for refused in (pickle.dumps, copy.copy):
        with pytest.raises(TypeError, match="cannot pickle 'Surface'"):
            refused(plate)


@pytest.mark.parametrize("name", ["trimesh", "open3d"])
def test_a_package_that_is_not_there_is_named(plate, monkeypatch, name):
    monkeypatch.setitem(sys.modules, name, None)  # as if it were not installed
    with pytest.raises(ImportError, match=f"to_{name} needs the package {name}.*Surface.save"):
        getattr(plate, f"to_{name}")()
