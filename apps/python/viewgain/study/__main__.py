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
import subprocess
import sys

from . import plots
from .rows import SpecError
from .runs import RunError, find_program, make_runs, write_text
from .spec import read_spec
from .table import table


def _arguments(words):
    parser = argparse.ArgumentParser(
        prog="python3 -m viewgain.study",
        description="Compares policies and gains: a run of `viewgain reconstruct` for every object, policy, seed, sensor, voxel and size of "
                    "a spec, in one table. If it was stopped or killed, the same call goes on with what is there.",
        epilog="DIR gets results.csv, results.json, table.md, coverage.png, differences.png and runs/. Exit code 2: something given is "
               "wrong; 130: it was stopped.")
    parser.add_argument("spec", metavar="SPEC", type=pathlib.Path,
                        help="TOML file: lists objects, policies, seeds, sensors and voxels [m], and max_views; as you like also a list "
                             "of sizes [m], against, tolerance [m], flags and kept_candidates")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, required=True, help="folder for results")
    parser.add_argument("--jobs", type=int, metavar="N", help="runs at once on this machine; default: as many as it has threads")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="of a Dask cluster (tcp://HOST:8786), whose workers make the runs; they need the program and the files by the same names")
    parser.add_argument("--program", metavar="PATH", help="the program viewgain; default: that beside this package, else on PATH")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    options = parser.parse_args(words)
    if options.jobs is not None and not 1 <= options.jobs <= 1000:
        parser.error(f"--jobs must be in 1..1000, not {options.jobs}")
    if options.jobs is not None and options.scheduler:
        parser.error("--jobs goes without --scheduler: a cluster's workers have threads of their own")
    return options


def _check_folder(out, spec):
    """A study's folder has runs/; another one that holds more than the spec is somebody else's."""
    if out.exists() and not out.is_dir():
        raise SpecError(f"--out {out}: is a file; name a new folder")
    others = [path for path in out.iterdir() if path.resolve() != spec.resolve()] if out.is_dir() else []
    if others and not (out / "runs").is_dir():
        raise SpecError(f"--out {out}: has files, but no runs/ of a study; name a new folder")


def _csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, [key for key in rows[0] if key != "coverage_by_view"], extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _version(program):
    return subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.split()[-1]


def _study(options):
    program = find_program(options.program)
    spec = read_spec(options.spec, _version(program))
    _check_folder(options.out, options.spec)
    voxel = max(run.voxel for run in spec.runs)
    if voxel > spec.tolerance:
        print(f"warning: coverage is counted to {1e3 * spec.tolerance:g} mm, finer than voxels of {1e3 * voxel:g} mm "
              f"(tolerance = {voxel:g} in the spec)", file=sys.stderr)
    said = (lambda line: None) if options.quiet else (lambda line: print(line, file=sys.stderr, flush=True))
    rows = make_runs(spec, options.out, options.jobs, options.scheduler, program, said)
    text = table(rows, spec.against, spec.max_views, spec.tolerance)
    files = {"results.csv": _csv(rows), "table.md": text, "results.json": json.dumps(rows, indent=2, allow_nan=False) + "\n"}
    try:
        files["coverage.png"] = plots.coverage(rows)
        if len(spec.policies) > 1:
            files["differences.png"] = plots.differences(rows, spec.against)
    except ImportError as error:
        print(f"warning: no plots: {error}; the same call draws them where matplotlib is (Debian: python3-matplotlib)", file=sys.stderr)
    for name in ("coverage.png", "differences.png"):
        if name not in files:
            (options.out / name).unlink(missing_ok=True)  # of another spec perhaps
    for name, content in files.items():
        write_text(options.out / name, content)
    print(f"{text}\nleft in {options.out}: {', '.join(files)}, runs/")


def main(words=None):
    """Returns the exit code."""
    options = _arguments(words)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        _study(options)
        return 0
    except KeyboardInterrupt:
        print(f"viewgain.study: stopped; the same call goes on with what is in {options.out}", file=sys.stderr)
        return 130
    except (SpecError, RunError, OSError) as error:
        print(f"viewgain.study: {error}", file=sys.stderr)
        return 2 if isinstance(error, SpecError) or getattr(error, "code", 2) == 2 else 1


if __name__ == "__main__":
    sys.exit(main())
