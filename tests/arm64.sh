#!/usr/bin/env bash
# Builds the library, the program and some tests for arm64 by cross compiler, warnings being errors, in a clean Debian of this
# machine's release, and runs these tests by qemu-user: the oracles of tracing and gains, the grid, the program's loop.
#   tests/arm64.sh
# The system is kept in build/arm64 with what was compiled. Needs root (chroot) and the network that apt uses; not part of ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/chroot.sh
. /etc/os-release
need_root

root=$PWD/build/arm64/root
make_bare_system "$VERSION_CODENAME" "$root"
open_system "$root"
copy_sources "$root/source"

cat >"$root/inside.sh" <<'INSIDE'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C CCACHE_DIR=/ccache CCACHE_MAXSIZE=2G
dpkg --add-architecture arm64
apt-get update -qq
apt-get install -y -qq --no-install-recommends cmake ninja-build ccache g++-aarch64-linux-gnu qemu-user-static libeigen3-dev \
  libcli11-dev nlohmann-json3-dev lib{embree,openvdb,tbb,hwy,gtest,cgal,png,tomlplusplus,zstd,lz4,bz2,sqlite3,octomap,gmp,mpfr}-dev:arm64 zlib1g-dev:arm64 >/dev/null
cd /source
cmake -B build/arm64 -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/aarch64-linux-gnu.cmake -DCMAKE_BUILD_TYPE=Release -DVIEWGAIN_WERROR=ON \
  -DVIEWGAIN_BUILD_PYTHON=OFF -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache >/configure.log 2>&1 ||
  { cat /configure.log; exit 1; }
cmake --build build/arm64 -j "$1" --target viewgain_program raycast_test surface_gain_test c_api_test -- -k 0
aarch64-linux-gnu-readelf -h build/arm64/bin/viewgain | grep AArch64
ctest --test-dir build/arm64 --output-on-failure -j "$1" -R "$2"
INSIDE
chroot "$root" bash /inside.sh "${VIEWGAIN_JOBS:-$(nproc)}" 'Oracle|Capi'
