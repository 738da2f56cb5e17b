#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The page of keys says what there is: every subcommand has a section, and every key that it prints stands there.

    reference_test.py SOURCE_FOLDER BIN_FOLDER
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

CALLS = {
    "simulate": "simulate meshes/camel.off --size 0.35 --poses sphere:2,0.6 --sensor sr4000 --out frames",
    "integrate": "integrate frames --voxel 0.01 --out map.vdb",
    "convert": "convert map.vdb map.ot",
    "info": "info map.vdb --workspace=-0.1,-0.1,-0.1,0.1,0.1,0.1",
    "score": "score map.vdb --poses sphere:20,0.6 --top 2",
    "score --set": "score map.vdb --poses sphere:20,0.6 --set 2",
    "score --approximate": "score map.vdb --poses sphere:20,0.6 --approximate 0.2",
    "score --gain": "score map.vdb --poses sphere:20,0.6 --gain unknown_count",
    "reconstruct": "reconstruct meshes/camel.off --size 0.35 --sensor sr4000 --voxel 0.01 --max-views 2 --out run",
    "model": "model frames --voxel 0.01 --pictures off --out model",
    "next": "next run/map.vdb --top 2",
    "next --plan": "next run/map.vdb --plan 2",
    "next --top": "next run/map.vdb --top all --generator sphere,boundary",
    "model --watch": "model frames --watch --voxel 0.01 --workspace=-0.2,-0.2,-0.2,0.2,0.2,0.2 --out watched",
    "calibrate": "calibrate --noise static --out measured.toml",
    "surface": "surface run/map.vdb --out surface.ply --truth meshes/camel.off --size 0.35 --place center",
    "render": "render run sigma --out sigma.png",
    "sensors": "sensors",
}
WALL = "OFF\n4 2 0\n-3 -3 1\n3 -3 1\n3 3 1\n-3 3 1\n3 0 1 2\n3 0 2 3\n"
# A wall with a box's front before it.
STATIC = """OFF
8 2 0
-3 -3 1.5
3 -3 1.5
3 3 1.5
-3 3 1.5
-0.15 -0.2 1
0.17 -0.2 1
0.17 0.22 1
-0.15 0.22 1
4 0 1 2 3
4 4 5 6 7
"""
POSES = "0 0 0 0 0 0 0 1\n1 0 0 0.3 0 0 0 1\n"
# Objects whose keys are data: reasons, stages, gains by name.
OPEN = {"dropped", "final_dropped", "seconds", "settings", "versions"}


def keys_of(value, under=""):
    if isinstance(value, list):
        for entry in value:
            yield from keys_of(entry, under)
    elif isinstance(value, dict) and under not in OPEN:
        for key, entry in value.items():
            yield key
            yield from keys_of(entry, key)


def sections_of(page):
    parts = re.split(r"(?m)^## (.+)$", page.read_text(encoding="utf-8"))
    return dict(zip(parts[1::2], parts[2::2]))


def main():
    source, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve() / "viewgain"
    faults, keys = [], 0
    shown = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    subcommands = set(re.findall(r"(?m)^  ([a-z]+) {5,}\S", shown))
    assert len(subcommands) >= 12, subcommands
    sections = sections_of(source / "apps/docs/reference/json.md")
    faults += [f"json.md: no section of {name}" for name in sorted(subcommands - sections.keys())]
    gains = set()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([source / "apps/extract_mesh.sh", "camel.off", f"{folder}/meshes"], check=True)
        for file, text in {"wall.off": WALL, "static.off": STATIC, "poses.txt": POSES,
                           "pose.txt": POSES.splitlines()[0]}.items():
            pathlib.Path(folder, file).write_text(text, encoding="utf-8")
        for call in ["simulate wall.off --poses poses.txt --sensor sr4000 --out wall",
                     "simulate static.off --poses pose.txt --sensor sr4000 --noise on --frames-per-view 30 --out static"]:
            subprocess.run([program, *call.split()], cwd=folder, capture_output=True, check=True)
        for name, call in CALLS.items():
            if name == "model --watch":
                pathlib.Path(folder, "frames/done").touch()
            result = subprocess.run([program, *call.split(), "--json", "--quiet"], cwd=folder, capture_output=True, text=True)
            assert result.returncode == 0, f"{call}: {result.stderr}"
            output = json.loads(result.stdout)
            if name == "score --gain":
                gains = set(output["gains"])
            said = set(re.findall(r"`(\w+)`", sections[name.split()[0]]))
            found = set(keys_of(output)) - gains
            keys += len(found)
            faults += [f"json.md: {name} has a key `{key}` that is not there" for key in sorted(found - said)]
    print(f"{len(CALLS)} calls, {keys} keys")
    assert keys > 150, keys
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
