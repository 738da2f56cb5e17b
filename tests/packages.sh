#!/usr/bin/env bash
# Builds the Debian packages, installs them in a clean Debian of this machine's release, runs the program
# and Python there and builds a client. Needs root (chroot) and the network that apt uses; not part of ctest.
#   tests/packages.sh [WORK_FOLDER]   (default build/packages_test; the bare system in it is kept)
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/chroot.sh
work=$(realpath -m "${1:-build/packages_test}")
jobs=${VIEWGAIN_JOBS:-$(nproc)}
. /etc/os-release

fail() { echo "packages.sh: $*" >&2; exit 1; }
need_root

./apps/install_dependencies.sh --all
mkdir -p "$work"

# Packages.
cmake --preset packages >"$work/configure.log" 2>&1 || { cat "$work/configure.log" >&2; exit 1; }
cmake --build --preset packages -j "$jobs"
rm -rf build/packages/packages
(cd build/packages && cpack >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log" >&2; exit 1; }
ls build/packages/packages
for name in libviewgain0.1 libviewgain-mesh0.1 libviewgain-dev viewgain viewgain-doc python3-viewgain python3-viewgain-mesh; do
  test -f build/packages/packages/"$name"_*.deb || fail "no $name"
done

# Only the surfaces and what links them need CGAL's libraries.
binaries=0
for deb in build/packages/packages/{libviewgain0.1,python3-viewgain}_*.deb; do
  rm -rf "$work/content" && dpkg-deb -x "$deb" "$work/content"
  dpkg-deb -f "$deb" Depends | tee "$work/depends"
  ! grep -E 'gmp|mpfr|cgal|mesh' "$work/depends" || fail "$deb depends on CGAL's libraries"
  while read -r binary; do
    nm -DC "$binary" >"$work/symbols"
    ! grep -E 'CGAL|gmp|mpfr' "$work/symbols" || fail "$binary in $deb holds CGAL"
    binaries=$((binaries + 1))
  done < <(find "$work/content" -type f -name '*.so*')
done
[ "$binaries" -eq 5 ] || fail "$binaries libraries were looked at, there should be 5"
dpkg-deb -c build/packages/packages/viewgain_*.deb | grep ' ./usr/share/bash-completion/completions/viewgain$' ||
  fail "viewgain lacks its completion"
doc=build/packages/packages/viewgain-doc_*.deb
[ "$(dpkg-deb -f $doc Architecture)" = all ] || fail "viewgain-doc is for one architecture"
[ -z "$(dpkg-deb -f $doc Depends)" ] || fail "viewgain-doc depends on something"
suggests=$(dpkg-deb -f build/packages/packages/libviewgain-dev_*.deb Suggests)
[ "$suggests" = liboctomap-dev ] || fail "libviewgain-dev suggests '$suggests'"

# A clean system, made once and copied.
make_bare_system "$VERSION_CODENAME" "$work/bare"
root=$work/root
rm -rf --one-file-system "$root"
cp -a "$work/bare" "$root"
mkdir "$root/debs" "$root/client"
cp build/packages/packages/*.deb "$root/debs"
cp tests/consumer/gain.cpp "$root/client"

cat >"$root/program.sh" <<'INSIDE'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
apt-get update -qq
apt-get install -y -qq --no-install-recommends /debs/libviewgain0.1_*.deb /debs/libviewgain-mesh0.1_*.deb \
  /debs/viewgain_*.deb >/dev/null
dpkg -l | awk '$2 ~ /viewgain/ {print $1, $2, $3}'
if dpkg -l | grep -E '^ii +lib[a-z0-9]+-dev '; then exit 1; fi # nothing to develop with
grep -q 'Apache License' /usr/share/doc/libviewgain0.1/copyright
grep -q 'GNU GENERAL PUBLIC LICENSE' /usr/share/doc/viewgain/copyright
viewgain --version
viewgain --help >/dev/null
cat >/box.off <<'MESH'
OFF
8 6 0
-1 -1 -1
1 -1 -1
1 1 -1
-1 1 -1
-1 -1 1
1 -1 1
1 1 1
-1 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 2 3 7 6
4 1 2 6 5
4 0 4 7 3
MESH
viewgain simulate /box.off --poses orbit:1,0.6,20 --sensor sr4000 --size 0.2 --out /frames >/dev/null
viewgain integrate /frames --voxel 0.01 --workspace -0.2,-0.2,-0.2,0.2,0.2,0.2 --out /map.vdb >/dev/null
viewgain score /map.vdb --poses sphere:50,0.6 --sensor sr4000 --top 3 --threads 1 | tee /score.txt
INSIDE
cat >"$root/client.sh" <<'INSIDE'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
apt-get install -y -qq --no-install-recommends /debs/libviewgain-dev_*.deb g++ cmake make pkg-config >/dev/null
if dpkg -l | grep -E '^ii +(libcgal|libembree|libopenvdb|libtbb|libhwy)[a-z0-9]*-dev '; then exit 1; fi
cd /client
g++ -std=c++20 gain.cpp -o by_pkg_config $(pkg-config --cflags --libs viewgain)
printf 'cmake_minimum_required(VERSION 3.22)\nproject(client LANGUAGES CXX)\nfind_package(viewgain 0.1 REQUIRED)\nadd_executable(gain gain.cpp)\ntarget_link_libraries(gain PRIVATE viewgain::viewgain)\n' >CMakeLists.txt
cmake -B build >/dev/null
cmake --build build >/dev/null
./by_pkg_config | tee first.txt
./build/gain | cmp - first.txt
grep -qE '^[0-9]+\.[0-9]*[1-9]' first.txt
apt-get remove -y -qq libviewgain0.1 >/dev/null # takes all that depends on it along
if dpkg -l | grep -E '^ii +(libviewgain|viewgain +[0-9]|python3-viewgain)'; then exit 1; fi
INSIDE
cat >"$root/documentation.sh" <<'INSIDE'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
rm -f /etc/dpkg/dpkg.cfg.d/*nodoc* # minimal images leave out /usr/share/doc
apt-get install -y -qq --no-install-recommends /debs/viewgain-doc_*.deb >/dev/null
site=/usr/share/doc/viewgain-doc
grep -q 'Where should a robot' "$site/html/index.html"
test "$(find "$site/html" -name '*.html' | wc -l)" -gt 500
grep -q 'Apache License' "$site/copyright"
grep -q 'Expat\|MIT' "$site/copyright.furo"
INSIDE
cat >"$root/python.sh" <<'INSIDE'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
apt-get install -y -qq --no-install-recommends /debs/python3-viewgain_*.deb >/dev/null
python3 - <<'PYTHON'
import numpy as np, viewgain
grid = viewgain.BeliefGrid.from_labels(np.zeros((32, 32, 32), np.uint8), voxel_size=0.01, origin=(-0.16, -0.16, -0.16), sensor=viewgain.sensor_preset("sr4000"))
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), viewgain.sensor_preset("sr4000"))
assert (evaluator.evaluate(viewgain.sphere_poses(5, 0.6)) > 0).all()
try:
    import viewgain.mesh
except ImportError:
    pass
else:
    raise SystemExit("python3-viewgain brings the surfaces along")
PYTHON
apt-get install -y -qq --no-install-recommends /debs/python3-viewgain-mesh_*.deb >/dev/null
python3 -c 'import viewgain.mesh; print(viewgain.mesh.__file__)' | grep -q '^/usr/lib/python3'
INSIDE
open_system "$root"
chroot "$root" bash /program.sh
chroot "$root" bash /documentation.sh
chroot "$root" bash /python.sh
chroot "$root" bash /client.sh
echo "packages.sh: all well"
