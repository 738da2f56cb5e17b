#!/usr/bin/env bash
# Each reader of foreign bytes, and the calls of C, under libFuzzer for some minutes in turn, from the readers' good
# files, corpus/ and what earlier runs found; ends in a summary. Inputs that end in more than an error are kept.
#   tests/fuzz/run.sh [MINUTES a target, 1] [TARGET ...]
set -euo pipefail
cd "$(dirname "$0")/../.."
minutes=${1:-1}
shift || true
fuzzer=$PWD/build/fuzz/bin/fuzz_readers work=$PWD/build/fuzz/work
rm -rf "$work/seeds"
mkdir -p "$work"
export TMPDIR=/dev/shm
"$fuzzer" --seeds "$work/seeds"
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls "$work/seeds")
sum=0 findings=0
for target in "${targets[@]}"; do
  inputs=$work/inputs/$target found=$work/findings/$target
  mkdir -p "$inputs" "$found"
  from=("$inputs" "$work/seeds/$target")
  [ -d "tests/fuzz/corpus/$target" ] && from+=("tests/fuzz/corpus/$target")
  VIEWGAIN_FUZZED=$target "$fuzzer" -max_total_time="$(awk "BEGIN { print int(60 * $minutes) }")" -timeout=20 -report_slow_units=20 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$found/" "${from[@]}" >"$work/$target.log" 2>&1 || true
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$target.log")
  edges=$(grep -oE 'cov: [0-9]+' "$work/$target.log" | tail -n 1 || true)
  count=$(find "$found" -type f | wc -l)
  echo "$target: ${executions:-0} executions, ${edges:-cov: 0}, $count findings"
  sum=$((sum + ${executions:-0})) findings=$((findings + count))
done
echo "fuzz: ${#targets[@]} targets, $minutes min each, $sum executions, $findings findings"
[ "$findings" -eq 0 ]
