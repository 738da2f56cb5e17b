# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the runs of a study, by processes of this machine or on a Dask cluster."""
from __future__ import annotations

import concurrent.futures
import contextlib
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from typing import Callable, Optional

import numpy as np

from .rows import SpecError, row_of
from .spec import Run, Spec

_children: set[subprocess.Popen] = set()  # of this process, so that none of them outlives a wish to stop
_children_lock = threading.Lock()


class RunError(RuntimeError):
    """A run that failed; the text names it and says what the program said. `code` is the program's exit code."""

    def __init__(self, text: str, code: int = 1):
        super().__init__(text, code)
        self.text, self.code = text, code

    def __str__(self):
        return self.text


def find_program(name: Optional[str] = None) -> str:
    """The program ``viewgain``: `name` if given, else that of the build or prefix that this package lies in, else that on PATH.
    Raises SpecError where there is none."""
    if name is None:
        for folder in pathlib.Path(__file__).resolve().parents[2:]:
            if os.access(folder / "bin/viewgain", os.X_OK):
                return str(folder / "bin/viewgain")
    found = shutil.which(name or "viewgain")
    if found is None:
        raise SpecError(f"there is no program {name or 'viewgain'}; put its folder into PATH, or name it by --program")
    return str(pathlib.Path(found).resolve())


def _called(words, title):
    """Calls a program in a session of its own, as Ctrl-C is the study's; raises RunError."""
    try:
        with _children_lock:
            process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       errors="replace", start_new_session=True)
            _children.add(process)
    except OSError as error:
        raise RunError(f"{title}: {words[0]}: {error.strerror}") from None
    try:
        _, said = process.communicate()
    finally:
        with _children_lock:
            _children.discard(process)
    if process.returncode != 0:
        lines = [line for line in said.splitlines() if line and "warning:" not in line]
        by_signal = f"ended by signal {-process.returncode}" if process.returncode < 0 else f"exit code {process.returncode}"
        raise RunError(f"{title}: {lines[-1].removeprefix('viewgain: ') if lines else by_signal}", process.returncode)


def _kill_children():
    with _children_lock:
        for process in _children:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def make_run(words, title, kept, folder=None):
    """One run in a folder of its own inside `folder` (default: the system's for such files), which it removes: run.json's text, and
    of each view's candidates `kept`, evenly taken, as TUM lines whose time is how many views there were. Raises RunError."""
    with tempfile.TemporaryDirectory(prefix=".run-", dir=folder) as work:
        split = words.index("--")
        _called([*words[:split], f"--out={work}/run", *words[split:]], title)
        record = pathlib.Path(work, "run/run.json")
        if not record.is_file():
            raise RunError(f"{title}: {words[0]} left no run.json in the folder that --out names", 2)
        lines = []
        for view, path in enumerate(sorted(pathlib.Path(work, "run/maps").glob("*.txt")) if kept else [], start=1):
            poses = [line.split(maxsplit=1)[1] for line in path.read_text().splitlines() if line and not line.startswith("#")]
            count = min(kept, len(poses))
            lines += [f"{view} {poses[i * len(poses) // count]}\n" for i in range(count)]
        return record.read_text(encoding="utf-8"), "".join(lines)


def write_text(path, text):
    """Writes a file as a whole or not at all; of one that is there the mode stays."""
    descriptor, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with open(descriptor, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
            os.fchmod(file.fileno(), path.stat().st_mode & 0o7777 if path.exists() else 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


@contextlib.contextmanager
def _study_folder(out):
    """Makes DIR/runs for one study at a time, and clears what a killed one has left."""
    runs = out / "runs"
    try:
        runs.mkdir(parents=True, exist_ok=True)
        lock = open(runs / ".lock", "w")  # released when this process ends, however it does
    except OSError as error:
        raise SpecError(f"--out {out}: {error.strerror}") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SpecError(f"--out {out}: another study is at work there; several machines share one by --scheduler") from None
        except OSError:
            pass  # a file system without locks
        for left in runs.glob(".run-*"):
            shutil.rmtree(left, ignore_errors=True)
        yield runs


def _command(spec, run, program, threads):
    return [*(run.policy.command or (program, "reconstruct")), f"--threads={threads}", *spec.words(run)]


def _first_of_each(runs):
    """The first run of each policy and of each scene."""
    seen, first = set(), []
    for run in runs:
        of = {("policy", run.policy.name), ("scene", run.object.name, run.sensor, run.voxel, run.size)}
        if not of <= seen:
            first.append(run)
        seen |= of
    return first


def _one_view(words):
    """The same call with a budget of one view: whether its words and files are right, before hours of work."""
    return [word if not word.startswith("--max-views=") else "--max-views=1" for word in words]


@contextlib.contextmanager
def _executor(jobs, scheduler):
    """What runs are submitted to. Ends what is under way if the block is left by an exception."""
    if scheduler is None:
        pool, client = concurrent.futures.ThreadPoolExecutor(jobs), None  # each thread waits for a process
    else:
        try:
            import distributed
        except ImportError as error:
            raise SpecError(f"--scheduler needs Dask (Debian: python3-distributed), which cannot be imported: {error}") from error
        try:
            client = distributed.Client(scheduler, timeout="10s", set_as_default=False)
        except (OSError, ValueError) as error:
            raise SpecError(f"--scheduler {scheduler}: no scheduler answers there: {error}") from error
        pool = client.get_executor(pure=False)
    try:
        yield pool
    except BaseException:
        if client is None:
            pool.shutdown(wait=False, cancel_futures=True)
            _kill_children()
        else:
            pool.shutdown(wait=False)
        raise
    finally:
        pool.shutdown()
        if client is not None:
            client.close()


def make_runs(spec: Spec, out, jobs: Optional[int] = None, scheduler: Optional[str] = None, program: Optional[str] = None,
              progress: Callable[[str], None] = lambda line: None) -> list[dict]:
    """Makes the runs that are not in ``out/runs/HASH`` yet, `jobs` at once (default: a thread of this machine each), or on the
    workers of a Dask cluster, which must have the program and the files by the same names. `progress` gets a line at the start
    and after each run. Returns the rows of all runs in the spec's order. Raises SpecError and RunError; what is whole stays."""
    out = pathlib.Path(out)
    cores = len(os.sched_getaffinity(0))
    threads = max(1, cores // jobs) if jobs and scheduler is None else 1
    program = program or find_program()
    with _study_folder(out) as folder:
        missing = [run for run in spec.runs if not (folder / run.hash / "run.json").exists()]
        if len(missing) < len(spec.runs):
            progress(f"{len(spec.runs) - len(missing)} of {len(spec.runs)} runs are there")
        work = None if scheduler else str(folder.resolve())
        with _executor(jobs or cores, scheduler) if missing else contextlib.nullcontext() as pool:
            checks = {pool.submit(make_run, _one_view(_command(spec, run, program, threads)), spec.title(run), 0, work): run
                      for run in _first_of_each(missing)}
            for future in concurrent.futures.as_completed(checks):
                _checked(future, spec, checks[future])
            begin = time.monotonic()
            futures = {pool.submit(_timed_run, _command(spec, run, program, threads), spec.title(run), spec.kept_candidates, work): run
                       for run in missing}
            for done, future in enumerate(concurrent.futures.as_completed(futures), start=1):
                run = futures[future]
                record, candidates, seconds = future.result()
                _keep(folder / run.hash, run, record, candidates)
                left = (time.monotonic() - begin) / done * (len(missing) - done)
                progress(f"run {len(spec.runs) - len(missing) + done} of {len(spec.runs)}: {spec.title(run)}, {seconds:.1f} s; "
                         f"{_time_text(left)} left")
        return [_row(folder / run.hash / "run.json", run, spec.max_views) for run in spec.runs]


def _checked(future, spec, run):
    try:
        future.result()
    except RunError as error:
        hint = "; a gain is \"gain:NAME\"" if "--policy" in str(error) and not run.policy.gain and not run.policy.command else ""
        raise RunError(f"{spec.path}: {error}{hint}", error.code) from None


def _timed_run(*arguments):
    begin = time.monotonic()
    return (*make_run(*arguments), time.monotonic() - begin)


def _keep(folder, run: Run, record, candidates):
    """run.json last, so that a run that is there is whole."""
    folder.mkdir(exist_ok=True)
    if candidates:
        write_text(folder / "candidates.txt", candidates)
    write_text(folder / "run.json", json.dumps({"configuration": run.configuration, **json.loads(record)}, indent=2) + "\n")


def _row(path, run, max_views):
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if record["configuration"] != run.configuration:
            raise ValueError("it is not of the run that its folder stands for")
        return row_of(run, record, max_views)
    except (LookupError, TypeError, ValueError) as error:
        raise SpecError(f"{path}: {type(error).__name__}: {error}; a run whose folder is removed is made again") from error


def _time_text(seconds):
    for unit, factor, most in (("s", 1, 120), ("min", 60, 7200), ("h", 3600, np.inf)):
        if seconds < most:
            return f"{np.ceil(seconds / factor):.0f} {unit}"
