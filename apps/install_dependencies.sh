#!/usr/bin/env bash
# Installs the Debian packages that building, testing and the demo need, those that are missing only.
# Asks nothing; uses sudo only if not root.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libeigen3-dev libembree-dev libopenvdb-dev libtbb-dev libcgal-dev libhwy-dev
  libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libpng-dev
  pkg-config
  pybind11-dev python3-dev python3-numpy python3-pytest python3-matplotlib
  libgtest-dev liboctomap-dev libbenchmark-dev libcgal-demo libopenvdb-tools python3
)

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
