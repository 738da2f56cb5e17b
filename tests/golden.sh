#!/usr/bin/env bash
# The loop and the scores as they were: runs `viewgain reconstruct` and `viewgain score` for three objects and
# three policies, with one and with two threads and with every instruction set of this machine, and compares
# the map's hash, run.json without its times, and the bytes of the scores with tests/golden.txt.
#   tests/golden.sh [PROGRAM]            default: build/release/bin/viewgain; ends with 1 where anything differs
#   tests/golden.sh --record [PROGRAM]   writes tests/golden.txt anew; the commit says what changed and why
set -euo pipefail
cd "$(dirname "$0")/.."

record=no
if [ "${1:-}" = "--record" ]; then
  record=yes
  shift
fi
viewgain=$(realpath "${1:-build/release/bin/viewgain}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

isas=(sse4)
grep -qw avx2 /proc/cpuinfo && isas+=(avx2)
grep -qw avx512f /proc/cpuinfo && isas+=(avx512)

# run.json without the values that a machine or its load sets.
without_times() {
  python3 - "$1" <<'PYTHON'
import json, sys

def kept(value):
    if isinstance(value, dict):
        return {k: kept(v) for k, v in value.items() if k not in ("seconds", "mesh", "out", "threads")}
    return [kept(v) for v in value] if isinstance(value, list) else value

print(json.dumps(kept(json.load(open(sys.argv[1])))))
PYTHON
}

# One run: hash of the map, of run.json and of the scores.
figures() {
  local object=$1 policy=$2 isa=$3 threads=$4
  local out=$work/$object-$policy-$isa-$threads
  VIEWGAIN_ISA=$isa "$viewgain" reconstruct "$work/$object.off" --size 0.35 --sensor sr4000 --voxel 0.005 \
    --policy "$policy" --max-views 4 --seed 3 --threads "$threads" --pictures off --out "$out" >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; return 1; }
  VIEWGAIN_ISA=$isa "$viewgain" score "$out/map.vdb" --sphere 100,0.6 --sensor sr4000 --gain paper --threads "$threads" \
    --out "$out/scores.csv" >"$work/log" 2>&1 || { cat "$work/log" >&2; return 1; }
  printf '%s %s %s' "$("$viewgain" info "$out/map.vdb" --hash | cut -c1-16)" \
    "$(without_times "$out/run.json" | sha256sum | cut -c1-16)" "$(sha256sum <"$out/scores.csv" | cut -c1-16)"
}

runs=0
for object in camel lion-head mannequin-devil; do
  ./apps/extract_mesh.sh "$object.off" "$work" >/dev/null
  for policy in gain frontier kriegel; do
    for isa in "${isas[@]}"; do
      for threads in 1 2; do
        printf '%s %s %s %s %s\n' "$object" "$policy" "$isa" "$threads" \
          "$(figures "$object" "$policy" "$isa" "$threads")" >>"$work/golden.txt"
        runs=$((runs + 1))
      done
    done
  done
done

if [ "$record" = yes ]; then
  { echo "# object policy isa threads map run.json scores (tests/golden.sh --record)"; cat "$work/golden.txt"; } \
    >tests/golden.txt
  echo "recorded $runs runs"
  exit 0
fi
# A machine without some instruction set compares the others.
grep -E " ($(IFS='|'; echo "${isas[*]}")) " tests/golden.txt >"$work/expected.txt"
if ! diff -u "$work/expected.txt" "$work/golden.txt"; then
  echo "golden: the lines above differ from tests/golden.txt" >&2
  exit 1
fi
echo "golden: $runs runs as recorded"
