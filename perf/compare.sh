#!/usr/bin/env bash
# Is HEAD faster than BASE? Builds viewgain-bench at both commits and alternates runs of `trace` or `bars`.
# Prints the ratio of the medians and its spread per method or bar. Above 1, HEAD is better.
#   perf/compare.sh BASE HEAD        for example BENCH=bars perf/compare.sh v0.1 main
# Environment (defaults): BENCH: trace or bars (trace); RUNS of each (9); POSES (100); VOXELS (128);
# THREADS (0: all); JOBS for the build (all); WORK: a folder to build in and keep, so that the next
# call builds only what changed.
# Only for bars: MAPS (10), ONLY: groups (all).
set -euo pipefail

if [ $# -ne 2 ]; then
  sed -n '2,8s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
bench=${BENCH:-trace} runs=${RUNS:-9}
options=(--json --voxels "${VOXELS:-128}" --poses "${POSES:-100}" --threads "${THREADS:-0}")
case $bench in
  trace) options+=(--repetitions 1) ;;
  bars)
    options+=(--repetitions 3 --maps "${MAPS:-10}")
    [ -z "${ONLY:-}" ] || options+=(--only "$ONLY")
    ;;
  *)
    echo "$0: BENCH is $bench; expected trace or bars" >&2
    exit 2
    ;;
esac
repository=$(git -C "$(dirname "$0")" rev-parse --show-toplevel)
declare -A commits=()
for side in base head; do
  name=$1
  shift
  if ! commits[$side]=$(git -C "$repository" rev-parse --verify --quiet "$name^{commit}"); then
    echo "$0: $name is not a commit of $repository" >&2
    exit 2
  fi
done

if [ -n "${WORK:-}" ]; then
  mkdir -p "$WORK"
  work=$(cd "$WORK" && pwd)
else
  work=$(mktemp -d)
  clean_up() {
    for side in base head; do
      git -C "$repository" worktree remove --force "$work/$side" 2>/dev/null || true
    done
    rm -rf "$work"
  }
  trap clean_up EXIT
fi

for side in base head; do
  commit=${commits[$side]}
  if [ -e "$work/$side/.git" ]; then
    git -C "$work/$side" checkout --quiet --detach "$commit"
  else
    git -C "$repository" worktree add --quiet --detach "$work/$side" "$commit"
  fi
  echo "building $side, ${commit:0:12}" >&2
  cmake -S "$work/$side" -B "$work/$side/build/release" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DVIEWGAIN_BUILD_TESTS=OFF -DVIEWGAIN_BUILD_PERF=ON -DBUILD_SHARED_LIBS=OFF \
    >"$work/$side.log" 2>&1 &&
    cmake --build "$work/$side/build/release" --target viewgain_bench \
      -j "${JOBS:-$(nproc)}" >>"$work/$side.log" 2>&1 || {
    tail -20 "$work/$side.log" >&2
    echo "$0: $side failed to build" >&2
    exit 1
  }
done

results=$work/results
rm -rf "$results"
mkdir -p "$results"
for ((run = 0; run < runs; ++run)); do
  # Every other round begins with the other side, so that neither is always the one that runs warm.
  order=(base head)
  [ $((run % 2)) -eq 0 ] || order=(head base)
  for side in "${order[@]}"; do
    echo "run $((run + 1)) of $runs: $side" >&2
    # Exit code 1: a bar is missed or an answer is wrong. Compare all the same.
    "$work/$side/build/release/bin/viewgain-bench" "$bench" "${options[@]}" \
      >"$results/$side.$run.json" || [ $? -eq 1 ]
  done
done

echo "base ${commits[base]:0:12}, head ${commits[head]:0:12}, $bench"
"$(dirname "$0")/compare_runs.py" "$results"
