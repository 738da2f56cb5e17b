#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What scoring on many machines costs, measured on this one. Needs PYTHONPATH of a build, python3-distributed, BIN.

    many_machines.py BIN FOLDER rate [POSES]        two workers of one thread against two threads in one process, in turns
    many_machines.py BIN FOLDER kill [POSES]        one of two workers is killed half way: complete, no row twice, the same bits
    many_machines.py BIN FOLDER merge [ROWS] [csv]  peak memory of `viewgain merge`, its best against a sort
    many_machines.py BIN FOLDER cost [POSES]        seconds a pose and a map at 512^3, what they foretell and what runs take

Each prints one JSON object; exit code 1 if a bar is missed. FOLDER keeps maps, for the next call.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import numpy as np

import viewgain

STRIDE, CHUNK_ROWS = 4, 65536
# Runs a program and prints its peak memory [KiB]. A process of its own: what a child needs begins with what its parent has.
PEAK = """import os, sys
pid = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
_, status, usage = os.wait4(pid, 0)
assert status == 0, status
print(usage.ru_maxrss)"""


def camel(binaries, folder, voxels):
    """The map of camel-VOXELS: 4 views, a workspace of 0.4 m."""
    path = folder / f"camel-{voxels}.vdb"
    if not path.exists():
        source = pathlib.Path(__file__).resolve().parent.parent
        run = lambda *words: subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, cwd=folder)
        run(source / "apps/extract_mesh.sh", "camel.off", "meshes")
        run(binaries / "viewgain", "simulate", "meshes/camel.off", "--size", 0.35, "--recenter", "on", "--sphere", "4,0.6",
            "--sensor", "sr4000", "--out", "frames")
        run(binaries / "viewgain", "integrate", "frames", "--voxel", 0.4 / voxels, "--workspace=-0.2,-0.2,-0.2,0.2,0.2,0.2",
            "--out", path.name)
    return path


def evaluator_of(path, threads, stride=STRIDE):
    grid = viewgain.BeliefGrid.load(path)
    sensor = viewgain.Sensor.load("sr4000")
    return viewgain.GainEvaluator(viewgain.VoxelScene(grid, num_threads=threads), sensor, gain="paper", pixel_stride=stride,
                                  num_threads=threads, posterior_entropy=True)


def one_process(path, poses, threads):
    """Gains of all, in chunks, and how long these took [s]; the map is there before."""
    evaluator = evaluator_of(path, threads)
    evaluator.evaluate(poses[:64])
    start = time.perf_counter()
    gains = [evaluator.evaluate_detailed(poses[i:i + CHUNK_ROWS]) for i in range(0, len(poses), CHUNK_ROWS)]
    return np.concatenate(gains), time.perf_counter() - start


def dask_run(path, poses, out, workers=2, progress=None):
    """What score() says of so many workers of one thread, from the file of the map on, and all rows."""
    import distributed
    import viewgain.distributed

    shutil.rmtree(out, ignore_errors=True)
    with distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None,
                                  memory_limit=0) as cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        found = viewgain.distributed.score(client, path, poses, "sr4000", out=out, num_threads=1, gain="paper", pixel_stride=STRIDE,
                                           progress=progress and (lambda done, total: progress(pids, done, total)))
    return found, np.concatenate([np.load(part) for part in found.parts])


def same(rows, gains):
    return rows["index"].tolist() == list(range(len(gains))) and all(
        rows[name].tobytes() == gains[name].tobytes() for name in rows.dtype.names[1:])


def rate(binaries, folder, count=1_000_000):
    path, poses = camel(binaries, folder, 128), viewgain.shell_poses(count, 0.45, 0.8, seed=1)
    gains, alone = one_process(path, poses, 2)
    found, rows = dask_run(path, poses, folder / "out")
    _, again = one_process(path, poses, 2)
    alone_mean = (alone + again) / 2
    return {"poses": count, "isa": found.isa, "one_process_seconds": [alone, again], "two_workers_seconds": found.seconds,
            "ratio": alone_mean / found.seconds, "chunks": len(found.parts), "same_bits": same(rows, gains),
            "met": same(rows, gains) and alone_mean / found.seconds >= 0.9}


def kill(binaries, folder, count=1_000_000):
    path, poses, killed = camel(binaries, folder, 128), viewgain.shell_poses(count, 0.45, 0.8, seed=1), []

    def progress(pids, done, total):
        if not killed and done >= total / 2:
            os.kill(pids[0], signal.SIGKILL)
            killed.append(done)

    found, rows = dask_run(path, poses, folder / "out", progress=progress)
    gains, _ = one_process(path, poses, 2)
    return {"poses": count, "killed_at": killed, "seconds": found.seconds, "chunks": len(found.parts),
            "rows": len(rows), "distinct_rows": len(np.unique(rows["index"])), "same_bits": same(rows, gains),
            "met": bool(killed) and same(rows, gains)}


def merge(binaries, folder, count=10_000_000, ending="npy", parts=100, top=1000):
    """Parts of rows that nobody scored, with many ties."""
    from viewgain import _rows, _viewgain

    head = f"# format 1\n# viewgain 0\n# map 0\n# sensor 0 0\n# settings {{}}\n# isa avx2\n# poses {count} 0\n# rows 0:0\n# scored 0\n"
    random, names, gains = np.random.default_rng(1), [], []
    shutil.rmtree(folder / "parts", ignore_errors=True)
    (folder / "parts").mkdir()
    for i in range(parts):
        begin, end = count * i // parts, count * (i + 1) // parts
        rows = np.zeros(end - begin, _rows.dtype_of("paper"))
        rows["index"], rows["gain"] = np.arange(begin, end), random.integers(0, 1_000_000, end - begin)
        gains.append(rows["gain"].copy())
        names.append(folder / "parts" / f"{i:03d}.{ending}")
        _viewgain._write_part(names[-1], head, "paper", rows.tobytes())
    said = {"rows": count, "parts": parts, "ending": ending}
    for flags in ((), ("--top", str(top))):
        start = time.perf_counter()
        out = folder / f"merged.{ending}"
        call = [sys.executable, "-c", PEAK, binaries / "viewgain", "merge", *names, "--out", out, *flags]
        peak = subprocess.run([str(word) for word in call], check=True, capture_output=True, text=True).stdout
        said["top" if flags else "all"] = {"seconds": time.perf_counter() - start, "peak_mb": int(peak) * 1024 / 1e6}
        if flags:
            gains = np.concatenate(gains)
            order = np.argsort(-gains, kind="stable")[:top]
            best = np.load(out)["index"] if ending == "npy" else np.loadtxt(out, delimiter=",", skiprows=10, usecols=0)
            said["best_are_those_of_a_sort"] = bool(np.array_equal(best, order))
        out.unlink()
    shutil.rmtree(folder / "parts")
    said["met"] = said["best_are_those_of_a_sort"] and max(said[key]["peak_mb"] for key in ("all", "top")) <= 200
    return said


def cost(binaries, folder, count=60_000):
    """Constants at 512^3, what they foretell for one and two workers of a thread and what these take, and for 10^7 poses."""
    path, sensor = camel(binaries, folder, 512), viewgain.Sensor.load("sr4000")
    start = time.perf_counter()
    grid = viewgain.BeliefGrid.load(path)
    grid.content_hash()
    data = grid.to_bytes()
    packed = time.perf_counter()
    scene = viewgain.VoxelScene(viewgain.BeliefGrid.from_bytes(data), num_threads=1)
    client_seconds, worker_seconds = packed - start, time.perf_counter() - packed
    said = {"isa": scene.isa, "map_mb": len(data) / 1e6, "load_hash_and_pack_seconds": client_seconds,
            "unpack_and_build_seconds": worker_seconds}
    rates = {}
    for stride, some in ((STRIDE, 8000), (1, 1500)):
        for threads in (1, 2):
            poses = viewgain.shell_poses(some, 0.45, 0.8, seed=2)
            evaluator = viewgain.GainEvaluator(scene, sensor, gain="paper", pixel_stride=stride, num_threads=threads)
            evaluator.evaluate(poses[:64])
            start = time.perf_counter()
            evaluator.evaluate(poses)
            rates[stride, threads] = some / (time.perf_counter() - start)
            said[f"poses_per_second_stride_{stride}_threads_{threads}"] = rates[stride, threads]
    fixed = client_seconds + worker_seconds
    poses = viewgain.shell_poses(count, 0.45, 0.8, seed=1)
    for workers in (1, 2):
        found, _ = dask_run(path, poses, folder / "out", workers)
        # Two workers of a thread share the machine as two threads do.
        said[f"{workers}_workers"] = {"poses": count, "foretold_seconds": fixed + count / rates[STRIDE, workers],
                                      "seconds": found.seconds}
    for stride in (STRIDE, 1):
        said[f"hours_for_1e7_stride_{stride}"] = {
            machines: (fixed + 1e7 / (machines * rates[stride, 2])) / 3600 for machines in (1, 10, 100)}
    return said


def main():
    binaries, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    what = {"rate": rate, "kill": kill, "merge": merge, "cost": cost}[sys.argv[3]]
    said = what(binaries, folder, *(int(word) if word.isdigit() else word for word in sys.argv[4:]))
    print(json.dumps({"what": sys.argv[3], **said}, indent=1))
    sys.exit(0 if said.get("met", True) else 1)


if __name__ == "__main__":
    main()
