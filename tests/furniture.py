#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Reads every OBJ file of Debian's package sweethome3d-furniture with the program.

    tests/furniture.py PROGRAM [--work FOLDER]

Each mesh is scaled to 0.35 m and seen by one simulated frame, which must not be empty. Prints each
refusal and, in the last line, the counts. Ends with 1 if fewer than 99 % of the meshes are read.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

LIBRARIES = pathlib.Path("/usr/share/sweethome3d/furniture")
LEAST = 0.99


def meshes(work):
    """The OBJ files of all libraries, which are zip files, unpacked."""
    for library in sorted(LIBRARIES.glob("*.sh3f")):
        with zipfile.ZipFile(library) as archive:
            for name in sorted(archive.namelist()):
                if name.lower().endswith(".obj"):
                    yield pathlib.Path(archive.extract(name, work / library.stem))


def read(program, mesh, frames):
    """What the program says of a mesh: its JSON, or its error."""
    call = [program, "simulate", mesh, "--size", "0.35", "--place", "center", "--up", "y", "--poses", "orbit:1,0.6,27",
            "--sensor", "sr4000", "--threads", "1", "--json", "--quiet", "--out", frames]
    done = subprocess.run(call, capture_output=True, text=True, timeout=300, check=False)
    shutil.rmtree(frames, ignore_errors=True)
    if done.returncode != 0:
        return done.stderr.strip() or f"ended with {done.returncode}"
    found = json.loads(done.stdout)
    return found if found["readings"] > 0 else "no reading"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("furniture"))
    arguments = parser.parse_args()
    shutil.rmtree(arguments.work, ignore_errors=True)
    paths = list(meshes(arguments.work))
    if not paths:
        sys.exit(f"tests/furniture.py: no meshes in {LIBRARIES}: apps/install_dependencies.sh --furniture")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda i: read(arguments.program, paths[i], arguments.work / f"frames{i}"),
                              range(len(paths))))
    good = [answer for answer in found if isinstance(answer, dict)]
    for path, answer in zip(paths, found):
        if not isinstance(answer, dict):
            print(f"{path.relative_to(arguments.work)}: {answer}")
    print(f"{len(good)} of {len(paths)} meshes read; {sum(a['mended_faces'] for a in good)} faces mended, "
          f"{sum(a['dropped_faces'] for a in good)} without area dropped")
    shutil.rmtree(arguments.work)
    sys.exit(len(good) < LEAST * len(paths))


if __name__ == "__main__":
    main()
