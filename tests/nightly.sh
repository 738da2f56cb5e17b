#!/usr/bin/env bash
# The checks that take too long for tests/run.sh, in parts that each end in a summary:
#   tests/nightly.sh PART [...]
#     statistics  tests of the release build that repeat for statistics' sake
#     asan        core, grid, raycast, C and Python under AddressSanitizer and UBSan
#     tsan        what runs at once, under ThreadSanitizer
#     golden      the loop and the scores as recorded, under every instruction set
#     packages    Debian packages, installed and used in a clean system (root)
#     browser     reports of a run and of a ranking in a real browser
#     docs        the documentation site without warnings, and whether every public name is documented
#     perf        every benchmark at its smallest size
#     debian13    the release build, the site and their tests in a clean Debian 13 (root)
#     arm64       the library and the oracles' tests by cross compiler, run by qemu-user (root)
#     kill        100 kills of runs, of watches and of studies: all end as if nothing had been
#     vdb         .vdb files: damaged ones, with little memory, read by OpenVDB's own tools
#     mutate      60 faults put into the code, one at a time: do the tests catch them?
#     fuzz [N]    libFuzzer for each reader and the calls of C, N minutes each (1)
#     furniture   the 820 meshes of Debian's sweethome3d-furniture: at least 99 % are read
#     long        2,000 frames into 512³ voxels: does memory or time grow?
# Dates, commits and results are appended to tests/nightly.log, which is committed.
set -euo pipefail
cd "$(dirname "$0")/.."
all="statistics asan tsan golden packages browser docs perf debian13 arm64 kill vdb mutate fuzz furniture long"

if [ $# -eq 0 ]; then
  echo "usage: tests/nightly.sh PART [...], of: $all" >&2
  exit 2
fi
minutes=1 parts=()
for part in "$@"; do
  if [[ "${parts[*]}" == *fuzz && $part =~ ^[0-9.]+$ ]]; then
    minutes=$part
    continue
  fi
  parts+=("$part")
  [[ " $all " == *" $part "* ]] || { echo "tests/nightly.sh: no part $part; there are $all" >&2; exit 2; }
done

. tests/checks.sh
mkdir -p build

# build PRESET [ARGUMENTS of the configuration]
build() {
  local preset=$1
  shift
  cmake --preset "$preset" "$@" >build/configure.log || { cat build/configure.log >&2; return 1; }
  cmake --build --preset "$preset"
}

# One part, in a shell of its own.
run_part() {
  set -euo pipefail
  ./apps/install_dependencies.sh --tests
  make_locale
  case "$1" in
    statistics) build release; run_ctest --preset statistics ;;
    asan) build asan; run_ctest --preset asan ;;
    tsan)
      build tsan
      # ThreadSanitizer does not see the locks of TBB, which OpenVDB and Embree run on: it comes compiled without.
      # On one CPU TBB starts no threads, and so needs no list of suppressions; our own threads are as many as ever.
      taskset -cp "$(taskset -cp $BASHPID | grep -oE '[0-9]+' | sed -n 2p)" $BASHPID
      run_ctest --preset tsan
      ;;
    golden) build program; ./tests/golden.sh ;;
    packages) ./tests/packages.sh ;;
    browser)
      ./apps/install_dependencies.sh --browser
      build release
      run_ctest --preset browser
      ;;
    docs)
      ./apps/install_dependencies.sh --docs
      build release
      cmake --build build/release --target docs
      run_ctest --preset docs
      ;;
    perf) ./apps/install_dependencies.sh --perf; build perf; run_ctest --preset perf ;;
    debian13) ./tests/portability.sh debian13 ;;
    arm64) ./tests/arm64.sh ;;
    kill)
      build program
      ./apps/extract_mesh.sh camel.off build/kill
      /usr/bin/python3 tests/kill.py build/release/bin/viewgain build/kill/camel.off --work build/kill/work | tee build/kill.log
      ;;
    vdb) build release; run_ctest --preset vdb ;;
    mutate) build release; ./tests/mutate.py build/release | tee build/mutate.log ;;
    fuzz) ./apps/install_dependencies.sh --fuzz; build fuzz; ./tests/fuzz/run.sh "$minutes" | tee build/fuzz.log ;;
    furniture)
      ./apps/install_dependencies.sh --furniture
      build program
      ./tests/furniture.py build/release/bin/viewgain --work build/furniture | tee build/furniture.log
      ;;
    long)
      build release
      PYTHONPATH=build/release/python /usr/bin/python3 tests/long_run.py --csv build/long.csv --plot tests/long.png | tee build/long.log
      ./tests/long_watch.py build/release/bin/viewgain build/release/meshes/camel.off --work build/long | tee -a build/long.log
      ;;
  esac
}

failed=0
for part in "${parts[@]}"; do
  SECONDS=0
  rm -f build/ctest.log
  result=passed
  # Not in a condition, which would switch `set -e` off inside.
  set +e
  (run_part "$part")
  [ $? -eq 0 ] || result=FAILED failed=1
  set -e
  summary=$(grep -E 'tests passed|tests failed' build/ctest.log 2>/dev/null | tail -n 1 || true)
  case "$part" in golden | packages | debian13 | arm64) summary= ;; kill | mutate | fuzz | furniture) summary=$(tail -n 1 "build/$part.log") ;; long) summary=$(paste -sd ' ' build/long.log) ;; esac
  line="$(date -u +%F) $(git describe --always --dirty --exclude "*") $part: $result in $((SECONDS / 60)) min${summary:+, $summary}"
  echo "$line" | tee -a tests/nightly.log
done
exit "$failed"
