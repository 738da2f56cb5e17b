#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests; ends with ctest's summary.
#   --readers  instead what reads foreign bytes, and some tests of the kernels, under AddressSanitizer and UBSan
# Where CI is set, the standard library checks itself and a test that is skipped fails. What takes
# longer is in tests/nightly.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  "") preset=release ;;
  --readers) preset=readers ;;
  *) echo "tests/run.sh: no option $1; there is --readers" >&2; exit 2 ;;
esac
if [ "$preset" = release ] && [ -n "${CI:-}" ]; then preset=ci; fi

./apps/install_dependencies.sh --tests
. tests/checks.sh
make_locale
cmake --preset "$preset" >build/configure.log || { cat build/configure.log >&2; exit 1; }
cmake --build --preset "$preset"
run_ctest --preset "$preset"
