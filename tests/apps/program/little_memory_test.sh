#!/usr/bin/env bash
# Each command, with memory that ends at another moment each time: it does what it does with enough, or says so
# in one line and leaves nothing half written. It neither crashes nor waits for ever, and what goes on, goes on.
#   little_memory_test.sh PROGRAM WORK_FOLDER [LIMITS]     so many a command
set -euo pipefail
program=$(realpath "$1")
limits=${3:-11}
here=$(realpath "$(dirname "$0")")
case "$(ldd "$program")" in
  *lib[at]san*)
    echo "sanitizers need more memory than there is"
    exit 77
    ;;
esac
rm -rf "$2"
mkdir -p "$2"
cd "$2"
cp "$here/cube.off" .
ended=0 done=0

# What the loader and libraries take before the program begins is not ours: from where it says its version on.
least=100000
while ! { (ulimit -v "$least" && "$program" --version) >/dev/null 2>&1; } 2>/dev/null; do
  least=$((least + 10000))
  [ "$least" -lt 1000000 ] || { echo "it does not start with $least kB"; exit 1; }
done
least=$((least + 20000)) most=$((least + 250000 + 20000 * $(nproc)))  # threads have stacks
step=$(((most - least) / limits))

# wrong WHAT: of the call with $kilobytes
wrong() {
  echo "$1, with $kilobytes kB:"
  cat said.err
  exit 1
}

# The call with enough memory, in whole/.
with_enough() {
  rm -rf out whole
  mkdir out
  kilobytes=all
  "$program" "$@" >said.out 2>said.err || wrong "$1"
}

# The call with so little memory; its exit code.
limited() {
  local code=0
  (ulimit -v "$kilobytes" && timeout -s KILL 120 "$program" "$@" >said.out 2>said.err) || code=$?
  case $code in
    0) done=$((done + 1)) ;;
    1 | 2)
      [ "$(wc -l <said.err)" = 1 ] && grep -q '^viewgain: ' said.err || wrong "$1: not one line"
      ended=$((ended + 1))
      ;;
    *) wrong "$1: ended with $code" ;;
  esac
  return $code
}

# same FOLDER OTHER: but for times; a map that is gone on with has the same hash
same() {
  diff -r --exclude '*.json' --exclude '*.csv' --exclude table.md --exclude state.vdb "$1" "$2" || wrong "$2 is another"
  local map=run/state.vdb
  [ ! -e "$1/$map" ] || { "$program" info "$1/$map" >one.txt && "$program" info "$2/$map" >two.txt && cmp one.txt two.txt; } ||
    wrong "$2/$map is another"
}

# sweep COMMAND...: writes to out/*, or nowhere
sweep() {
  with_enough "$@"
  mv out whole
  for ((kilobytes = least; kilobytes <= most; kilobytes += step)); do
    mkdir out
    if limited "$@"; then
      same whole out
    else
      [ -z "$(ls -A out)" ] || wrong "$1: leaves $(ls -A out)"
    fi
    rm -r out
  done
}

# goes_on COMMAND...: writes to out/run, and goes on with what an earlier call left
goes_on() {
  with_enough "$@"
  mv out whole
  for ((kilobytes = least; kilobytes <= most; kilobytes += step)); do
    if limited "$@"; then
      same whole out
      rm -r out
    fi
  done
  kilobytes=all
  "$program" "$@" >said.out 2>said.err || wrong "$1, gone on with"
  same whole out
}

workspace=--workspace=-0.15,-0.15,-0.15,0.25,0.25,0.25
mesh="cube.off --size 0.2 --sensor sr4000"
# shellcheck disable=SC2086
goes_on reconstruct $mesh --voxel 0.0125 --max-views 3 --resume --quiet --threads 1 --out out/run
cp -r whole/run .
cp run/map.vdb .
# shellcheck disable=SC2086
sweep simulate $mesh --poses sphere:4,0.6 --quiet --threads 2 --out out/frames
cp -r whole/frames .
touch frames/done
goes_on model frames --watch --voxel 0.0125 $workspace --quiet --threads 2 --out out/run
sweep model frames --voxel 0.0125 $workspace --quiet --threads 2 --out out/run
sweep integrate frames --voxel 0.0125 $workspace --quiet --threads 2 --out out/map.vdb
sweep convert map.vdb out/map.ot
sweep surface map.vdb --threads 2 --out out/surface.ply
sweep next map.vdb --top all --generator boundary --threads 2 --out out/poses.txt
sweep render map.vdb map --threads 2 --out out/map.png
sweep render run sigma --threads 2 --out out/run.png
sweep info map.vdb
sweep next map.vdb --top 3 --threads 2
sweep score map.vdb --poses sphere:200,0.6 --top 3 --threads 2
sweep score map.vdb --poses sphere:200,0.6 --top 3 --threads 2 --trace embree
sweep score map.vdb --poses sphere:200,0.6 --top 3 --threads 2 --race --obstacle cube.off
[ "$ended" -ge 30 ] && [ "$done" -ge 20 ] || { echo "only $ended calls ended, $done were done"; exit 1; }
echo "$ended calls ended, $done were done"
