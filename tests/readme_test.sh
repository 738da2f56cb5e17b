#!/usr/bin/env bash
# The README's C++ example is the file that is built, it runs, and the README names the two commands.
#   readme_test.sh SOURCE_FOLDER BIN_FOLDER
set -euo pipefail
source=$1
bin=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

awk '/^```cpp$/ {inside = 1; next} /^```$/ {inside = 0} inside' "$source/README.md" >"$work/example.cpp"
diff -u "$source/apps/examples/score_poses.cpp" "$work/example.cpp"
grep -q '^\./apps/demo\.sh' "$source/README.md"
grep -q '^\./tests/run\.sh' "$source/README.md"

cat >"$work/box.off" <<'MESH'
OFF
8 6 0
-1 -1 -1
1 -1 -1
1 1 -1
-1 1 -1
-1 -1 1
1 -1 1
1 1 1
-1 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 2 3 7 6
4 1 2 6 5
4 0 4 7 3
MESH
"$bin/viewgain" simulate "$work/box.off" --orbit 1,0.6,20 --sensor sr4000 --size 0.2 --out "$work/frames" >/dev/null
"$bin/viewgain" integrate "$work/frames" --voxel 0.01 --workspace -0.2,-0.2,-0.2,0.2,0.2,0.2 \
  --out "$work/map.vdb" >/dev/null
"$bin/score_poses" "$work/map.vdb" | tee "$work/best.txt"
test "$(grep -cE '^pose [0-9]+: [0-9.]+ nat$' "$work/best.txt")" -eq 3
