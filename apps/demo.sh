#!/usr/bin/env bash
# The camel from nothing, on Debian 12: installs what is missing, builds, simulates three views of a
# time-of-flight camera, maps them, and scores 2,000 candidate views. Leaves out/demo/: map.vdb,
# scores.csv and best_view.png.
set -euo pipefail
cd "$(dirname "$0")/.."

./apps/install_dependencies.sh
echo "building (the first time takes some minutes)" >&2
mkdir -p build
cmake --preset release >build/demo_configure.log 2>&1 || { cat build/demo_configure.log >&2; exit 1; }
cmake --build --preset release --target viewgain_program >&2

viewgain=build/release/bin/viewgain
frames=build/demo_frames
out=out/demo
./apps/extract_mesh.sh camel.off build/meshes
mkdir -p "$out"

"$viewgain" simulate build/meshes/camel.off --orbit 3,0.6,27,0,46 --sensor sr4000 \
  --center --size 0.35 --background 1.5 --noise off --out "$frames"
"$viewgain" integrate "$frames" --voxel 0.003125 --workspace -0.2,-0.2,-0.2,0.2,0.2,0.2 \
  --out "$out/map.vdb"
"$viewgain" score "$out/map.vdb" --sphere 2000,0.6 --sensor sr4000 --top 10 \
  --out "$out/scores.csv" --picture "$out/best_view.png"
echo "left in $out: map.vdb, scores.csv, best_view.png"
