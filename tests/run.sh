#!/usr/bin/env bash
# Installs what is missing, builds, runs all tests; ends with ctest's summary.
#   --sanitize-quick  a good part of what --sanitize runs, in a quarter of an hour
#   --sanitize  core, grid, raycast and the C and Python entry points instead, under AddressSanitizer and
#               UBSan, without those that repeat for statistics' sake what others do, and one that saves
#               maps without memory (OpenVDB's addLeaf forgets its leaf then)
#   --tsan      the tests of what runs at once, of core, grid, raycast and C, under ThreadSanitizer
#               (without one that raises a signal, which ThreadSanitizer delivers late)
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  "") preset=release ;;
  --sanitize-quick) preset=asan-quick ;;
  --sanitize) preset=asan ;;
  --tsan) preset=tsan ;;
  *) echo "tests/run.sh: no option $1; there are --sanitize-quick, --sanitize and --tsan" >&2; exit 2 ;;
esac
./apps/install_dependencies.sh --tests
cmake --preset "${preset%-quick}" >/dev/null
cmake --build --preset "$preset"
run=()
if [ "$preset" = tsan ]; then
  # ThreadSanitizer does not see the locks of TBB, which OpenVDB and Embree run on: it comes compiled without.
  # On one CPU TBB starts no threads, and so needs no list of suppressions; our own threads are as many as ever.
  run=(taskset -c "$(taskset -cp $$ | grep -oE '[0-9]+' | sed -n 2p)")
fi
"${run[@]}" ctest --preset "$preset" -j "$(nproc)"
