#!/usr/bin/env bash
# Loops, scores and next views as they were, compared with tests/golden.txt:
# - `viewgain reconstruct` and `viewgain score` for three objects and three policies, with one and with two threads
#   and with every instruction set of this machine: the map's hash, run.json without its times, the scores;
# - of six of these maps the next views and their JSON without times (`viewgain next`);
# - two recordings, round the demo's camel and in a room: the map and JSON of `integrate`, `model` and
#   `model --watch`.
#   tests/golden.sh [PROGRAM]            default: build/release/bin/viewgain; ends with 1 where anything differs
#   tests/golden.sh --record [PROGRAM]   writes tests/golden.txt anew; the commit says what changed and why
set -euo pipefail
cd "$(dirname "$0")/.."

record=no
if [ "${1:-}" = "--record" ]; then
  record=yes
  shift
fi
viewgain=$(realpath "${1:-build/release/bin/viewgain}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

isas=(sse4)
grep -qw avx2 /proc/cpuinfo && isas+=(avx2)
grep -qw avx512f /proc/cpuinfo && isas+=(avx512)

# JSON without the values that a machine or its load sets.
without_times() {
  python3 - "$1" <<'PYTHON'
import json, sys

OMITTED = "seconds", "seconds_per_frame", "mesh", "out", "threads"

def kept(value):
    if isinstance(value, dict):
        return {k: kept(v) for k, v in value.items() if k not in OMITTED}
    return [kept(v) for v in value] if isinstance(value, list) else value

print(json.dumps(kept(json.load(open(sys.argv[1])))))
PYTHON
}

hash_of() { "$viewgain" info "$1" | sed -n 's/^hash *\(.\{16\}\).*/\1/p'; }

# One run: hash of the map, of run.json and of the scores.
figures() {
  local object=$1 policy=$2 isa=$3 threads=$4
  local out=$work/$object-$policy-$isa-$threads
  VIEWGAIN_ISA=$isa "$viewgain" reconstruct "$work/$object.off" --size 0.35 --sensor sr4000 --voxel 0.005 \
    --policy "$policy" --max-views 4 --seed 3 --threads "$threads" --pictures off --out "$out" >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; return 1; }
  VIEWGAIN_ISA=$isa "$viewgain" score "$out/map.vdb" --poses sphere:100,0.6 --sensor sr4000 --gain paper --threads "$threads" \
    --out "$out/scores.csv" >"$work/log" 2>&1 || { cat "$work/log" >&2; return 1; }
  printf '%s %s %s' "$(hash_of "$out/map.vdb")" \
    "$(without_times "$out/run.json" | sha256sum | cut -c1-16)" "$(sha256sum <"$out/scores.csv" | cut -c1-16)"
}

short() { sha256sum | cut -c1-16; }

# Runs the program in the folder of work, where files have the same names in each call.
call() { (cd "$work" && VIEWGAIN_ISA=sse4 "$viewgain" "$@" 2>"$work/log") || { cat "$work/log" >&2; return 1; }; }

# The next views of a map, and their JSON.
next_views() {
  call next "$@" --top 5 --json --out next.txt --quiet >"$work/next.json"
  printf '%s %s' "$(short <"$work/next.txt")" "$(without_times "$work/next.json" | short)"
}

# A recording by the three ways from frames.
recording() {
  local name=$1 layout=(--voxel "$2" --workspace "$3")
  call integrate "$name" "${layout[@]}" --out "$name.vdb" --json --quiet >"$work/integrate.json"
  printf '%s integrate %s %s\n' "$name" "$(hash_of "$work/$name.vdb")" \
    "$(without_times "$work/integrate.json" | short)"
  call model "$name" "${layout[@]}" --out "$name-run" --quiet >/dev/null
  printf '%s model %s %s\n' "$name" "$(hash_of "$work/$name-run/map.vdb")" \
    "$(without_times "$work/$name-run/run.json" | short)"
  touch "$work/$name/done" # ends the watch
  call model "$name" --watch "${layout[@]}" --top 5 --out "$name-plan" --quiet >/dev/null
  printf '%s watch %s %s\n' "$name" "$(short <"$work/$name-plan/next.txt")" \
    "$(without_times "$work/$name-plan/next.json" | short)"
}

runs=0
for object in camel lion-head mannequin-devil; do
  ./apps/extract_mesh.sh "$object.off" "$work" >/dev/null
  for policy in gain frontier kriegel; do
    for isa in "${isas[@]}"; do
      for threads in 1 2; do
        printf '%s %s %s %s %s\n' "$object" "$policy" "$isa" "$threads" \
          "$(figures "$object" "$policy" "$isa" "$threads")" >>"$work/golden.txt"
        runs=$((runs + 1))
      done
    done
    [ "$policy" = kriegel ] ||
      printf '%s %s next sse4 %s\n' "$object" "$policy" \
        "$(next_views "$object-$policy-sse4-2/map.vdb")" \
        >>"$work/golden.txt"
  done
done

# The demo's camel, with noise; and a room of 3 m with a table and a cupboard, seen from its middle.
"$viewgain" simulate "$work/camel.off" --size 0.35 --place center --up y --poses orbit:8,0.6,27 --sensor sr4000 --noise on \
  --out "$work/demo" --quiet >/dev/null
python3 - "$work" <<'PYTHON'
import math, sys

def box(low, high, inward):
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, [q[::-1] if inward else q for q in quads]

parts = [box((-1.5, -1.2, 0), (1.5, 1.2, 2.2), True), box((0.5, 0.1, 0), (1.2, 0.9, 0.7), False),
         box((-1.4, -1.1, 0), (-0.9, -0.3, 1.8), False)]
vertices, faces = [], []
for corners, quads in parts:
    faces += [[len(vertices) + i for i in quad] for quad in quads]
    vertices += corners
with open(sys.argv[1] + "/room.off", "w") as file:
    print("OFF\n", len(vertices), len(faces), 0, file=file)
    for vertex in vertices:
        print(*vertex, file=file)
    for face in faces:
        print(4, *face, file=file)
with open(sys.argv[1] + "/room.txt", "w") as file:
    for i in range(6):  # looking outward, turning by 60 degrees: x right, y down, z forward
        half = math.radians(60 * i - 90) / 2
        q = [math.cos(half) * -math.sqrt(0.5), -math.sin(half) * math.sqrt(0.5), math.sin(half) * math.sqrt(0.5),
             math.cos(half) * math.sqrt(0.5)]  # Rz(turn) * Rx(-90 degrees)
        print(i, 0.1 * i - 0.3, 0.05 * i, 1.1, *q, file=file)
PYTHON
"$viewgain" simulate "$work/room.off" --poses "$work/room.txt" --sensor kinect_v1 --noise on --background 0 \
  --out "$work/room" --quiet >/dev/null
recording demo 0.005 -0.2,-0.2,-0.2,0.2,0.2,0.2 >>"$work/golden.txt"
recording room 0.05 -1.6,-1.3,-0.1,1.6,1.3,2.3 >>"$work/golden.txt"

if [ "$record" = yes ]; then
  { echo "# object policy isa threads map run.json scores, or recording command and hashes (tests/golden.sh --record)"
    cat "$work/golden.txt"; } \
    >tests/golden.txt
  echo "recorded $runs runs"
  exit 0
fi
# A machine without some instruction set compares the others.
grep -E " ($(IFS='|'; echo "${isas[*]}")) |^(demo|room) " tests/golden.txt >"$work/expected.txt"
if ! diff -u "$work/expected.txt" "$work/golden.txt"; then
  echo "golden: the lines above differ from tests/golden.txt" >&2
  exit 1
fi
echo "golden: $runs runs as recorded"
