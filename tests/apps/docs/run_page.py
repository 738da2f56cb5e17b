#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the blocks of a page of the site in their order, in a folder of their own.

    run_page.py SOURCE_FOLDER BIN_FOLDER PAGE

`python` blocks share their names; `sh` blocks run by bash with the program in PATH; a `toml` block is the file that its first
line names; `console` blocks name scripts, presets and targets that are there. `cpp` blocks are compiled by
another test. Git ignores what the blocks write. Needs PYTHONPATH.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from page_blocks import blocks_of


def check_console(source, block, where):
    """What a user is told to type: `$ ` and a script, a preset or a target of the repository."""
    presets = json.loads((source / "CMakePresets.json").read_text(encoding="utf-8"))
    for line in block.code.splitlines():
        command = re.fullmatch(r"\$ (.+)", line)
        assert command, f"{where}: {line!r} does not begin with '$ '"
        words = command[1].split()
        if words[0].startswith("./"):
            script = source / words[0]
            assert os.access(script, os.X_OK), f"{where}: no script {words[0]}"
            text = script.read_text(encoding="utf-8")
            missing = [word for word in words[1:] if word.startswith("--") and word not in text]
            assert not missing, f"{where}: {words[0]} has no {missing}"
        elif words[0] == "cmake":
            kind = "buildPresets" if "--build" in words else "configurePresets"
            preset = words[words.index("--preset") + 1]
            assert preset in [p["name"] for p in presets[kind]], f"{where}: no preset {preset}"
            if "--target" in words:
                target = words[words.index("--target") + 1]
                files = [p for folder in ("apps", "perf", "tests") for p in (source / folder).rglob("CMakeLists.txt")]
                assert any(re.search(rf"add_custom_target\({target}\s", p.read_text(encoding="utf-8")) for p in files), f"{where}: no target {target}"
        else:
            assert words[0] == "export", f"{where}: who knows whether {line!r} works?"


def main():
    source, binaries, page = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    blocks = blocks_of(page)
    environment = os.environ | {"PATH": f"{binaries}:{os.path.dirname(sys.executable)}:{os.environ['PATH']}", "MPLBACKEND": "agg"}
    os.environ.update(environment)
    names, ran = {"__name__": "__main__"}, 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if "meshes/" in page.read_text(encoding="utf-8"):
            subprocess.run([source / "apps/extract_mesh.sh", "camel.off", "meshes"], check=True)
        for block in blocks:
            where = f"{page.relative_to(source)}:{block.line}"
            print(f"-- {where} {block.language}", flush=True)
            if block.language == "python":
                exec(compile("\n" * (block.line - 1) + block.code, str(page), "exec"), names)
            elif block.language == "sh":
                result = subprocess.run(["bash", "-euo", "pipefail", "-c", block.code], text=True, stdin=subprocess.DEVNULL)
                assert result.returncode == 0, f"{where}: exit code {result.returncode}"
            elif block.language == "toml":
                name = re.match(r"# (\w+\.toml)\n", block.code)
                assert name, f"{where}: the first line of a file names it"
                pathlib.Path(name[1]).write_text(block.code, encoding="utf-8")
            elif block.language == "console":
                check_console(source, block, where)
            ran += 1
        os.chdir(source)
        subprocess.run([source / "tests/root_test.py", source, "--written", folder], check=True)
    assert ran == len(blocks)
    print(f"{ran} blocks of {page.relative_to(source)}")


if __name__ == "__main__":
    main()
