# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

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
