# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Units and conventions that are allowed and seldom meant: which calls warn, and of what."""
import warnings

import numpy as np
import pytest
from conftest import box_mesh

import viewgain

WORKSPACE = [[-0.15, -0.15, -0.15], [0.15, 0.15, 0.15]]


def make_sensor(**more):
    camera = viewgain.PinholeCamera(64, 48, fx=80, fy=80, cx=31.5, cy=23.5)
    return viewgain.Sensor(camera, **{**dict(noise=viewgain.ConstantNoise(), min_range=0.1,
                                             max_range=3, working_distance=0.4), **more})


@pytest.fixture(scope="module")
def sensor():
    return make_sensor()


@pytest.fixture(scope="module")
def camera(sensor):
    return viewgain.SimulatedSensor(*box_mesh([-0.08] * 3, [0.08] * 3), sensor)


@pytest.fixture(scope="module")
def poses():
    return viewgain.orbit_poses(12, 0.5, 0.3)


def said(call):
    """The one warning of a call, or nothing."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert len(caught) <= 1 and all(w.category is UserWarning for w in caught)
    return str(caught[0].message) if caught else ""


def planner(sensor, **more):
    return viewgain.ViewPlanner(sensor, **{**dict(voxel_size=0.01, workspace=WORKSPACE), **more})


def test_poses_that_are_inverse(sensor, camera, poses):
    wrong = np.linalg.inv(poses)
    plan = planner(sensor)
    for i in range(3):
        depth, amplitude = camera.acquire(poses[i], i)
        assert said(lambda: plan.add(depth, poses[i])) == ""
    evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(plan.grid), sensor)
    words = "the poses are world to camera, not camera to world"
    calls = [evaluator.evaluate, evaluator.evaluate_detailed, evaluator.best, evaluator.race,
             lambda T: evaluator.best_set(T, 2), lambda T: plan.rank(poses=T),
             plan.add_poses]
    for call in calls:
        assert said(lambda: call(poses)) == ""
        assert words in said(lambda: call(wrong))
    assert said(lambda: evaluator.evaluate(poses[0])) == ""
    assert words in said(lambda: evaluator.evaluate(wrong[0]))
    # Half of them right: as the program, nothing.
    assert said(lambda: evaluator.evaluate(np.concatenate([poses, wrong]))) == ""
    # One that looks elsewhere is an answer; bad ones are no poses.
    away = poses.copy()
    away[:, 0, 3] += 9
    assert said(lambda: evaluator.evaluate(away[0])) == ""
    assert said(lambda: evaluator.evaluate(away)) == "100 % of the poses see no voxel of the map"
    assert said(lambda: evaluator.evaluate(np.full((20, 4, 4), np.nan))) == ""
    assert said(lambda: evaluator.evaluate(np.empty((0, 4, 4)))) == ""


def test_a_frame_at_an_inverse_pose(sensor, camera, poses):
    depth, amplitude = camera.acquire(poses[0], 0)
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    integrator = viewgain.FrameIntegrator(sensor)
    for add in planner(sensor).add, lambda d, T: integrator.integrate(grid, d, T):
        assert "world to camera" in said(lambda: add(depth, np.linalg.inv(poses[0])))
        millimetres = poses[0].copy()
        millimetres[:3, 3] *= 1000
        assert "the poses are in millimetres" in said(lambda: add(depth, millimetres))
        assert said(lambda: add(depth, poses[0])) == ""
        assert said(lambda: add(np.zeros_like(depth), poses[0])) == ""


def test_a_warning_can_be_an_error(sensor, camera, poses):
    plan = planner(sensor)
    depth, amplitude = camera.acquire(poses[0], 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="world to camera"):
            plan.add(depth, np.linalg.inv(poses[0]))
        plan.add(depth, poses[0])  # it works on


def test_settings_in_other_units(sensor, poses):
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    scene = viewgain.VoxelScene(grid)
    for more, words in [({"noise": viewgain.ConstantNoise(sigma_axial=2.0, sigma_lateral=0.005)}, "sigma_axial"),
                        ({"pose_sigma": (5.0, 0.5)}, "5 m"), ({"pose_sigma": (0, 0.3)}, "17.19 degrees"),
                        ({"body_size": (65.0, 65.0, 76.0)}, "65 x 65 x 76 m"),
                        ({"min_range": 100.0, "max_range": 3000.0, "working_distance": 400.0}, "100 to 3000 m")]:
        odd = make_sensor(**more)
        for make in (planner, viewgain.FrameIntegrator, viewgain.CloudIntegrator,
                     lambda s: viewgain.GainEvaluator(scene, s)):
            assert words in said(lambda: make(odd))
            assert said(lambda: make(sensor)) == ""
    far = viewgain.ReachRegion(boxes=[[[300, -500, 0], [900, 500, 800]]])
    for more, words in [({"boxes": [[[400, 0, 0], [500, 50, 50]]]}, "Is the obstacle in metres?"),
                        ({"meshes": [box_mesh([-3000] * 3, [3000] * 3)]}, "Is the obstacle in metres?"),
                        ({"support_plane": -300.0}, "support plane"), ({"object_size": 160.0}, "object size"),
                        ({"reach": far}, "reachable"), ({"clearance": 20.0}, "clearance"),
                        ({"body_size": [65, 65, 76]}, "body")]:
        assert words in said(lambda: planner(sensor, **more))
    assert said(lambda: planner(sensor, boxes=[[[-1, -1, -0.3], [1, 1, -0.2]]], support_plane=-0.1,
                                object_size=0.16, clearance=0.02)) == ""
    for name in viewgain.sensor_preset_names():
        for voxel in 0.002, 0.005, 0.01:
            assert said(lambda: planner(viewgain.sensor_preset(name), voxel_size=voxel)) == ""
