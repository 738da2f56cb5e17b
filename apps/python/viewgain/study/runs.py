# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the runs of a study in processes on this machine, or on a Dask cluster."""
from __future__ import annotations

import concurrent.futures
import contextlib
import fcntl
import json
import logging
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from typing import Callable, Optional

from .rows import SpecError, row_of
from .spec import Run, Spec

_WORKERS_WITHIN = 60  # time to wait for the first worker [s]
# Prefix of a command, so that its process ends when the parent process ends or is killed (util-linux).
_ENDS_WITH_US = ["setpriv", "--pdeathsig", "KILL", "--"] if shutil.which("setpriv") else []


class RunError(RuntimeError):
    """A failed run. The text names the run and quotes the program's message. `code` is the program's exit code."""

    def __init__(self, text: str, code: int = 1):
        super().__init__(text, code)
        self.text, self.code = text, code

    def __str__(self):
        return self.text


class _Children:
    """The running processes of a study on this machine. kill() ends all of them."""

    def __init__(self):
        self._lock, self._running, self._is_over = threading.Lock(), set(), False

    def call(self, words, title, beside):
        """Runs a program and waits for it. It gets a new session, so that only the study receives Ctrl-C. Its PATH begins with `beside`, the
        folder of ``viewgain``, and the folder of this Python, for custom programs. Raises RunError if it fails."""
        path = os.pathsep.join([beside, os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])
        try:
            with self._lock:
                if self._is_over:
                    raise RunError(f"{title}: stopped")
                process = subprocess.Popen([*_ENDS_WITH_US, *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                           errors="replace", start_new_session=True, env={**os.environ, "PATH": path})
                self._running.add(process)
        except OSError as error:
            raise RunError(f"{title}: {words[0]}: {error.strerror}") from None
        try:
            _, said = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        if process.returncode != 0:
            lines = [line for line in said.splitlines() if line.strip() and "warning:" not in line]
            by_signal = f"ended by signal {-process.returncode}" if process.returncode < 0 else f"exit code {process.returncode}"
            raise RunError(f"{title}: {lines[-1].removeprefix('viewgain: ') if lines else by_signal}", process.returncode)

    def kill(self):
        with self._lock:
            self._is_over = True
            for process in self._running:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)


def find_program(name: Optional[str] = None) -> str:
    """The path of the program ``viewgain``: `name` if given, otherwise the program in the build or prefix that contains this package, otherwise
    the one on PATH. Raises SpecError if there is none."""
    if name is None:
        for folder in pathlib.Path(__file__).resolve().parents[2:]:
            if (folder / "bin/viewgain").is_file() and os.access(folder / "bin/viewgain", os.X_OK):
                return str(folder / "bin/viewgain")
    found = shutil.which(name or "viewgain")
    if found is None:
        raise SpecError(f"program {name or 'viewgain'} not found; add its folder to PATH, or give --program")
    return os.path.abspath(found)


def version_of(program: str) -> str:
    """The program's version. Raises SpecError if the program is not viewgain."""
    try:
        said = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace").stdout
    except OSError as error:
        raise SpecError(f"{program}: {error.strerror}") from error
    found = re.fullmatch(r"viewgain (\S+)\s*", said)
    if not found:
        raise SpecError(f"{program} is not the program viewgain; its --version prints {said[:60]!r}")
    return found[1]


def _fault(error):
    """What is wrong, for a person: the text of a KeyError is only its key."""
    return f"the key {error} is missing" if isinstance(error, KeyError) else str(error)


def make_run(words, title, kept, beside, is_own=False, folder=None, children=None):
    """Makes one run in a temporary folder inside `folder` (default: that of the system), which is removed afterwards. Returns run.json as a
    dict, candidates, and the duration of the run [s]. For each view, candidates has up to `kept` of its candidates, evenly sampled, as TUM lines
    whose timestamp is the number of views so far. `is_own`: the program is a custom one, and run.json gets the duration of the whole call.
    Raises RunError."""
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix=".run-", dir=folder) as work:
        split = words.index("--")
        (children or _Children()).call([*words[:split], f"--out={work}/run", *words[split:]], title, beside)
        seconds = time.monotonic() - begin
        try:
            record = json.loads(pathlib.Path(work, "run/run.json").read_text(encoding="utf-8"))
            record["seconds"] = {"total": seconds} if is_own else record["seconds"]
        except FileNotFoundError:
            raise RunError(f"{title}: {words[0]} wrote no run.json to the folder of --out", 2) from None
        except (LookupError, TypeError, ValueError) as error:
            raise RunError(f"{title}: run.json is invalid: {_fault(error)}", 2) from None
        lines = []
        for path in sorted(pathlib.Path(work, "run/maps").glob("*.txt"), key=lambda path: int(path.stem)) if kept else []:
            poses = [line.split(maxsplit=1)[1] for line in path.read_text().splitlines() if line and not line.startswith("#")]
            count = min(kept, len(poses))
            lines += [f"{int(path.stem) + 1} {poses[i * len(poses) // count]}\n" for i in range(count)]
        return record, "".join(lines), seconds


def write_file(path, content):
    """Writes a file atomically and keeps the mode of an existing one."""
    temporary = path.with_name(f".{path.name}.tmp")  # no conflict: only one study uses the folder. Leftovers of a killed study are overwritten.
    try:
        with open(temporary, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
            os.fchmod(file.fileno(), path.stat().st_mode & 0o7777 if path.exists() else 0o644)
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextlib.contextmanager
def _study_folder(out):
    """Creates the folder `out`/runs and locks it, so that only one study uses it. Removes leftovers of a killed study. If no run was kept,
    removes the folders again."""
    runs = out / "runs"
    try:
        runs.mkdir(parents=True, exist_ok=True)
        lock = open(runs / ".lock", "w")  # released when this process ends, even if it is killed
    except OSError as error:
        raise SpecError(f"--out {out}: {error.strerror}") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SpecError(f"--out {out}: another study uses this folder; to use several machines, give --scheduler") from None
        except OSError:
            pass  # a file system without locks
        for left in runs.glob(".run-*"):
            shutil.rmtree(left, ignore_errors=True)
        try:
            yield runs
        finally:
            if not any(path.is_dir() for path in runs.iterdir()):
                (runs / ".lock").unlink()
                for folder in (runs, out):
                    with contextlib.suppress(OSError):  # it has other files
                        folder.rmdir()


def _command(spec, run, program, threads):
    return [*(run.policy.command or (program, "reconstruct")), f"--threads={threads}", *spec.words(run)]


def _first_of_each(runs):
    """For each policy and each scene, the first run."""
    seen, first = set(), []
    for run in runs:
        of = {("policy", run.policy.name), ("scene", run.object.name, run.sensor, run.voxel, run.size)}
        if not of <= seen:
            first.append(run)
        seen |= of
    return first


def _one_view(words):
    """The same command with a budget of one view, to check its arguments and files before hours of work."""
    return [word if not word.startswith("--max-views=") else "--max-views=1" for word in words]


@contextlib.contextmanager
def _here(jobs, folder):
    """Yields a function that starts a run in a process on this machine and returns a future. An exception in the block kills the running
    processes."""
    children = _Children()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:  # each thread waits for a process
        try:
            yield lambda *run: pool.submit(make_run, *run, folder, children)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            children.kill()
            raise


@contextlib.contextmanager
def _on_cluster(scheduler, progress):
    """As `_here`, on the workers of a Dask cluster."""
    try:
        import distributed
    except ImportError as error:
        raise SpecError(f"--scheduler needs Dask (Debian: python3-distributed), which cannot be imported: {error}") from error
    if not re.fullmatch(r"(\w+://)?\S+:\d+", scheduler):
        raise SpecError(f"--scheduler {scheduler}: expected the address of a scheduler, for example tcp://HOST:8786")
    for name in ("asyncio", "distributed", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # errors are reported by this module
    try:
        client = distributed.Client(scheduler, timeout="10s", set_as_default=False)
    except (OSError, ValueError) as error:
        raise SpecError(f"--scheduler {scheduler}: no scheduler answers: {error}") from error
    with client:
        if not client.nthreads():
            progress(f"{scheduler} has no workers yet; waiting {_WORKERS_WITHIN} s for one")
        try:
            client.wait_for_workers(1, timeout=_WORKERS_WITHIN)
        except (OSError, TimeoutError, distributed.TimeoutError) as error:
            raise SpecError(f"--scheduler {scheduler}: the scheduler has no workers; start one with: dask worker {scheduler}") from error
        futures = []

        def submit(*run):
            futures.append(client.submit(make_run, *run, pure=False))
            return futures[-1]

        try:
            yield submit
        except BaseException:
            with contextlib.suppress(Exception):  # the scheduler may be gone
                client.cancel(futures)
            raise


def _results(futures, title, scheduler):
    """When a future finishes, yields futures[future] and the result of the future, or its RunError."""
    if scheduler is None:
        done = concurrent.futures.as_completed(futures)
    else:
        import distributed

        done = distributed.as_completed(list(futures), loop=next(iter(futures)).client.loop)
    for future in done:
        try:
            yield futures[future], future.result()
        except RunError as error:
            yield futures[future], error
        except Exception as error:  # of a cluster
            cure = "; the workers need this package and scipy" if "ModuleNotFoundError" in repr(error) else ""
            yield futures[future], RunError(f"{title(futures[future])}: on {scheduler}: {type(error).__name__}: {error}{cure}")


def make_runs(spec: Spec, out, jobs: Optional[int] = None, scheduler: Optional[str] = None, program: Optional[str] = None,
              progress: Callable[[str], None] = lambda line: None) -> list[dict]:
    """Makes the runs that are not in ``out/runs/HASH`` yet. On this machine, makes `jobs` runs at a time (default: one per thread). With
    `scheduler`, makes them on the workers of a Dask cluster, which need the program and the files at the same paths. `progress` receives a line
    if runs are reused, and after each run. Returns the rows of all runs, in the order of the spec. Raises SpecError and RunError; finished runs
    are kept."""
    cores = len(os.sched_getaffinity(0))
    threads = max(1, cores // jobs) if jobs and scheduler is None else 1
    program = program or find_program()
    with _study_folder(pathlib.Path(out)) as folder:
        rows = {run.hash: _row(folder / run.hash / "run.json", run, spec.max_views)
                for run in spec.runs if (folder / run.hash / "run.json").exists()}
        missing = [run for run in spec.runs if run.hash not in rows]
        if rows:
            progress(f"{len(rows)} of {len(spec.runs)} runs are done already")
        if missing:
            at = _here(jobs or cores, str(folder.resolve())) if scheduler is None else _on_cluster(scheduler, progress)
            with at as submit:
                def start(run, kept, words):
                    return submit(words, spec.title(run), kept, os.path.dirname(program), bool(run.policy.command))

                _check(spec, {start(run, 0, _one_view(_command(spec, run, program, threads))): run for run in _first_of_each(missing)}, scheduler)
                futures = {start(run, spec.kept_candidates, _command(spec, run, program, threads)): run for run in missing}
                _gather(spec, folder, futures, scheduler, rows, progress)
        return [rows[run.hash] for run in spec.runs]


def _check(spec, futures, scheduler):
    """Raises RunError for the first failed call."""
    for run, made in _results(futures, spec.title, scheduler):
        if isinstance(made, RunError):
            is_word = "--policy" in str(made) and not run.policy.gain and not run.policy.command
            hint = f"; to use a gain, write \"gain:{run.policy.name}\"" if is_word else ""
            raise RunError(f"{spec.path}: {made}{hint}", made.code)
        _row_of(spec, run, made[0], 1)


def _gather(spec, folder, futures, scheduler, rows, progress):
    """Writes the files of each run when it finishes. If runs fail, waits for the remaining runs and then raises RunError."""
    begin, failures, total = time.monotonic(), [], len(spec.runs)
    for done, (run, made) in enumerate(_results(futures, spec.title, scheduler), start=1):
        if not isinstance(made, RunError):
            record, candidates, seconds = made
            try:
                rows[run.hash] = _row_of(spec, run, record, spec.max_views)
                _keep(folder / run.hash, run, record, candidates)
            except RunError as error:
                made = error
        if isinstance(made, RunError):
            failures.append(made)
            progress(str(made))
            continue
        left = (time.monotonic() - begin) / done * (len(futures) - done)
        progress(f"run {total - len(futures) + done} of {total}: {spec.title(run)}, {seconds:.1f} s; {_time_text(left)} left")
    if failures:
        raise RunError(f"{len(failures)} of {total} runs failed. Repeat the call to run them again. The first failure: {failures[0]}", failures[0].code)


def _row_of(spec, run, record, max_views):
    """The row of a run that was just made. Raises RunError if its run.json is invalid."""
    try:
        made_by = record.get("versions", {}).get("viewgain")
        if made_by not in (None, run.configuration["version"]) and run.configuration["version"]:
            raise ValueError(f"viewgain {made_by} made this run, not viewgain {run.configuration['version']}")
        return row_of(run, record, max_views)
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        raise RunError(f"{spec.title(run)}: run.json is invalid: {_fault(error)}", 2) from None


def _keep(folder, run: Run, record, candidates):
    """Writes the files of a run. run.json is the last, so a run that has it is complete."""
    folder.mkdir(exist_ok=True)
    if candidates:
        write_file(folder / "candidates.txt", candidates)
    write_file(folder / "run.json", json.dumps({**record, "configuration": run.configuration}, indent=2) + "\n")


def _row(path, run, max_views):
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if record["configuration"] != run.configuration:
            raise ValueError("its configuration differs from the spec")
        return row_of(run, record, max_views)
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        raise SpecError(f"{path}: the file is invalid: {_fault(error)}; remove the folder of this file and repeat the call") from error


def _time_text(seconds):
    for unit, factor, most in (("s", 1, 120), ("min", 60, 7200), ("h", 3600, math.inf)):
        if seconds < most:
            return f"{math.ceil(seconds / factor)} {unit}"
