#!/bin/sh
# Damages Draco streams and mesh files of every format at random, under AddressSanitizer and
# UndefinedBehaviorSanitizer: each must be an error or a valid mesh. Prints one line.
#
#   scripts/fuzz_assets.sh [RUNS [SEED]]    100000 runs of each kind, seed 1; half an hour
#
# TEST: a test_mesh_files that is built already.
set -eu
cd "$(dirname "$0")/.."
runs=${1:-100000}
seed=${2:-1}
if [ -z "${TEST:-}" ]; then
  [ -f build/asan-ubsan/build.ninja ] || cmake --preset asan-ubsan >/dev/null
  ninja --quiet -C build/asan-ubsan test_mesh_files
  TEST=build/asan-ubsan/tests/test_mesh_files
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if SEEDFRAME_FUZZ_RUNS=$runs SEEDFRAME_FUZZ_SEED=$seed \
  "$TEST" --gtest_filter='InputFuzz.*' >"$log" 2>&1; then
  echo "$runs damaged Draco streams and $runs damaged mesh files, seed $seed: no crash, no sanitizer report," \
    "$(sed -n 's/^\[==========\].* ran. (\([0-9]*\) ms total)/\1/p' "$log" | awk '{printf "%.0f s", $1 / 1000}')"
else
  tail -n 60 "$log"
  echo "fuzz_assets: failed, seed $seed" >&2
  exit 1
fi
