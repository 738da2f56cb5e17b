# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import functools
import os
import pathlib

import numpy as np
import pytest
from conftest import box_mesh

import viewgain


def test_labels_come_back(labels, grid):
    assert np.array_equal(grid.states(), labels)
    assert grid.shape == labels.shape and grid.voxel_size == 0.01
    assert np.allclose(grid.T_world_grid[:3, 3], -0.16)
    statistics = grid.statistics()
    for state, name in enumerate(("unknown", "free", "occupied")):
        assert statistics[name] == np.count_nonzero(labels == state)
    turned = viewgain.BeliefGrid.from_labels(
        labels.transpose(2, 1, 0), voxel_size=0.3, origin=(0.1, 7, 2), prior_sigma=0.15)
    assert np.array_equal(turned.states(), labels.transpose(2, 1, 0))


def test_octomap_files(tmp_path, grid, sensor):
    path = tmp_path / "map.ot"
    grid.save(path)
    # A tree lies in the world's frame.
    workspace = np.array([[0, 0, 0], [0.32, 0.32, 0.32]]) + grid.T_world_grid[:3, 3]
    again = viewgain.BeliefGrid.load(path, workspace=workspace, prior_sigma=0.005)
    assert again.prior_sigma == 0.005 and again.voxel_size == 0.01
    assert np.array_equal(again.states(), grid.states())
    of_sensor = viewgain.BeliefGrid.load(str(path), sensor=sensor)
    assert of_sensor.prior_sigma == grid.prior_sigma
    assert np.count_nonzero(of_sensor.states() == 2) == np.count_nonzero(grid.states() == 2)
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(viewgain.Error, match="map.ot"):
        viewgain.BeliefGrid.load(path, sensor=sensor)
    with pytest.raises(FileNotFoundError):
        viewgain.BeliefGrid.load(tmp_path / "none.ot")
    with pytest.raises(ValueError, match=r"\(2,\)"):
        viewgain.BeliefGrid.load(path, workspace=[0, 1])


def test_files(tmp_path, grid):
    path = tmp_path / "map.vdb"
    grid.save(path)
    again = viewgain.BeliefGrid.load(str(path))
    assert again.content_hash() == grid.content_hash() == grid.clone().content_hash()
    with pytest.raises(FileNotFoundError) as missing:
        viewgain.BeliefGrid.load(tmp_path / "none.vdb")
    assert missing.value.filename == str(tmp_path / "none.vdb")
    with pytest.raises(IsADirectoryError):
        viewgain.BeliefGrid.load(tmp_path)
    with pytest.raises(FileNotFoundError):
        grid.save(tmp_path / "no" / "map.vdb")
    with pytest.raises(IsADirectoryError) as folder:
        grid.save(tmp_path)
    assert folder.value.filename == str(tmp_path)
    with pytest.raises(NotADirectoryError):
        grid.save(path / "map.ot")
    with pytest.raises(TypeError):
        viewgain.BeliefGrid.load(3)
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(viewgain.Error, match="map.vdb"):
        viewgain.BeliefGrid.load(path)
    path.write_text("nothing of the kind")
    with pytest.raises(viewgain.Error, match="map.vdb"):
        viewgain.BeliefGrid.load(path)
    assert issubclass(viewgain.Error, RuntimeError)


def test_names_of_files_are_bytes(tmp_path, grid):
    folder = os.fsencode(tmp_path)
    name = folder + b"/m\xff.vdb"
    grid.save(name)
    assert os.listdir(folder) == [b"m\xff.vdb"]
    for same in (name, os.fsdecode(name), pathlib.Path(os.fsdecode(name))):
        assert viewgain.BeliefGrid.load(same).content_hash() == grid.content_hash()
    with open(name, "wb") as file:
        file.write(b"no map" * 100)
    with pytest.raises(viewgain.Error, match="m\udcff.vdb"):
        viewgain.BeliefGrid.load(name)
    with pytest.raises(FileNotFoundError) as missing:
        viewgain.BeliefGrid.load(f"{tmp_path}/\udcfe.vdb")
    assert missing.value.filename == f"{tmp_path}/\udcfe.vdb"
    grid.save(tmp_path / "a.vdb")
    for call in (viewgain.BeliefGrid.load, grid.save):
        with pytest.raises(ValueError, match="null"):
            call(f"{tmp_path}/a\0b.vdb")
    assert sorted(os.listdir(folder)) == [b"a.vdb", b"m\xff.vdb"]


def test_limits_are_looked_at_before_labels_are_copied():
    # 256 TiB if it were.
    labels = np.broadcast_to(np.uint8(0), (65536, 65536, 65536))
    with pytest.raises(viewgain.Error, match="voxels"):
        viewgain.BeliefGrid.from_labels(labels, voxel_size=0.01, prior_sigma=0.01)


def test_wrong_labels_and_layouts_are_named(labels):
    make = functools.partial(viewgain.BeliefGrid.from_labels, prior_sigma=0.1)
    with pytest.raises(ValueError):
        make(np.zeros((0, 2, 2), np.uint8), voxel_size=0.01)
    for settings, text in [({"voxel_size": 0.0}, "voxel"), ({"voxel_size": np.nan}, "voxel"),
                           ({"voxel_size": 0.1, "origin": (0, 0)}, r"\(2,\)"),
                           ({"voxel_size": 0.1, "origin": (0, np.nan, 0)}, "origin"),
                           ({"voxel_size": 0.1, "prior_sigma": -1.0}, "prior"),
                           ({"voxel_size": 0.1, "T_world_grid": np.zeros((4, 4))}, "T_world_grid")]:
        with pytest.raises(ValueError, match=text):
            make(labels, **settings)
    with pytest.raises(ValueError, match=r"\(3,\)"):
        viewgain.BeliefGrid(voxel_size=0.1, workspace=[0, 1, 2])
    with pytest.raises(viewgain.Error):
        viewgain.BeliefGrid(voxel_size=1e-4, workspace=[[0, 0, 0], [9, 9, 9]], prior_sigma=0.1)


def test_frames_make_a_map(sensor):
    vertices, triangles = box_mesh([-0.1] * 3, [0.1] * 3)
    camera = viewgain.SimulatedSensor(vertices, triangles, sensor, background_radius=1.5)
    grid = viewgain.BeliefGrid(
        voxel_size=0.01, workspace=[[-0.2] * 3, [0.2] * 3], sensor=sensor)
    assert grid.statistics()["unknown"] == 40**3 and grid.views().shape == (0, 4, 4)
    integrator = viewgain.FrameIntegrator(sensor)
    poses = viewgain.orbit_poses(4, 0.6, 0.4)
    for pose in poses:
        depth, amplitude = camera.acquire(pose)
        assert depth.shape == amplitude.shape == (144, 176) and depth.dtype == np.float32
        report = integrator.integrate(grid, depth, pose, amplitude=amplitude)
        assert report["readings_inside"] > 1000 and report["voxels_hit"] > 100
    assert np.allclose(grid.views(), poses)
    points = grid.points()
    assert len(points) > 300
    assert not np.array_equal(grid.points(scale_sigma=0.01)["covariance"], points["covariance"])
    twins = [grid.clone() for _ in range(2)]
    for twin, keywords in zip(twins, ({}, {"pose_sigma": (0.004, 0.01)})):
        integrator.integrate(twin, depth, poses[-1], amplitude=amplitude, **keywords)
    assert twins[0].content_hash() != twins[1].content_hash()
    beliefs = grid.beliefs()
    occupied = grid.states() == 2
    hit = np.zeros_like(occupied)
    hit[tuple((beliefs["voxel"] - grid.min_index).T)] = True
    assert np.all(hit[occupied]) and beliefs["hits"].min() >= 1 and grid.occupied()["hits"].min() >= 1
    bounds = viewgain.reading_bounds(sensor, depth, poses[-1])
    assert bounds.shape == (2, 3) and np.all(bounds[0] < bounds[1])
    assert viewgain.reading_bounds(sensor, np.zeros((144, 176)), poses[0]) is None

    before = grid.content_hash()
    with pytest.raises(ValueError, match=r"\(144, 176\), not \(176, 144\)"):
        integrator.integrate(grid, depth.T, poses[0])
    with pytest.raises(ValueError, match="amplitude"):
        integrator.integrate(grid, depth, poses[0], amplitude=amplitude[1:])
    with pytest.raises(ValueError, match="orthonormal"):
        integrator.integrate(grid, depth, 2 * poses[0] - np.diag([0, 0, 0, 1]))
    with pytest.raises(ValueError, match="pose_sigma must be at least 0 and finite, not -1"):
        integrator.integrate(grid, depth, poses[0], pose_sigma=(0, -1))
    with pytest.raises(ValueError, match="carve"):
        viewgain.FrameIntegrator(sensor, carve="rays")
    with pytest.raises(ValueError, match="occupancy"):
        viewgain.FrameIntegrator(sensor, occupancy="yes")
    assert grid.content_hash() == before
    # What is no depth says nothing.
    nothing = integrator.integrate(grid, np.full((144, 176), np.nan), poses[0])
    assert nothing["invalid"] == 144 * 176 and nothing["voxels_crossed"] == 0


def test_voxels_and_points(labels, sensor):
    grid = viewgain.BeliefGrid(voxel_size=0.03, workspace=[[-0.2, 0.1, 0.3], [0.4, 0.5, 0.9]], sensor=sensor,
                               T_world_grid=viewgain.look_at([0.3, 0.1, 0.7], [0, 0, 0]))
    low = np.array(grid.min_index)
    voxels = np.stack(np.meshgrid(*map(np.arange, grid.shape), indexing="ij"), axis=-1) + low
    centers = grid.center(voxels)
    assert centers.shape == (*grid.shape, 3) and centers.dtype == np.float64
    T = grid.T_world_grid
    assert np.allclose(centers, (voxels + 0.5) * 0.03 @ T[:3, :3].T + T[:3, 3], atol=1e-12)
    index = grid.index_of(centers)
    assert index.dtype == np.int32 and np.array_equal(index, voxels)
    index = grid.index_of(np.array([centers[0, 0, 0], [np.nan, 0, 0], [9, 9, 9]]))
    assert np.array_equal(index, [voxels[0, 0, 0], [-(2**31)] * 3, [-(2**31)] * 3])
    index = index[1:].reshape(1, 2, 3)
    with pytest.raises(IndexError):
        grid.states()[tuple(index[0, 0] - low)]
    # A grid whose lattice begins at 0: indices are those of arrays.
    of_labels = viewgain.BeliefGrid.from_labels(labels, voxel_size=0.01, sensor=sensor)
    at = of_labels.index_of([[0.085, 0.155, 0.231], [0.001, 0.319, 0.001]])
    assert np.array_equal(of_labels.states()[tuple(at.T)], [labels[8, 15, 23], labels[0, 31, 0]])
    assert grid.index_of([]).shape == grid.center([]).shape == (0, 3)
    for wrong, text in [([1, 2], r"\(\.\.\., 3\), not \(2,\)"), ([0, 0, 0.5], "contains 0.5"),
                        ([0, 0, 2.0**31], "contains 2.1474"), (index[0, 0], "contains -2.1474"), ("x", "real numbers")]:
        with pytest.raises(ValueError, match=text):
            grid.center(wrong)
    with pytest.raises(ValueError, match=r"points.*\(2,\)"):
        grid.index_of([1, 2])


def test_voxels_are_set_and_listed(sensor):
    def empty():
        return viewgain.BeliefGrid(voxel_size=0.02, workspace=[[-0.3, -0.2, 0.1], [0.3, 0.2, 0.6]], sensor=sensor)

    rng = np.random.default_rng(11)
    many, one_by_one = empty(), empty()
    low = np.array(many.min_index)
    voxels = rng.integers(low, low + many.shape, (3, 400, 3))
    log_odds = rng.uniform(-2.5, 4, (3, 400))
    many.set(voxels, log_odds)
    for voxel, value in zip(voxels.reshape(-1, 3), log_odds.ravel()):
        one_by_one.set(voxel, value)
    assert many.content_hash() == one_by_one.content_hash() != empty().content_hash()
    rows = many.occupied()
    states = many.states()
    assert len(rows) == np.count_nonzero(states == 2) > 300
    assert np.all(states[tuple((rows["voxel"] - low).T)] == 2) and len(np.unique(rows["voxel"], axis=0)) == len(rows)
    before = many.content_hash()
    many.set([], [])
    outside = low - 1
    for wrong, value, text in [([low, outside], 1.0, "workspace"), ([low, low], [1.0, np.nan], "NaN"),
                               ([low, low], [1.0], r"\(1,\).*\(2, 3\)"), ([low], [[1.0]], r"\(1, 1\)"),
                               (low + 0.5, 1.0, "whole number"), (low[:2], 1.0, r"\(2,\)")]:
        with pytest.raises(ValueError, match=text):
            many.set(wrong, value)
    assert many.content_hash() == before


def test_a_box_follows_another_map(sensor):
    grid = viewgain.BeliefGrid(voxel_size=0.02, workspace=[[-0.3, -0.2, 0.1], [0.3, 0.2, 0.6]], sensor=sensor)
    expected = grid.states()
    labels = np.arange(60).reshape(3, 4, 5) % 3
    expected[2:5, 3:7, 4:9] = labels
    assert grid.update_box(grid.min_index + np.array([2, 3, 4]), labels) == 40
    assert np.array_equal(grid.states(), expected)
    with pytest.raises(ValueError, match="labels contains 3"):
        grid.update_box(grid.min_index, np.full((2, 2, 2), 3))
    with pytest.raises(ValueError, match="workspace"):
        grid.update_box(grid.min_index, np.zeros((99, 2, 2), np.uint8))
    assert np.array_equal(grid.states(), expected)


def test_a_region_is_forgotten(sensor):
    grid = viewgain.BeliefGrid(voxel_size=0.02, workspace=[[-0.3, -0.2, 0.1], [0.3, 0.2, 0.6]], sensor=sensor)
    voxels = np.stack(np.meshgrid(*map(np.arange, grid.shape), indexing="ij"), -1) + grid.min_index
    grid.set(voxels, np.where(voxels[..., 0] % 2 == 0, 1.0, -1.0))
    assert grid.forget([[-0.1, -0.06, 0.2], [0.14, 0.1, 0.44]]) == 12 * 8 * 12 == np.count_nonzero(grid.states() == 0)
    with pytest.raises(ValueError, match=r"region.*\(3,\)"):
        grid.forget([0, 0, 0])


def test_leaves_have_scales(sensor):
    box = [[-0.32, -0.32, -0.32], [0.32, 0.32, 0.32]]
    depth = np.full((sensor.camera.height, sensor.camera.width), 0.5)
    pose = np.eye(4)
    pose[2, 3] = -0.5
    for coarsest, fine, finest in [(0, None, 0), (3, None, 0), (3, [box], 3), (3, None, 3)]:
        grid = viewgain.BeliefGrid(voxel_size=0.001, workspace=box, sensor=sensor)
        integrator = viewgain.FrameIntegrator(sensor, coarsest=coarsest, fine=fine, finest=finest)
        integrator.integrate(grid, depth, pose)
        voxels = grid.occupied()["voxel"]
        scales = grid.scale(voxels)
        assert scales.dtype == np.uint8 and scales.shape == voxels.shape[:1]
        assert np.count_nonzero(scales) > 100 if coarsest and not fine else np.all(scales == 0)
        assert np.all(scales == 3) == (finest > 0 and not fine)
    assert grid.resample(np.array(box) * np.inf, 2) > 0 and np.all(grid.scale(grid.occupied()["voxel"]) == 2)
    with pytest.raises(ValueError, match=r"the scale must be in 0\.\.3, not 4"):
        grid.resample(box, 4)
    with pytest.raises(ValueError, match=r"the coarsest scale must be in 0\.\.3, not 5"):
        viewgain.CloudIntegrator(sensor, coarsest=5)
    with pytest.raises(ValueError, match="the finest scale must be between 0 and the coarsest scale, 1, not 2"):
        viewgain.FrameIntegrator(sensor, coarsest=1, finest=2)
    with pytest.raises(ValueError, match="fine"):
        viewgain.FrameIntegrator(sensor, fine=[[0, 1]])


def test_obstacles_block(grid, sensor, poses):
    plain = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, pixel_stride=4)
    wall = np.array([[[0.3, -1, -1], [0.4, 1, 1]]])
    behind = poses[:, 0, 3] > 0.5
    for scene in (viewgain.VoxelScene(grid, boxes=wall),
                  viewgain.VoxelScene(grid, meshes=[box_mesh(*wall[0])])):
        gains = viewgain.GainEvaluator(scene, sensor, pixel_stride=4).evaluate(poses)
        assert np.all(gains[behind] == 0) and np.count_nonzero(behind) > 2
        free = poses[:, 0, 3] < 0
        assert np.array_equal(gains[free], plain.evaluate(poses)[free])
    vertices, triangles = box_mesh(*wall[0])
    for boxes, meshes, text in [(wall[0], (), r"\(2, 3\)"), (wall[:, ::-1], (), "inside out|box"),
                                (None, [vertices], "pair"),
                                (None, [(vertices, triangles + 1)], "contains 8"),
                                (None, [(vertices, triangles - 0.5)], "index"),
                                (None, [(vertices * np.nan, triangles)], "finite")]:
        with pytest.raises(ValueError, match=text):
            viewgain.VoxelScene(grid, boxes=boxes, meshes=meshes)


def test_reach_and_collisions(grid, sensor):
    scene = viewgain.VoxelScene(grid)
    poses = viewgain.look_at([[0.6, 0, 0], [-0.6, 0, 0], [0.075, 0, 0], [0, 0, 0.6]], (0, 0, 0.01))
    checker = viewgain.FeasibilityChecker(scene)
    assert np.array_equal(checker.feasible(poses), [True, True, False, True])
    assert checker.feasible(poses[0]) == True  # noqa: E712: numpy's
    names = np.array(viewgain.INFEASIBILITY_NAMES)
    assert names[checker.reasons(poses)].tolist() == ["none", "none", "collision", "none"]
    bad = poses.copy()
    bad[0, 0, 0] = np.nan
    assert names[checker.reasons(bad.reshape(2, 2, 4, 4), taken=poses[1:2])].tolist() == [
        ["bad_pose", "taken"], ["collision", "none"]]

    asked = []

    def predicate(T_world_camera):
        asked.append(T_world_camera)
        return T_world_camera[0, 3] > 0

    reach = viewgain.ReachRegion(
        boxes=[[[-1, -1, -1], [1, 1, 0.5]]], shells=[[0, 0, 0, 0.05, 2]],
        half_spaces=[[0, 0, 1, -0.5]], predicate=predicate)
    assert np.array_equal(reach.contains(poses), [True, False, True, False])
    assert len(asked) == 3 and asked[0].shape == (4, 4)
    checker = viewgain.FeasibilityChecker(scene, reach=reach, sensor=sensor)
    assert names[checker.reasons(poses)].tolist() == [
        "none", "unreachable", "collision", "unreachable"]
    assert "predicate" in repr(reach) and "primitives" in repr(checker)
    assert np.array_equal(checker.with_scene(viewgain.VoxelScene(grid)).reasons(poses), checker.reasons(poses))
    table = checker.with_scene(viewgain.VoxelScene(grid, support_plane=0.1))
    assert names[table.reasons(poses)].tolist() == ["plane", "unreachable", "plane", "unreachable"]

    def broken(T_world_camera):
        raise KeyError("robot")

    broken_reach = viewgain.ReachRegion(predicate=broken)
    with pytest.raises(KeyError, match="robot"):
        viewgain.FeasibilityChecker(scene, reach=broken_reach).feasible(poses)
    with pytest.raises(KeyError, match="robot"):
        broken_reach.contains(poses)
    assert viewgain.ReachRegion(poses=poses).contains(poses).all()
    for settings, text in [({"boxes": [[0, 1]]}, r"\(1, 2\)"), ({"shells": [[0, 0, 0, 2, 1]]}, "shell"),
                           ({"half_spaces": [[0, 0, 0, 1]]}, "normal"), ({"poses": poses[0]}, r"\(4, 4\)")]:
        with pytest.raises(ValueError, match=text):
            viewgain.ReachRegion(**settings)
    with pytest.raises(TypeError):
        viewgain.ReachRegion(predicate=3)
    with pytest.raises(ValueError, match="body"):
        viewgain.FeasibilityChecker(scene, body_size=(0, 0, 0))


def test_the_housing_is_the_sensors_unless_told_otherwise(grid, sensor):
    scene = viewgain.VoxelScene(grid)
    large = viewgain.Sensor(camera=sensor.camera, min_range=sensor.min_range, max_range=sensor.max_range,
                            working_distance=sensor.working_distance, noise=sensor.noise, body_size=(0.5, 0.5, 0.9))
    poses = viewgain.sphere_poses(60, 0.4) @ np.diag([-1.0, 1, -1, 1])  # looking away: the housing is before the object
    of_sensor = viewgain.FeasibilityChecker(scene, sensor=large).reasons(poses)
    told = viewgain.FeasibilityChecker(scene, sensor=large, body_size=(0.5, 0.5, 0.9)).reasons(poses)
    small = viewgain.FeasibilityChecker(scene, sensor=large, body_size=(0.01, 0.01, 0.01)).reasons(poses)
    assert (of_sensor == told).all()
    assert (told == viewgain.Infeasibility.COLLISION).any() and not (small == viewgain.Infeasibility.COLLISION).any()
