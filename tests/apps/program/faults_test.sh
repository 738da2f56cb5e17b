#!/usr/bin/env bash
# Runs on a full disk, into folders that cannot be written or vanish, with nobody who reads: each says so
# in one line, and goes on with --resume to the bytes of a run that nothing happened to.
#   faults_test.sh PROGRAM WORK_FOLDER
set -euo pipefail
program=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
if [ "${3:-}" != inside ]; then
  unshare -rm true 2>/dev/null || { echo "no namespace of mounts here"; exit 77; }
  exec unshare -rm "$(realpath "$0")" "$program" "$2" inside
fi
rm -rf "$2"
mkdir -p "$2"
cd "$2"
cases=0
cp "$here/cube.off" .

reconstruct() { "$program" reconstruct cube.off --size 0.2 --sensor sr4000 --voxel 0.0125 --resume "$@"; }
run() { reconstruct --max-views 3 "$@"; }

# fails CODE WORDS COMMAND: ends so, and says so in one last line.
fails() {
  local code=0
  "${@:3}" >said.out 2>said.err || code=$?
  [ "$code" = "$1" ] || { echo "$3: ended with $code, not $1"; cat said.err; exit 1; }
  [ "$(grep -c '^viewgain: ' said.err)" = 1 ] || { echo "not one line:"; cat said.err; exit 1; }
  grep -q "^viewgain: .*$2" said.err || { echo "no \"$2\" in:"; cat said.err; exit 1; }
  cases=$((cases + 1))
}

same() {
  diff -r --exclude run.json whole "$1"
  python3 - whole/run.json "$1/run.json" <<'PYTHON'
import json, sys

def kept(value):
    if isinstance(value, dict):
        return {k: kept(v) for k, v in value.items() if k != "seconds"}
    return [kept(v) for v in value] if isinstance(value, list) else value

assert kept(json.load(open(sys.argv[1]))) == kept(json.load(open(sys.argv[2]))), "run.json differs"
PYTHON
  cases=$((cases + 1))
}

run --quiet --out whole >/dev/null

# A full disk: what is there stays, and the run goes on when there is room.
mkdir disk
mount -t tmpfs -o size=300k tmpfs disk
echo mine >disk/mine.txt
fails 2 "No space left" run --quiet --out disk/run
[ "$(cat disk/mine.txt)" = mine ]
ls disk/.run.tmp-*/checkpoint.json >/dev/null
mount -o remount,size=64m disk
run --quiet --out disk/run >/dev/null
same disk/run
[ "$(ls -A disk | tr '\n' ' ')" = "mine.txt run " ]

# A disk that cannot be written.
mount -o remount,ro disk
before=$(find disk -type f -exec sha256sum {} + | sort)
fails 2 "Read-only" run --quiet --out disk/run
fails 2 "Read-only" run --quiet --out disk/other
[ "$before" = "$(find disk -type f -exec sha256sum {} + | sort)" ]
umount disk

# The folder vanishes while the run writes. On a busy machine, three views may end before that.
mkdir -p gone
reconstruct --max-views 20 --quiet --save-maps on --out gone/run >said.out 2>said.err &
while ! ls gone/.run.tmp-*/maps/00.vdb >/dev/null 2>&1; do sleep 0.01; done
mv gone elsewhere
rm -rf elsewhere
fails 2 "No such file" wait $!
run --quiet --out gone/run >/dev/null
same gone/run

# Nobody reads how far it is: the run ends well. Nobody reads what came of it: the run is there.
run --out pipe 2> >(true) >/dev/null
same pipe
rm -r pipe
{ run --quiet --out pipe 2>said.err || echo $? >code; } | true
[ "$(cat code)" = 1 ]
grep -q '^viewgain: cannot write to the standard output$' said.err
same pipe

[ "$cases" -ge 8 ] || { echo "only $cases cases"; exit 1; }
echo "$cases cases"
