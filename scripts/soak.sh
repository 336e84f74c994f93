#!/bin/sh
# What takes too long for scripts/test.sh: run it for a night before a release.
#
#   scripts/soak.sh
set -eu
cd "$(dirname "$0")/.."
echo "== damaged assets and mesh files"
scripts/fuzz_assets.sh 500000 "$(date +%Y%m%d)"
