# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What one tries first: a calibration's matrix, labels of any integers, an object in another's place, pickles of regions."""
import copy
import pickle

import numpy as np
import pytest

import viewgain

WORKSPACE = [[-0.2] * 3, [0.2] * 3]
MATRIX = np.array([[525.0, 0, 319.5], [0, 520.0, 239.5], [0, 0, 1]])


def test_a_camera_comes_from_its_matrix():
    camera = viewgain.PinholeCamera.from_matrix(MATRIX, 640, 480)
    assert camera == viewgain.PinholeCamera(640, 480, fx=525.0, fy=520.0, cx=319.5, cy=239.5)
    assert camera.matrix.dtype == np.float64 and np.array_equal(camera.matrix, MATRIX)
    lens = [0.1, -0.2, 0.001, 0.002, 0.05]
    distorted = viewgain.PinholeCamera.from_matrix(MATRIX.tolist(), width=640, height=480, distortion=lens)
    assert distorted.distortion == lens and np.array_equal(distorted.matrix, MATRIX)
    assert viewgain.PinholeCamera.from_matrix(MATRIX.astype(np.float32), 640, 480) == camera
    point = np.array([0.2, -0.1, 0.8])
    assert np.allclose(camera.project(point), (MATRIX @ point)[:2] / point[2], rtol=1e-14)


@pytest.mark.parametrize("at, value, text", [
    ((0, 1), 0.3, r"K has skew: K\[0, 1\] is 0.3"), ((1, 0), 1e-6, "K has skew"), ((2, 2), 2.0, "the last row 0 0 1"),
    ((2, 0), 0.1, "last row"), ((2, 1), np.nan, "last row"), ((0, 1), np.nan, "skew"), ((0, 0), 0.0, "fx|focal"), ((1, 1), -520.0, "fy|focal"),
    ((0, 2), np.inf, "cx"), ((1, 2), np.nan, "cy")])
def test_a_matrix_that_is_none_is_refused(at, value, text):
    wrong = MATRIX.copy()
    wrong[at] = value
    with pytest.raises(ValueError, match=text):
        viewgain.PinholeCamera.from_matrix(wrong, 640, 480)


def test_labels_may_be_of_any_integers(labels):
    def grid_of(array):
        return viewgain.BeliefGrid.from_labels(array, voxel_size=0.01, prior_sigma=0.01)

    wanted = grid_of(labels)
    others = [labels.astype(dtype) for dtype in (np.int8, np.int16, np.int32, np.int64, np.uint16, np.uint64, ">i4")]
    others += [labels.tolist(), np.asfortranarray(labels), labels.astype(np.int64)[::1], np.flip(np.flip(labels.astype(int), 1), 1)]
    for other in others:
        assert grid_of(other) == wanted
    masked = np.ma.array(labels.astype(int), mask=labels == 2)
    assert np.array_equal(grid_of(masked).states(), np.where(labels == 2, 0, labels))


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.int32, np.int64, np.uint16])
def test_labels_that_are_no_states_are_named(labels, dtype):
    def refusal(*values):
        wrong = labels.astype(dtype)
        wrong.flat[:len(values)] = values
        with pytest.raises(ValueError) as raised:
            viewgain.BeliefGrid.from_labels(wrong, voxel_size=0.01, prior_sigma=0.01)
        return str(raised.value)

    assert refusal(7) == "labels contains 7; valid values: 0 (unknown), 1 (free), 2 (occupied)"
    assert refusal(100, 3, 100) == "labels contains 3, 100; valid values: 0 (unknown), 1 (free), 2 (occupied)"
    assert refusal(*range(3, 12)).startswith("labels contains 3, 4, 5, 6, 7 and 4 more; valid values: ")
    if np.issubdtype(dtype, np.signedinteger):
        assert refusal(-1) == "labels contains -1; valid values: 0 (unknown), 1 (free), 2 (occupied)"


def test_labels_that_are_no_integers_are_refused(labels):
    for wrong, text in [(labels == 2, r"numpy.where\(labels, 2, 1\) makes True occupied"), (labels.astype(float), "float64"),
                        (labels.astype(complex), "complex"), ([[[0, 1], [2]]], "whole numbers"), (labels[0], r"\(32, 32\)")]:
        with pytest.raises(ValueError, match=text):
            viewgain.BeliefGrid.from_labels(wrong, voxel_size=0.01, prior_sigma=0.01)


def test_an_object_in_anothers_place_is_named(grid, sensor, evaluator, poses):
    scene, depth = evaluator.scene, np.ones((144, 176))
    frames, clouds = viewgain.FrameIntegrator(sensor), viewgain.CloudIntegrator(sensor)
    make = viewgain.BeliefGrid.from_labels
    box = {"voxel_size": 0.02, "workspace": WORKSPACE}
    of_grid = "grid must be a BeliefGrid, not {}; make one from an array of states with BeliefGrid.from_labels"
    of_scene = r"scene must be a VoxelScene, not {}; make one from a BeliefGrid with VoxelScene\(grid\)"
    of_sensor = r"sensor must be a Sensor, not {}; get one with sensor_preset\(name\)"
    calls = [(lambda: viewgain.GainEvaluator(grid, sensor), of_scene, "BeliefGrid"),
             (lambda: viewgain.GainEvaluator(scene, "sr4000"), of_sensor, "str"),
             (lambda: viewgain.VoxelScene(np.zeros((4, 4, 4), np.uint8)), of_grid, "ndarray"),
             (lambda: viewgain.VoxelScene(None), of_grid, "NoneType"),
             (lambda: viewgain.FeasibilityChecker(scene, reach=poses), "reach must be a ReachRegion, not {}", "ndarray"),
             (lambda: frames.calibrate_hazard(grid, grid, depth, poses[0]), of_scene, "BeliefGrid"),
             (lambda: clouds.integrate(poses[0], np.ones((1, 3)), poses[0]), of_grid, "ndarray"),
             (lambda: viewgain.ViewPlanner("sr4000", **box), of_sensor, "str"),
             (lambda: make(np.zeros((2, 2, 2), int), voxel_size=0.1, sensor="sr4000"), of_sensor, "str"),
             (lambda: evaluator.evaluate(poses, control=print), r"control must be a BatchControl, not {}; make one from a function with BatchControl\(progress\)",
              "builtin_function_or_method"),
             (lambda: viewgain.Sensor(MATRIX, min_range=0.1, max_range=1, working_distance=0.5, noise=viewgain.ConstantNoise()),
              "camera must be a PinholeCamera, not {}; make one from an intrinsic matrix with PinholeCamera.from_matrix", "ndarray")]
    for call, text, given in calls:
        with pytest.raises(TypeError, match=text.format(given)):
            call()
    assert viewgain.BeliefGrid(**box, sensor=None, prior_sigma=0.01).prior_sigma == 0.01


@pytest.fixture(scope="module")
def region(poses):
    return viewgain.ReachRegion(boxes=[[[0, 0, 0], [1, 1, 1]], [[-1, -1, -1], [0, 0, 0.5]]], shells=[[0, 0, 0, 0.1, 1]],
                                half_spaces=[[0, 0, 1, 0.1]], poses=poses[:5], distance=0.03, angle=0.2)


def test_a_region_is_pickled(region, poses):
    for one in (region, viewgain.ReachRegion(), viewgain.ReachRegion(poses=poses[:3], distance=0.03, angle=0.2)):
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            again = pickle.loads(pickle.dumps(one, protocol))
            assert again == one and repr(again) == repr(one)
        assert np.array_equal(again.contains(poses), one.contains(poses))
        assert copy.copy(one) == one == copy.deepcopy(one)


def test_a_region_with_a_predicate_is_not_pickled():
    asked = viewgain.ReachRegion(predicate=lambda pose: True)
    for call in (pickle.dumps, copy.copy):
        with pytest.raises(TypeError, match="predicate cannot be pickled"):
            call(asked)
