#!/usr/bin/env bash
# Installs what is missing, builds, runs all tests; ends with ctest's summary. With --sanitize, core,
# grid, raycast and the C and Python entry points are built and tested under AddressSanitizer and UBSan
# instead, without three tests that repeat for statistics' sake what others do.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release
[ "${1:-}" = "--sanitize" ] && preset=asan
./apps/install_dependencies.sh
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"
