#!/usr/bin/env bash
# The example planner runs, gives the same answer again, and refuses wrong use.
#   octomap_planner_test.sh BIN_FOLDER
set -euo pipefail
planner=$1/octomap_planner
for wrong in 0 -1 x "1 2"; do
  code=0
  # shellcheck disable=SC2086
  said=$("$planner" $wrong 2>&1) || code=$?
  [ "$code" = 2 ] && [[ $said == "usage: "* ]]
done
said=$("$planner" 3)
echo "$said"
# What is known grows, and the best view promises less in the end.
awk '{ changed[NR] = $3; gain[NR] = $(NF - 1) }
     END { exit !(NR == 3 && changed[3] > 1000 && gain[3] < gain[1]) }' <<<"$said"
[ "$("$planner" 3)" = "$said" ]
