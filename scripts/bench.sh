#!/bin/sh
# The benchmarks, into results/: how fast configs are expanded, what the twin costs and where it agrees with Cycles, what submit costs above
# a bare loop in Blender, a worker's memory over 1,000 frames, how fast annotations are written, what a large store costs, how fast an audit reads,
# how long the program takes to start, how many frames an hour all of it makes beside BlenderProc, what a second of rendering buys,
# and whether a stated error is kept. Takes about two hours
# on two idle cores; on a busy machine longer, and then it measures the company.
#
#   scripts/bench.sh               all
#   scripts/bench.sh NAME…         of error, quality, expansion, twin, frame, stability, overhead, memory, export, store, audit, startup, determinism, throughput
set -eu
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja --quiet -C build/release seedframe bench_expansion bench_twin bench_frame bench_export bench_store stability
mkdir -p results/bench results/stability results/reliability results/determinism
[ $# -gt 0 ] || set -- error quality expansion twin frame stability overhead memory export store audit startup determinism throughput
failed=0
for name in "$@"; do
  case $name in
    expansion) tests/bench/expansion.py --report results/bench/expansion.md ;;
    twin) tests/bench/twin.py --report results/bench/twin.md ;;
    frame) tests/bench/frame.py --report results/bench/frame.md ;;
    stability) tests/stability/stability.py --report results/stability/twin.md ;;
    overhead) tests/bench/overhead.py --report results/bench/overhead.md ;;
    memory) tests/bench/worker_memory.py --report results/bench/memory.md ;;
    export) tests/bench/export.py --report results/bench/export.md ;;
    store) tests/bench/store.py --report results/reliability/scale.md ;;
    audit) tests/bench/audit.py --report results/bench/audit.md ;;
    error) # of each Blender that there is: 20 minutes
      for version in 3.4.1 4.5; do
        blender=blender
        [ $version = 3.4.1 ] || blender=python:venv/blender-$version
        build/release/seedframe bench error configs/parts.yaml configs/robocup_spl.yaml configs/parts_study.yaml \
          configs/tyol_multi_8_target.yaml -o results/error_vs_time/blender-$version --width 160 --frames 2 \
          --budget 14min --blender $blender || failed=1
      done
      ;;
    quality) tests/bench/quality.py --report results/quality/quality.md ;;
    startup) tests/bench/startup.py --report results/bench/startup.md ;;
    throughput) tests/bench/throughput.py --report results/bench/throughput.md ;;
    determinism)
      build/release/seedframe bench determinism -o results/determinism &&
        tests/bench/audit_demo.sh results/determinism/audit_demo.md
      ;;
    *) echo "bench.sh: there is no benchmark '$name'" >&2; exit 2 ;;
  esac || failed=1
done
exit $failed
