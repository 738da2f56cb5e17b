#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of keys are those of the program.

json.md has a section per subcommand. Every key that the program prints has a row there, or in the table of the object
that holds it, with the type of its value; every row is a key that a call here prints. formats.md has the keys of
sensor files and of frames.toml.

    reference_test.py SOURCE_FOLDER BIN_FOLDER
"""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

CALLS = {
    "simulate": "simulate meshes/camel.off --size 0.35 --poses sphere:2,0.6 --sensor sr4000 --out frames",
    "integrate": "integrate frames --voxel 0.01 --out map.vdb",
    "integrate --register": "integrate frames --voxel 0.01 --register on --out registered.vdb",
    "convert": "convert map.vdb map.ot",
    "info": "info map.vdb --workspace=-0.1,-0.1,-0.1,0.1,0.1,0.1",
    "score": "score map.vdb --poses sphere:20,0.6 --top 2 --cost-per-metre 1 --out scores.csv",
    "score --set": "score map.vdb --poses sphere:20,0.6 --set 2",
    "score --approximate": "score map.vdb --poses sphere:20,0.6 --approximate 0.2",
    "score --gain": "score map.vdb --poses sphere:20,0.6 --gain unknown_count",
    "reconstruct": "reconstruct meshes/camel.off --size 0.35 --sensor sr4000 --voxel 0.01 --register on --max-views 2 --out run",
    "model": "model frames --voxel 0.01 --register on --plan 2 --pictures off --out model",
    "integrate --cloud": "integrate --cloud model/points.ply --origin 0,0,1 --sensor sr4000 --voxel 0.01 --out clouds.vdb",
    "next": "next run/map.vdb --top 2 --explain",
    "next without a gain": "next seen.vdb --poses away.txt --explain",
    "next --plan": "next run/map.vdb --plan 2",
    "next --top": "next run/map.vdb --top all --generator sphere,boundary",
    "model --watch": "model frames --watch --voxel 0.01 --workspace=-0.2,-0.2,-0.2,0.2,0.2,0.2 --out watched",
    "import": "import RECORDINGS/arm_zstd.mcap --out imported",
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
# Looks away from the map.
AWAY = "0 0 0 -5 1 0 0 0\n"
POSES = "0 0 0 0 0 0 0 1\n1 0 0 0.3 0 0 0 1\n"
# Objects whose keys are data: reasons, stages, gains by name.
OPEN = {"dropped", "final_dropped", "bad", "seconds", "settings", "versions"}
# The types of the tables. A count is a whole number that is not negative.
TYPES = {"count": int, "number": (int, float), "text": str, "boolean": bool, "list": list, "object": dict, "pose": list, "box": list}
# Rows of a flag that no call here has.
NOT_PRINTED = {"left_out", "distances", "rms_before", "rms_after", "offset_sigma", "error", "residual"}  # calibrate --range
ROW = re.compile(r"\| `(\w+)` \| (\w+)\b(.*?)\|")
HOLDER = re.compile(r"(?:Each of|In) ((?:`\w+`(?:, | and )?)+)")


def keys_of(value, under=""):
    """(the key that holds it, key, value) of all objects."""
    if isinstance(value, list):
        for entry in value:
            yield from keys_of(entry, under)
    elif isinstance(value, dict) and under not in OPEN:
        for key, entry in value.items():
            yield under, key, entry
            yield from keys_of(entry, key)


def is_of(value, kind, rest):
    if value is None:
        return "null" in rest
    if isinstance(value, bool) != (kind == "boolean") or not isinstance(value, TYPES[kind]):
        return False
    return kind != "count" or value >= 0


def sections_of(page):
    parts = re.split(r"(?m)^## (.+)$", page.read_text(encoding="utf-8"))
    return dict(zip(parts[1::2], parts[2::2]))


def rows_of(section):
    """{(the key that holds it, key): [(type, the rest of its cell)]}: a heading ends what is said of a holder."""
    rows, holders = {}, [""]
    for line in section.splitlines():
        row, holder = ROW.match(line), HOLDER.match(line)
        if line.startswith("#"):
            holders = [""]
        elif holder:
            holders = re.findall(r"`(\w+)`", holder[1])
        elif row:
            for name in holders:
                rows.setdefault((name, row[1]), []).append((row[2], row[3]))
    return rows


class Tables:
    """The rows of json.md, and which of them have been printed."""

    def __init__(self, page):
        self.sections = {name: rows_of(text) for name, text in sections_of(page).items()}
        self.printed, self.faults = set(), []

    def find(self, section, holder, key):
        places = [(section, holder)] + [(other, holder) for other in self.sections if holder] + [(section, "")] * (holder == "per_view")
        for place, name in places:
            if (name, key) in self.sections[place]:
                self.printed.add((place, name, key))
                return self.sections[place][name, key]
        return None

    def check(self, call, section, output):
        keys = 0
        gains = set(output.get("gains", [])) if isinstance(output, dict) else set()
        for holder, key, value in keys_of(output):
            types = self.find(section, holder, key)
            keys += 1
            if types is None and key not in gains:
                self.faults.append(f"json.md: {call} has a key `{key}`" + f" in `{holder}`" * bool(holder) + " that is not there")
            elif types and not any(is_of(value, kind, rest) for kind, rest in types):
                said = " or ".join((kind + rest).strip() for kind, rest in types)
                self.faults.append(f"json.md: {call}: `{key}` is {json.dumps(value)[:60]}, not {said}")
        return keys

    def not_printed(self):
        for section, rows in self.sections.items():
            for holder, key in rows:
                if (section, holder, key) not in self.printed and key not in NOT_PRINTED:
                    yield f"json.md: no call prints `{key}`" + f" in `{holder}`" * bool(holder) + f", {section}"


def study_of(source, folder, environment):
    """results.json of a study of one run."""
    spec = 'objects = ["meshes/camel.off"]\npolicies = ["gain:paper"]\nseeds = [1]\nsensors = ["sr4000"]\nvoxels = [0.02]\nsizes = [0.35]\nmax_views = 2\n'
    pathlib.Path(folder, "small.toml").write_text(spec, encoding="utf-8")
    subprocess.run([sys.executable, "-m", "viewgain.study", "small.toml", "--out", "study"], cwd=folder, capture_output=True, check=True,
                   env=environment | {"PYTHONPATH": str(source / "apps/python"), "PYTHONDONTWRITEBYTECODE": "1"})
    return json.loads(pathlib.Path(folder, "study/results.json").read_text(encoding="utf-8"))


def value_of(text):
    """Of a cell of a CSV file."""
    try:
        return int(text) if text.isdigit() else float(text)
    except ValueError:
        return text


def toml_keys(file):
    """All keys of a TOML file, those of its tables too."""
    return {key for _, key, _ in keys_of(tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8")))}


def main():
    source, binaries = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    program, environment = binaries / "viewgain", os.environ | {"PATH": f"{binaries}:{os.environ['PATH']}"}
    shown = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    subcommands = set(re.findall(r"(?m)^  ([a-z]+) {5,}\S", shown))
    assert len(subcommands) >= 12, subcommands
    tables = Tables(source / "apps/docs/reference/json.md")
    faults = [f"json.md: no section of {name}" for name in sorted(subcommands - tables.sections.keys())]
    formats = sections_of(source / "apps/docs/reference/formats.md")
    keys = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([source / "apps/extract_mesh.sh", "camel.off", f"{folder}/meshes"], check=True)
        for file, text in {"wall.off": WALL, "static.off": STATIC, "poses.txt": POSES, "away.txt": AWAY,
                           "pose.txt": POSES.splitlines()[0]}.items():
            pathlib.Path(folder, file).write_text(text, encoding="utf-8")
        for call in ["simulate wall.off --poses poses.txt --sensor sr4000 --out wall",
                     "simulate static.off --poses pose.txt --sensor sr4000 --noise on --frames-per-view 30 --out static",
                     "integrate wall --voxel 0.1 --workspace=-1,-1,0.5,1,1,1.5 --out seen.vdb"]:
            subprocess.run([program, *call.split()], cwd=folder, capture_output=True, check=True)
        for name, call in CALLS.items():
            if name == "model --watch":
                pathlib.Path(folder, "frames/done").touch()
            words = call.replace("RECORDINGS", str(source / "tests/data/recordings")).split()
            result = subprocess.run([program, *words, "--json", "--quiet"], cwd=folder, capture_output=True, text=True)
            assert result.returncode == 0, f"{call}: {result.stderr}"
            keys += tables.check(name, name.split()[0], json.loads(result.stdout))
        for section, file in {"reconstruct": "run/run.json", "model": "watched/next.json"}.items():
            keys += tables.check(file, section, json.loads(pathlib.Path(folder, file).read_text(encoding="utf-8")))
        keys += tables.check("a study", "Studies", study_of(source, folder, environment))
        with open(f"{folder}/scores.csv", newline="", encoding="utf-8") as scores:
            row = next(csv.DictReader(scores))
        keys += tables.check("scores.csv", "score", {column: value_of(text) for column, text in row.items()})
        for section, file in {"Sensor files": "frames/sensor.toml", "Folders of frames": "frames/frames.toml"}.items():
            found, said = toml_keys(pathlib.Path(folder, file)), set(re.findall(r"(?m)^\| `(\w+)` \|", formats[section]))
            faults += [f"formats.md: {file} has a key `{key}` that is not there" for key in sorted(found - said)]
            keys += len(found)
    faults += [*tables.faults, *tables.not_printed()]
    print(f"{len(CALLS)} calls, {keys} keys")
    assert keys > 500, keys
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
