# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Scores poses on many machines with Dask (Debian: python3-distributed). The Dask workers need this package.

>>> import distributed, viewgain, viewgain.distributed                     # doctest: +SKIP
>>> with distributed.Client("tcp://scheduler:8786") as client:
...     gains = viewgain.distributed.evaluate(client, "map.vdb", poses, sensor="sr4000", gain="paper")
"""
from __future__ import annotations

import concurrent.futures
import os
from typing import Any, Callable, Optional, Union

import distributed
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._viewgain import BeliefGrid, Error, Sensor, ViewScorer

_ROUNDS = 4  # attempts for chunks lost with their workers
_LOST = (distributed.scheduler.KilledWorker, concurrent.futures.CancelledError, distributed.comm.CommClosedError)


def _evaluate(scorer: ViewScorer, poses: NDArray[np.float64], measure: Any) -> NDArray[np.float64]:
    return scorer.evaluate(poses, measure=measure)


def _rows(poses: ArrayLike) -> tuple[NDArray[np.float64], tuple[int, ...]]:
    """The poses as an array with one leading axis, and the shape of the original leading axes."""
    array = np.asarray(poses, np.float64)
    pose = array.shape[-1:] if array.shape[-1:] == (7,) else array.shape[-2:]
    if pose not in ((7,), (3, 4), (4, 4)):
        raise ValueError(f"poses must have the shape (..., 4, 4), (..., 3, 4) or (..., 7), not {array.shape}")
    lead = array.shape[:array.ndim - len(pose)]
    return np.ascontiguousarray(array.reshape(-1, *pose)), lead


def _answers(client: distributed.Client, scorer: ViewScorer, chunks: dict[int, NDArray[np.float64]], measure: Any):
    """Yields the number and the gains of each finished chunk. Sends the map to each worker once. Omits chunks that were lost with
    their workers."""
    try:
        (shared,) = client.scatter([scorer], broadcast=True, hash=False)
    except (TimeoutError, distributed.TimeoutError) as error:
        raise Error(f"the cluster has no workers: {error}") from error
    futures = {client.submit(_evaluate, shared, poses, measure, pure=False): number for number, poses in chunks.items()}
    try:
        for future in distributed.as_completed(list(futures)):
            try:
                gains = future.result()
            except _LOST:
                continue
            yield futures[future], gains
    finally:
        client.cancel(list(futures))


def evaluate(client: distributed.Client, map: Union[BeliefGrid, str, os.PathLike[str]], poses: ArrayLike, *,
             sensor: Union[Sensor, str, os.PathLike[str]], chunk_size: Optional[int] = None, measure: Any = None,
             progress: Optional[Callable[[int, int], None]] = None, **gain: Any) -> NDArray[np.float64]:
    """The gain of each pose on a map, computed by the workers of a Dask cluster.

    The gains are in the order of the poses, and do not depend on the number of workers. They are bit-identical to those of
    ``ViewScorer.evaluate`` if all machines have the same CPU model and C library. If a worker dies, other workers do its chunks.
    Cost: the map is read on this machine and sent to each worker once. For each pose, at most 128 bytes are sent and 8 returned.

    Parameters
    ----------
    client : distributed.Client
    map : BeliefGrid or path-like
        A file is read on this machine; workers need no access to it.
    poses : array_like, (..., 4, 4), (..., 3, 4) or (..., 7)
        T_world_camera.
    sensor : Sensor, or the name of a preset or .toml file
    chunk_size : int, optional
        Number of poses per task. Default: at most 4096, such that there are about four tasks per thread of the cluster.
    measure : callable, optional
        Custom gain, as in ``ViewScorer.evaluate``.
    progress : callable, optional
        Called with the number of poses scored so far and the number of all poses.
    **gain
        Further arguments of ``ViewScorer``: gain, criterion, pixel_stride, weights, boxes, meshes, ... num_threads is the number of
        threads per task; default: 1.

    Returns
    -------
    ndarray, (...), float64
        NaN for an invalid pose.

    Raises
    ------
    viewgain.Error
        If chunks are lost with their workers four times.
    ValueError, TypeError, OSError
        As ``ViewScorer``. They are raised before anything is sent.
    """
    if not isinstance(client, distributed.Client):
        raise TypeError(f"client must be a distributed.Client, not {type(client).__name__}")
    rows, lead = _rows(poses)
    camera = sensor if isinstance(sensor, Sensor) else Sensor.load(sensor)
    scorer = ViewScorer(camera, map=map, **{"num_threads": 1, **gain})
    if chunk_size is not None and chunk_size < 1:
        raise ValueError(f"chunk_size must be positive, not {chunk_size}")
    threads = max(1, sum(client.nthreads().values()))
    size = chunk_size or min(4096, max(1, -(-len(rows) // (4 * threads))))
    chunks = {begin: rows[begin:begin + size] for begin in range(0, len(rows), size)}
    gains, done = np.empty(len(rows)), 0
    for _ in range(_ROUNDS):
        if not chunks:
            break
        for begin, some in _answers(client, scorer, chunks.copy(), measure):
            gains[begin:begin + len(some)] = some
            done += len(some)
            del chunks[begin]
            if progress is not None:
                progress(done, len(rows))
    if chunks:
        raise Error(f"{len(rows) - done} of {len(rows)} poses have no gain, because their workers were lost {_ROUNDS} times")
    return gains.reshape(lead)
