#!/usr/bin/env bash
# The example planner runs and gives the same answer again.
#   octomap_planner_test.sh BIN_FOLDER
set -euo pipefail
planner=$1/octomap_planner
said=$("$planner")
echo "$said"
# What is known grows. The first frame tells where the rest of the surface is; after that the best
# view promises less.
awk '{ changed[NR] = $3; gain[NR] = $(NF - 1) }
     END { exit !(NR == 3 && changed[3] > 1000 && gain[3] < gain[2]) }' <<<"$said"
[ "$("$planner")" = "$said" ]
