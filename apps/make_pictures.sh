#!/usr/bin/env bash
# Makes every picture of the READMEs and the site from the program's own output: apps/docs/gallery/, perf/*.png, apps/docs/figures/*.png. Needs a
# full build and some minutes of a quiet machine; coverage, which makes a study, some hours.
#   apps/make_pictures.sh [demo] [gains] [idea] [speed] [coverage] [approximate] [scaling] [depth_images] [scales] [own_camera]; default: all
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH=$PWD/build/release/bin:$PATH PYTHONPATH=$PWD/build/release/python
python=/usr/bin/python3
gallery=apps/docs/gallery
work=build/pictures
mkdir -p "$work"
wanted=("$@")
[ "${#wanted[@]}" -gt 0 ] || wanted=(demo gains idea speed coverage approximate scaling depth_images scales own_camera)

# What demo.sh makes, kept for the pictures that show it.
demo() {
  [ -e "$work/demo/run.json" ] && return
  ./apps/extract_mesh.sh camel.off build/meshes
  viewgain reconstruct build/meshes/camel.off --size 0.35 --up y --sensor sr4000 --voxel 0.003125 \
    --max-views 12 --save-maps on --seed 1 --out "$work/demo"
}

for picture in "${wanted[@]}"; do
  case "$picture" in
    demo)
      demo
      "$python" $gallery/draw.py step "$work/demo/views/03.png" $gallery/demo.png ;;
    gains)
      demo
      # The README's own lines, in a folder where they find what they name.
      mkdir -p "$work/python/out"
      ln -sfn "$PWD/$work/demo" "$work/python/out/demo"
      awk '/^```python$/ {inside = 1; next} /^```$/ {inside = 0} inside' README.md >"$work/python/gains.py"
      (cd "$work/python" && MPLBACKEND=agg "$python" gains.py)
      cp "$work/python/gains.png" $gallery/gains.png ;;
    idea)
      demo
      viewgain score "$work/demo/maps/02.vdb" --poses sphere:2000,0.6 --gain paper --top 1 --picture "$work/idea.png"
      "$python" $gallery/draw.py idea "$work/idea.png" $gallery/idea.png ;;
    speed)
      viewgain-bench trace --threads 2 --json >"$work/trace.json"
      "$python" $gallery/draw.py speed "$work/trace.json" $gallery/speed.png ;;
    coverage)
      for mesh in camel lion-head mannequin-devil armadillo elephant bunny00; do
        ./apps/extract_mesh.sh "$mesh.off" build/meshes
      done
      python3 -m viewgain.study perf/studies/policies.toml --out "$work/policies" >"$work/policies.md"
      "$python" $gallery/draw.py coverage "$work/policies/results.json" $gallery/coverage.png ;;
    approximate)
      viewgain-bench approximate --json >"$work/approximate.json"
      "$python" perf/plot.py "$work/approximate.json" perf/approximate.png ;;
    scaling)
      viewgain-bench scaling --json >"$work/scaling.json"
      "$python" perf/plot.py "$work/scaling.json" perf/scaling.png ;;
    scales)
      "$python" perf/mug.py --picture apps/docs/figures/scales.png ;;
    depth_images)
      examples=$PWD/apps/examples
      (cd "$work" && MPLBACKEND=agg "$python" "$examples/depth_images.py")
      for part in gains known why; do cp "$work/$part.png" "apps/docs/figures/depth_images_$part.png"; done ;;
    own_camera)
      data=tests/data/recordings
      viewgain import $data/arm_zstd.mcap --sensor $data/frames/sensor.toml --out "$work/own/frames"
      viewgain model "$work/own/frames" --voxel 0.01 --workspace=-0.26,-0.26,-0.26,0.26,0.26,0.26 --out "$work/own/run"
      viewgain render "$work/own/run" surface --viewer 40,25,640 --out apps/docs/figures/own_camera.png ;;
    *) echo "apps/make_pictures.sh: no picture $picture" >&2; exit 2 ;;
  esac
done
