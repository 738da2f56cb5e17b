#!/usr/bin/env bash
# Is HEAD faster than BASE? Builds viewgain-bench of two commits, runs `trace` of both in turns and
# prints, for each method, the ratio of the medians of HEAD to BASE with its spread.
#   perf/compare.sh BASE HEAD        compare.sh main HEAD, compare.sh v0.1 perf
# Environment: RUNS (7) of each, POSES (100), VOXELS (128), THREADS (0: all), JOBS (all) to build with,
# WORK: a folder to build in and keep, so that the next call builds only what changed.
set -euo pipefail

if [ $# -ne 2 ]; then
  sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
runs=${RUNS:-7} poses=${POSES:-100} voxels=${VOXELS:-128} threads=${THREADS:-0}
repository=$(git -C "$(dirname "$0")" rev-parse --show-toplevel)
declare -A commits=()
for side in base head; do
  name=$1
  shift
  if ! commits[$side]=$(git -C "$repository" rev-parse --verify --quiet "$name^{commit}"); then
    echo "$0: $name is no commit of $repository" >&2
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
    -DVIEWGAIN_BUILD_TESTS=OFF \
    >"$work/$side.log" 2>&1 &&
    cmake --build "$work/$side/build/release" --target viewgain_bench \
      -j "${JOBS:-$(nproc)}" >>"$work/$side.log" 2>&1 || {
    tail -20 "$work/$side.log" >&2
    echo "$0: $side does not build" >&2
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
    "$work/$side/build/release/bin/viewgain-bench" trace --json --voxels "$voxels" \
      --poses "$poses" --threads "$threads" --repetitions 1 >"$results/$side.$run.json"
  done
done

python3 - "$results" "${commits[base]:0:12}" "${commits[head]:0:12}" <<'PYTHON'
import json, pathlib, statistics, sys

folder, base_name, head_name = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]


def rates(side):
    """Rays per second by method, one a run."""
    result = {}
    for path in sorted(folder.glob(f"{side}.*.json"), key=lambda p: int(p.name.split(".")[1])):
        for method in json.loads(path.read_text())["methods"]:
            result.setdefault(method["name"], []).append(method["rays_per_second"])
    return result


def quantile(values, share):
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


base, head = rates("base"), rates("head")
runs = len(next(iter(base.values())))
print(f"Mrays/s, {runs} runs of each in turns; ratio of medians, 5 % and 95 % of the runs' ratios")
print(f"{'method':<20} {base_name:>14} {head_name:>14} {'ratio':>8} {'p05':>8} {'p95':>8}")
for name in base:
    if name not in head:
        continue
    a, b = statistics.median(base[name]), statistics.median(head[name])
    each = [y / x for x, y in zip(base[name], head[name])]
    print(f"{name:<20} {a / 1e6:>14.3f} {b / 1e6:>14.3f} {b / a:>8.3f} "
          f"{quantile(each, 0.05):>8.3f} {quantile(each, 0.95):>8.3f}")
for name in sorted(set(base) ^ set(head)):
    print(f"{name:<20} only in {'base' if name in base else 'head'}")
PYTHON
