#!/usr/bin/env bash
# The examples of embedding that need a map alone: own_gain (C++) and score_stdin (C).
#   embedding_examples_test.sh BIN_FOLDER MAP.vdb
set -euo pipefail
bin=$1 map=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }

# Exit code 2, nothing on stdout, this on stderr.
refuses() { # PATTERN PROGRAM ARGUMENTS... < INPUT
  local status=0
  "${@:2}" >"$work/out" 2>"$work/err" || status=$?
  [ "$status" = 2 ] || fail "${*:2}: exit code $status"
  [ ! -s "$work/out" ] || fail "${*:2}: says something on stdout"
  grep -q -- "$1" "$work/err" || fail "${*:2}: $(cat "$work/err")"
}

"$bin/own_gain" "$map" | tee "$work/own.txt"
grep -qE '^pose [0-9]+: [1-9][0-9.]* unknown voxels per m2$' "$work/own.txt" || fail "own_gain"
refuses 'missing.vdb' "$bin/own_gain" "$work/missing.vdb"
refuses 'usage' "$bin/own_gain"

# A camera 0.7 m above the map that looks down; one that is no pose; one that looks away.
cat >"$work/poses.txt" <<'POSES'
1 0 0 0  0 -1 0 0  0 0 -1 0.7

1 0 0 0 0 -1 0 0 0 0 -1 nan
1 0 0 0 0 1 0 0 0 0 1 0.7
POSES
"$bin/score_stdin" "$map" <"$work/poses.txt" | tee "$work/gains.txt"
mapfile -t gain <"$work/gains.txt"
[ "${#gain[@]}" = 3 ] || fail "score_stdin: ${#gain[@]} lines"
[[ "${gain[0]}" =~ ^[1-9] ]] || fail "score_stdin: the first gain is ${gain[0]}"
[ "${gain[1]}" = nan ] || fail "score_stdin: a pose with nan gains ${gain[1]}"
[ "${gain[2]}" = 0 ] || fail "score_stdin: a camera that looks away gains ${gain[2]}"
"$bin/score_stdin" "$map" kinect_v1 <"$work/poses.txt" >"$work/kinect.txt"
! cmp -s "$work/gains.txt" "$work/kinect.txt" || fail "score_stdin: the sensor does not matter"
[ -z "$("$bin/score_stdin" "$map" </dev/null)" ] || fail "score_stdin: gains without poses"

for wrong in '1 2 3' '1 0 0 zero 0 1 0 0 0 0 1 0'; do
  echo "$wrong" >"$work/wrong.txt"
  refuses '12 numbers' "$bin/score_stdin" "$map" <"$work/wrong.txt"
done
refuses 'missing.vdb' "$bin/score_stdin" "$work/missing.vdb" </dev/null
refuses 'sr4001' "$bin/score_stdin" "$map" sr4001 </dev/null
refuses 'usage' "$bin/score_stdin" </dev/null
