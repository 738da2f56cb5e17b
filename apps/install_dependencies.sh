#!/usr/bin/env bash
# Installs the missing Debian packages.
#   apps/install_dependencies.sh [OPTION...]
# Without options: those that are needed to build and run the program, and for the demo's mesh.
# Every option adds those that tests/run.sh needs, and:
#   --tests      nothing else
#   --perf       benchmarks and 820 meshes of furniture
#   --browser    the test of the report in a browser
#   --docs       the documentation site (target `docs`)
#   --fuzz       libFuzzer
#   --packages   Debian packages
#   --furniture  the furniture
#   --all        all of these
# Asks nothing; uses sudo only if not root.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libeigen3-dev libembree-dev libopenvdb-dev libtbb-dev libcgal-dev libhwy-dev
  libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libpng-dev zlib1g-dev
  libzstd-dev liblz4-dev libbz2-dev libsqlite3-dev
  libcgal-demo
)
# Node.js may come from elsewhere than Debian.
npm --version >/dev/null 2>&1 || packages+=(nodejs npm)
tests=(
  pkg-config python3 pybind11-dev python3-dev python3-numpy python3-pytest python3-matplotlib
  python3-scipy python3-distributed
  libgtest-dev liboctomap-dev libopenvdb-tools file locales
)
perf=(libbenchmark-dev libnanovdb-dev sweethome3d-furniture)
browser=(chromium-headless-shell)
fuzz=(clang-19 libclang-rt-19-dev)
docs=(doxygen doxygen-awesome-css python3-sphinx python3-myst-parser furo libjs-mathjax)
for option in "$@"; do
  case "$option" in
    --tests) ;;
    --perf) packages+=("${perf[@]}") ;;
    --browser) packages+=("${browser[@]}") ;;
    --docs) packages+=("${docs[@]}") ;;
    --fuzz) packages+=("${fuzz[@]}") ;;
    --packages) packages+=(dpkg-dev) ;;
    --furniture) packages+=(sweethome3d-furniture) ;;
    --all) packages+=("${perf[@]}" "${browser[@]}" "${fuzz[@]}" "${docs[@]}" dpkg-dev) ;;
    *) echo "$0: $option: expected --tests, --perf, --browser, --docs, --fuzz, --packages, --furniture or --all" >&2; exit 2 ;;
  esac
done
[ $# -eq 0 ] || packages+=("${tests[@]}")

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
export DEBIAN_FRONTEND=noninteractive
echo "installing: ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
