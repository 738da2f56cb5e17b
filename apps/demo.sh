#!/usr/bin/env bash
# The camel from nothing, on Debian 12: installs what is missing, builds, runs the whole loop on it with
# a simulated time-of-flight camera (acquire, map, propose, rank, move), and scores 2,000 candidate views
# against the map after a few views. Leaves out/demo/: what `viewgain reconstruct` writes, report.html,
# scores.csv and best_view.png.
set -euo pipefail
cd "$(dirname "$0")/.."

./apps/install_dependencies.sh
echo "building (the first time takes some minutes)" >&2
mkdir -p build
cmake --preset program >build/demo_configure.log 2>&1 || { cat build/demo_configure.log >&2; exit 1; }
cmake --build --preset program >&2

viewgain=build/release/bin/viewgain
out=out/demo
# The page of the report comes from npm's registry, which may be out of reach.
report=on
[ -s build/release/apps/show/report/report_page.html ] || report=off
./apps/extract_mesh.sh camel.off build/meshes

"$viewgain" reconstruct build/meshes/camel.off --sensor sr4000 --size 0.35 --voxel 0.003125 --max-views 12 \
  --up y --save-maps on --report "$report" --seed 1 --out "$out"
"$viewgain" score "$out/maps/03.vdb" --poses sphere:2000,0.6 --race --top 10 \
  --out "$out/scores.csv" --picture "$out/best_view.png"
echo "left in $out: run.json, config.toml, views.txt, map.vdb, surface.ply, points.ply, views/, maps/, scores.csv, best_view.png"
[ "$report" = off ] || echo "the run to click through, in a browser: $PWD/$out/report.html"
