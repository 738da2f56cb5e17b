# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""ViewScorer against the parts that it is made of, and what it refuses."""
import copy
import pickle
import threading

import numpy as np
import pytest
from conftest import box_mesh

import viewgain

WORKSPACE = [(-0.12, -0.12, 0.0), (0.12, 0.12, 0.12)]
SETTINGS = {"voxel_size": 0.01, "workspace": WORKSPACE, "support_plane": 0.0}
POSES = viewgain.dome_poses(60, 0.5, center=(0, 0, 0.05))
POSES = POSES[POSES[:, 2, 3] > 0.25]


@pytest.fixture(scope="module")
def sensor():
    camera = viewgain.PinholeCamera(64, 48, fx=80, fy=80, cx=31.5, cy=23.5)
    return viewgain.Sensor(camera, noise=viewgain.ConstantNoise(), min_range=0.1, max_range=3, working_distance=0.4)


def frame(sensor, pose, seed=0):
    """Depth and amplitude of a box of 8 cm on the table, seen from there."""
    vertices, triangles = box_mesh([-0.04, -0.04, 0.0], [0.04, 0.04, 0.08])
    return viewgain.SimulatedSensor(vertices, triangles, sensor).acquire(pose, seed)


@pytest.mark.parametrize("gain", ["paper", "surface", "combined"])
def test_gains_after_frames_are_those_of_the_parts(sensor, gain):
    scorer = viewgain.ViewScorer(sensor, gain=gain, jump_edges=False, **SETTINGS)
    planner = viewgain.ViewPlanner(sensor, gain=gain, jump_edges=False, **SETTINGS)
    for i in range(3):
        depth, amplitude = frame(sensor, POSES[7 * i], i)
        update = scorer.add(depth, POSES[7 * i], amplitude=amplitude)
        added = planner.add(depth, POSES[7 * i], amplitude=amplitude)
        assert update.verdict == "used" and update.readings_inside == added.readings_inside > 100
        assert np.isnan(update.new_area) == (gain == "paper")
        assert update.new_area == added.new_area or gain == "paper"
        # What the map has learnt of the hazard is in its hash.
        assert scorer.grid.content_hash() == planner.grid.content_hash()
    gains = scorer.evaluate(POSES)
    scene = viewgain.VoxelScene(planner.grid, support_plane=0.0)
    by_parts = viewgain.GainEvaluator(scene, sensor, gain=gain).evaluate(POSES)
    assert gains.shape == (len(POSES),) and np.array_equal(gains, by_parts) and gains.max() > 0
    assert np.array_equal(scorer.evaluator.evaluate(POSES), by_parts)
    best = scorer.best(POSES, 3)
    assert isinstance(best, viewgain.BestViews) and len(best.indices) == 3 and best.complete
    assert np.array_equal(best.indices, scorer.evaluator.race(POSES, 3).indices)
    assert np.array_equal(best.gains["gain"], gains[best.indices])
    assert scorer.consistency().suspicion is None


def test_labels_are_counted_as_surface_alone(sensor):
    settings = {"voxel_size": 0.01, "workspace": WORKSPACE, "object_size": 0.1}
    combined = viewgain.ViewScorer(sensor, **settings)
    surface = viewgain.ViewScorer(sensor, gain="surface", **settings)
    labels = np.ones((24, 12, 12), np.uint8)
    labels[8:16, 8:, :8] = 2
    for scorer in (combined, surface):
        assert scorer.set((-12, -12, 0), labels) == labels.size
        assert scorer.set((-12, -12, 0), labels) == 0
    nats, areas = combined.evaluate(POSES), surface.evaluate(POSES)
    assert (areas > 0).sum() > 10
    ratio = nats[areas > 0] / areas[areas > 0]
    assert np.allclose(ratio, ratio[0], rtol=1e-12)
    assert combined.forget([(-1, -1, -1), (1, 1, 1)]) == labels.size
    assert combined.grid.content_hash() == viewgain.ViewScorer(sensor, **settings).grid.content_hash()


def test_a_measure_and_costs(sensor):
    scorer = viewgain.ViewScorer(sensor, **SETTINGS)
    depth = frame(sensor, POSES[0])[0]
    scorer.add(depth, POSES[0])
    measured = scorer.evaluate(POSES[:5], measure=lambda pose, hits: float(len(hits)))
    assert np.array_equal(measured, scorer.evaluator.evaluate_own(POSES[:5], lambda pose, hits: float(len(hits))))
    gains = scorer.evaluate(POSES)
    costs = np.zeros(len(POSES))
    costs[gains.argmax()] = 1e9
    assert scorer.best(POSES, costs=costs).indices[0] != gains.argmax()
    late = scorer.best(POSES, 2, deadline=0)
    assert len(late.indices) <= 2 and not late.complete
    priced = scorer.best(POSES, 3, costs=np.full(len(POSES), 2.0))
    assert np.array_equal(priced.worth, priced.gains["gain"] - 2)


def test_possible_poses_alone_with_a_body(sensor):
    inside = viewgain.look_at((0, 0, 0.06), (0, 0, 0))
    poses = np.concatenate([POSES, inside[None]])
    with_body = viewgain.ViewScorer(sensor, body_size=(0.065, 0.065, 0.076), **SETTINGS)
    without = viewgain.ViewScorer(sensor, **SETTINGS)
    assert len(with_body.best(poses, len(poses)).indices) < len(without.best(poses, len(poses)).indices)
    assert len(poses) - 1 not in with_body.best(poses, len(poses)).indices


def test_files_come_back(sensor, tmp_path):
    scorer = viewgain.ViewScorer(sensor, **SETTINGS)
    depth = frame(sensor, POSES[0])[0]
    scorer.add(depth, POSES[0])
    scorer.save(tmp_path / "map.vdb")
    again = viewgain.ViewScorer.load(tmp_path / "map.vdb", sensor, support_plane=SETTINGS["support_plane"])
    assert np.array_equal(again.evaluate(POSES), scorer.evaluate(POSES))
    scorer.grid.save(tmp_path / "map.ot")
    octree = viewgain.ViewScorer(sensor, map=tmp_path / "map.ot", prior_sigma=0.003)
    assert octree.evaluate(POSES).shape == (len(POSES),) and octree.grid.prior_sigma == 0.003
    with pytest.raises(FileNotFoundError, match="none.vdb"):
        viewgain.ViewScorer(sensor, map="none.vdb")
    of_grid = viewgain.ViewScorer(sensor, map=scorer.grid, support_plane=SETTINGS["support_plane"])
    assert np.array_equal(of_grid.evaluate(POSES), scorer.evaluate(POSES))
    # What the map has is not said twice.
    for said in ({"voxel_size": 0.01}, {"workspace": WORKSPACE}, {"T_world_grid": np.eye(4)}, {"prior_sigma": 0.01}):
        with pytest.raises(ValueError, match="cannot be used with map"):
            viewgain.ViewScorer(sensor, map=tmp_path / "map.vdb", **said)


@pytest.mark.parametrize("again", [copy.deepcopy, *(lambda one, p=p: pickle.loads(pickle.dumps(one, p)) for p in (0, 2, 5))])
def test_pickles_have_settings_and_map(sensor, again):
    corner = ([(0, 0, 0), (0.05, 0.05, 0.05)], 3.0)
    scorer = viewgain.ViewScorer(sensor, boxes=[[(0.05, 0.05, 0), (0.1, 0.1, 0.1)]], gain="combined", weights=iter([corner]),
                                 refinement_weight=0.5, body_size=(0.05, 0.05, 0.05), jump_edges=False, num_threads=1, **SETTINGS)
    for i in range(2):
        scorer.add(frame(sensor, POSES[5 * i], i)[0], POSES[5 * i])
    copied = again(scorer)
    assert np.array_equal(copied.evaluate(POSES), scorer.evaluate(POSES)) and scorer.evaluate(POSES).max() > 0
    assert copied.best(POSES, 4).indices.tolist() == scorer.best(POSES, 4).indices.tolist()
    depth = frame(sensor, POSES[12], 7)[0]
    assert copied.add(depth, POSES[12]) == scorer.add(depth, POSES[12])
    assert copied.grid.content_hash() == scorer.grid.content_hash()
    assert copied.evaluator.num_threads == 1


def test_refuses(sensor):
    scorer = viewgain.ViewScorer(sensor, **SETTINGS)
    depth = frame(sensor, POSES[0])[0]
    with pytest.raises(ValueError, match="pose_sigma must be at least 0 and finite, not -1"):
        scorer.add(depth, POSES[0], pose_sigma=(-1, 0))
    with pytest.raises(ValueError, match="T_world_camera"):
        scorer.add(depth, np.zeros((4, 4)))
    bad = POSES[:2].copy()
    bad[1, 0, 0] = 7
    assert np.isnan(scorer.evaluate(bad)).tolist() == [False, True]
    with pytest.raises(ValueError, match=r"\[1\]"):
        scorer.evaluate(bad, strict=True)
    with pytest.raises(ValueError, match="workspace"):
        scorer.set((500, 0, 0), np.ones((2, 2, 2), np.uint8))
    with pytest.raises(ValueError, match="3"):
        scorer.set((0, 0, 0), np.full((2, 2, 2), 3, np.uint8))
    with pytest.raises(ValueError, match="cost"):
        scorer.best(POSES, costs=[1.0])
    with pytest.raises(ValueError, match="trace"):
        viewgain.ViewScorer(sensor, criterion="trace", **SETTINGS)
    assert scorer.grid.content_hash() == viewgain.ViewScorer(sensor, **SETTINGS).grid.content_hash()
    assert repr(scorer).startswith("<ViewScorer of")


def test_gains_while_frames_come(sensor):
    scorer = viewgain.ViewScorer(sensor, num_threads=1, **SETTINGS)
    frames = [frame(sensor, POSES[i], i)[0] for i in range(6)]
    known, done = [], threading.Event()
    reference = viewgain.ViewScorer(sensor, num_threads=1, **SETTINGS)
    expected = [reference.evaluate(POSES[:8]).tobytes()]
    for depth, pose in zip(frames, POSES):
        reference.add(depth, pose)
        expected.append(reference.evaluate(POSES[:8]).tobytes())

    def score():
        while not done.is_set() or not known:
            known.append(scorer.evaluate(POSES[:8]).tobytes())

    thread = threading.Thread(target=score)
    thread.start()
    for depth, pose in zip(frames, POSES):
        scorer.add(depth, pose)
    done.set()
    thread.join()
    order = [expected.index(answer) for answer in known]
    assert order == sorted(order) and len(order) >= 1
    assert scorer.evaluate(POSES[:8]).tobytes() == expected[-1]
