#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What scoring on many machines costs, measured on this one. Needs PYTHONPATH of a build, python3-distributed, BIN.

    many_machines.py BIN FOLDER rate [POSES]        two workers of one thread against two threads in one process, in turns
    many_machines.py BIN FOLDER kill [POSES]        one of two workers is killed half way: complete, no row twice, the same bits
    many_machines.py BIN FOLDER merge [ROWS] [csv]  peak memory of `viewgain merge`, its best against a sort
    many_machines.py BIN FOLDER constants           seconds a pose, to build, to read and write, at 128^3 and 512^3

Each prints one JSON object. FOLDER keeps maps, for the next call.
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
    return viewgain.GainEvaluator(viewgain.VoxelScene(grid, num_threads=threads), sensor, pixel_stride=stride,
                                  num_threads=threads)


def one_process(path, poses, threads):
    """Gains of all, in chunks, and how long these took [s]; the map is there before."""
    evaluator = evaluator_of(path, threads)
    evaluator.evaluate(poses[:64])
    start = time.perf_counter()
    gains = [evaluator.evaluate_detailed(poses[i:i + CHUNK_ROWS]) for i in range(0, len(poses), CHUNK_ROWS)]
    return np.concatenate(gains), time.perf_counter() - start


def two_workers(path, poses, out, progress=None):
    """What score() says, the same without a map built before, and the workers' processes."""
    import distributed
    import viewgain.distributed

    shutil.rmtree(out, ignore_errors=True)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                  memory_limit=0) as cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        found = viewgain.distributed.score(client, path, poses, "sr4000", out=out, num_threads=1, pixel_stride=STRIDE,
                                           progress=progress and (lambda done, total: progress(pids, done, total)))
    return found, np.concatenate([np.load(part) for part in found.parts])


def same(rows, gains):
    return rows["index"].tolist() == list(range(len(gains))) and all(
        rows[name].tobytes() == gains[name].tobytes() for name in rows.dtype.names[1:])


def rate(binaries, folder, count=1_000_000):
    path, poses = camel(binaries, folder, 128), viewgain.shell_poses(count, 0.45, 0.8, seed=1)
    gains, alone = one_process(path, poses, 2)
    found, rows = two_workers(path, poses, folder / "out")
    _, again = one_process(path, poses, 2)
    alone_mean = (alone + again) / 2
    return {"poses": count, "isa": found.isa, "one_process_seconds": [alone, again], "two_workers_seconds": found.seconds,
            "ratio": alone_mean / found.seconds, "chunks": len(found.parts), "same_bits": same(rows, gains)}


def kill(binaries, folder, count=1_000_000):
    path, poses, killed = camel(binaries, folder, 128), viewgain.shell_poses(count, 0.45, 0.8, seed=1), []

    def progress(pids, done, total):
        if not killed and done >= total / 2:
            os.kill(pids[0], signal.SIGKILL)
            killed.append(done)

    found, rows = two_workers(path, poses, folder / "out", progress)
    gains, _ = one_process(path, poses, 2)
    return {"poses": count, "killed_at": killed, "seconds": found.seconds, "chunks": len(found.parts),
            "rows": len(rows), "distinct_rows": len(np.unique(rows["index"])), "same_bits": same(rows, gains)}


def merge(binaries, folder, count=10_000_000, ending="npy", parts=100, top=1000):
    """Parts of rows that nobody scored, with many ties."""
    from viewgain import _parts

    head = f"# viewgain 0\n# map 0\n# sensor 0 0\n# settings {{}}\n# isa avx2\n# poses {count} 0\n"
    random, names, gains = np.random.default_rng(1), [], []
    shutil.rmtree(folder / "parts", ignore_errors=True)
    (folder / "parts").mkdir()
    for i in range(parts):
        begin, end = count * i // parts, count * (i + 1) // parts
        rows = np.zeros(end - begin, _parts.dtype_of({}))
        rows["index"], rows["gain"] = np.arange(begin, end), random.integers(0, 1_000_000, end - begin)
        gains.append(rows["gain"].copy())
        names.append(folder / "parts" / f"{i:03d}.{ending}")
        if ending == "npy":
            _parts.write_part(names[-1], rows, head, begin)
        else:
            with open(names[-1], "w") as file:
                file.write(f"{head}# rows {begin}:{end}\n# scored {len(rows)}\n{','.join(rows.dtype.names)}\n")
                file.writelines(f"{i},{g:.0f},0,0,0,0,0,0,0,ok\n" for i, g in zip(rows["index"], rows["gain"]))
    said = {"rows": count, "parts": parts, "ending": ending}
    for flags in ((), ("--top", str(top))):
        start = time.perf_counter()
        out = folder / f"merged.{ending}"
        process = subprocess.Popen([binaries / "viewgain", "merge", *names, "--out", out, *flags], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0
        said["top" if flags else "all"] = {"seconds": time.perf_counter() - start, "peak_mb": usage.ru_maxrss / 1e3}
        if flags:
            gains = np.concatenate(gains)
            order = np.argsort(-gains, kind="stable")[:top]
            best = np.load(out)["index"] if ending == "npy" else np.loadtxt(out, delimiter=",", skiprows=9, usecols=0)
            said["best_are_those_of_a_sort"] = bool(np.array_equal(best, order))
        out.unlink()
    shutil.rmtree(folder / "parts")
    return said


def constants(binaries, folder):
    said = {}
    for voxels in (128, 512):
        path = camel(binaries, folder, voxels)
        start = time.perf_counter()
        grid = viewgain.BeliefGrid.load(path)
        loaded = time.perf_counter()
        scene = viewgain.VoxelScene(grid, num_threads=2)
        entry = {"map_mb": path.stat().st_size / 1e6, "load_seconds": loaded - start,
                 "build_seconds": time.perf_counter() - loaded, "isa": scene.isa}
        for stride, count in ((1, 2000), (4, 20000)):
            poses = viewgain.shell_poses(count, 0.45, 0.8, seed=2)
            for threads in (1, 2):
                evaluator = evaluator_of(path, threads, stride)
                evaluator.evaluate(poses[:64])
                start = time.perf_counter()
                evaluator.evaluate(poses)
                entry[f"poses_per_second_stride_{stride}_threads_{threads}"] = count / (time.perf_counter() - start)
        said[f"camel-{voxels}"] = entry
    return said


def main():
    binaries, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    what = {"rate": rate, "kill": kill, "merge": merge, "constants": constants}[sys.argv[3]]
    said = what(binaries, folder, *(int(word) if word.isdigit() else word for word in sys.argv[4:]))
    print(json.dumps({"what": sys.argv[3], **said}, indent=1))


if __name__ == "__main__":
    main()
