#!/usr/bin/env bash
# Scores poses in shards by GNU parallel, on this machine or on those of a list, and puts them together.
# Killed or failed, the same call goes on: parts that are there are whole, and are not made again. OUT is of one job: with
# another number of shards, other flags or other contents of their files it is refused (exit 2).
#
#   score_parallel.sh SHARDS OUT MAP [FLAGS OF score...]
#   score_parallel.sh 200 out map.vdb --poses poses.npy --sensor sr4000 --stride 4
#
# JOBS: at once on each machine (1, each on all its cores)   THREADS: of each job (0: all)
# HOSTS: names with commas, reached by ssh, which see the same folder; : is this machine (:)
# TOP: leave so many of the best in OUT/best.npy too (100)   VIEWGAIN: the program (viewgain)
# VIEWGAIN_ISA: set it to the least that all machines have (avx2) where they differ
set -euo pipefail
[ $# -ge 3 ] || { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2; exit 2; }
shards=$1 out=$2
shift 2
program=${VIEWGAIN:-viewgain}
mkdir -p "$out/parts"

last=$((shards - 1))
width=${#last}
part() { printf '%s/parts/%0*d.npy' "$out" "$width" "$1"; }
parts=() missing=()
for ((i = 0; i < shards; i++)); do
  parts+=("$(part "$i")")
  [ -e "${parts[-1]}" ] || missing+=("$i")
done

# What parts are of, the files among the words by their contents. The first call leaves it in the folder.
version=$("$program" --version)
job=$(
  printf '%s\n' "$shards shards" "$version" "VIEWGAIN_ISA=${VIEWGAIN_ISA:-}"
  for word in "$@"; do
    file=${word#--*=}
    [ ! -f "$file" ] || word=${word%"$file"}$(cksum <"$file")
    printf '%s\n' "$word"
  done
)
if ! ls "$out"/parts/*.npy >/dev/null 2>&1; then  # parts without job.txt are of who knows what
  new=$(mktemp "$out/.job.XXXXXX")
  printf '%s\n' "$job" >"$new"
  # Whole at once, and never over another call's; mv where there are no links.
  ln "$new" "$out/job.txt" 2>/dev/null || mv -n "$new" "$out/job.txt" || :
  rm -f "$new"
fi
[ "$(cat "$out/job.txt" 2>/dev/null)" = "$job" ] ||
  { echo "$out belongs to another job ($out/job.txt): name another folder, or delete this one" >&2; exit 2; }
echo "$((shards - ${#missing[@]})) of $shards parts are there" >&2

if [ ${#missing[@]} -gt 0 ]; then
  call=$(printf '%q ' "$program" score "$@" --quiet --threads "${THREADS:-0}")
  # A shard that fails is tried twice; the others go on. The log says which shards failed. parallel quotes {2} itself.
  # In the background: a shell that waits for a program in front heeds no signal.
  for i in "${missing[@]}"; do printf '%s\t%s\n' "$i" "$(part "$i")"; done |
    parallel --colsep '\t' --jobs "${JOBS:-1}" --sshlogin "${HOSTS:-:}" --workdir . --env VIEWGAIN_ISA \
      --retries "${RETRIES:-2}" --joblog "$out/parallel.log" \
      "$call --shard {1}/$shards --out {2} >/dev/null" &
  running=$!
  trap 'kill "$running" || :; wait "$running" || :; exit 143' TERM INT HUP
  wait "$running" ||
    { echo "some shards failed ($out/parallel.log); the same call goes on with them" >&2; exit 1; }
  trap - TERM INT HUP
fi
"$program" merge "${parts[@]}" --out "$out/scores.npy"
"$program" merge "${parts[@]}" --top "${TOP:-100}" --out "$out/best.npy" --quiet >/dev/null
