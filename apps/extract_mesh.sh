#!/usr/bin/env bash
# Takes one of the meshes that Debian's libcgal-demo ships into a folder, unless it is there already.
#   apps/extract_mesh.sh camel.off build/meshes
set -euo pipefail

if [ $# -ne 2 ]; then
  echo "usage: $0 NAME FOLDER   (camel.off, lion-head.off, armadillo.off, ...)" >&2
  exit 2
fi
name=$1
folder=$2
archive=/usr/share/doc/libcgal-dev/data.tar.gz

[ -s "$folder/$name" ] && exit 0
if [ ! -r "$archive" ]; then
  echo "$0: $archive is missing: install libcgal-demo" >&2
  exit 2
fi
mkdir -p "$folder"
temporary=$(mktemp "$folder/.$name.XXXXXX")
trap 'rm -f "$temporary"' EXIT
if ! tar -xzOf "$archive" "data/meshes/$name" >"$temporary" 2>/dev/null; then
  echo "$0: $archive holds no data/meshes/$name" >&2
  exit 2
fi
chmod 644 "$temporary"
mv "$temporary" "$folder/$name"
