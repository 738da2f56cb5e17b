#!/usr/bin/env bash
# Builds the project and its documentation, warnings being errors, and runs all its tests in a clean Debian of another release:
#   tests/portability.sh debian13
# The system is made by debootstrap in build/portability/<release> and kept with what was compiled; the
# next run compiles what has changed. Remove the folder to begin anew. VIEWGAIN_JOBS: how many processes
# (default: the number of processors). Needs root (chroot) and the network that apt uses; not part of ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/chroot.sh

declare -A code_names=([debian13]=trixie)
usage() {
  echo "usage: tests/portability.sh RELEASE, one of: ${!code_names[*]}" >&2
  exit 2
}
if [ $# -ne 1 ] || [ -z "$1" ] || [ -z "${code_names[$1]:-}" ]; then usage; fi
need_root

root=$PWD/build/portability/$1/root
make_bare_system "${code_names[$1]}" "$root"
open_system "$root"

copy_sources "$root/source"

cat >"$root/inside.sh" <<'INSIDE'
set -euo pipefail
export LC_ALL=C CCACHE_DIR=/ccache CCACHE_MAXSIZE=2G
cd /source
./apps/install_dependencies.sh --all
dpkg-query -W ccache >/dev/null 2>&1 ||
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends ccache >/dev/null
cmake --preset release -DCMAKE_BUILD_TYPE=Release -DVIEWGAIN_WERROR=ON \
  -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache >/configure.log 2>&1 ||
  { cat /configure.log; exit 1; }
if grep -A 8 'CMake Warning' /configure.log; then exit 1; fi
cmake --build --preset release -j "$1" -- -k 0 # all that fails, not the first alone
cmake --build --preset release --target docs

echo "Debian $(cat /etc/debian_version):"
for package in g++ cmake libembree-dev libopenvdb-dev libcgal-dev libeigen3-dev libtbb-dev libhwy-dev \
  libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libpng-dev libzstd-dev liblz4-dev libbz2-dev libsqlite3-dev liboctomap-dev libgtest-dev \
  libbenchmark-dev python3 python3-numpy python3-pytest pybind11-dev \
  doxygen python3-sphinx furo; do
  dpkg-query -W -f '  ${Package} ${Version}\n' "$package" 2>/dev/null || true
done
ctest --test-dir build/release --output-on-failure -j "$1"

# The package by pip, with Debian's own build tools where the release has them.
if apt-cache show python3-scikit-build-core >/dev/null 2>&1; then
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends python3-pip \
    python3-scikit-build-core >/dev/null
  rm -rf /pip
  CMAKE_BUILD_PARALLEL_LEVEL=$1 CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache \
    pip install --quiet --root-user-action=ignore --no-build-isolation --no-deps --target /pip /source
  cd /
  PYTHONPATH=/pip python3 - <<'PYTHON'
import numpy as np, viewgain
assert viewgain.__file__.startswith("/pip/"), viewgain.__file__
sensor = viewgain.sensor_preset("sr4000")
grid = viewgain.BeliefGrid.from_labels(np.zeros((16, 16, 16), np.uint8), voxel_size=0.02, origin=(-0.16, -0.16, -0.16), sensor=sensor)
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor)
assert (evaluator.evaluate(viewgain.sphere_poses(5, 0.6)) > 0).all()
import viewgain.mesh  # CGAL is there
points = np.stack(np.meshgrid(np.arange(9) * 0.02, np.arange(9) * 0.02, [0.0]), axis=-1).reshape(-1, 3)
assert len(viewgain.mesh.reconstruct_surface(points, spacing=0.02).triangles) > 100
assert len(viewgain.mesh.surface_of_grid(grid).triangles) == 0  # a grid of the other extension
print("pip install: viewgain", viewgain.__version__)
PYTHON
fi
INSIDE
chroot "$root" bash /inside.sh "${VIEWGAIN_JOBS:-$(nproc)}"
