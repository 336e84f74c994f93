#!/bin/sh
# The benchmarks, into results/bench: how fast configs are expanded, what submit costs above a bare loop in Blender, and
# a worker's memory over 1,000 frames. Takes about 8 minutes on two idle cores; on a busy machine longer, and then it measures the company.
set -eu
cd "$(dirname "$0")/.."
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja --quiet -C build/release seedframe bench_expansion
mkdir -p results/bench
failed=0
tests/bench/expansion.py --report results/bench/expansion.md || failed=1
tests/bench/overhead.py --report results/bench/overhead.md || failed=1
tests/bench/worker_memory.py --report results/bench/memory.md || failed=1
exit $failed
