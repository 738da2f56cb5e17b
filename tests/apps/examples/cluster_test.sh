#!/usr/bin/env bash
# apps/examples/cluster on this machine: a job of GNU parallel's is killed and the call resumed; make and the SLURM script leave
# the same bytes as one call. A folder with another job's parts is refused.
#
#   cluster_test.sh SOURCE_FOLDER BIN_FOLDER MAP
set -euo pipefail
cluster=$(realpath "$1")/apps/examples/cluster bin=$(realpath "$2") map=$(realpath "$3")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "$*" >&2; exit 1; }
export VIEWGAIN=$bin/viewgain
flags=(--sphere 900,0.6 --sensor sr4000 --stride 8)
"$VIEWGAIN" score "$map" "${flags[@]}" --shard 0/1 --out whole.npy >/dev/null
"$VIEWGAIN" merge whole.npy --top 100 --out whole_best.npy >/dev/null
{ cat "$map"; echo; } >other.vdb
refused=0
refuse() {
  local code=0
  "$@" >said 2>&1 || code=$?
  [ $code = 2 ] && [ "$(grep -c "belongs to another job" said)" = 1 ] || fail "not refused ($code): $* $(cat said)"
  refused=$((refused + 1))
}

# The program, of which the first call for shard 4 is killed at its work.
cat >killed <<END
#!/usr/bin/env bash
echo "\$*" >>"$folder/calls"
if [[ "\$*" == *"--shard 4/9"* ]] && mkdir "$folder/once" 2>/dev/null; then
  "$VIEWGAIN" "\$@" &
  sleep 0.02
  kill -9 \$!
  wait \$! || exit 137
fi
exec "$VIEWGAIN" "\$@"
END
chmod +x killed
if command -v parallel >/dev/null; then
  if VIEWGAIN=$folder/killed JOBS=2 THREADS=1 RETRIES=1 "$cluster/score_parallel.sh" 9 "its out" "$map" "${flags[@]}" \
      >said 2>&1; then
    fail "a killed job went unnoticed"
  fi
  grep -q "0 of 9 parts" said || fail "$(cat said)"
  [ "$(find "its out/parts" -name '[0-9].npy' | wc -l)" = 8 ] || fail "not 8 parts: $(ls -A "its out/parts")"
  [ ! -e "its out/scores.npy" ] || fail "an incomplete result"
  VIEWGAIN=$folder/killed JOBS=2 THREADS=1 "$cluster/score_parallel.sh" 9 "its out" "$map" "${flags[@]}" >said 2>&1 ||
    fail "$(cat said)"
  grep -q "8 of 9 parts" said || fail "$(cat said)"
  cmp whole.npy "its out/scores.npy"
  cmp whole_best.npy "its out/best.npy"
  [ -z "$(find "its out" -name '.*')" ] || fail "left behind: $(find "its out" -name '.*')"
  for i in 0 1 2 3 5 6 7 8; do
    [ "$(grep -c -- "--shard $i/9" calls)" = 1 ] || fail "shard $i was not scored once"
  done
  [ "$(grep -c -- "--shard 4/9" calls)" = 2 ] || fail "shard 4 was not scored again"
  echo "parallel: 9 shards, one killed and made again"

  cp "$map" moved.vdb  # a file is what it holds
  "$cluster/score_parallel.sh" 9 "its out" moved.vdb "${flags[@]}" >said 2>&1 || fail "$(cat said)"
  refuse "$cluster/score_parallel.sh" 9 "its out" "$map" "${flags[@]:0:4}" --stride 4
  refuse "$cluster/score_parallel.sh" 9 "its out" other.vdb "${flags[@]}"
  refuse "$cluster/score_parallel.sh" 8 "its out" "$map" "${flags[@]}"
  rm "its out/job.txt"
  refuse "$cluster/score_parallel.sh" 9 "its out" "$map" "${flags[@]}"
  [ $refused = 4 ] || fail "$refused of 4 refused by score_parallel.sh"
  echo "parallel: 4 other jobs refused"
else
  echo "parallel is not installed (apps/install_dependencies.sh --tests)" >&2
  skipped=yes
fi

make -s -f "$cluster/Makefile" -j2 MAP="$map" FLAGS="${flags[*]}" SHARDS=11 OUT=made THREADS=1 >/dev/null
cmp whole.npy made/scores.npy
rm made/parts/08.npy made/scores.npy
make -f "$cluster/Makefile" MAP="$map" FLAGS="${flags[*]}" SHARDS=11 OUT=made THREADS=1 >said
[ "$(grep -c ' score ' said)" = 1 ] || fail "make scored more than what was missing: $(cat said)"
cmp whole.npy made/scores.npy
make -s -f "$cluster/Makefile" MAP="$map" FLAGS="${flags[*]}" SHARDS=11 OUT=made TOP=5 >/dev/null
"$VIEWGAIN" merge whole.npy --top 5 --out five.npy >/dev/null
cmp five.npy made/best.npy
refused=0
refuse make -f "$cluster/Makefile" MAP="$map" FLAGS="${flags[*]:0:4} --stride 4" SHARDS=11 OUT=made
refuse make -f "$cluster/Makefile" MAP=other.vdb FLAGS="${flags[*]}" SHARDS=11 OUT=made
refuse make -f "$cluster/Makefile" MAP="$map" FLAGS="${flags[*]}" SHARDS=10 OUT=made
[ $refused = 3 ] || fail "$refused of 3 refused by make"
cmp whole.npy made/scores.npy
echo "make: 11 shards, one made again, 3 other jobs refused"

isa=$("$VIEWGAIN" score "$map" --sphere 1,0.6 --sensor sr4000 --json | sed -n 's/.*"isa": "\(.*\)".*/\1/p')
for i in 0 2 2; do
  VIEWGAIN_ISA=$isa SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=3 SLURM_CPUS_PER_TASK=1 \
    "$cluster/score_array.slurm" slurm "$map" "${flags[@]}" >/dev/null
done
SHARDS=3 VIEWGAIN_ISA=$isa SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_COUNT=1 \
  "$cluster/score_array.slurm" slurm "$map" "${flags[@]}" >/dev/null
"$VIEWGAIN" merge slurm/parts/*.npy --out slurm/scores.npy >/dev/null
cmp whole.npy slurm/scores.npy
refused=0
export SHARDS=3 VIEWGAIN_ISA=$isa SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_COUNT=1 SLURM_CPUS_PER_TASK=1
refuse "$cluster/score_array.slurm" slurm "$map" "${flags[@]:0:4}" --stride 4
refuse "$cluster/score_array.slurm" slurm other.vdb "${flags[@]}"
SHARDS=2 refuse "$cluster/score_array.slurm" slurm "$map" "${flags[@]}"
[ $refused = 3 ] || fail "$refused of 3 refused by score_array.slurm"
# Tasks of two jobs that start at the same time in a folder: the one job's all go, the other's none.
tasks=()
for i in 0 1 2; do
  for stride in 4 8; do
    SLURM_ARRAY_TASK_ID=$i "$cluster/score_array.slurm" both "$map" "${flags[@]:0:4}" --stride $stride >/dev/null 2>&1 &
    tasks+=($!)
  done
done
codes=
for task in "${tasks[@]}"; do code=0; wait "$task" || code=$?; codes+=$code; done
[[ $codes = 020202 || $codes = 202020 ]] || fail "tasks of two jobs ended with $codes"
"$VIEWGAIN" merge both/parts/*.npy --out both/scores.npy >/dev/null
[ -z "$(find both slurm -name '.*')" ] || fail "left behind: $(find both slurm -name '.*')"
if env -u SHARDS SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=200 "$cluster/score_array.slurm" one "$map" >said 2>&1; then
  fail "an array without shard 0 was taken"
fi
grep -q -- "--array=0-199" said || fail "$(cat said)"
echo "slurm: 3 tasks, 3 other jobs refused, 6 tasks of two jobs at once"
[ -z "${skipped:-}" ] || exit 77
