# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""viewgain.distributed: the same bits as one process, also when a worker is killed; what it says without Dask."""
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import viewgain
from viewgain import _rows as parts, _viewgain as native

WITHOUT_DASK = """
import importlib.abc, sys
class Without(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("distributed", "dask"):
            raise ModuleNotFoundError(f"No module named {name!r}")
sys.meta_path.insert(0, Without())
import viewgain
assert len(viewgain.sphere_poses(3, 1.0)) == 3
try:
    import viewgain.distributed
except ImportError as error:
    print(error)
"""


def test_without_dask_it_says_what_to_install_and_the_rest_works():
    said = subprocess.run([sys.executable, "-c", WITHOUT_DASK], capture_output=True, text=True, check=True).stdout
    assert "apt-get install python3-distributed" in said


def part_of(sensor, rows, path, poses=viewgain.sphere_poses(12, 1.0)):
    head = native._part_head("map", sensor, {}, "sse4", poses)
    native._write_part(path, head, "paper", rows.tobytes())
    return head


def four_rows():
    rows = np.zeros(4, parts.dtype_of("paper"))
    rows["index"] = np.arange(3, 7)
    return rows


def test_files_of_parts_need_no_dask(sensor, tmp_path):
    rows, path = four_rows(), tmp_path / "part.npy"
    head = part_of(sensor, rows, path)
    assert np.array_equal(parts.rows_of(path, head, "paper"), rows) and os.listdir(tmp_path) == ["part.npy"]
    assert np.array_equal(np.load(path), rows) and b"# rows 3:7\n# scored 4\n" in path.read_bytes()
    for other in ({"pixel_stride": 2}, {"prior_sigma": 0.5}, {"weights": [([[0, 0, 0], [1, 1, 1]], 2)]}):
        with pytest.raises(ValueError, match="another job .settings"):
            parts.rows_of(path, native._part_head("map", sensor, other, "sse4", viewgain.sphere_poses(12, 1.0)), "paper")
    assert parts.gaps([(3, 7), (9, 10)], 12) == [(0, 3), (7, 9), (10, 12)]
    assert parts.gaps([(0, 12)], 12) == []


def test_every_pose_counts_for_the_job(sensor):
    poses = viewgain.sphere_poses(9001, 1.0)
    columns = np.zeros(len(poses), [(name, "<f8") for name in ("tx", "ty", "tz", "qx", "qy", "qz", "qw")])
    for some in (poses, columns):
        whole = native._part_head("map", sensor, {}, "sse4", some)
        for row in (0, 1, 4500, 8999, 9000):
            changed = some.copy()
            changed.view("<f8").reshape(len(some), -1)[row, 3] += 1e-9
            assert native._part_head("map", sensor, {}, "sse4", changed) != whole, row


def test_damaged_parts_are_named(sensor, tmp_path):
    path, rows = tmp_path / "rows-3-7.npy", four_rows()
    head = part_of(sensor, rows, path)
    whole = path.read_bytes()
    contents = [whole[:length] for length in (0, 5, 60, 200, whole.index(b"# viewgain"), len(whole) - 30, len(whole) - 1)]
    contents += [whole + b"#", b"PK\3\4" + whole]
    for column, row, value in (("index", 1, 9), ("index", 3, 3), ("status", 2, 3), ("status", 3, 77)):
        changed = rows.copy()
        changed[column][row] = value
        part_of(sensor, changed, path)
        contents.append(path.read_bytes())
    part_of(sensor, rows[:0], path)
    contents.append(path.read_bytes())
    for content in contents:
        path.write_bytes(content)
        with pytest.raises(ValueError, match=r"rows-3-7\.npy: .*; delete it"):
            parts.rows_of(path, head, "paper")


def test_poses_in_columns_are_matrices():
    random = np.random.default_rng(2)
    q = random.normal(size=(100, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    rows = np.zeros(100, [(name, "<f8") for name in ("t", "tx", "ty", "tz", "qx", "qy", "qz", "qw")])
    t = random.normal(size=(100, 3))
    for i, name in enumerate(("tx", "ty", "tz")):
        rows[name] = t[:, i]
    for i, name in enumerate(("qx", "qy", "qz", "qw")):
        rows[name] = q[:, i]
    matrices = native._pose_matrices(rows)
    x, y, z, w = q.T
    for column, p in enumerate(np.eye(3)):  # p + 2 w (v x p) + 2 v x (v x p)
        v = np.stack([x, y, z], axis=1)
        turned = p + 2 * w[:, None] * np.cross(v, p) + 2 * np.cross(v, np.cross(v, p))
        assert np.allclose(matrices[:, :3, column], turned, atol=1e-14)
    rows["qw"][:5] = 3  # no rotations any more
    assert np.isnan(native._pose_matrices(rows)[:5]).any(axis=(1, 2)).all()
    assert np.array_equal(matrices[:, :3, 3], t) and np.array_equal(matrices[:, 3], np.tile([0, 0, 0, 1.0], (100, 1)))
    with pytest.raises(ValueError, match="qw"):
        parts.poses_of(np.zeros(3, [(name, "<f8") for name in ("tx", "ty", "tz", "qx", "qy", "qz")]))


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                  memory_limit=0) as cluster:
        with distributed.Client(cluster) as made:
            yield made


def rows_of(found):
    return np.concatenate([np.load(path) for path in found.parts])


def check_rows(rows, evaluator, poses):
    assert rows["index"].tolist() == list(range(len(poses)))  # all, none twice
    gains = evaluator.evaluate_detailed(poses)
    for name in rows.dtype.names[1:-7]:
        assert rows[name].tobytes() == gains[name].tobytes(), name
    assert rows.dtype.names[-7:] == ("tx", "ty", "tz", "qx", "qy", "qz", "qw")
    again = native._pose_matrices(rows)
    assert np.allclose(again, poses, rtol=0, atol=1e-14, equal_nan=True) or np.isnan(poses).any()
    assert np.array_equal(np.isnan(again).any((1, 2)), np.isnan(poses).any((1, 2)))


def test_scores_are_those_of_one_process(client, grid, sensor, tmp_path):
    import viewgain.distributed

    poses = np.concatenate([viewgain.sphere_poses(3000, 0.6), np.full((1, 4, 4), np.nan)])
    np.save(tmp_path / "poses.npy", poses)
    for number, settings in enumerate(({"pixel_stride": 4}, {"pixel_stride": 8, "gain": "paper"})):
        seen = []
        found = viewgain.distributed.score(
            client, grid, tmp_path / "poses.npy", sensor, out=tmp_path / str(number), top=7, chunk_seconds=0.05, num_threads=1,
            progress=lambda done, total: seen.append((done, total)), **settings)
        evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, num_threads=1,
                                            posterior_entropy=True, **settings)
        assert found.isa == evaluator.scene.isa and found.poses == 3001 and found.resumed == 0
        check_rows(rows_of(found), evaluator, poses)
        assert found.best["index"].tolist() == evaluator.best(poses, 7).tolist()
        assert seen == sorted(seen) and seen[-1] == (3001, 3001) and len(seen) == len(found.parts) > 2
        # What is there is not done again; another job is refused.
        again = viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / str(number), num_threads=1, **settings)
        assert again.resumed == 3001 and again.parts == found.parts
        found.parts[1].unlink()
        again = viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / str(number), num_threads=1, **settings)
        assert 0 < again.resumed < 3001
        check_rows(rows_of(again), evaluator, poses)
        with pytest.raises(ValueError, match="another job"):
            viewgain.distributed.score(client, grid, poses[1:], sensor, out=tmp_path / str(number), **settings)
    # Built once a process and setting.
    counts = client.run(lambda: __import__("viewgain.distributed").distributed._built)
    assert all(count <= 2 for count in counts.values()), counts


def test_a_killed_worker_is_done_without(client, grid, sensor, tmp_path):
    import viewgain.distributed

    poses = viewgain.sphere_poses(20000, 0.6)
    victim, when = next(iter(client.run(os.getpid).values())), []

    def progress(done, total):
        if not when and done > total // 3:
            os.kill(victim, signal.SIGKILL)
            when.append(done)

    found = viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "out", chunk_seconds=0.1, num_threads=1,
                                       progress=progress, pixel_stride=4)
    assert when and found.poses == 20000
    check_rows(rows_of(found), viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, pixel_stride=4,
                                                       posterior_entropy=True), poses)
    client.wait_for_workers(2)
    assert victim not in client.run(os.getpid).values()


def test_parts_are_those_of_the_program(client, grid, sensor, tmp_path):
    import viewgain.distributed

    program = os.environ.get("VIEWGAIN_PROGRAM")
    if not program:
        pytest.skip("the program is not built")
    grid.save(tmp_path / "map.vdb")
    np.save(tmp_path / "poses.npy", viewgain.sphere_poses(2500, 0.6))
    found = viewgain.distributed.score(client, tmp_path / "map.vdb", tmp_path / "poses.npy", "sr4000", out=tmp_path / "out",
                                       chunk_seconds=0.05, num_threads=1, pixel_stride=4, min_range=0.25,
                                       weights=[([[-0.1, -0.1, -0.1], [0.1, 0.1, 0.125]], 3),
                                                (np.array([[0, 0, 0], [1, 1, 1]]), 0.5)])
    run = lambda *words: subprocess.run([program, *map(str, words)], cwd=tmp_path, check=True, capture_output=True)
    score = ("score", "map.vdb", "--poses", "poses.npy", "--sensor", "sr4000", "--stride", 4, "--min-range", 0.25,
             "--weight", "-0.1,-0.1,-0.1,0.1,0.1,0.125,3", "--weight", "0,0,0,1,1,1,0.5")
    run(*score, "--shard", "0/1", "--out", "whole.npy")
    run("merge", *found.parts, "--out", "merged.npy")
    assert (tmp_path / "merged.npy").read_bytes() == (tmp_path / "whole.npy").read_bytes()


def test_isa_and_tracer_are_pinned_and_wrong_calls_are_named(client, grid, sensor, poses, tmp_path):
    import viewgain.distributed

    if viewgain.distributed._best_isa() in ("avx2", "avx512"):
        found = viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "low", isa="sse4", pixel_stride=4)
        assert found.isa == "sse4" and b"\n# isa sse4\n" in found.parts[0].read_bytes()
        with pytest.raises(ValueError, match="isa sse4, not"):  # the default is another
            viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "low", pixel_stride=4)
    if viewgain.distributed._best_isa() != "avx512":
        with pytest.raises(RuntimeError, match="avx512"):
            viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "none", isa="avx512")
    rows = {rows_of(viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / tracer, pixel_stride=4, tracer=tracer)).tobytes()
            for tracer in ("automatic", "embree", "sweep")}
    assert len(rows) == 1
    with pytest.raises(ValueError, match="valid are automatic, embree, sweep"):
        viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "none", tracer="bvh")
    with pytest.raises(ValueError, match="no ISA 'mmx'"):
        viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "none", isa="mmx")
    with pytest.raises(ValueError, match=r"\(4, 4\)"):
        viewgain.distributed.score(client, grid, np.eye(4), sensor, out=tmp_path / "none")


def test_settings_that_are_none_are_refused_by_the_client(client, grid, sensor, poses, tmp_path):
    import viewgain.distributed

    def score(**settings):
        return viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path / "out", pixel_stride=8, **settings)

    for _ in range(2):  # the workers have the evaluator the second time
        for name in ("pixle_stride", "strides", "seed"):
            with pytest.raises(TypeError, match=f"no setting '{name}'.*pixel_stride"):
                score(**{name: 2})
        assert score().poses == len(poses)
        for path in (tmp_path / "out").iterdir():
            path.unlink()
    given = {"gain": "combined", "criterion": "log_determinant", "refinement_weight": 0.5, "support_plane": -0.1,
             "prior_sigma": 0.1, "min_range": 0.3, "max_range": 2.0, "weights": [([[0, 0, 0], [1, 1, 1]], 2)],
             "posterior_entropy": True}
    assert {*given, "pixel_stride"} == set(parts.SETTINGS)
    assert score(**given).poses == len(poses)


def test_parts_with_the_same_rows_are_named(client, grid, sensor, poses, tmp_path):
    import viewgain.distributed

    score = lambda: viewgain.distributed.score(client, grid, poses, sensor, out=tmp_path, pixel_stride=8)
    rows = rows_of(score())
    for path in tmp_path.iterdir():
        head = path.read_bytes()[-2000:].decode(errors="replace")
        path.unlink()
    head = head[head.index("# format"):]
    for first, second in (((0, 9), (0, 9)), ((0, 9), (0, 20)), ((0, 20), (5, 9)), ((3, 9), (8, 20))):
        for name, (begin, end) in (("rows-a.npy", first), ("rows-b.npy", second)):
            native._write_part(tmp_path / name, head, viewgain.DEFAULT_GAIN, rows[begin:end].tobytes())
        with pytest.raises(ValueError, match=r"rows-b\.npy: rows .* overlap rows .*rows-a\.npy"):
            score()
    native._write_part(tmp_path / "rows-b.npy", head, viewgain.DEFAULT_GAIN, rows[9:20].tobytes())
    assert score().resumed == 17 and rows_of(score()).tobytes() == rows.tobytes()


SPEC = """objects = ["cube.off"]
policies = ["frontier", "random"]
seeds = [1, 2]
sensors = ["sr4000"]
voxels = [0.02]
sizes = [0.2]
max_views = 1
"""
CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")


def test_a_study_is_shared(client, tmp_path):
    import viewgain.distributed

    program = os.environ.get("VIEWGAIN_PROGRAM")
    if not program:
        pytest.skip("the program is not built")
    (tmp_path / "spec.toml").write_text(SPEC)
    (tmp_path / "cube.off").write_text(CUBE)
    seen = []
    results = viewgain.distributed.study(client, tmp_path / "spec.toml", tmp_path / "study", program=program, num_threads=1,
                                         progress=seen.append)
    subprocess.run([program, "study", "spec.toml", "--out", "alone", "--plots", "off"], cwd=tmp_path, check=True,
                   capture_output=True)
    assert seen[-1] == 4 and seen == sorted(seen)
    for name in ("results.csv", "table.md"):
        shared, alone = ((tmp_path / folder / name).read_text().splitlines() for folder in ("study", "alone"))
        assert len(shared) == len(alone) > 4
    assert [run["object"] for run in results] == 4 * ["cube"]
    with pytest.raises(RuntimeError, match="viewgainx cannot be started"):
        viewgain.distributed.study(client, tmp_path / "spec.toml", tmp_path / "none", program="viewgainx")
    with pytest.raises(RuntimeError, match="no.toml"):
        viewgain.distributed.study(client, tmp_path / "no.toml", tmp_path / "none", program=program)
