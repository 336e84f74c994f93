#!/bin/sh
# The benchmarks, into results/bench: what submit costs above a bare loop in Blender, and a worker's memory over
# 1,000 frames. Takes about 5 minutes on two idle cores; on a busy machine longer, and then it measures the company.
set -eu
cd "$(dirname "$0")/.."
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja --quiet -C build/release seedframe
mkdir -p results/bench
failed=0
tests/bench/overhead.py --report results/bench/overhead.md || failed=1
tests/bench/worker_memory.py --report results/bench/memory.md || failed=1
exit $failed
