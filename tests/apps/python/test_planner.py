# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The planner step by step against the parts that it is made of, and what it refuses."""
import gc
import threading

import numpy as np
import pytest
from conftest import box_mesh

import viewgain

WORKSPACE = [[-0.15, -0.12, -0.01], [0.15, 0.12, 0.12]]
BLOCK = [[-0.06, -0.04, 0.0], [0.05, 0.05, 0.06]]
WALL = [[0.11, -0.1, 0.0], [0.13, 0.1, 0.1]]


@pytest.fixture(scope="module")
def sensor():
    camera = viewgain.PinholeCamera(64, 48, fx=80, fy=80, cx=31.5, cy=23.5)
    return viewgain.Sensor(camera, noise=viewgain.ConstantNoise(), min_range=0.1,
                           max_range=3, working_distance=0.4)


@pytest.fixture(scope="module")
def camera(sensor):
    (block, faces), (wall, same) = box_mesh(*BLOCK), box_mesh(*WALL)
    return viewgain.SimulatedSensor(np.concatenate([block, wall]), np.concatenate([faces, same + len(block)]), sensor)


@pytest.fixture(scope="module")
def poses():
    dome = viewgain.dome_poses(40, 0.45, center=[0, 0, 0.05])
    return dome[dome[:, 2, 3] > 0.25]


def make(sensor, **settings):
    return viewgain.ViewPlanner(sensor, **{**dict(voxel_size=0.006, workspace=WORKSPACE, boxes=[WALL],
                                                  jump_edges=False, num_threads=1), **settings})


def step(planner, camera, pose, frame=0):
    depth, amplitude = camera.acquire(pose, frame)
    told = [planner.add(depth, pose, amplitude=amplitude), planner.propose()["dropped"], planner.rank(3), planner.should_stop()]
    told[0] = told[0]._replace(view=0)
    return repr(told)


def test_frames_are_held_against_one_another(sensor, camera, poses):
    off = np.eye(4)
    off[:3, 3] = [0.0, 0.03, 0.0]  # of every second frame
    for wrong in (False, True):
        planner, scorer = make(sensor), viewgain.ViewScorer(sensor, voxel_size=0.006, workspace=WORKSPACE)
        for frame, pose in enumerate(poses):
            depth = camera.acquire(pose, frame)[0]
            at = off @ pose if wrong and frame % 2 else pose
            planner.add(depth, at)
            scorer.add(depth, at)
        for found in (planner.consistency(), scorer.consistency()):
            assert len(found.in_free) == len(found.seen_past) == len(poses)
            assert (found.suspicion is not None) == wrong, found
            assert bool(found.contradicting) == wrong
            assert (found.share_seen_past > 0.05) == wrong
            assert len(found.displacements) == len(poses) and np.isnan(found.displacements[0])
            assert found.expected > 0 and np.isclose(found.displacement, np.nanquantile(found.displacements, 0.5, method="higher"))


def test_registers_a_frame_against_its_map(sensor, camera, poses):
    planner = make(sensor)
    reported = poses[3].copy()
    reported[:3, 3] += [0.004, -0.003, 0.003]
    depth, amplitude = camera.acquire(poses[3], 100)
    first = planner.register_frame(depth, reported, amplitude=amplitude)
    assert first.status == "too_little_overlap" and first.reason == "the map has no surface yet"
    assert np.allclose(first.T_world_camera, reported, atol=1e-12)
    for frame, pose in enumerate(poses):
        planner.add(*camera.acquire(pose, frame)[:1], pose)
    before = planner.grid.content_hash()
    found = planner.register_frame(depth, reported, amplitude=amplitude)
    assert found.status == "registered" and found.reason == "" and found.overlap > 0.5
    assert found.covariance.shape == (6, 6) and np.all(np.linalg.eigvalsh(found.covariance) > 0)
    assert np.isclose(found.translation, np.linalg.norm(found.T_world_camera[:3, 3] - reported[:3, 3]))
    assert planner.grid.content_hash() == before
    variances = np.diag(found.covariance)
    assert np.allclose(found.pose_sigma, np.sqrt([variances[:3].mean(), variances[3:].mean()]))
    assert first.pose_sigma == (0, 0)  # of an empty map's first frame
    with pytest.raises(ValueError, match="pose_sigma must be at least 0 and finite, not -1"):
        planner.add(depth, reported, amplitude=amplitude, pose_sigma=(-1, 0))
    with pytest.raises(ValueError, match="sigma_rotation"):
        planner.register_frame(depth, reported, sigma_rotation=0)


@pytest.mark.parametrize("gain", ["paper", "surface", "combined"])
def test_says_what_the_parts_say(gain, sensor, camera, poses):
    planner = make(sensor, gain=gain)
    planner.add_poses(poses, name="dome")
    depth, amplitude = camera.acquire(poses[3], 0)
    added = planner.add(depth, poses[3], amplitude=amplitude)
    assert added["view"] == 0 and np.isnan(added["new_area"]) == (gain == "paper")
    proposal = planner.propose()
    assert set(proposal["generator"]) == {"dome"} and proposal["dropped"]["taken"] >= 1
    scene = viewgain.VoxelScene(planner.grid, boxes=[WALL])
    gains = viewgain.GainEvaluator(scene, sensor, gain=gain).evaluate(proposal["T_world_camera"])
    best = planner.rank(4, exact=True)
    order = np.argsort(-gains, kind="stable")[:4]
    assert best["indices"].tolist() == order.tolist() and best["complete"]
    assert np.array_equal(best["gain"], gains[order])
    assert np.array_equal(best["T_world_camera"], proposal["T_world_camera"][order])
    paid = planner.rank(2, costs=np.linspace(0, 5, len(gains)), exact=True)
    assert np.allclose(paid["worth"], paid["gain"] - np.linspace(0, 5, len(gains))[paid["indices"]])
    own = planner.rank(2, measure=lambda pose, hits: -float(pose[2, 3]), exact=True)
    lowest = np.argsort(proposal["T_world_camera"][:, 2, 3], kind="stable")[:2]
    assert own.indices.tolist() == lowest.tolist() and np.isnan(own.gain).all()
    assert np.allclose(own.worth, -proposal["T_world_camera"][lowest, 2, 3])
    assert set(planner.seconds) == {"integrate", "snapshot", "candidates", "score"}


@pytest.mark.parametrize("gain", ["paper", "combined"])
def test_ways_begin_where_the_camera_is(gain, sensor, camera, poses, tmp_path):
    planner = make(sensor, gain=gain, idle_views=0)
    planner.add_poses(poses)
    home = viewgain.look_at([0.3, -0.2, 0.9], [0, 0, 0])

    def expect_from(where, planner=planner, **given):
        proposal = planner.propose().T_world_camera
        gains = viewgain.GainEvaluator(viewgain.VoxelScene(planner.grid, boxes=[WALL]), sensor, gain=gain).evaluate(proposal)
        worth = gains - 700 * np.linalg.norm(proposal[:, :3, 3] - where[:3, 3], axis=1)
        ranking = planner.rank(len(proposal), cost_per_metre=700, exact=True, **given)
        assert len(ranking.worth) > 5 and ranking.worth[0] == pytest.approx(worth.max(), abs=1e-9)
        assert np.allclose(ranking.worth, worth[ranking.indices], rtol=0, atol=1e-9)

    planner.add(camera.acquire(poses[3], 0)[0], poses[3])
    expect_from(poses[3])
    expect_from(home, current_pose=home)
    empty = np.zeros((48, 64))
    assert planner.add(empty, poses[7]).verdict not in ("used", "carved")
    expect_from(poses[7])
    planner.drop("unreadable", poses[5])
    planner.drop("no_pose", None)
    expect_from(poses[5])
    planner.save(tmp_path / "state.vdb")
    again = viewgain.ViewPlanner.load(tmp_path / "state.vdb", sensor, voxel_size=0.006, workspace=WORKSPACE, boxes=[WALL],
                                      jump_edges=False, gain=gain, idle_views=0)
    again.add_poses(poses)
    expect_from(poses[5], again)
    for bad in (2 * home, np.full((4, 4), np.nan), np.eye(3)):
        with pytest.raises(ValueError, match="current_pose"):
            planner.rank(cost_per_metre=1, current_pose=bad)


def test_views_go_together_and_are_planned(sensor, camera, poses):
    one, ahead = make(sensor), make(sensor, plan=3, take=2)
    for planner in (one, ahead):
        planner.add_poses(poses, name="dome")
        planner.add(camera.acquire(poses[3], 0)[0], poses[3])
        proposal = planner.propose()
    scene = viewgain.VoxelScene(one.grid, boxes=[WALL])
    chosen, marginal = viewgain.GainEvaluator(scene, sensor).best_set(proposal.T_world_camera, 3)[:2]
    together = one.rank(3, together=True, exact=True)
    assert np.array_equal(together.indices, chosen) and np.array_equal(together.gain, marginal["gain"])
    assert 0 < len(ahead.rank(3).indices) <= 3
    with pytest.raises(ValueError, match="take must be in 1..*not 4"):
        make(sensor, plan=3, take=4)


def test_saved_it_goes_on_bit_for_bit(sensor, camera, poses, tmp_path):
    whole, parts = make(sensor), make(sensor)
    whole.add_poses(poses), parts.add_poses(poses)
    settings = dict(voxel_size=0.006, workspace=WORKSPACE, boxes=[WALL], jump_edges=False)
    for view in range(2):
        assert step(parts, camera, poses[5 * view], view) == step(whole, camera, poses[5 * view], view)
        parts.save(tmp_path / "state.vdb")
        parts = viewgain.ViewPlanner.load(tmp_path / "state.vdb", sensor, **settings)
        parts.add_poses(poses)
        assert parts.grid.content_hash() == whole.grid.content_hash()
    assert viewgain.BeliefGrid.load(tmp_path / "state.vdb").content_hash() == whole.grid.content_hash()
    assert [p.name for p in tmp_path.iterdir()] == ["state.vdb"]
    with pytest.raises(ValueError, match="0.005"):
        viewgain.ViewPlanner.load(tmp_path / "state.vdb", sensor, **{**settings, "voxel_size": 0.005})
    whole.grid.save(tmp_path / "map.vdb")
    with pytest.raises(viewgain.Error, match="map.vdb.*no planner state"):
        viewgain.ViewPlanner.load(tmp_path / "map.vdb", sensor, **settings)
    with pytest.raises(FileNotFoundError):
        viewgain.ViewPlanner.load(tmp_path / "none.vdb", sensor, **settings)
    with pytest.raises(OSError):
        whole.save(tmp_path / "none" / "state.vdb")
    with pytest.raises(TypeError):
        viewgain.ViewPlanner.load(tmp_path / "state.vdb", sensor, voxels=3)


def test_generators_and_what_was_tried(sensor, camera, poses):
    planner = make(sensor)
    asked = []

    def generator(grid):
        asked.append(len(grid.views()))
        return poses[:5]

    planner.add_generator(generator, name="mine")
    planner.add(*camera.acquire(poses[0], 0)[:1], poses[0])
    proposal = planner.propose()
    assert asked == [1] and proposal["generator"] == 4 * ["mine"] and proposal["dropped"] == {"taken": 1}
    planner.tried(poses[1], reached=False)
    planner.tried(poses[2], reached=True)
    assert planner.propose()["dropped"] == {"taken": 2, "missed": 1}

    def raises(grid):
        raise KeyError("mine")

    planner.add_generator(raises)
    with pytest.raises(KeyError, match="mine"):
        planner.propose()
    inside = make(sensor)
    inside.add_generator(lambda grid: inside.should_stop())
    with pytest.raises(RuntimeError, match="one call at a time"):
        inside.propose()
    wrong = make(sensor)
    wrong.add_generator(lambda grid: np.zeros((3, 3)))
    with pytest.raises(ValueError, match="the result of the generator"):
        wrong.propose()
    del inside, wrong
    gc.collect()


def test_one_call_at_a_time(sensor, poses):
    planner = make(sensor)
    entered, leave = threading.Event(), threading.Event()

    def generator(grid):
        entered.set()
        leave.wait(20)
        return poses

    planner.add_generator(generator)
    thread = threading.Thread(target=planner.propose)
    thread.start()
    assert entered.wait(20)
    with pytest.raises(RuntimeError, match="one call at a time"):
        planner.rank()
    leave.set()
    thread.join()
    assert len(planner.rank()["indices"]) == 1


def test_refused(sensor, camera, poses):
    planner = make(sensor)
    depth = camera.acquire(poses[0], 0)[0]
    with pytest.raises(ValueError, match="propose"):
        planner.rank()
    nan = poses[0].copy()
    nan[0, 3] = np.nan
    for bad in (nan, np.eye(3), 2 * np.eye(4)):
        for call in (lambda: planner.tried(bad, True), lambda: planner.add_poses([bad])):
            with pytest.raises(ValueError):
                call()
    with pytest.raises(ValueError):
        planner.add(depth, np.eye(3))
    # A pose that is lost costs a frame, no call.
    lost = make(sensor)
    assert [lost.add(depth, bad).verdict for bad in (nan, 2 * np.eye(4))] == ["lost_pose"] * 2
    assert lost.frames == {"lost_pose": 2}
    with pytest.raises(ValueError, match="2 lost_pose"):
        lost.propose()
    for frame in (depth[:-1], np.ones((48, 64), int), 1000 * depth):
        with pytest.raises((ValueError, TypeError)):
            planner.add(frame, poses[0])
    with pytest.raises(ValueError):
        planner.add(depth, poses[0], amplitude=np.ones(3))
    with pytest.raises(TypeError):
        planner.add_generator(3)
    assert len(planner.grid.views()) == 0
    ranked = planner.rank(3, poses=[nan, poses[1]])
    assert ranked["indices"].tolist() == [1] and ranked["gain"][0] >= 0
    with pytest.raises(ValueError, match="cost"):
        planner.rank(poses=poses, costs=[1.0])
    with pytest.raises(ValueError, match="cost"):
        planner.rank(poses=poses, costs=[])
    for settings in (dict(gain="best"), dict(max_views=0), dict(workspace=[[0, 0, 0]]), dict(body_size=[1, 2]),
                     dict(voxel_size=5)):
        with pytest.raises(ValueError):
            make(sensor, **settings)
    control = viewgain.BatchControl()
    control.stop()
    stopped = planner.rank(poses=np.tile(poses, (20, 1, 1)), control=control)
    assert not stopped["complete"]
