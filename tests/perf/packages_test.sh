#!/usr/bin/env bash
# Configuring the benchmarks without what they need names the packages and the command that installs
# them. packages_test.sh SOURCE_FOLDER CMAKE
set -euo pipefail
source=$1 cmake=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/CMakeLists.txt" <<EOF
cmake_minimum_required(VERSION 3.25)
project(benchmarks NONE)
include($source/cmake/viewgain_perf_packages.cmake)
EOF
status=0
"$cmake" -S "$work" -B "$work/build" -DCMAKE_DISABLE_FIND_PACKAGE_octomap=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON -DCMAKE_IGNORE_PREFIX_PATH=/usr >"$work/log" 2>&1 || status=$?
[ "$status" != 0 ] || { echo "configuring goes on without packages"; exit 1; }
for word in liboctomap-dev libbenchmark-dev libnanovdb-dev 'apps/install_dependencies.sh --perf'; do
  grep -qF -- "$word" "$work/log" || { cat "$work/log"; echo "$word is not named"; exit 1; }
done
