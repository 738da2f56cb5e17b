#!/usr/bin/env bash
# Installs the Debian packages, those that are missing only, that are needed
#   apps/install_dependencies.sh          to build and run the program, and for the demo's mesh
#   apps/install_dependencies.sh --tests  for tests, benchmarks, examples, the Python package and packages as well
#   apps/install_dependencies.sh --docs   for all that and the documentation site (target `docs`)
# Asks nothing; uses sudo only if not root.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libeigen3-dev libembree-dev libopenvdb-dev libtbb-dev libcgal-dev libhwy-dev
  libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libpng-dev zlib1g-dev
  libcgal-demo
)
# Node.js may come from elsewhere than Debian.
npm --version >/dev/null 2>&1 || packages+=(nodejs npm)
case "${1:-}" in
  "") ;;
  --tests | --docs)
    packages+=(
      pkg-config python3 pybind11-dev python3-dev python3-numpy python3-pytest python3-matplotlib
      libgtest-dev liboctomap-dev libompl-dev libbenchmark-dev libopenvdb-tools groff-base
      chromium-headless-shell file dpkg-dev parallel python3-distributed
    )
    ;;
  *) echo "$0: no option $1; there are --tests and --docs" >&2; exit 2 ;;
esac
if [ "${1:-}" = --docs ]; then
  packages+=(
    doxygen doxygen-awesome-css python3-sphinx python3-myst-parser furo libjs-mathjax
  )
fi

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
