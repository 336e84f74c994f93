# A Debian 12 with nothing installed, in a folder, for scripts that show what strangers will see. To be sourced, as
# root:
#
#   make_bare_system FOLDER    by debootstrap, unless it is there; unmounted at exit, removed too unless KEEP=1
#   in_bare_system COMMAND     runs it there with sh, timed; USER_THERE: as whom (default: root)

make_bare_system() {
  [ "$(id -u)" = 0 ] || { echo "a bare system needs root, for chroot" >&2; exit 4; }
  bare_system=$1
  mkdir -p "$bare_system"
  chmod 755 "$bare_system"  # a root that users may look into, which a folder of mktemp is not
  command -v debootstrap >/dev/null || apt-get install -y -qq --no-install-recommends debootstrap >/dev/null
  if [ ! -f "$bare_system/etc/debian_version" ]; then
    debootstrap --variant=minbase bookworm "$bare_system" >/dev/null
  fi
  for file in /etc/resolv.conf /etc/hosts; do cp "$file" "$bare_system$file"; done
  trap remove_bare_system EXIT
  mountpoint -q "$bare_system/proc" || mount -t proc proc "$bare_system/proc"
  mountpoint -q "$bare_system/dev" || mount --rbind /dev "$bare_system/dev"
  mount --make-rslave "$bare_system/dev"
}

remove_bare_system() {
  for mount in dev proc; do
    if mountpoint -q "$bare_system/$mount"; then umount -R "$bare_system/$mount"; fi
  done
  [ -n "${KEEP:-}" ] || rm -rf --one-file-system "$bare_system"
}

in_bare_system() {
  echo "== $1"
  begin=$(date +%s)
  user=${USER_THERE:-root}
  home=/root
  [ "$user" = root ] || home=/home/$user
  chroot --userspec="$user:$user" "$bare_system" /usr/bin/env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    HOME="$home" LC_ALL=C.UTF-8 sh -c "$1"
  echo "== $1: $(($(date +%s) - begin)) s"
}
