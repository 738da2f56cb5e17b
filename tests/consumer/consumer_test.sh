#!/usr/bin/env bash
# Builds and runs a project of a user of viewgain.
#   consumer_test.sh KIND SOURCE_FOLDER BUILD_FOLDER WORK_FOLDER EXPECTED_GAIN_PROGRAM
# KIND: install, install_static (these two first: the others use what they leave in WORK_FOLDER);
# find_package, native, moved, static, static_native, pkg_config, add_subdirectory, headers, python,
# octomap, absolute_folders, versions, missing_dependency.
set -euo pipefail
kind=$1 source=$2 build=$3 work=$4 expected=$5
here=$source/tests/consumer
export VIEWGAIN_OBJECTS=$build
unset LD_LIBRARY_PATH
unity=$(grep '^VIEWGAIN_UNITY:' "$build/CMakeCache.txt")  # else its objects are others
static=
[[ $kind != static* ]] || static=--static
mkdir -p "$work"

fail() { echo "$kind: $*" >&2; exit 1; }

# One job: ctest runs others beside.
quiet_build() { # FOLDER
  cmake --build "$1" -j 1 >"$1/build.log" 2>&1 || { cat "$1/build.log" >&2; fail "did not build"; }
}

check_gain() { # PROGRAM [c]
  local gain
  gain=$("$1")
  [ "$gain" = "$("$expected" "${@:2}")" ] || fail "the gain is $gain, expected $("$expected" "${@:2}")"
  echo "$kind: gain $gain"
}

# A source of this folder compiled by what viewgain.pc's folder, $pc, says of a package.
by_pkg_config() { # PACKAGE SOURCE PROGRAM [flags]
  # Split on purpose.
  # shellcheck disable=SC2046
  c++ -std=c++20 "$here/$2" -o "$work/$kind/$3" "${@:4}" $(PKG_CONFIG_PATH=$pc pkg-config $static --cflags --libs "$1")
}

# A project that finds viewgain under a prefix, built, and its three programs run.
check_project() { # PREFIX [cmake arguments]
  local folder=$work/$kind
  rm -rf "$folder"
  cmake -S "$here/find_package" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
    "-DCMAKE_PREFIX_PATH=$1" "${@:2}" >/dev/null
  quiet_build "$folder"
  check_gain "$folder/gain"
  check_gain "$folder/gain_c" c
  local answers
  answers=$("$folder/boundary" "$folder/map.vdb")
  [ "$answers" = 11111111 ] || fail "boundary.cpp says $answers"
  answers=$("$folder/files" "$folder/sensor.toml")
  [ "$answers" = 11 ] || fail "files.cpp says $answers"
  answers=$("$folder/planner" "$folder/planner.vdb")
  [ "$answers" = 1111 ] || fail "planner.cpp says $answers"
  answers=$("$folder/planner_mesh" "$folder/planner.vdb")
  [ "$answers" = 1111 ] || fail "planner.cpp with surfaces says $answers"
}

case $kind in
  install)
    rm -rf "$work/prefix"
    cmake --install "$build" --prefix "$work/prefix" >/dev/null
    ;;
  install_static)
    rm -rf "$work/static_build" "$work/static_prefix"
    cmake -S "$source" -B "$work/static_build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DBUILD_SHARED_LIBS=OFF -DVIEWGAIN_BUILD_APPS=OFF -DVIEWGAIN_BUILD_TESTS=OFF \
      -DVIEWGAIN_BUILD_PERF=OFF -DVIEWGAIN_BUILD_PYTHON=OFF "-D$unity" \
      "-DCMAKE_CXX_COMPILER_LAUNCHER=$here/reuse_objects.sh" >/dev/null
    quiet_build "$work/static_build"
    grep -q '^reuse_objects.sh: no' "$work/static_build/build.log" && fail "compiled anew"
    cmake --install "$work/static_build" --prefix "$work/static_prefix" >/dev/null
    ;;
  find_package) check_project "$work/prefix" ;;
  native) check_project "$work/prefix" -DCMAKE_CXX_FLAGS=-march=native ;;
  moved)
    rm -rf "$work/elsewhere"
    cp -a "$work/prefix" "$work/elsewhere"
    "$work/elsewhere/bin/viewgain" --version | grep -q '^viewgain [0-9]' || fail "the program does not start"
    check_project "$work/elsewhere"
    ! ldd "$work/moved/gain" | grep -F "$work/prefix/" || fail "still uses the old prefix"
    ;;
  static)
    check_project "$work/static_prefix"
    ! ldd "$work/static/gain" | grep viewgain || fail "not linked statically"
    pc=$(dirname "$(find "$work/static_prefix" -name viewgain.pc)")
    by_pkg_config viewgain gain.cpp by_pkg_config
    check_gain "$work/$kind/by_pkg_config"
    by_pkg_config viewgain-formats files.cpp files_by_pkg_config
    [ "$("$work/$kind/files_by_pkg_config" "$work/$kind/sensor.toml")" = 11 ] || fail "files.cpp"
    by_pkg_config viewgain-planner planner.cpp planner_by_pkg_config
    [ "$("$work/$kind/planner_by_pkg_config" "$work/$kind/state.vdb")" = 1111 ] || fail "planner.cpp"
    ;;
  static_native) check_project "$work/static_prefix" -DCMAKE_CXX_FLAGS=-march=native ;;
  pkg_config)
    mkdir -p "$work/$kind"
    pc=$(dirname "$(find "$work/prefix" -name viewgain.pc)")
    rpath=-Wl,-rpath,$(dirname "$pc")
    by_pkg_config "viewgain >= 0.1" gain.cpp gain "$rpath"
    check_gain "$work/$kind/gain"
    # C99 with the one header.
    # shellcheck disable=SC2046
    cc -std=c99 -pedantic -Wall -Wextra -Werror "$here/gain.c" -o "$work/$kind/gain_c" \
      "$rpath" $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs viewgain)
    check_gain "$work/$kind/gain_c" c
    by_pkg_config viewgain-mesh boundary.cpp boundary "$rpath"
    [ "$("$work/$kind/boundary" "$work/$kind/map.vdb")" = 11111111 ] || fail "boundary.cpp"
    by_pkg_config viewgain-formats files.cpp files "$rpath"
    [ "$("$work/$kind/files" "$work/$kind/sensor.toml")" = 11 ] || fail "files.cpp"
    by_pkg_config viewgain-planner planner.cpp planner "$rpath"
    [ "$("$work/$kind/planner" "$work/$kind/state.vdb")" = 1111 ] || fail "planner.cpp"
    by_pkg_config viewgain-planner_mesh planner.cpp planner_mesh -DWITH_SURFACES "$rpath"
    [ "$("$work/$kind/planner_mesh" "$work/$kind/state.vdb")" = 1111 ] || fail "planner.cpp with surfaces"
    ;;
  add_subdirectory)
    folder=$work/$kind
    rm -rf "$folder"
    cmake -S "$here/add_subdirectory" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      "-DVIEWGAIN_SOURCE=$source" -DVIEWGAIN_INSTALL=ON "-D$unity" \
      "-DCMAKE_CXX_COMPILER_LAUNCHER=$here/reuse_objects.sh" >/dev/null
    [ ! -e "$folder/CPackConfig.cmake" ] || fail "viewgain says how its user's project is packed"
    quiet_build "$folder"
    grep -q '^reuse_objects.sh: no' "$folder/build.log" && fail "compiled anew"
    check_gain "$folder/gain"
    ;;
  headers)
    # All public headers together bring in nothing but Eigen and the standard library.
    count=0
    while read -r header; do
      echo "#include <${header#"$work/prefix/include/"}>"
      count=$((count + 1))
    done < <(find "$work/prefix/include/viewgain" -name '*.hpp' -not -name 'octomap_*' | sort) >"$work/all.cpp"
    [ "$count" -gt 30 ] || fail "$count headers"
    c++ -std=c++20 -M "-I$work/prefix/include" -I/usr/include/eigen3 "$work/all.cpp" >"$work/all.d"
    grep -q Eigen "$work/all.d" || fail "no Eigen in the list"
    ! grep -oE '[^ ]*/((openvdb|embree[34]?|CGAL|tbb|oneapi|hwy|boost|Imath|toml\+\+)/[^ ]*|png\.h( |$))' "$work/all.d" ||
      fail "a public header brings in a private library"
    # Nor does a public type hold what Eigen aligns as -march says: clients may be compiled for another processor.
    ! grep -rnE '^  (std::[a-z]+<)?Eigen::(Vector[24]|Matrix[24]|Isometry|Affine|Transform|Quaternion)' "$work/prefix/include" ||
      fail "a public type's layout depends on the instruction set"
    ;;
  python)
    # Both modules, found where they were installed, with libraries of the same prefix.
    package=$(find "$work/prefix" -type d -path '*-packages/viewgain')
    export PYTHONPATH=${package%/viewgain} PYTHONDONTWRITEBYTECODE=1
    # The frame of its map begins elsewhere than gain.cpp's: equal but for rounding.
    gain=$("$here/gain.py")
    awk -v a="$gain" -v b="$("$expected" c)" 'BEGIN { exit !(a > 0 && (a / b - 1) ^ 2 < 1e-20) }' ||
      fail "the gain is $gain, expected $("$expected" c)"
    grep -q "def evaluate(self" "$package/_viewgain.pyi" && grep -q "^class Surface" "$package/mesh/_mesh.pyi" ||
      fail "types are missing"
    /usr/bin/python3 -c "import viewgain.mesh; print(viewgain.mesh.__file__)" | grep -q "^$work/prefix/" ||
      fail "another viewgain.mesh was found"
    for extension in "$package"/_viewgain.*.so; do
      nm -DC "$extension" >"$work/$kind.symbols"
      ! grep -E 'CGAL|gmp|mpfr' "$work/$kind.symbols" || fail "$extension holds CGAL"
      ! readelf -d "$extension" | grep -E 'NEEDED.*(gmp|mpfr|CGAL|viewgain_mesh)' ||
        fail "$extension is linked to CGAL's libraries"
    done
    ;;
  octomap)
    # Where OctoMap lay when viewgain was built is not where it lies for others.
    targets=$(find "$work/prefix" -name viewgain-octomapTargets.cmake)
    ! grep -nE 'liboctomap|liboctomath|octomath/|"[^"]*/usr/include' "$targets" || fail "$targets holds paths of this machine"
    folder=$work/$kind
    rm -rf "$folder" && mkdir "$folder"
    cat >"$folder/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.22)
project(consumer LANGUAGES CXX)
find_package(viewgain 0.1 REQUIRED COMPONENTS octomap)
get_target_property(links viewgain::octomap INTERFACE_LINK_LIBRARIES)
foreach(library IN LISTS OCTOMAP_LIBRARIES)
  if(NOT library IN_LIST links)
    message(FATAL_ERROR "viewgain::octomap does not link ${library}, but ${links}")
  endif()
endforeach()
add_executable(tree tree.cpp)
target_link_libraries(tree PRIVATE viewgain::octomap)
PROJECT
    cat >"$folder/tree.cpp" <<'PROGRAM'
#include <cstdio>
#include <viewgain/formats/octomap_tree.hpp>
int main() {
  viewgain::BeliefGrid grid({0.1, {{0, 0, 0}, {1, 1, 1}}, {}, 0.05});
  grid.set({1, 2, 3}, 1.0F);
  std::printf("%zu\n", viewgain::octree_from_grid(grid)->getNumLeafNodes());
}
PROGRAM
    cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      "-DCMAKE_PREFIX_PATH=$work/prefix" >/dev/null
    quiet_build "$folder/build"
    [ "$("$folder/build/tree")" = 1 ] || fail "the tree has another count of leaves"
    ;;
  versions)
    # Each request says whether this 0.1 answers it.
    folder=$work/$kind
    rm -rf "$folder" && mkdir "$folder"
    cat >"$folder/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.22)
project(consumer LANGUAGES CXX)
set(cases 0)
foreach(case IN ITEMS "0.1;yes" "0.1.0;yes" "0.1...0.1.9;yes" "0.0;no" "0.2;no" "0.1.99;no" "1.0;no")
  list(GET case 0 version)
  list(GET case 1 expected)
  set(viewgain_DIR viewgain_DIR-NOTFOUND CACHE PATH "" FORCE)
  find_package(viewgain ${version} QUIET)
  set(answer no)
  if(viewgain_FOUND)
    set(answer yes)
  endif()
  if(NOT answer STREQUAL expected)
    message(FATAL_ERROR "viewgain ${version}: ${answer}, expected ${expected}")
  endif()
  math(EXPR cases "${cases} + 1")
endforeach()
find_package(viewgain 0.1.0 EXACT REQUIRED)
message(STATUS "${cases} requests")
PROJECT
    cmake -S "$folder" -B "$folder/build" -G Ninja "-DCMAKE_PREFIX_PATH=$work/prefix" >"$folder/log" 2>&1 ||
      { cat "$folder/log" >&2; fail "find_package answered otherwise"; }
    grep -q '7 requests' "$folder/log" || fail "not all requests were made"
    ;;
  missing_dependency)
    cases=0
    check_request() { # REQUEST EXPECTED [cmake arguments]
      local folder=$work/$kind
      rm -rf "$folder" && mkdir "$folder"
      # CMake's variables.
      # shellcheck disable=SC2016
      printf 'cmake_minimum_required(VERSION 3.22)\nproject(consumer LANGUAGES CXX)\nfind_package(%s)\n%s\n' "$1" \
        'message(STATUS "answer:${viewgain_FOUND}:${viewgain_octomap_FOUND}:${viewgain_mesh_FOUND}${viewgain_planner_mesh_FOUND}:${viewgain_NOT_FOUND_MESSAGE}")' \
        >"$folder/CMakeLists.txt"
      cmake -S "$folder" -B "$folder/build" -G Ninja "${@:3}" >"$folder/log" 2>&1 || true
      tr -s ' \n' ' ' <"$folder/log" | grep -qE "$2" ||
        { cat "$folder/log" >&2; fail "find_package($1): not $2"; }
      cases=$((cases + 1))
    }
    shared=-DCMAKE_PREFIX_PATH=$work/prefix static=-DCMAKE_PREFIX_PATH=$work/static_prefix
    no_octomap=-DCMAKE_DISABLE_FIND_PACKAGE_octomap=ON no_cgal=-DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON
    optional='OPTIONAL_COMPONENTS octomap mesh hovercraft'
    check_request "viewgain REQUIRED $optional" 'answer:(1|TRUE):TRUE:TRUE: ' "$shared"
    check_request "viewgain REQUIRED $optional" 'answer:(1|TRUE):FALSE:TRUE: ' "$shared" "$no_octomap"
    check_request "viewgain $optional" 'answer:(1|TRUE):FALSE:TRUE: ' "$shared" "$no_octomap"
    check_request "viewgain REQUIRED $optional" 'answer:(1|TRUE):TRUE:FALSE: ' "$static" "$no_cgal"
    check_request "viewgain REQUIRED OPTIONAL_COMPONENTS planner_mesh" 'answer:(1|TRUE)::FALSE: ' "$static" "$no_cgal"
    check_request "viewgain REQUIRED COMPONENTS planner_mesh" 'answer:(1|TRUE)::TRUE: ' "$static"
    check_request "viewgain COMPONENTS octomap OPTIONAL_COMPONENTS mesh" \
      'answer:(0|FALSE):FALSE:TRUE:[^:]*octomap could not be found' "$shared" "$no_octomap"
    check_request "viewgain COMPONENTS hovercraft OPTIONAL_COMPONENTS octomap" \
      'answer:(0|FALSE):FALSE::[^:]*without the component hovercraft' "$shared" "$no_octomap"
    check_request "viewgain REQUIRED COMPONENTS octomap" 'CMake Error.*octomap' "$shared" "$no_octomap"
    check_request "viewgain OPTIONAL_COMPONENTS octomap" 'answer:(0|FALSE):.*Eigen3 could not be found' \
      "$shared" -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
    check_request "viewgain 9.0 REQUIRED" 'compatible with requested version "9.0"' "$shared"
    [ "$cases" = 11 ] || fail "$cases cases"
    ;;
  absolute_folders)
    # Distributions give folders as absolute paths.
    folder=$work/$kind
    rm -rf "$folder" && mkdir "$folder"
    cmake -S "$source" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DVIEWGAIN_BUILD_APPS=OFF -DVIEWGAIN_BUILD_TESTS=OFF -DVIEWGAIN_BUILD_PERF=OFF \
      -DVIEWGAIN_BUILD_PYTHON=OFF -DVIEWGAIN_BUILD_MESH=OFF "-DCMAKE_INSTALL_PREFIX=$folder/usr" \
      "-DCMAKE_INSTALL_LIBDIR=$folder/lib" "-DCMAKE_INSTALL_INCLUDEDIR=$folder/usr/inc" >/dev/null
    export PKG_CONFIG_PATH=$folder/build
    [ "$(pkg-config --variable=libdir viewgain)" = "$folder/lib" ] || fail "$(pkg-config --variable=libdir viewgain)"
    [ "$(pkg-config --variable=includedir viewgain)" = "$folder/usr/inc" ] ||
      fail "$(pkg-config --variable=includedir viewgain)"
    [ "$(pkg-config --variable=prefix viewgain)" = "$folder/usr" ] || fail "$(pkg-config --variable=prefix viewgain)"
    ;;
  *) fail "unknown kind" ;;
esac
