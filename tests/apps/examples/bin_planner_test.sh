#!/usr/bin/env bash
# The example bin_planner: in one go, stopped and started again, and in Python the same.
#   bin_planner_test.sh SOURCE_FOLDER BIN_FOLDER [PYTHON PACKAGE_FOLDER]
set -euo pipefail
source=$1 bin=$2
sensor=$source/apps/examples/l515_like.toml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }

check() { # NAME COMMAND...
  local name=$1
  shift
  "$@" "$sensor" "$work/frames" "$work/$name.vdb" 9 >"$work/$name.txt"
  for _ in 1 2 3; do "$@" "$sensor" "$work/frames" "$work/$name-again.vdb" 2 >>"$work/$name-again.txt"; done
  cat "$work/$name.txt"
  [ "$(wc -l <"$work/$name.txt")" = 5 ] || fail "$name: not five views"
  [ "$(grep -c 'the best is [0-9]* at (' "$work/$name.txt")" = 5 ] || fail "$name: a view without a next one"
  cmp "$work/$name.txt" "$work/$name-again.txt" || fail "$name: stopped and started again it says other things"
  [ "$(hash_of "$work/$name.vdb")" = "$(hash_of "$work/$name-again.vdb")" ] || fail "$name: another map"
  local status=0
  "$@" "$sensor" "$work/none" "$work/none.vdb" 1 >/dev/null 2>&1 || status=$?
  [ "$status" != 0 ] || fail "$name: frames that are not there are no error"
  [ ! -e "$work/none.vdb" ] || fail "$name: leaves a state behind"
}
hash_of() { "$bin/viewgain" info "$1" --json | grep -oE '"hash": "[0-9a-f]{16}"'; }

"$bin/bin_planner_frames" "$sensor" "$work/frames"
check cpp "$bin/bin_planner"
# The block stands 14 cm from this wall, whose readings are known: what is left is noise beyond 3 sigma.
"$bin/viewgain" info "$work/cpp.vdb" --workspace -0.2,-0.15,0,-0.09,0.15,0.2 --json >"$work/region.json"
grep -qE '"occupied": [0-9]{1,2},?$' "$work/region.json" || fail "a wall is in the map: $(cat "$work/region.json")"
"$bin/viewgain" info "$work/cpp.vdb" --json | grep -E '"occupied": [1-9][0-9]{3,}' >/dev/null || fail "no block in the map"
if [ $# -gt 2 ]; then
  export PYTHONPATH=$4 PYTHONDONTWRITEBYTECODE=1
  check python "$3" "$source/apps/examples/bin_planner.py"
  cmp "$work/cpp.txt" "$work/python.txt" || fail "Python says other things"
fi
