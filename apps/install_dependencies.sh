#!/usr/bin/env bash
# Installs the Debian packages, those that are missing only, that are needed
#   apps/install_dependencies.sh          to build and run the program, and for the demo's mesh
#   apps/install_dependencies.sh --tests    for what tests/run.sh builds and runs as well
#   apps/install_dependencies.sh --perf     for all that, the benchmarks and 820 meshes of furniture
#   apps/install_dependencies.sh --browser  for all that and the test of the report in a browser
#   apps/install_dependencies.sh --docs     for all that and the documentation site (target `docs`)
#   apps/install_dependencies.sh --fuzz     for all that --tests is for and libFuzzer
#   apps/install_dependencies.sh --packages for all that --tests is for and Debian packages
#   apps/install_dependencies.sh --furniture for all that --tests is for and the furniture
#   apps/install_dependencies.sh --all      for all of it
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
case "${1:-}" in
  "") ;;
  --tests) packages+=("${tests[@]}") ;;
  --perf) packages+=("${tests[@]}" "${perf[@]}") ;;
  --browser) packages+=("${tests[@]}" "${browser[@]}") ;;
  --docs) packages+=("${tests[@]}" "${docs[@]}") ;;
  --fuzz) packages+=("${tests[@]}" "${fuzz[@]}") ;;
  --packages) packages+=("${tests[@]}" dpkg-dev) ;;
  --furniture) packages+=("${tests[@]}" sweethome3d-furniture) ;;
  --all) packages+=("${tests[@]}" "${perf[@]}" "${browser[@]}" "${fuzz[@]}" "${docs[@]}" dpkg-dev) ;;
  *) echo "$0: no option $1; there are --tests, --perf, --browser, --docs, --fuzz, --packages, --furniture and --all" >&2; exit 2 ;;
esac

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
