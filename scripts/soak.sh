#!/bin/sh
# What takes too long for scripts/test.sh: run it for a night before a release.
#
#   scripts/soak.sh
set -eu
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
ninja --quiet -C build/release seedframe
echo "== a long campaign with the real Blender"
tests/reliability/soak.py --report results/reliability/soak.md
echo "== everything that reads bytes from elsewhere, guided by coverage"
scripts/fuzz.sh --table results/reliability/fuzz.md 3600
echo "== damaged assets and mesh files"
scripts/fuzz_assets.sh 500000 "$(date +%Y%m%d)"
