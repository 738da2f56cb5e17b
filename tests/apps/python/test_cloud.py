# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from conftest import box_mesh

import viewgain

WORKSPACE = np.array([[-0.2] * 3, [0.2] * 3])


@pytest.fixture(scope="module")
def laser():
    """As sure at any incidence, so that frames and clouds say the same."""
    camera = viewgain.PinholeCamera(88, 72, fx=110.0, fy=110.0, cx=43.5, cy=35.5)
    return viewgain.Sensor(camera, min_range=0.2, max_range=2.0, working_distance=0.5,
                           noise=viewgain.ConstantNoise(), name="laser")


def empty_grid(sensor):
    return viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)


def test_a_cloud_says_what_its_frame_says(laser):
    camera = viewgain.SimulatedSensor(*box_mesh([-0.1] * 3, [0.1] * 3), laser, background_radius=1.5)
    frames, clouds = viewgain.FrameIntegrator(laser, carve="lines"), viewgain.CloudIntegrator(laser)
    of_frames, of_clouds = empty_grid(laser), empty_grid(laser)
    for pose in viewgain.orbit_poses(4, 0.6, 0.4):
        depth, _ = camera.acquire(pose)
        # Nothing up to max_range is a point beyond it.
        z = np.where(np.isinf(depth), 9.0, depth.astype(float))
        points = (laser.camera.rays() * z[..., None]).reshape(-1, 3)
        points[::97] = np.nan
        depth.ravel()[::97] = np.nan
        one = frames.integrate(of_frames, depth, pose)
        other = clouds.integrate(of_clouds, points, pose)
        assert one["readings"] == other["readings"] > 1500 and one["invalid"] == other["invalid"] > 60
        bounds = viewgain.cloud_bounds(laser, points, pose)
        assert np.allclose(bounds, viewgain.reading_bounds(laser, depth, pose), atol=1e-6)
    assert np.array_equal(of_clouds.views(), of_frames.views()) and len(of_clouds.views()) == 4
    same = of_clouds.states() == of_frames.states()  # but for points at a face of voxels
    assert same.size == 40**3 and np.count_nonzero(~same) < 64
    assert of_clouds.statistics()["occupied"] > 1000
    assert viewgain.cloud_bounds(laser, points * np.nan, pose) is None


def test_the_same_map_for_any_number_of_threads(laser):
    points = np.random.default_rng(1).normal(size=(5000, 3)) * 0.05 + [0, 0, 0.6]
    pose = viewgain.look_at([0, -0.6, 0], [0, 0, 0])
    hashes = set()
    for num_threads in (1, 2, 3):
        grid = empty_grid(laser)
        viewgain.CloudIntegrator(laser, num_threads=num_threads).integrate(grid, points, pose)
        hashes.add(grid.content_hash())
    assert len(hashes) == 1


def test_files(tmp_path, laser):
    points = np.array([[0.1, 0.2, 0.7], [np.nan] * 3, [0.0, -0.1, 0.8]])
    header = ("VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\n"
              "VIEWPOINT 1 2 3 1 0 0 0\nPOINTS 3\nDATA ascii\n")
    path = tmp_path / "scan.pcd"
    path.write_text(header + "\n".join(" ".join(map(str, p)) for p in points) + "\n")
    again, viewpoint = viewgain.load_cloud(path)
    assert again.dtype == np.float64 and np.array_equal(again, points, equal_nan=True)
    assert np.array_equal(viewpoint[:3, 3], [1, 2, 3]) and np.array_equal(viewpoint[:3, :3], np.eye(3))
    ply = tmp_path / "scan.ply"
    ply.write_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
                   "property double z\nend_header\n1 2 3\n")
    again, viewpoint = viewgain.load_cloud(str(ply))
    assert np.array_equal(again, [[1, 2, 3]]) and viewpoint is None
    path.write_text(header)
    with pytest.raises(viewgain.Error, match="scan.pcd"):
        viewgain.load_cloud(path)
    with pytest.raises(FileNotFoundError):
        viewgain.load_cloud(tmp_path / "none.ply")


def test_wrong_values_are_named(laser):
    integrator, grid = viewgain.CloudIntegrator(laser), empty_grid(laser)
    before = grid.content_hash()
    for points, pose, text in [(np.zeros((4, 2)), np.eye(4), r"points.*\(4, 2\)"),
                               (np.zeros(3), np.eye(4), r"points.*\(3,\)"),
                               (np.zeros((4, 3)), np.eye(3), r"T_world_sensor.*\(3, 3\)"),
                               (np.zeros((4, 3)), np.diag([2, 1, 1, 1]), "T_world_sensor.*orthonormal")]:
        with pytest.raises(ValueError, match=text):
            integrator.integrate(grid, points, pose)
        with pytest.raises(ValueError, match=text):
            viewgain.cloud_bounds(laser, points, pose)
    assert grid.content_hash() == before
    for settings, text in [({"occupancy": "yes"}, "occupancy"), ({"support_plane": np.nan}, "plane"),
                           ({"num_threads": -1}, "-1")]:
        with pytest.raises(ValueError, match=text):
            viewgain.CloudIntegrator(laser, **settings)
    assert repr(integrator) == "<CloudIntegrator of laser>"
