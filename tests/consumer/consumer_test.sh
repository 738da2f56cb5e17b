#!/usr/bin/env bash
# Builds and runs a project of a user of viewgain.
#   consumer_test.sh KIND SOURCE_FOLDER BUILD_FOLDER WORK_FOLDER EXPECTED_GAIN_PROGRAM
# KIND: install, install_static (these two first: the others use what they leave in WORK_FOLDER);
# find_package, native, moved, static, static_native, pkg_config, add_subdirectory, headers, python,
# wrong_version, no_component.
set -euo pipefail
kind=$1 source=$2 build=$3 work=$4 expected=$5
here=$source/tests/consumer
export VIEWGAIN_OBJECTS=$build
unset LD_LIBRARY_PATH
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

# A project that finds viewgain under a prefix, built, and its three programs run.
check_project() { # PREFIX [cmake arguments]
  local folder=$work/$kind
  rm -rf "$folder"
  cmake -S "$here/find_package" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    "-DCMAKE_PREFIX_PATH=$1" "${@:2}" >/dev/null
  quiet_build "$folder"
  check_gain "$folder/gain"
  check_gain "$folder/gain_c" c
  local answers
  answers=$("$folder/boundary" "$folder/map.vdb")
  [ "$answers" = 11111111 ] || fail "boundary.cpp says $answers"
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
      -DVIEWGAIN_BUILD_PERF=OFF -DVIEWGAIN_BUILD_PYTHON=OFF \
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
    # Split on purpose.
    # shellcheck disable=SC2046
    c++ -std=c++20 "$here/gain.cpp" -o "$work/$kind/by_pkg_config" \
      $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs viewgain)
    check_gain "$work/$kind/by_pkg_config"
    ;;
  static_native) check_project "$work/static_prefix" -DCMAKE_CXX_FLAGS=-march=native ;;
  pkg_config)
    mkdir -p "$work/$kind"
    pc=$(dirname "$(find "$work/prefix" -name viewgain.pc)")
    libraries=$(dirname "$pc")
    # Split on purpose.
    # shellcheck disable=SC2046
    c++ -std=c++20 "$here/gain.cpp" -o "$work/$kind/gain" "-Wl,-rpath,$libraries" \
      $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs "viewgain >= 0.1")
    check_gain "$work/$kind/gain"
    # C99 with the one header.
    # shellcheck disable=SC2046
    cc -std=c99 -pedantic -Wall -Wextra -Werror "$here/gain.c" -o "$work/$kind/gain_c" \
      "-Wl,-rpath,$libraries" $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs viewgain)
    check_gain "$work/$kind/gain_c" c
    # shellcheck disable=SC2046
    c++ -std=c++20 "$here/boundary.cpp" -o "$work/$kind/boundary" "-Wl,-rpath,$libraries" \
      $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs viewgain-mesh)
    [ "$("$work/$kind/boundary" "$work/$kind/map.vdb")" = 11111111 ] || fail "boundary.cpp"
    ;;
  add_subdirectory)
    folder=$work/$kind
    rm -rf "$folder"
    cmake -S "$here/add_subdirectory" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      "-DVIEWGAIN_SOURCE=$source" "-DCMAKE_CXX_COMPILER_LAUNCHER=$here/reuse_objects.sh" >/dev/null
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
    ! grep -oE '[^ ]*/(openvdb|embree[34]?|CGAL|tbb|oneapi|hwy|boost|Imath)/[^ ]*' "$work/all.d" ||
      fail "a public header brings in a private library"
    ;;
  python)
    # Both modules, found where they were installed, with libraries of the same prefix.
    package=$(find "$work/prefix" -type d -path '*-packages/viewgain')
    export PYTHONPATH=${package%/viewgain} PYTHONDONTWRITEBYTECODE=1
    # The frame of its map begins elsewhere than gain.cpp's: equal but for rounding.
    gain=$("$here/gain.py")
    awk -v a="$gain" -v b="$("$expected")" 'BEGIN { exit !(a > 0 && (a / b - 1) ^ 2 < 1e-20) }' ||
      fail "the gain is $gain, expected $("$expected")"
    /usr/bin/python3 -c "import viewgain.mesh; print(viewgain.mesh.__file__)" | grep -q "^$work/prefix/" ||
      fail "another viewgain.mesh was found"
    for extension in "$package"/_viewgain.*.so; do
      nm -DC "$extension" >"$work/$kind.symbols"
      ! grep -E 'CGAL|gmp|mpfr' "$work/$kind.symbols" || fail "$extension holds CGAL"
      ! readelf -d "$extension" | grep -E 'NEEDED.*(gmp|mpfr|CGAL|viewgain_mesh)' ||
        fail "$extension is linked to CGAL's libraries"
    done
    ;;
  wrong_version | no_component)
    folder=$work/$kind
    rm -rf "$folder" && mkdir "$folder"
    if [ "$kind" = wrong_version ]; then
      request="viewgain 9.0 REQUIRED"
      message='compatible with requested version "9.0"'
    else
      request="viewgain REQUIRED COMPONENTS mesh hovercraft"
      message='without the component hovercraft'
    fi
    printf 'cmake_minimum_required(VERSION 3.22)\nproject(consumer LANGUAGES CXX)\nfind_package(%s)\n' \
      "$request" >"$folder/CMakeLists.txt"
    if cmake -S "$folder" -B "$folder/build" "-DCMAKE_PREFIX_PATH=$work/prefix" >"$folder/log" 2>&1; then
      fail "find_package($request) was accepted"
    fi
    tr -s ' \n' ' ' <"$folder/log" | grep -qF "$message" || { cat "$folder/log" >&2; fail "no clear message"; }
    ;;
  *) fail "unknown kind" ;;
esac
