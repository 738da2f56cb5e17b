#!/usr/bin/env bash
# The examples labels and frames run; C++ and Python say the same of the same frames.
#   scorer_test.sh SOURCE BIN_FOLDER [PYTHON PACKAGES]
set -euo pipefail
source=$1 bin=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for example in labels.cpp frames.cpp frames.c frames.py octomap_planner.cpp score_poses.c score_poses.cpp; do
  [ "$(wc -l <"$source/apps/examples/$example")" -le 40 ] || { echo "$example is longer than 40 lines" >&2; exit 1; }
done
"$bin/labels" | tee labels.txt
# Five slices; what is free leaves less to expect.
awk '{ gain[NR] = $(NF - 1) } END { exit !(NR == 5 && gain[5] < gain[1]) }' labels.txt
"$bin/frames" | tee frames.txt
[ "$(grep -c '^view' frames.txt)" = 5 ]
[ -z "$(tail -1 frames.txt)" ] # the frames agree
"$bin/viewgain" info frames_map.vdb | grep ^hash >hash.txt
"$bin/frames_c" | tee frames_c.txt
grep -qE '^[1-9][0-9]* cm2 seen; next pose [0-9]+, [1-9][0-9.]* nat$' frames_c.txt
if [ $# -gt 2 ]; then
  rm frames_map.vdb
  PYTHONPATH=$4 "$3" "$source/apps/examples/frames.py" | tee frames_py.txt
  diff <(grep '^view' frames.txt) <(grep '^view' frames_py.txt)
  [ "$(tail -1 frames_py.txt)" = None ]
  "$bin/viewgain" info frames_map.vdb | grep ^hash | diff hash.txt -
fi
