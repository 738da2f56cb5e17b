#!/usr/bin/env bash
# A compiler launcher for a second build tree of viewgain: an object that VIEWGAIN_OBJECTS, the build
# tree that the tests belong to, has already made with the same flags is copied; all else is compiled.
# Static and shared libraries are made of the same objects, so nothing takes minutes twice.
set -euo pipefail
object= depfile= previous=
for argument in "$@"; do
  [ "$previous" = -o ] && object=$argument
  [ "$previous" = -MF ] && depfile=$argument
  previous=$argument
done
if [[ "$object" =~ ((core|grid|raycast|mesh|apps/c|apps/formats|apps/literature|apps/planner|apps/planner_mesh)/CMakeFiles/viewgain_.*\.o)$ ]]; then
  made=$VIEWGAIN_OBJECTS/${BASH_REMATCH[1]}
  if [ -f "$made" ]; then
    cp "$made" "$object"
    [ -z "$depfile" ] || echo "$object:" >"$depfile"
    exit 0
  fi
  echo "reuse_objects.sh: no $made" >&2
fi
exec "$@"
