#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Puts the faults of mutants.txt into the code, one at a time, and tells which the tests catch.

    tests/mutate.py BUILD [--only REGEX] [--jobs N] [--work FOLDER]

BUILD is that of preset `release`, up to date; it and the tree stay as they are. A fault costs one object and one link of
a shared library, in a folder of its own, which the tests load in the place of theirs. Ends with 1 where more than one
fault in twenty is missed, or does not compile.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_MISSED = 1 / 20
SECONDS = 300  # a test may hang


class Fault:
    """A block of the table."""

    def __init__(self, number, block):
        head, *rest = block.split("\n")
        path, self.kind, tests = [part.strip() for part in head.split("|")]
        self.number, self.path, self.tests = number, pathlib.PurePosixPath(path), tests.split()
        self.text, self.instead = ("\n".join(line[2:] for line in rest if line[:1] == sign) for sign in "-+")
        self.name = f"{number:2} {path}: {self.kind}"
        source = (ROOT / path).read_text(encoding="utf-8")
        if source.count(self.text) != 1:
            raise SystemExit(f"mutants.txt: {self.name}: its text is {source.count(self.text)} times in the file")
        self.source = source.replace(self.text, self.instead)


def faults():
    table = (ROOT / "tests/mutants.txt").read_text(encoding="utf-8")
    blocks = [block.strip("\n") for block in re.split(r"\n\n+", re.sub(r"(?m)^#.*\n", "", table))]
    return [Fault(i + 1, block) for i, block in enumerate(block for block in blocks if block)]


class Build:
    """What is compiled and linked how."""

    def __init__(self, folder):
        self.folder = folder
        self.commands = {}  # by source: what compiles it, alone or with others of its folder
        for entry in json.loads((folder / "compile_commands.json").read_text()):
            file = pathlib.Path(entry["file"])
            together = re.findall(r'#include "(/[^"]*\.cpp)"', file.read_text()) if file.suffix == ".cxx" else []
            for source in together or [str(file)]:
                self.commands.setdefault(source, entry)
        self.links = {}  # by object: what links the library
        for library in folder.rglob("libviewgain*.so.*.*.*"):
            if "consumer" in library.parts:  # installed there by a test
                continue
            command = subprocess.run(["ninja", "-t", "commands", "-s", str(library.relative_to(folder))], cwd=folder,
                                     check=True, text=True, capture_output=True).stdout.strip()
            self.links.update((word, command) for word in command.split() if word.endswith(".o"))

    def make(self, fault, work):
        """The library with the fault, in work/lib; false if the compiler refuses it."""
        source = ROOT / fault.path
        entry = self.commands[str(source)]
        # As the sources name it: some include themselves, once for each instruction set.
        of_module = pathlib.Path(*fault.path.parts[fault.path.parts.index("src") + 1:])
        mutated = work / "src" / of_module
        mutated.parent.mkdir(parents=True)
        (work / "lib").mkdir()
        mutated.write_text(fault.source, encoding="utf-8")
        unit = pathlib.Path(entry["file"])
        if unit != source:
            unit = work / "unit.cxx"
            unit.write_text(pathlib.Path(entry["file"]).read_text().replace(str(source), str(mutated)))
        else:
            unit = mutated
        out = work / "fault.o"
        compiler, *words = shlex.split(entry["command"])
        good = words[words.index("-o") + 1]
        words[words.index("-o") + 1] = str(out)
        words[words.index("-c") + 1] = str(unit)
        call = [compiler, f"-I{work / 'src'}", "-iquote", str(source.parent), *words, "-w", "-O1"]
        if subprocess.run(call, cwd=entry["directory"], capture_output=True, check=False).returncode != 0:
            return False
        link = self.links[good].replace(f" {good} ", f" {out} ")
        name = re.search(r"-soname,(\S+)", link).group(1)
        link = re.sub(r" -o \S+", f" -o {work / 'lib' / name}", link)
        subprocess.run(link, shell=True, cwd=self.folder, check=True, capture_output=True)
        return True

    def passes(self, test, library=None):
        program, _, tests = test.partition(":")
        environment = dict(os.environ)
        if library:
            environment["LD_LIBRARY_PATH"] = str(library)
        call = [self.folder / "bin" / program, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={tests or '*'}"]
        try:
            run = subprocess.run(call, env=environment, cwd=self.folder, capture_output=True, text=True,
                                 errors="replace", timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return False
        return run.returncode == 0 and "PASSED  ] 0 tests" not in run.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="", help="faults whose number, file and kind match")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutate")
    options = parser.parse_args()
    build = Build(options.build.resolve())
    wanted = [fault for fault in faults() if re.search(options.only, fault.name)]
    shutil.rmtree(options.work, ignore_errors=True)

    def look(fault):
        begin = time.monotonic()
        work = (options.work / str(fault.number)).resolve()
        if not build.make(fault, work):
            return "did not compile", time.monotonic() - begin
        is_caught = not all(build.passes(test, work / "lib") for test in fault.tests)
        shutil.rmtree(work)
        return "caught" if is_caught else "missed", time.monotonic() - begin

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        tests = sorted({test for fault in wanted for test in fault.tests})
        for test, passes in zip(tests, pool.map(build.passes, tests)):
            if not passes:
                raise SystemExit(f"{test} fails without a fault, or has no test")
        results = []
        for fault, (result, seconds) in zip(wanted, pool.map(look, wanted)):
            results.append(result)
            print(f"{fault.name}: {result} ({seconds:.0f} s)", flush=True)
    caught = results.count("caught")
    print(f"{caught} of {len(results)} caught")
    return 1 if len(results) - caught > MOST_MISSED * len(results) else 0


if __name__ == "__main__":
    sys.exit(main())
