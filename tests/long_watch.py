#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Feeds `model --watch` frames of an object from poses that jump about, as quickly as it takes them, and looks for what
grows, what is lost and what differs from the same frames put into a map at once.

    tests/long_watch.py PROGRAM MESH --work FOLDER [--frames 10000]

Ends with 1 where a frame is not counted, where the map is not the one of `integrate`, or where from the second quarter
to the last memory grows by more than 4 kB a frame or a frame takes half as much CPU time again.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import time

POSES = 100
AHEAD = 50  # frames that wait for it
MOST_GROWTH = 4096  # a frame [bytes]
MAP = ("--voxel", "0.0125", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2")
SENSOR = '''format = 1
name = "small"
min_range = 0.1  # [m]
max_range = 3.0  # [m]
working_distance = 0.4  # [m]
[camera]
width = 64
height = 48
fx = 70.0
fy = 70.0
cx = 31.5
cy = 23.5
[noise]
model = "quadratic"
offset = 0.001
quadratic = 0.0
linear = 0.002
'''


def resident(process):
    return int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[1]) * 4096


def cpu_seconds(process):
    words = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def counted(out):
    try:
        return json.loads((out / "next.json").read_text())["frames"]
    except FileNotFoundError:
        return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("mesh")
    parser.add_argument("--work", required=True)
    parser.add_argument("--frames", type=int, default=10000)
    options = parser.parse_args()
    work = pathlib.Path(options.work).resolve()
    shutil.rmtree(work, ignore_errors=True)
    live, out, some = work / "live", work / "out", work / "some"
    live.mkdir(parents=True)
    program = str(pathlib.Path(options.program).resolve())
    (work / "small.toml").write_text(SENSOR)

    def call(*arguments):
        return subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True).stdout

    call("simulate", options.mesh, "--size", "0.35", "--place", "center", "--poses", f"sphere:{POSES},0.6", "--sensor",
         work / "small.toml", "--noise", "on", "--out", some)
    for name in ("sensor.toml", "frames.toml"):
        shutil.copy(some / name, live)
    poses = [line.split() for line in (some / "poses.txt").read_text().splitlines() if not line.startswith("#")]
    order = random.Random(1).choices(range(POSES), k=options.frames)
    process = subprocess.Popen([program, "model", str(live), "--watch", *MAP, "--out", str(out), "--quiet"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    rows = []
    with open(live / "poses.txt", "w", encoding="utf-8") as file:
        given = done = 0
        while done < options.frames:
            while given < min(done + AHEAD, options.frames):
                name = f"frame-{given:06d}.depth.png"
                shutil.copy(some / f"frame-{order[given]:06d}.depth.png", live / f".{name}")
                (live / f".{name}").rename(live / name)
                file.write(" ".join([f"{given / 30:.6f}", *poses[order[given]][1:]]) + "\n")
                given += 1
            file.flush()
            if process.poll() is not None:
                print(f"the watch ended with {process.returncode}: {process.stderr.read()}", file=sys.stderr)
                return 1
            done = counted(out)
            rows.append((done, resident(process), cpu_seconds(process)))
            time.sleep(0.005)
    (live / "done").touch()
    if process.wait() != 0:
        print(f"the watch ended with {process.returncode}: {process.stderr.read()}", file=sys.stderr)
        return 1
    frames = counted(out)
    call("integrate", live, *MAP, "--out", work / "whole.vdb")
    same = call("info", out / "state.vdb", "--json") == call("info", work / "whole.vdb", "--json")

    def quarter(k):
        rows_of = [row for row in rows if options.frames * k <= 4 * row[0] <= options.frames * (k + 1)]
        took = (rows_of[-1][2] - rows_of[0][2]) / max(rows_of[-1][0] - rows_of[0][0], 1)
        return statistics.mean(row[1] for row in rows_of), took

    (before_bytes, before), (bytes_now, now) = quarter(1), quarter(3)
    growth = (bytes_now - before_bytes) / (options.frames / 2)
    print(f"long: {frames} frames followed, {max(row[1] for row in rows) / 1e6:.0f} MB, {growth:+.0f} bytes and {now:.4f} s "
          f"of CPU time a frame, {now / before:.2f} of the second quarter's; the map is {'' if same else 'not '}that of integrate")
    return 0 if frames == options.frames and same and growth <= MOST_GROWTH and now <= 1.5 * before else 1


if __name__ == "__main__":
    sys.exit(main())
