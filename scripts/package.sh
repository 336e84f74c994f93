#!/bin/sh
# Builds the Debian package, in build/release/packages.
#
#   scripts/package.sh                   builds it
#   scripts/package.sh --test [FOLDER]   and, as root, installs it in a bare Debian 12 (FOLDER: scratch, removed
#                                        afterwards unless KEEP=1), where a user makes a small campaign and exports it
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh --packages
cmake --preset release >/dev/null
ninja --quiet -C build/release seedframe
packages=build/release/packages
rm -rf "$packages"
(cd build/release && cpack --config CPackConfig.cmake -B packages >packages.log) ||
  { cat build/release/packages.log >&2; exit 1; }
package=$(echo "$packages"/*.deb)
ls -sh "$package"
dpkg-deb --field "$package" Package Version Depends Recommends Installed-Size
[ "${1:-}" = --test ] || exit 0

. scripts/bare_system.sh
root=${2:-$(mktemp -d)}
make_bare_system "$root"
cp "$package" "$root/seedframe.deb"
in_bare_system "apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
  --no-install-recommends /seedframe.deb bash-completion man-db >/dev/null && seedframe --version"
chroot "$root" sh -c 'id user >/dev/null 2>&1 || useradd --create-home user'

# From a home with nothing in it, by a user who may write nowhere else.
USER_THERE=user
configs=/usr/share/seedframe/configs
in_bare_system "cd && seedframe doctor"
in_bare_system "cd && seedframe submit $configs/parts.yaml -o labels --set labels=geometry --quiet"
in_bare_system "cd && seedframe export labels --format coco --format yolo-segment --format voc"
in_bare_system "cd && seedframe export labels --format coco --verify"
in_bare_system "cd && seedframe submit $configs/parts.yaml -o parts --frames 2 --quiet"
in_bare_system "cd && seedframe status parts && seedframe audit parts --frames 1 --vary threads --quiet"
in_bare_system "man seedframe >/dev/null && seedframe --help >/dev/null"
in_bare_system "bash -c '. /usr/share/bash-completion/bash_completion && _completion_loader seedframe; complete -p seedframe'"
USER_THERE=root
in_bare_system "apt-get remove -y -qq seedframe >/dev/null && ! ls -d /usr/share/seedframe /usr/lib/seedframe 2>/dev/null"
echo "the package works"
