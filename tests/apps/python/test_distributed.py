# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Scores by the workers of a cluster are those of one machine, bit for bit, also where a worker dies midway."""
import os
import signal

import distributed
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import viewgain
import viewgain.distributed


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        with distributed.Client(cluster) as client:
            yield cluster, client


@pytest.mark.parametrize("gain", ["paper", "surface", "combined"])
@pytest.mark.parametrize("form", ["matrices", "rows", "a grid of them", "one"])
def test_the_same_bits_in_the_poses_order(cluster, grid, sensor, poses, gain, form):
    of = {"matrices": poses, "rows": np.hstack([poses[:, :3, 3], Rotation.from_matrix(poses[:, :3, :3]).as_quat()]), "one": poses[3],
          "a grid of them": poses.reshape(6, 10, 4, 4).astype(np.float32)}[form]
    here = viewgain.ViewScorer(sensor, map=grid, gain=gain, pixel_stride=4).evaluate(of)
    there = viewgain.distributed.evaluate(cluster[1], grid, of, sensor=sensor, gain=gain, pixel_stride=4, chunk_size=7)
    assert there.shape == np.shape(here) and np.array_equal(there, here)


def test_a_file_progress_and_none(cluster, grid, poses, tmp_path):
    grid.save(tmp_path / "map.vdb")
    said = []
    gains = viewgain.distributed.evaluate(cluster[1], tmp_path / "map.vdb", poses, sensor="sr4000", pixel_stride=8,
                                          progress=lambda done, total: said.append((done, total)))
    assert np.array_equal(gains, viewgain.ViewScorer(viewgain.sensor_preset("sr4000"), map=grid, pixel_stride=8).evaluate(poses))
    assert said[-1] == (60, 60) and said == sorted(said) and len(said) == 8  # four tasks for each of two threads
    assert viewgain.distributed.evaluate(cluster[1], grid, np.empty((0, 4, 4)), sensor="sr4000").shape == (0,)


def test_bad_poses_and_a_gain_of_ones_own(cluster, grid, sensor, poses):
    bad = poses.copy()
    bad[4, 0, 3] = np.nan
    gains = viewgain.distributed.evaluate(cluster[1], grid, bad, sensor=sensor, gain="paper", pixel_stride=8, chunk_size=3)
    assert np.flatnonzero(np.isnan(gains)).tolist() == [4]

    def occupied(pose, hits):
        return float(np.sum(hits["state"] == 2))

    scorer = viewgain.ViewScorer(sensor, map=grid, pixel_stride=8)
    there = viewgain.distributed.evaluate(cluster[1], grid, poses[:9], sensor=sensor, measure=occupied, pixel_stride=8, chunk_size=2)
    assert np.array_equal(there, scorer.evaluate(poses[:9], measure=occupied)) and there.max() > 0

    def fails(pose, hits):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        viewgain.distributed.evaluate(cluster[1], grid, poses[:2], sensor=sensor, measure=fails, pixel_stride=8)


def test_wrong_calls_are_refused_before_anything_is_sent(cluster, grid, sensor, poses, monkeypatch):
    monkeypatch.setattr(cluster[1], "scatter", lambda *given, **more: pytest.fail("something is sent"))
    with pytest.raises(TypeError, match="must be a distributed.Client, not str"):
        viewgain.distributed.evaluate("tcp://127.0.0.1:1", grid, poses, sensor=sensor)
    cases = 0
    for wrong, error in (({"poses": np.zeros((3, 5))}, ValueError), ({"gain": "papr"}, ValueError), ({"chunk_size": 0}, ValueError),
                         ({"sensor": "sr4001"}, ValueError), ({"map": "no.vdb"}, OSError), ({"gian": "paper"}, TypeError)):
        given = {"map": grid, "poses": poses, "sensor": sensor, **wrong}
        with pytest.raises(error):
            viewgain.distributed.evaluate(cluster[1], given.pop("map"), given.pop("poses"), **given)
        cases += 1
    assert cases == 6


def test_a_worker_that_is_killed_midway_changes_nothing(cluster, grid, sensor, poses):
    many = np.concatenate([poses] * 40)
    killed = []

    def kill(done, total):
        if done >= total // 4 and not killed:
            killed.append(next(iter(cluster[0].workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    there = viewgain.distributed.evaluate(cluster[1], grid, many, sensor=sensor, gain="paper", chunk_size=30, progress=kill)
    assert len(killed) == 1 and len(many) == 2400
    assert np.array_equal(there, viewgain.ViewScorer(sensor, map=grid, gain="paper").evaluate(many))


def test_all_workers_killed_at_once_are_waited_for(cluster, grid, sensor, poses):
    """The map is lost with them; nannies start others, which get it anew."""
    killed = []

    def kill(done, total):
        if not killed:
            for worker in cluster[0].workers.values():
                killed.append(worker.pid)
                os.kill(worker.pid, signal.SIGKILL)

    many = np.concatenate([poses] * 20)
    there = viewgain.distributed.evaluate(cluster[1], grid, many, sensor=sensor, gain="paper", chunk_size=30, progress=kill)
    assert len(killed) == 2
    assert np.array_equal(there, viewgain.ViewScorer(sensor, map=grid, gain="paper").evaluate(many))
