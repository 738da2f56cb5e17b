#!/usr/bin/env bash
# What viewgain 0.1.0 wrote, a file of each format that later versions read (state.vdb: map, frames and planner). Made once; a later version gets a
# folder of its own beside this one.
#   tests/data/0.1.0/make.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >cube.off <<'END'
OFF
8 6 0
0 0 0
2 0 0
2 2 0
0 2 0
0 0 2
2 0 2
2 2 2
0 2 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
END
cat >small.toml <<'END'
name = "small"
min_range = 0.2
max_range = 5.0
working_distance = 0.4
body = [0.05, 0.05, 0.05]
pose_sigma = [0.001, 0.002]
scale_sigma = 0.001
out_of_range = "carve"
[camera]
width = 48
height = 36
fx = 60.0
fy = 60.0
cx = 23.5
cy = 17.5
distortion = [0.01, 0, 0, 0, 0]
[noise]
model = "quadratic"
offset = 0.001
quadratic = 0.001
[range_calibration]
measured = [0.3, 1.0]
error = [0.001, 0.002]
END
cat >reach.toml <<'END'
format = 1
poses = "reach.poses.txt"
[[box]]
min = [-1, -1, -1]
max = [1, 1, 1]
[[shell]]
center = [0, 0, 0]
min_radius = 0.3
max_radius = 0.9
[[half_space]]
normal = [0, 0, 1]
offset = -0.5
[tolerance]
distance = 0.01
angle_deg = 2
END

space=0,0,0,0.3,0.3,0.3  # a corner of the cube, one leaf of the map
"$program" sensors small.toml >sensor.toml
"$program" simulate cube.off --poses orbit:2,0.6,27 --sensor sensor.toml --size 0.2 --place center --out frames >log
touch frames/done
"$program" model frames --watch --voxel 0.0375 --workspace "$space" --top 2 --out plan --quiet >log
"$program" next plan/state.vdb --top all --generator sphere --count 4 --sensor sensor.toml --out reach.poses.txt >log
flags=(reconstruct cube.off --sensor sensor.toml --size 0.2 --voxel 0.02 --max-views 3 --stop idle=0 --pictures off --resume)
"$program" "${flags[@]}" --out run >log 2>&1
"$program" "${flags[@]}" --out ended >log 2>&1 &
until grep -qs candidate .ended.tmp-*/checkpoint.json; do :; done
kill -9 $!

cp sensor.toml reach.toml reach.poses.txt "$here"
cp plan/state.vdb "$here"
cp run/run.json .ended.tmp-*/checkpoint.json "$here"
{
  "$program" --version
  "$program" info "$here/state.vdb" | sed -n 's/^hash *//p'
} >"$here/made.txt"
