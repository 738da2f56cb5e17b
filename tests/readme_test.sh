#!/usr/bin/env bash
# Every block of code in the README is what it says and runs: the C++ is the file that is built, the
# CMake lines are those of the consumer test, the Python and the commands run on maps of a camel, coarser
# than the README's so that they take seconds. Git ignores what they write. The README has at most 800 words
# and lines of 100.
#   readme_test.sh SOURCE_FOLDER BIN_FOLDER [PYTHON PACKAGE_FOLDER]
set -euo pipefail
source=$1
bin=$2
work=$(mktemp -d)
log=$(mktemp -d)  # what this test writes, not the README
trap 'rm -rf "$work" "$log"' EXIT
export PATH=$bin:$PATH

# block LANGUAGE: the lines of the README's blocks in this language
block() { awk -v fence="^\`\`\`$1\$" '$0 ~ fence {inside = 1; next} /^```$/ {inside = 0} inside' "$source/README.md"; }

words=$(wc -w <"$source/README.md")
[ "$words" -le 800 ] || { echo "README.md: $words words" >&2; exit 1; }
python3 - "$source/README.md" <<'LINES'
import sys
long = [i for i, line in enumerate(open(sys.argv[1], encoding="utf-8"), 1) if len(line.rstrip("\n")) > 100]
sys.exit(f"README.md: lines over 100 columns: {long}" if long else 0)
LINES
# What it shows and links is there.
grep -oE '\]\([^)#]+' "$source/README.md" | sed 's/](//' | while read -r path; do
  test -e "$source/$path" || { echo "README.md: there is no $path" >&2; exit 1; }
done

block cpp >"$log/example.cpp"
diff -u "$source/apps/examples/score_poses.cpp" "$log/example.cpp"
block cmake | sed 's/ *#.*//' | while read -r line; do
  grep -qF "${line//planner/gain}" "$source/tests/consumer/find_package/CMakeLists.txt" ||
    grep -qF "${line%% REQUIRED)}" "$source/tests/consumer/find_package/CMakeLists.txt"
done
block sh | grep -q '^\./apps/demo\.sh'
block sh | grep -q '^\./tests/run\.sh'

cd "$work"
"$source/apps/extract_mesh.sh" camel.off build/meshes
commands=$(block sh | sed ':a; /\\$/ {N; s/\\\n *//; ta}' | grep '^viewgain' | sed 's/--voxel 0.003125/--voxel 0.01 --max-views 3/')
test "$(wc -l <<<"$commands")" -eq 3
if [ ! -s "$bin/../apps/show/report/report_page.html" ]; then  # built without npm
  commands=$(sed 's/--report on//; s/--report score.html//' <<<"$commands")
fi
while read -r command; do
  echo "$command"
  eval "$command" >"$log/log.txt" 2>&1 || { cat "$log/log.txt"; exit 1; }
done <<<"$commands"
test -s run/map.vdb
test -s sigma.png

score_poses run/map.vdb | tee "$log/best.txt"
test "$(grep -cE '^pose [0-9]+: [0-9.]+ nat$' "$log/best.txt")" -eq 3
score_poses_c run/map.vdb | diff "$log/best.txt" -  # C says what C++ says
for program in score_poses score_poses_c; do
  status=0
  "$program" no_such.vdb 2>"$log/error.txt" || status=$?
  test "$status" -eq 2
  grep -q no_such.vdb "$log/error.txt"
done

if [ $# -eq 4 ]; then
  mkdir -p out
  ln -s "$work/run" out/demo
  block python >"$log/example.py"
  MPLBACKEND=agg PYTHONPATH=$4 "$3" "$log/example.py"
  test -s gains.png
fi
"$source/tests/root_test.py" "$source" --written "$work"
