# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""``python3 -m viewgain.study SPEC.toml --out DIR``"""
from __future__ import annotations

import argparse
import csv
import io
import json
import pathlib
import signal
import sys

from . import plots
from .rows import SpecError, early_ends
from .runs import RunError, find_program, make_runs, version_of, write_file
from .spec import read_spec
from .table import table


def _arguments(words):
    parser = argparse.ArgumentParser(
        prog="python3 -m viewgain.study",
        description="Compares policies and gains in one table. Runs `viewgain reconstruct` for each object, policy, seed, sensor, voxel size and "
                    "object size in SPEC. If the study was stopped or killed, the same call continues it.",
        epilog="Files in DIR: results.csv, results.json, table.md, coverage.png, differences.png and runs/. Exit codes: 1 if a run failed, "
               "2 for invalid input, 130 if interrupted.")
    parser.add_argument("spec", metavar="SPEC", type=pathlib.Path,
                        help="TOML file with the lists objects, policies, seeds, sensors and voxels [m], and with max_views; optional keys: sizes [m] "
                             "(a list), against, tolerance [m], flags and kept_candidates")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, required=True, help="folder to write results to")
    parser.add_argument("--jobs", type=int, metavar="N", help="number of parallel runs on this machine (default: number of the processor's threads)")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="Dask scheduler (tcp://HOST:8786) whose workers do the runs; they need the program and the files at the same paths")
    parser.add_argument("--program", metavar="PATH", help="path of the program viewgain (default: next to this package, else on PATH)")
    parser.add_argument("--quiet", action="store_true", help="do not print progress")
    options = parser.parse_args(words)
    if options.jobs is not None and not 1 <= options.jobs <= 1000:
        parser.error(f"--jobs must be in 1..1000, not {options.jobs}")
    if options.jobs is not None and options.scheduler:
        parser.error("--jobs cannot be used with --scheduler, because the cluster decides how many runs are done at once")
    return options


def _check_folder(out, spec):
    """Raises SpecError if the folder has files other than the spec, but no runs/.lock of a study."""
    if out.exists() and not out.is_dir():
        raise SpecError(f"--out {out}: this is a file; choose another folder")
    others = [path for path in out.iterdir() if path.resolve() != spec.resolve()] if out.is_dir() else []
    if others and not (out / "runs/.lock").is_file():
        raise SpecError(f"--out {out}: the folder has files that no study wrote; choose another folder")


def _csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, [key for key in rows[0] if key != "coverage_by_view"], extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _study(options):
    program = find_program(options.program)
    spec = read_spec(options.spec, version_of(program))
    _check_folder(options.out, options.spec)
    voxel = max(run.voxel for run in spec.runs)
    if voxel > spec.tolerance:
        _warn(f"coverage is measured at {1e3 * spec.tolerance:g} mm, less than a voxel of {1e3 * voxel:g} mm; set tolerance = {voxel:g} in the spec")
    said = (lambda line: None) if options.quiet else (lambda line: print(line, file=sys.stderr, flush=True))
    rows = make_runs(spec, options.out, options.jobs, options.scheduler, program, said)
    for line in early_ends(rows, spec.max_views):
        _warn(line)
    text = table(rows, spec.against, spec.max_views, spec.tolerance)
    files = {"results.csv": _csv(rows), "table.md": text, "results.json": json.dumps(rows, indent=2, allow_nan=False) + "\n"}
    for name, content in files.items():
        write_file(options.out / name, content)
    draw = {"coverage.png": lambda: plots.coverage(rows), "differences.png": lambda: plots.differences(rows, spec.against)}
    for name in list(draw)[:1] if len(spec.policies) == 1 else draw:
        try:
            write_file(options.out / name, draw[name]())
            files[name] = None
        except ImportError as error:
            _warn(f"{name} was not drawn: {error}; install matplotlib (Debian: python3-matplotlib) and repeat the call")
        except (ValueError, RuntimeError, MemoryError) as error:
            _warn(f"{name} was not drawn: {error}")
    for name in draw.keys() - files.keys():
        (options.out / name).unlink(missing_ok=True)  # it may be from another spec
    print(f"{text}\nwritten to {options.out}: {', '.join(files)}, runs/")


def _warn(line):
    print(f"warning: {line}", file=sys.stderr)


def main(words=None):
    """Returns the exit code."""
    options = _arguments(words)
    for ended in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(ended, signal.default_int_handler)
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")
    try:
        _study(options)
        return 0
    except KeyboardInterrupt:
        print(f"viewgain.study: stopped; the same call continues with the runs in {options.out}", file=sys.stderr)
        return 130
    except (SpecError, RunError, OSError) as error:
        print(f"viewgain.study: {error}", file=sys.stderr)
        return 2 if isinstance(error, SpecError) or getattr(error, "code", 2) == 2 else 1


if __name__ == "__main__":
    sys.exit(main())
