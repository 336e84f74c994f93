#!/bin/sh
# Shows that the two commands work on a bare Debian 12: makes one with debootstrap in a scratch folder, clones this
# checkout's HEAD into it, and runs scripts/demo.sh (twice) and scripts/test.sh there. As root.
#
#   scripts/bare_system_test.sh [FOLDER]    FOLDER: scratch, removed afterwards unless KEEP=1
set -eu
cd "$(dirname "$0")/.."
. scripts/bare_system.sh
root=${1:-$(mktemp -d)}
make_bare_system "$root"

# The checkout as a stranger has it, made without needing git inside.
rm -rf "$root/seedframe"
git clone -q . "$root/seedframe"
in_bare_system "cd /seedframe && scripts/demo.sh"
in_bare_system "cd /seedframe && scripts/demo.sh # again"
in_bare_system "cd /seedframe && scripts/test.sh"
