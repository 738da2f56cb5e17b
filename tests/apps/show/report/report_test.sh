#!/usr/bin/env bash
# Reports of runs and of a ranking, in a real browser: report_test.mjs and wall_test.mjs say what is checked. Skipped (77)
# where npm, its registry or the browser is missing, or the program was built without npm.
#   report_test.sh VIEWGAIN_BIN_FOLDER WORK_FOLDER
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
export PATH=$1:$PATH
mkdir -p "$2"
work=$(cd "$2" && pwd)

if ! npm --version >/dev/null 2>&1; then echo "skipped: there is no npm"; exit 77; fi
cp "$here"/*.mjs "$here"/*.json "$work"
cd "$work"
node --test "$here/blocks_test.mjs"
if ! npm ci --ignore-scripts --no-audit --no-fund --loglevel=error; then
  echo "skipped: npm cannot install playwright-core"
  exit 77
fi

# An icosahedron, so that nothing is alike from two sides.
cat >object.off <<'MESH'
OFF
12 20 0
0 1 1.618
0 -1 1.618
0 1 -1.618
0 -1 -1.618
1 1.618 0
-1 1.618 0
1 -1.618 0
-1 -1.618 0
1.618 0 1
-1.618 0 1
1.618 0 -1
-1.618 0 -1
3 0 1 8
3 0 8 4
3 0 4 5
3 0 5 9
3 0 9 1
3 1 9 7
3 1 7 6
3 1 6 8
3 8 6 10
3 8 10 4
3 4 10 2
3 4 2 5
3 5 2 11
3 5 11 9
3 9 11 7
3 3 6 7
3 3 7 11
3 3 11 2
3 3 2 10
3 3 10 6
MESH
rm -rf run before in_bin
status=0
run() { viewgain reconstruct object.off --size 0.3 --sensor sr4000 --voxel 0.006 --pictures off "$@" >log.txt 2>&1; }
run --max-views 3 --policy random --out before
run --max-views 4 --report before --out run || status=$?
if [ "$status" -ne 0 ]; then
  cat log.txt
  if grep -q "without the report page" log.txt; then echo "skipped: built without npm"; exit 77; fi
  exit 1
fi
viewgain score run/map.vdb --poses sphere:200,0.6 --report score.html >>log.txt 2>&1
node make_bin.mjs >bin.off
printf '[[box]]\nmin = [-1, -1, 0.25]\nmax = [1, 1, 1]\n' >reach.toml
viewgain reconstruct bin.off --sensor sr4000 --voxel 0.008 --pictures off --max-views 2 --reach reach.toml \
  --from 0,0,0.6,1,0,0,0 --report on --out in_bin >>log.txt 2>&1
node wall_test.mjs in_bin/report.html run/report.html
node report_test.mjs run/report.html reconstruct
node report_test.mjs score.html score
