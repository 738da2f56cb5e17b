#!/usr/bin/env bash
# The example own_gain. own_gain_test.sh BIN_FOLDER MAP.vdb
set -euo pipefail
bin=$1 map=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }

# Exit code 2, nothing on stdout, this on stderr.
refuses() { # PATTERN PROGRAM ARGUMENTS...
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
