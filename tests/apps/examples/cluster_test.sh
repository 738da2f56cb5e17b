#!/usr/bin/env bash
# apps/examples/cluster on this machine: a job of GNU parallel's is killed and the call resumed; make and the SLURM script leave
# the same bytes as one call.
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
  if VIEWGAIN=$folder/killed JOBS=2 THREADS=1 RETRIES=1 "$cluster/score_parallel.sh" 9 out "$map" "${flags[@]}" >said 2>&1; then
    fail "a killed job went unnoticed"
  fi
  grep -q "0 of 9 parts" said || fail "$(cat said)"
  [ "$(find out/parts -name '[0-9].npy' | wc -l)" = 8 ] || fail "not 8 parts: $(ls -A out/parts)"
  [ ! -e out/scores.npy ] || fail "an incomplete result"
  VIEWGAIN=$folder/killed JOBS=2 THREADS=1 "$cluster/score_parallel.sh" 9 out "$map" "${flags[@]}" >said 2>&1 || fail "$(cat said)"
  grep -q "8 of 9 parts" said || fail "$(cat said)"
  cmp whole.npy out/scores.npy
  cmp whole_best.npy out/best.npy
  [ -z "$(find out/parts -name '.*tmp*')" ] || fail "left behind: $(ls -A out/parts)"
  for i in 0 1 2 3 5 6 7 8; do
    [ "$(grep -c -- "--shard $i/9" calls)" = 1 ] || fail "shard $i was not scored once"
  done
  [ "$(grep -c -- "--shard 4/9" calls)" = 2 ] || fail "shard 4 was not scored again"
  echo "parallel: 9 shards, one killed and made again"
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
echo "make: 11 shards, one made again"

isa=$("$VIEWGAIN" score "$map" --sphere 1,0.6 --sensor sr4000 --json | sed -n 's/.*"isa": "\(.*\)".*/\1/p')
for i in 0 2 2; do
  VIEWGAIN_ISA=$isa SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=3 SLURM_CPUS_PER_TASK=1 \
    "$cluster/score_array.slurm" slurm "$map" "${flags[@]}" >/dev/null
done
SHARDS=3 VIEWGAIN_ISA=$isa SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_COUNT=1 \
  "$cluster/score_array.slurm" slurm "$map" "${flags[@]}" >/dev/null
"$VIEWGAIN" merge slurm/parts/*.npy --out slurm/scores.npy >/dev/null
cmp whole.npy slurm/scores.npy
echo "slurm: 3 tasks"
[ -z "${skipped:-}" ] || exit 77
