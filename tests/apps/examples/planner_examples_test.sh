#!/usr/bin/env bash
# The example planners run, give the same answer again, and refuse wrong use.
#   planner_examples_test.sh BIN_FOLDER NAME...      NAME: octomap_planner, ompl_planner
set -euo pipefail
bin=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

refuses() {
  local code=0
  "$@" >"$work/out" 2>"$work/err" || code=$?
  test "$code" -eq 2
  test ! -s "$work/out"
  grep -q '^usage: ' "$work/err"
}

for name in "$@"; do
  planner=$bin/$name
  refuses "$planner" 0
  refuses "$planner" -1
  refuses "$planner" 12x
  refuses "$planner" 12 13
  case $name in
    octomap_planner)
      # Either entropy has the same best candidates.
      "$planner" 60 | tee "$work/planner"
      awk '
        /^view /             { ++views; candidates += $3 }
        / OctoMap, entropy / { best = $0; sub(/.*best:/, "", best) }
        /viewgain, entropy / { same = $0; sub(/.*best:/, "", same)
                               if (best != "" && best == same) ++alike }
        END { exit !(views == 3 && alike == 3 && candidates >= 45) }' "$work/planner"
      # But for the times it is the same again.
      "$planner" 60 >"$work/again"
      diff <(sed -E 's/[0-9.]+ s\b//' "$work/planner") <(sed -E 's/[0-9.]+ s\b//' "$work/again")
      ;;
    ompl_planner)
      # Views behind the screen, where no straight line leads, are worth the way round it.
      "$planner" 1000 | tee "$work/planner"
      awk '
        NF != 7 && NF != 8 { exit 1 }
        { rate[NR] = $(NF - 1); gain[NR] = $(NF - 3); path[NR] = $(NF - 5)
          expected = gain[NR] / (path[NR] + 0.3)
          if ((rate[NR] - expected)^2 > (0.002 * expected + 0.5)^2) wrong = 1 }
        END { exit !(NR == 3 && !wrong && path[1] == 0 && rate[2] > rate[1] && rate[3] > 1.05 * rate[2]) }' \
        "$work/planner"
      "$planner" 1000 >"$work/again"
      diff "$work/planner" "$work/again"
      ;;
  esac
done
