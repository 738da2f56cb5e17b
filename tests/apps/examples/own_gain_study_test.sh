#!/usr/bin/env bash
# The example own_gain_study: rows of a gain of one's own stand beside a study's, made as these are.
#   own_gain_study_test.sh SOURCE_FOLDER BIN_FOLDER PYTHON PACKAGE_FOLDER
set -euo pipefail
export PATH=$2:$PATH PYTHONPATH=$4 PYTHONDONTWRITEBYTECODE=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >block.off <<'MESH'
OFF
8 6 0
0 0 0
3 0 0
3 2 0
0 2 0
0 0 2
3 0 2
3 2 2
0 2 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
MESH
cat >spec.toml <<'TOML'
objects = ["block.off"]
policies = ["sequence", "gain:combined"]
seeds = [1, 2]
sensors = ["sr4000"]
voxels = [0.02]
sizes = [0.3]
max_views = 3
TOML
viewgain study spec.toml --out study --plots off --quiet
"$3" "$1/apps/examples/own_gain_study.py" spec.toml study
"$3" - <<'CHECK'
import json
rows = json.load(open("study/results.json"))
own = [row for row in rows if row["policy"] == "own"]
turntable = [row for row in rows if row["policy"] == "sequence"]
assert [row["seed"] for row in own] == [1, 2] and len(rows) == 6
for a, b in zip(own, turntable):
    assert a.keys() == b.keys()
    assert all(a[key] == b[key] for key in ("object", "sensor", "voxel", "size", "views"))
    first, last = a["coverage_by_view"][0], a["coverage_by_view"][-1]
    assert len(a["coverage_by_view"]) == 3 and first == b["coverage_by_view"][0]  # start, noise and truth are the study's
    assert last > first and last == a["coverage_visible"] and a["auc"] > first
CHECK
if "$3" -c 'import matplotlib' 2>/dev/null; then
  "$3" study/plots.py
  test -s study/coverage.png
fi
