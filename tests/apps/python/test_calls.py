# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What happens round a call: threads, fork, Ctrl-C, progress, stops."""
import os
import signal
import threading
import time

import numpy as np
import pytest

import viewgain


@pytest.fixture(scope="module")
def slow(grid):
    """An evaluator and poses that take it some seconds."""
    sensor = viewgain.sensor_preset("kinect_v1")
    evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, gain="paper", num_threads=2)
    return evaluator, viewgain.sphere_poses(20_000, 1.0)


def in_child(work):
    """Whether work() is true in a forked process, which has a minute."""
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        try:
            os._exit(0 if work() else 1)
        except BaseException:
            os._exit(2)
    return os.waitpid(child, 0)[1] == 0


def test_a_pool_that_lived_before_a_fork_works_after_it(evaluator, grid, sensor, poses):
    gains = evaluator.evaluate(poses)

    def same():
        return np.array_equal(evaluator.evaluate(poses), gains)

    assert in_child(same)
    assert in_child(lambda: in_child(same))
    assert in_child(lambda: np.array_equal(evaluator.best(poses, 3).indices, np.argsort(-gains)[:3]))

    def from_nothing():
        scene = viewgain.VoxelScene(grid, boxes=[[[5, 5, 5], [6, 6, 6]]])
        made = viewgain.GainEvaluator(scene, sensor, gain="paper", pixel_stride=4, num_threads=2)
        return np.array_equal(made.evaluate(poses), gains)

    assert in_child(from_nothing)
    dropped = viewgain.GainEvaluator(evaluator.scene, sensor, num_threads=3)
    dropped.evaluate(poses)

    def drop():
        nonlocal dropped
        del dropped
        return True

    assert in_child(drop)
    assert same()


def test_ctrl_c_ends_a_batch(slow):
    evaluator, poses = slow
    for call in (lambda: evaluator.evaluate(poses), lambda: evaluator.best_set(poses, 50),
                 lambda: evaluator.evaluate_own(poses, lambda pose, hits: 0.0)):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            call()
        assert time.monotonic() - begin < 30  # not to the end; the machine may be busy
        timer.join()


def test_progress_is_told_and_can_stop(slow):
    evaluator, poses = slow
    told = []

    def progress(done, total):
        told.append((done, total))
        return done < 100

    control = viewgain.BatchControl(progress)
    gains = evaluator.evaluate(poses, control=control)
    assert control.stopped and repr(control) == "BatchControl(stopped)"
    scored = np.count_nonzero(np.isfinite(gains))
    assert 100 <= scored < len(poses)
    assert told[-1][1] == len(poses)
    assert [done for done, _ in told] == sorted(done for done, _ in told)

    def broken(done, total):
        raise KeyError("plot")

    with pytest.raises(KeyError, match="plot"):
        evaluator.evaluate(poses, control=viewgain.BatchControl(broken))
    with pytest.raises(TypeError):
        viewgain.BatchControl(3)


def test_progress_hears_of_the_end_of_every_call(evaluator, poses):
    calls = [evaluator.evaluate, evaluator.evaluate_detailed, evaluator.best, evaluator.race,
             evaluator.approximate, lambda batch, control: evaluator.best_set(batch, 2, control=control),
             lambda batch, control: evaluator.plan_tour(batch, max_stops=2, control=control),
             lambda batch, control: evaluator.evaluate_own(batch, lambda pose, hits: 0.0, control=control)]
    told = []
    for call in calls:
        for batch in (poses, poses[:1], poses[:0]):
            before = len(told)
            call(batch, control=viewgain.BatchControl(lambda *now: told.append(now)))
            assert len(told) > before
            assert len(batch) > 0 or told[before:] == [(0, 0)]
    assert len(told) >= 24


def test_any_false_answer_of_progress_stops_but_none(slow):
    evaluator, poses = slow
    for answer, stops in [(False, True), (np.False_, True), (0, True), (None, False), (True, False),
                          (np.True_, False)]:
        control = viewgain.BatchControl(lambda done, total: answer)
        gains = evaluator.evaluate(poses if stops else poses[:50], control=control)
        assert control.stopped == stops and np.isnan(gains).any() == stops

    class Neither:
        def __bool__(self):
            raise KeyError("truth")

    with pytest.raises(KeyError, match="truth"):
        evaluator.evaluate(poses[:9], control=viewgain.BatchControl(lambda done, total: Neither()))


def test_another_thread_can_stop_a_call(slow):
    evaluator, poses = slow
    control = viewgain.BatchControl()
    assert not control.stopped
    timer = threading.Timer(0.2, control.stop)
    timer.start()
    gains = evaluator.evaluate(poses, control=control)
    timer.join()
    assert control.stopped and np.isnan(gains).any()
    stopped = evaluator.evaluate(poses[:5], control=control)
    assert np.isnan(stopped).all()


def test_threads_share_evaluator_and_grid(evaluator, labels, sensor, poses):
    gains = evaluator.evaluate(poses)
    grid = viewgain.BeliefGrid.from_labels(labels, voxel_size=0.01, sensor=sensor)
    integrator = viewgain.FrameIntegrator(sensor)
    depth = np.full((144, 176), 0.5, np.float32)
    wrong = []

    def score():
        for _ in range(5):
            if not np.array_equal(evaluator.evaluate(poses), gains):
                wrong.append("gains")

    def change():
        for pose in poses[:10]:
            integrator.integrate(grid, depth, pose)

    def read():
        for _ in range(20):
            if grid.states().size != 32**3 or grid.statistics()["bytes"] == 0:
                wrong.append("states")
            viewgain.VoxelScene(grid)

    threads = [threading.Thread(target=work) for work in (score, score, change, change, read, read)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong and len(grid.views()) == 20
