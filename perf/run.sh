#!/usr/bin/env bash
# How fast is viewgain on this machine, next to other libraries? Installs and builds what is missing,
# measures, prints one table and saves it.
#   perf/run.sh [OUT]     OUT: folder for table.md and the figures as JSON (default: out/perf)
# Environment (defaults): THREADS (2, for which the bars are stated; 0: all); MAPS to search (6).
set -euo pipefail

if [ $# -gt 1 ] || [[ "${1:-}" == -* ]]; then
  sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
repository=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$repository/out/perf}
threads=${THREADS:-2} maps=${MAPS:-6}
mkdir -p "$out"

"$repository/apps/install_dependencies.sh" --perf
bench=$repository/build/perf/bin/viewgain-bench
if [ ! -x "$bench" ]; then
  echo "building viewgain-bench takes 15 to 40 minutes on two cores, once" >&2
fi
log=$out/build.log
{ cd "$repository" && cmake --preset perf && cmake --build --preset perf --target viewgain_bench; } >"$log" 2>&1 || {
  tail -20 "$log" >&2
  echo "$0: the build failed; all of it is in $log" >&2
  exit 1
}

echo "measuring takes about 6 minutes on two cores" >&2
# Exit code 1: a bar is missed or an answer is wrong. The table tells both.
measure() {
  local name=$1
  shift
  echo "measuring: $name" >&2
  "$bench" "$@" --json --threads "$threads" >"$out/$name.json" || [ $? -eq 1 ]
}
cut -d' ' -f1 /proc/loadavg >"$out/load.txt"
started=$SECONDS
measure trace trace --poses 100 --repetitions 5
measure trace_256 trace --voxels 256 --without octomap,openvdb,tree64 --poses 40 --repetitions 3
measure trace_512 trace --voxels 512 --without octomap,openvdb,tree64 --poses 20 --repetitions 3
measure integrate integrate
measure decision decision --maps camel-128 --candidates 500
measure bars bars --maps "$maps" --repetitions 3 \
  --only scaling,latency,update,search,memory,decision,hazard,classic,surroundings
echo "measured in $((SECONDS - started)) s" >&2

status=0
"$repository/perf/run_table.py" "$out" >"$out/table.md" || status=$?
cat "$out/table.md"
echo "saved as $out/table.md" >&2
exit "$status"
