# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Many poses and many runs on many machines, by Dask's ``distributed`` (2022.12 or later; Debian: python3-distributed).

>>> import distributed, viewgain.distributed                              # doctest: +SKIP
>>> client = distributed.Client("tcp://head:8786")                        # doctest: +SKIP
>>> found = viewgain.distributed.score(client, "map.vdb", "poses.npy", "sr4000", out="scores")   # doctest: +SKIP
>>> found.best["index"]                                                   # doctest: +SKIP

Start one worker a machine with one thread for Dask and no limit of memory (``dask worker tcp://head:8786 --nthreads 1
--memory-limit 0``); viewgain's own threads use its cores. All must have the same version of viewgain, and Dask wants the
same versions of Python and of itself.
"""
from __future__ import annotations

import json
import math
import os
import pathlib
import subprocess
import threading
import time
import warnings
from collections import OrderedDict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

try:
    import distributed as _dask
except ImportError as error:
    raise ImportError(f"viewgain.distributed needs Dask, which cannot be imported ({error}): "
                      "apt-get install python3-distributed, or pip install distributed") from error

import viewgain

from . import _rows
from ._viewgain import _part_head, _pose_matrices, _pose_rows, _POSE_COLUMNS, _write_part

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Scores", "score", "study"]

_ISAS = ("baseline", "sse4", "avx2", "avx512")  # rising
_FIRST_ROWS, _MOST_ROWS = 1024, 65536  # of a chunk: to learn the rate; for messages of at most 8 MB
_KEPT_EVALUATORS = 2


# In the workers.

@dataclass(frozen=True)
class _Job:
    """What a worker needs beside the map's bytes; small, it goes with each chunk."""

    map_hash: str
    sensor: viewgain.Sensor
    settings: dict[str, Any]
    isa: str
    tracer: str
    num_threads: int
    head: str
    """What its parts say of themselves."""
    version: str = viewgain.__version__

    @property
    def key(self) -> str:
        """Of the evaluator that it needs."""
        return f"{self.head.partition('# poses')[0]} {self.tracer} {self.num_threads}"

    @property
    def gain(self) -> str:
        return self.settings.get("gain", viewgain.DEFAULT_GAIN)

    @property
    def dtype(self) -> np.dtype:
        return _rows.dtype_of(self.gain)


_lock = threading.Lock()
_maps: dict[str, bytes] = {}  # by hash, what plugins brought
_evaluators: OrderedDict[str, viewgain.GainEvaluator] = OrderedDict()
_built = 0  # evaluators, by this process


class _MapPlugin(_dask.WorkerPlugin):
    """Brings a map's bytes to every worker, also to those that come later: what is scattered is lost with a worker."""

    def __init__(self, map_hash: str, data: bytes) -> None:
        self.name = f"viewgain-map-{map_hash}"
        self.map_hash, self.data = map_hash, data

    def setup(self, worker: Any) -> None:
        _maps[self.map_hash] = self.data

    def teardown(self, worker: Any) -> None:
        _maps.pop(self.map_hash, None)


def _register(client: Any, plugin: _MapPlugin) -> None:
    # The first is the name since 2023.9, the second until then; the second warns since.
    register = getattr(client, "register_plugin", None) or client.register_worker_plugin
    register(plugin, name=plugin.name)


def _best_isa() -> str:
    sensor = viewgain.sensor_preset("sr4000")
    grid = viewgain.BeliefGrid.from_labels(np.zeros((1, 1, 1), np.uint8), voxel_size=0.01, sensor=sensor)
    return viewgain.VoxelScene(grid).isa


def _build(job: _Job) -> viewgain.GainEvaluator:
    global _built
    if job.version != viewgain.__version__:
        raise RuntimeError(f"this worker has viewgain {viewgain.__version__}, the client {job.version}")
    if job.map_hash not in _maps:
        raise RuntimeError(f"this worker has no map {job.map_hash}")
    before = os.environ.get("VIEWGAIN_ISA")
    os.environ["VIEWGAIN_ISA"] = job.isa  # pinned: another one would differ in the last digits
    try:
        grid = viewgain.BeliefGrid.from_bytes(_maps[job.map_hash])
        if grid.content_hash() != job.map_hash:
            raise RuntimeError(f"the map is no longer {job.map_hash}: its file was changed meanwhile")
        settings = {**job.settings, "posterior_entropy": True}  # a column of what is written
        scene = viewgain.VoxelScene(grid, support_plane=settings.pop("support_plane", None), num_threads=job.num_threads)
        if scene.isa != job.isa:
            raise RuntimeError(f"this worker's CPU lacks {job.isa}, it has {scene.isa} at best")
        _built += 1
        return viewgain.GainEvaluator(scene, job.sensor, tracer=job.tracer, num_threads=job.num_threads, **settings)
    finally:
        if before is None:
            del os.environ["VIEWGAIN_ISA"]
        else:
            os.environ["VIEWGAIN_ISA"] = before


def _evaluator(job: _Job) -> viewgain.GainEvaluator:
    key = job.key
    with _lock:
        if key not in _evaluators:
            while len(_evaluators) >= _KEPT_EVALUATORS:
                _evaluators.popitem(last=False)
            _evaluators[key] = _build(job)
        _evaluators.move_to_end(key)
        return _evaluators[key]


def _score_chunk(job: _Job, begin: int, poses: NDArray) -> tuple[int, NDArray, float]:
    """First row, rows, and how long scoring took [s]."""
    evaluator = _evaluator(job)
    start = time.perf_counter()
    matrices = _pose_matrices(poses) if poses.dtype.names else poses
    gains = evaluator.evaluate_detailed(matrices)
    seconds = time.perf_counter() - start
    rows = np.empty(len(poses), job.dtype)
    rows["index"] = np.arange(begin, begin + len(poses))
    for name in rows.dtype.names[1:-len(_POSE_COLUMNS)]:
        rows[name] = gains[name]
    for name, column in zip(_POSE_COLUMNS, _pose_rows(matrices).T):
        rows[name] = column
    return begin, rows, seconds


# In the client.

@dataclass(frozen=True)
class Scores:
    """What score() came to."""

    best: NDArray
    """(top,), structured: the best rows, best first, as in the parts: index; gain, ..., status, of
    ``GainEvaluator.evaluate_detailed`` [nat, m**2]; tx, ..., qw of the pose."""
    parts: list[pathlib.Path]
    """The files, by rows; ``viewgain merge`` puts them together."""
    isa: str
    """Instruction set that scored."""
    poses: int
    """How many were scored."""
    resumed: int
    """How many of these an earlier call had left in the folder."""
    seconds: float
    """From the call to its end [s]."""


class _Chunks:
    """Deals out rows that are missing, as many as take a worker so many seconds."""

    def __init__(self, gaps: list[tuple[int, int]], seconds: float) -> None:
        self._gaps, self._seconds = gaps[::-1], seconds
        self._rows = _FIRST_ROWS

    def learn(self, rows: int, seconds: float) -> None:
        self._rows = max(1, min(_MOST_ROWS, int(self._seconds * rows / max(seconds, 1e-9))))

    def next(self, workers: int) -> tuple[int, int] | None:
        if not self._gaps:
            return None
        begin, end = self._gaps.pop()
        left = end - begin + sum(b - a for a, b in self._gaps)
        # Towards the end smaller ones, so that all workers end together.
        rows = min(self._rows, max(math.ceil(left / (2 * workers)), self._rows // 8, 1))
        if end - begin > rows:
            self._gaps.append((begin + rows, end))
            end = begin + rows
        return begin, end


def _submit(client: Any, job: _Job, begin: int, poses: NDArray) -> Any:
    with warnings.catch_warnings():
        # Dask would have poses scattered, which are then lost with a worker. Each chunk goes out once, and is small enough.
        warnings.filterwarnings("ignore", "Large object of size|Sending large graph")
        return client.submit(_score_chunk, job, begin, poses, pure=False)


def _run(client: Any, job: _Job, poses: NDArray, chunks: _Chunks, keep: Callable[[int, NDArray], None]) -> None:
    running = _dask.as_completed()
    try:
        while True:
            workers = max(1, len(client.nthreads()))
            while running.count() < 2 * workers and (rows := chunks.next(workers)):
                running.add(_submit(client, job, rows[0], np.ascontiguousarray(poses[slice(*rows)])))
            if running.count() == 0:
                return
            future = next(running)
            begin, scored, seconds = future.result()
            future.release()
            chunks.learn(len(scored), seconds)
            keep(begin, scored)
    finally:
        client.cancel(list(running.futures))


def score(client: Any, map: Any, poses: Any, sensor: Any, *, out: Any, top: int = 10, isa: str | None = None,
          chunk_seconds: float = 5.0, tracer: str = "automatic", num_threads: int = 0,
          progress: Callable[[int, int], object] | None = None, **settings: Any) -> Scores:
    """Gains of many poses, by the workers of a Dask cluster, into files.

    The map goes to each worker once, which builds it once; poses go in chunks of some seconds, and their rows come back and
    are written by the caller. A worker that is lost loses what it was at, which others do again. Called again with the same
    arguments after a failure it goes on with what is in the folder. The same bits as one process with this ISA.

    Parameters
    ----------
    client : distributed.Client
    map : BeliefGrid, or path of a .vdb
    poses : array_like, (n, 4, 4), rows with tx, ty, tz, qx, qy, qz, qw, or path of a .npy of either
        T_world_camera [m]. A file or a mapped array is read chunk by chunk.
    sensor : Sensor, or name of a preset or a file
    out : path
        Folder for the parts, made if it is not there: rows-BEGIN-END.npy, which `viewgain merge` reads.
    top : int
        How many of the best are kept in memory.
    isa : {"sse4", "avx2", "avx512", "baseline"}, optional
        Instruction set of all workers; default: the best that all have which are there now.
    chunk_seconds : float
        How long a chunk is to take a worker [s]: 3 to 10 are right.
    tracer : {"automatic", "embree", "sweep"}
        Of all workers, as in ``GainEvaluator``. Never changes a result.
    num_threads : int
        Of each worker; 0: as many as its machine has.
    progress : callable, optional
        Gets the number of poses done and of all, after each chunk.
    **settings
        Of GainEvaluator: gain, criterion, pixel_stride, prior_sigma, ...; ``posterior_entropy`` is always there. Of
        VoxelScene, with the gains surface and combined: support_plane.

    Returns
    -------
    Scores

    Raises
    ------
    ValueError
        A shape is wrong, or the folder holds parts of another job, damaged ones or two with the same rows.
    TypeError
        There is no such setting.
    RuntimeError
        A worker has another version of viewgain or lacks the ISA.
    distributed.KilledWorker
        A chunk was lost with several workers, one after the other.
    """
    start = time.perf_counter()
    # Here, and not in workers: one that has the evaluator already would not look at what it does not know.
    for name in settings:
        if name not in _rows.SETTINGS:
            raise TypeError(f"there is no setting {name!r}, but {', '.join(_rows.SETTINGS)}")
    grid = map if isinstance(map, viewgain.BeliefGrid) else viewgain.BeliefGrid.load(map)
    sensor = sensor if isinstance(sensor, viewgain.Sensor) else viewgain.Sensor.load(sensor)
    poses = _rows.poses_of(poses)
    if isa is None:
        client.wait_for_workers(1)
        isa = min(client.run(_best_isa).values(), key=_ISAS.index)
    elif isa not in _ISAS:
        raise ValueError(f"there is no ISA {isa!r}, but {', '.join(_ISAS)}")
    map_hash = grid.content_hash()
    job = _Job(map_hash, sensor, settings, isa, tracer, num_threads, _part_head(map_hash, sensor, settings, isa, poses))
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    best, found = np.empty(0, job.dtype), []
    for path in sorted(folder.glob("rows-*.npy")):
        rows = _rows.rows_of(path, job.head, job.gain)
        found.append((int(rows["index"][0]), int(rows["index"][-1]) + 1, path))
        best = _rows.best_of(np.concatenate([best, rows]), top)
    found.sort()
    for (begin, end, path), (other_begin, other_end, other) in zip(found, found[1:]):
        if other_begin < end:
            raise ValueError(f"{other}: rows {other_begin}:{other_end} overlap rows {begin}:{end} of {path}; delete one")
    there = {begin: (end, path) for begin, end, path in found}
    gaps = _rows.gaps([(begin, end) for begin, end, _ in found], len(poses))
    done = resumed = len(poses) - sum(end - begin for begin, end in gaps)

    def keep(begin: int, rows: NDArray) -> None:
        nonlocal best, done
        path = folder / f"rows-{begin:012d}-{begin + len(rows):012d}.npy"
        if begin in there:
            raise RuntimeError(f"{path}: was scored twice")
        _write_part(path, job.head, job.gain, rows.tobytes())
        there[begin] = (begin + len(rows), path)
        best = _rows.best_of(np.concatenate([best, rows]), top)
        done += len(rows)
        if progress is not None:
            progress(done, len(poses))

    if gaps:
        # The file's bytes are those that to_bytes() would make again.
        data = grid.to_bytes() if grid is map else pathlib.Path(os.fsdecode(map)).read_bytes()
        plugin = _MapPlugin(job.map_hash, data)
        _register(client, plugin)
        try:
            _run(client, job, poses, _Chunks(gaps, chunk_seconds), keep)
        finally:
            client.unregister_worker_plugin(plugin.name)
    parts = [path for _, (_, path) in sorted(there.items())]
    return Scores(best, parts, isa, len(poses), resumed, time.perf_counter() - start)


def _join_study(command: list[str]) -> None:
    try:
        result = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise RuntimeError(f"{command[0]} cannot be started: {error.strerror}") from error
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {result.stderr.strip()}")


def study(client: Any, spec: Any, out: Any, *, program: str = "viewgain", num_threads: int = 0,
          progress: Callable[[int], object] | None = None) -> list[dict[str, Any]]:
    """A study (`viewgain study`) whose runs the workers of a Dask cluster share.

    Each worker calls `viewgain study SPEC --out OUT`; these claim runs one by one in the folder, so that it and the spec's files
    must be the same for the caller and all workers, under the same paths. Runs of a worker that is lost are made by
    others. Called again it goes on with what is there.

    Parameters
    ----------
    client : distributed.Client
    spec : path
    out : path
        The study's folder.
    program : str
        The program viewgain, as the workers find it.
    num_threads : int
        Of each worker; 0: as many as its machine has.
    progress : callable, optional
        Gets the number of runs done, each time that it has grown.

    Returns
    -------
    list of dict
        results.json.

    Raises
    ------
    RuntimeError
        The program failed, with what it said, or cannot be started.
    """
    folder = pathlib.Path(out).absolute()
    command = [program, "study", str(pathlib.Path(spec).absolute()), "--out", str(folder), "--plots", "off", "--quiet",
               "--threads", str(num_threads)]
    client.wait_for_workers(1)
    futures = [client.submit(_join_study, command, pure=False, workers=[worker], allow_other_workers=True)
               for worker in client.nthreads()]
    last = 0
    try:
        while any(future.status == "pending" for future in futures):
            done = sum(1 for _ in folder.glob("runs/*/run.json"))
            if progress is not None and done > last:
                progress(done)
            last = done
            time.sleep(0.2)
        client.gather(futures)
    finally:
        client.cancel(futures)
    done = sum(1 for _ in folder.glob("runs/*/run.json"))
    if progress is not None and done > last:
        progress(done)
    return json.loads((folder / "results.json").read_text(encoding="utf-8"))
