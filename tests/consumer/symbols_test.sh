#!/usr/bin/env bash
# What the shared libraries show and need.
#   symbols_test.sh LIBVIEWGAIN LIBVIEWGAIN_FORMATS LIBVIEWGAIN_PLANNER OTHERS...
set -euo pipefail
fail() { echo "$*" >&2; exit 1; }
symbols=$(mktemp)
trap 'rm -f "$symbols"' EXIT

for library in "$@"; do
  name=$(basename "$(readlink -f "$library")")
  nm -DC --defined-only "$library" >"$symbols"
  ours=$(grep -c ' viewgain::' "$symbols" || true)
  echo "$name shows $(wc -l <"$symbols") symbols, $ours of them in viewgain::"
  [ "$ours" -gt 0 ] || fail "$name shows nothing"
  # Weak symbols are the compiler's: inline functions of classes that OpenVDB itself exports, templates.
  ! grep -E ' [TBDR] ([a-z ]+ )*(openvdb|embree|CGAL|hwy|boost|tbb|Eigen|viewgain::detail)::' "$symbols" ||
    fail "$name shows what is private"
done

# What is Apache-2.0 stays clear of CGAL, whose surfaces are GPL.
for library in "${@:1:4}"; do
  nm -DC "$library" >"$symbols"
  ! grep -E 'CGAL|gmp|mpfr' "$symbols" || fail "$library holds CGAL"
  ! readelf -d "$library" | grep -E 'NEEDED.*(gmp|mpfr|CGAL|mesh)' || fail "$library is linked to CGAL's libraries"
done
readelf -d "$1" | grep -q 'SONAME.*libviewgain\.so\.0' || fail "$1 has another SONAME"
