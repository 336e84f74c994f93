#!/bin/sh
# Installs what building, testing and rendering need on Debian 12, and builds. Run again, it does only what is
# missing. As root, or with sudo.
#
#   scripts/setup.sh                packages, a release build, a link to it in PATH, and Blender 4.5 as the one that is
#                                   used unless another is named; where it cannot be had, Debian's 3.4.1 is
#   scripts/setup.sh --packages     packages only
#   scripts/setup.sh --blender 4.5  what Blender 4.5 (or 4.2, or 5.0; or 5.2, with a Python 3.13) needs, and it: venv/blender-4.5
set -eu
cd "$(dirname "$0")/.."

packages="
  bubblewrap ca-certificates ccache clang clang-format clang-tidy cmake dpkg-dev fish g++ git gzip libclang-dev
  libclang-rt-dev llvm-dev man-db ninja-build pkg-config zsh
  blender python3 python3-jsonschema python3-numpy python3-pil python3-yaml
  libarchive-dev libboost-dev libcgal-dev libcli11-dev libdeflate-dev libdraco-dev libeigen3-dev libembree-dev libexpected-dev
  libcairo2-dev libcpp-httplib-dev libfmt-dev libjs-chart.js
  libopencolorio-dev libopenexr-dev libopenimageio-dev libpango1.0-dev libpng-dev libpugixml-dev librandom123-dev libsqlite3-dev
  libssl-dev
  libtbb-dev libyaml-cpp-dev nlohmann-json3-dev zlib1g-dev
  libbenchmark-dev libgmock-dev libgtest-dev librapidcheck-dev"

# What a desktop has anyway, and Blender's module for Python is linked to.
[ "${1:-}" = --packages ] || packages="$packages
  python3-venv
  libegl1 libgl1 libgomp1 libice6 libsm6 libx11-6 libxfixes3 libxi6 libxkbcommon0 libxrender1 libxxf86vm1"

missing=""
for package in $packages; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing="$missing $package"
done
if [ -n "$missing" ]; then
  as_root=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "setup.sh: run this as root, or install sudo" >&2; exit 4; }
    as_root="sudo"
  fi
  echo "setup.sh: installing$missing"
  $as_root apt-get update -qq
  $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends $missing >/dev/null
fi
[ "${1:-}" = --packages ] && exit 0
[ "${1:-}" != --blender ] || exec scripts/blender_wheels.sh "${2:-}"

[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja -C build/release seedframe
echo "setup.sh: $(scripts/link_program.sh build/release/seedframe)"

# venv/blender is what the program uses when no other Blender is named. A link that is there stays.
if [ -e venv/blender ]; then
  :
elif scripts/blender_wheels.sh 4.5; then
  ln -sfn blender-4.5 venv/blender
else
  echo "setup.sh: without it, Debian's Blender is used: $(blender --version | head -n 1)"
fi
