#!/bin/sh
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
# Fetches the data of `viewgain-bench armadillo` from its authors and checks them. MIT licence, (c) its authors.
#     perf/peers/get_nbv_simulation.sh FOLDER; viewgain-bench armadillo --data FOLDER
# An existing folder is only checked, so you can use a copy that you fetched elsewhere.
set -eu
url=https://github.com/psc0628/NBV-Simulation.git
commit=92e42de3748fac5109a64c9d1d8da250a34e3ced
if [ $# -ne 1 ]; then
  echo "usage: $0 FOLDER" >&2
  exit 2
fi
if [ ! -e "$1" ]; then
  git clone --quiet "$url" "$1"
  git -C "$1" checkout --quiet "$commit"
fi
fail() {
  echo "$0: $*" >&2
  exit 1
}
points=$1/3d_models/Armadillo.pcd
views=$1/3d_models/Armadillo.txt
[ -f "$points" ] || fail "$points: no such file"
[ -f "$views" ] || fail "$views: no such file"
[ "$(awk '$1 == "POINTS" { print $2; exit }' "$points")" = 47705 ] || fail "$points: expected 47705 points"
[ "$(head -n 1 "$views" | tr -d '\r')" = 5000 ] || fail "$views: expected 5000 views"
[ "$(wc -c < "$views")" -ge 146293 ] || fail "$views: expected at least 146293 bytes"
echo "$1: as published"
