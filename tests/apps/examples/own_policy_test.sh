#!/usr/bin/env bash
# The example own_policy: a gain of one's own as a policy of a study, from the same starts as the others.
#   own_policy_test.sh SOURCE_FOLDER BIN_FOLDER PYTHON PACKAGE_FOLDER
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
policies = ["sequence", "gain:combined", {name = "own", command = "PYTHON EXAMPLES/own_policy.py"}]
seeds = [1, 2]
sensors = ["sr4000"]
voxels = [0.02]
sizes = [0.3]
max_views = 3
TOML
sed -i "s|PYTHON EXAMPLES|$3 $1/apps/examples|" spec.toml
"$3" -m viewgain.study spec.toml --out study --quiet >/dev/null
"$3" - <<'CHECK'
import json
rows = json.load(open("study/results.json"))
own = [row for row in rows if row["policy"] == "own"]
turntable = [row for row in rows if row["policy"] == "sequence"]
assert [row["seed"] for row in own] == [1, 2] and len(rows) == 6
for a, b in zip(own, turntable):
    assert all(a[key] == b[key] for key in ("object", "sensor", "voxel", "size", "views"))
    first, last = a["coverage_by_view"][0], a["coverage_by_view"][-1]
    assert len(a["coverage_by_view"]) == 3 and first == b["coverage_by_view"][0]  # start, noise and truth are the study's
    assert last > first and last == a["coverage_visible"] and a["auc"] > first
CHECK
