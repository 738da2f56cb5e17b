# shellcheck shell=bash
# Sourced by the scripts that try the project in a clean Debian; needs root and the network that apt uses.

need_root() {
  [ "$(id -u)" -eq 0 ] || { echo "$(basename "$0"): needs root, for chroot" >&2; exit 1; }
}

# make_bare_system RELEASE FOLDER: a minimal Debian of that release, unless the folder is there already.
make_bare_system() {
  command -v debootstrap >/dev/null || {
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends debootstrap >/dev/null
  }
  [ ! -d "$2" ] || return 0
  mkdir -p "$(dirname "$2")"
  rm -rf --one-file-system "$2.new"
  debootstrap --variant=minbase "$1" "$2.new" http://deb.debian.org/debian >"$2.log" 2>&1 ||
    { tail "$2.log" >&2; exit 1; }
  mv "$2.new" "$2"
}

# open_system FOLDER: name resolution, /proc and terminals for what will run in it, until the script ends.
open_system() {
  system=$1
  cp /etc/resolv.conf "$system/etc/resolv.conf" 2>/dev/null || true
  trap 'umount "$system/dev/pts" "$system/proc" 2>/dev/null || true' EXIT
  mountpoint -q "$system/proc" || mount -t proc proc "$system/proc" 2>/dev/null ||
    echo "$(basename "$0"): no /proc in the chroot" >&2
  mkdir -p "$system/dev/pts"
  mountpoint -q "$system/dev/pts" || mount -t devpts -o newinstance,ptmxmode=0666 devpts "$system/dev/pts" 2>/dev/null ||
    echo "$(basename "$0"): no terminals in the chroot" >&2
  ln -sf pts/ptmx "$system/dev/ptmx"
}

# copy_sources FOLDER: the project's. A file keeps its time if it is as in the last copy; otherwise its time is
# now, because it may have been written before something was compiled from the last copy.
copy_sources() {
  local before file
  before=$(mktemp -d)
  mkdir -p "$1"
  find "$1" -mindepth 1 -maxdepth 1 -not -name build -exec mv -t "$before" {} +
  tar --exclude=./build --exclude=./out --exclude=./.git -cf - . | tar -xmf - -C "$1"
  while IFS= read -r -d '' file; do
    if cmp -s "$1/$file" "$before/$file"; then touch -r "$before/$file" "$1/$file"; fi
  done < <(cd "$1" && find . -path ./build -prune -o -type f -print0)
  rm -rf "$before"
}
