#!/bin/sh
# Shows that the two commands work on a bare Debian 12: makes one with debootstrap in a scratch folder, clones this
# checkout's HEAD into it, and runs scripts/demo.sh (twice) and scripts/test.sh there. As root.
#
#   scripts/bare_system_test.sh [FOLDER]    FOLDER: scratch, removed afterwards unless KEEP=1
set -eu
cd "$(dirname "$0")/.."
[ "$(id -u)" = 0 ] || { echo "bare_system_test.sh: needs root for chroot" >&2; exit 4; }
root=${1:-$(mktemp -d)}
command -v debootstrap >/dev/null || apt-get install -y -qq --no-install-recommends debootstrap >/dev/null

if [ ! -f "$root/etc/debian_version" ]; then
  debootstrap --variant=minbase bookworm "$root" >/dev/null
fi
for file in /etc/resolv.conf /etc/hosts; do cp "$file" "$root$file"; done
clean() {
  for mount in dev proc; do
    if mountpoint -q "$root/$mount"; then umount -R "$root/$mount"; fi
  done
  [ -n "${KEEP:-}" ] || rm -rf --one-file-system "$root"
}
trap clean EXIT
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
mountpoint -q "$root/dev" || mount --rbind /dev "$root/dev"
mount --make-rslave "$root/dev"

# The checkout as a stranger has it, made without needing git inside.
rm -rf "$root/seedframe"
git clone -q . "$root/seedframe"
run() { # command: in the bare system, timed
  echo "== $1"
  begin=$(date +%s)
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    sh -c "cd /seedframe && $1"
  echo "== $1: $(($(date +%s) - begin)) s"
}
run scripts/demo.sh
run "scripts/demo.sh # again"
run scripts/test.sh
