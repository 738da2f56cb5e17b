#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Kills the program at random moments (SIGKILL), calls it again, and compares what comes of it with
what a call leaves that nobody ended.

    tests/kill.py PROGRAM MESH [--kills 100] [--seed 1] [--work FOLDER]

Half of the kills hit `reconstruct --resume` (of a mesh into no folder, over an earlier run, with a report) and `model --resume`, a
quarter `model --watch`, a quarter `python3 -m viewgain.study`. Bytes are compared, but for times: values and
columns named seconds and deciding_seconds, and a table's columns in s. Ends with 1 where anything differs.
"""
import argparse
import difflib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

PACKAGE = str(pathlib.Path(__file__).resolve().parents[1] / "apps/python")  # a study needs no extension module
TIMES = ("seconds", "deciding_seconds")


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def contents(folder):
    """What must be the same, by path; hidden files too."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir():
            found[name] = None
        elif path.suffix == ".json":
            found[name] = json.dumps(without_times(json.loads(path.read_text())))
        elif path.suffix == ".csv":
            rows = [line.split(",") for line in path.read_text().splitlines()]
            kept = [i for i, key in enumerate(rows[0]) if key not in TIMES]
            found[name] = [[row[i] for i in kept if i < len(row)] for row in rows]
        elif path.suffix == ".md":  # a table's columns of times
            columns, found[name] = [], []
            for line in path.read_text().splitlines():
                cells = line.split("|")
                if not line.startswith("|"):
                    columns = []
                elif not columns:
                    columns = [i for i, cell in enumerate(cells) if "[s]" in cell or "s per view" in cell]
                found[name].append([cell for i, cell in enumerate(cells) if i not in columns])
        elif path.suffix == ".html":
            found[name] = re.sub(r'"seconds":\{[^}]*\}', "", path.read_text())
        else:
            found[name] = path.read_bytes()
    return found


class Kills:
    """Ends calls at random moments until the budget is spent."""

    def __init__(self, program, work, seed):
        self.program, self.work, self.random = program, work, random.Random(seed)
        self.kills = self.late = self.runs = 0
        self.failures = []

    def start(self, arguments):
        call = [self.program, *arguments]
        if arguments[0] == "study":
            call = [sys.executable, "-m", "viewgain.study", *arguments[1:], "--program", self.program]
        return subprocess.Popen(call, env={**os.environ, "PYTHONPATH": PACKAGE}, cwd=self.work, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE)

    def run(self, arguments):
        """To the end; how long it took [s]."""
        begin = time.monotonic()
        process = self.start(arguments)
        error = process.communicate()[1].decode(errors="replace")
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(arguments)}: {process.returncode}: {error}")
        return time.monotonic() - begin

    def kill(self, process, within):
        """Whether it was still alive."""
        time.sleep(self.random.uniform(0, within))
        is_alive = process.poll() is None
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.kills += is_alive
        self.late += not is_alive
        return is_alive

    def compare(self, name, out, expected):
        self.runs += 1
        found = contents(self.work / out)
        differ = [key for key in sorted(found.keys() | expected.keys())
                  if found.get(key, 0) != expected.get(key, 0)]
        if differ:
            self.failures.append(f"{name}: {' '.join(differ)}")
            for key in differ:
                pair = [value.split(b"\n") if isinstance(value, bytes) else [value]
                        for value in (expected.get(key), found.get(key))]
                for line in difflib.ndiff(*[[repr(line)[:300] for line in lines] for lines in pair]):
                    if line[0] in "+-":
                        print(line, file=sys.stderr)

    def of_calls(self, name, arguments, count, before=None):
        """Kills calls and calls them again until `count` kills were made."""
        whole = [*arguments, "--out", "whole"]
        seconds = self.run(whole)
        expected = contents(self.work / "whole")
        shutil.rmtree(self.work / "whole")
        end = self.kills + count
        while self.kills < end:
            shutil.rmtree(self.work / "out", ignore_errors=True)
            for path in self.work.glob(".out.tmp-*"):
                shutil.rmtree(path)
            if before:
                self.run([*before, "--out", "out"])
            for _ in range(self.random.choice((1, 1, 2, 3))):
                if self.kills == end:
                    break
                if not self.kill(self.start([*arguments, "--out", "out"]), seconds):
                    seconds *= 0.9  # the machine has become quicker
                    break
            self.run([*arguments, "--out", "out"])
            self.compare(name, "out", expected)
            if list(self.work.glob(".out.tmp-*")):
                self.failures.append(f"{name}: leaves a hidden folder")
        print(f"{name}: {count} kills", flush=True)

    def of_watch(self, frames, count):
        """Frames come one by one, as a robot takes them: each when the one before is counted."""
        names = sorted(path.name for path in frames.glob("*.depth.png"))
        poses = (frames / "poses.txt").read_text().splitlines(keepends=True)
        arguments = ["model", "live", "--watch", "--voxel", "0.0125", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
                     "--out", "out"]

        def feed(kill_times):
            for folder in ("live", "out"):
                shutil.rmtree(self.work / folder, ignore_errors=True)
            live = self.work / "live"
            live.mkdir()
            for name in ("sensor.toml", "frames.toml"):
                shutil.copy(frames / name, live)
            (live / "poses.txt").write_text(poses[0] if poses[0].startswith("#") else "")
            lines = [line for line in poses if not line.startswith("#")]
            begin = time.monotonic()
            process = self.start(arguments)
            for i, name in enumerate(names):
                for amplitude in (name, name.replace("depth", "amplitude")):
                    if (frames / amplitude).exists():
                        shutil.copy(frames / amplitude, live / f".{amplitude}")
                        (live / f".{amplitude}").rename(live / amplitude)
                with open(live / "poses.txt", "a", encoding="utf-8") as file:
                    file.write(lines[i])
                while not is_counted(i + 1):
                    if kill_times and time.monotonic() - begin > kill_times[0]:
                        kill_times.pop(0)
                        self.kill(process, 0)
                        process = self.start(arguments)
                    elif process.poll() is not None:
                        raise RuntimeError(f"the watch ended: {process.stderr.read().decode()}")
                    time.sleep(0.005)
            (live / "done").touch()
            if process.wait() != 0:
                raise RuntimeError(f"the watch ended: {process.stderr.read().decode()}")
            return time.monotonic() - begin

        def is_counted(least):
            try:
                return json.loads((self.work / "out/next.json").read_text())["frames"] >= least
            except FileNotFoundError:
                return False

        seconds = feed([])
        expected = contents(self.work / "out")
        end = self.kills + count
        while self.kills < end:
            few = min(self.random.choice((1, 2, 3)), end - self.kills)
            feed(sorted(self.random.uniform(0, seconds) for _ in range(few)))
            self.compare("watch", "out", expected)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("mesh")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", required=True)
    parser.add_argument("--only", choices=("reconstruct", "watch", "study"))
    options = parser.parse_args()
    work = pathlib.Path(options.work).resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    mesh = str(pathlib.Path(options.mesh).resolve())
    kills = Kills(str(pathlib.Path(options.program).resolve()), work, options.seed)
    eighth, quarter = options.kills // 8, options.kills // 4

    camel = ["reconstruct", mesh, "--size", "0.35", "--sensor", "sr4000", "--voxel", "0.0125", "--up", "y",
             "--max-views", "5", "--resume"]
    kills.run(["simulate", mesh, "--size", "0.35", "--place", "center", "--sensor", "sr4000", "--poses",
               "orbit:5,0.6,27", "--noise", "on", "--out", "frames"])
    of_frames = ["model", "frames", "--voxel", "0.0125", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
                 "--resume"]
    earlier = ["reconstruct", mesh, "--size", "0.35", "--sensor", "sr4000", "--voxel", "0.025", "--max-views", "1",
               "--pictures", "off"]
    if options.only in (None, "reconstruct"):
        kills.of_calls("camel", [*camel, "--save-maps", "on"], 2 * quarter - 3 * eighth)
        kills.of_calls("camel over another", camel, eighth, before=earlier)
        kills.of_calls("camel with a report", [*camel, "--report", "on"], eighth)
        kills.of_calls("camel's frames", of_frames, eighth)
    if options.only in (None, "watch"):
        kills.of_watch(work / "frames", quarter)
    (work / "spec.toml").write_text(f'''objects = ["{mesh}"]
policies = ["gain:combined", "random"]
seeds = [1, 2]
sensors = ["sr4000"]
voxels = [0.0125]
sizes = [0.35]
max_views = 2
tolerance = 0.0125
''')
    if options.only in (None, "study"):
        kills.of_calls("study", ["study", "spec.toml", "--quiet"], quarter)

    for failure in kills.failures:
        print(failure, file=sys.stderr)
    print(f"kill: {kills.kills} kills, {kills.late} calls were done before theirs; {kills.runs} results compared, "
          f"{len(kills.failures)} differ")
    return 1 if kills.failures else 0


if __name__ == "__main__":
    sys.exit(main())
