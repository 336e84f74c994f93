#!/bin/sh
# The benchmarks, into results/: how fast configs are expanded, what the twin costs and where it agrees with Cycles, what submit costs above
# a bare loop in Blender, a worker's memory over 1,000 frames, how fast annotations are written, how large a report is and how soon it can be used, what a large store costs, how fast an audit reads,
# how long the program takes to start, how many frames an hour all of it makes beside BlenderProc, what a second of rendering buys,
# whether a stated error is kept, how much frames sparkle, what pictures of single objects cost, how costs grow with a scene, whether forecasts come true,
# how a campaign grows with the nodes of a Slurm cluster, how like a render a shaded preview is,
# and what a detector that learns from the frames makes of their samples. Takes about two and a half hours
# on two idle cores; on a busy machine longer, and then it measures the company.
#
#   scripts/bench.sh               all
#   scripts/bench.sh NAME…         of error, quality, fireflies, patches, scaling, forecast, expansion, twin, frame, stability, overhead, memory, export, report, store, audit, startup,
#                                  determinism, throughput, slurm, stream, likeness, detector
#   scripts/bench.sh detector-full the whole of results/detector, an hour, in place of a short version
#   scripts/bench.sh quick         most of them, cut down to ten minutes in all, into build/quick/: does a change show?
set -eu
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja --quiet -C build/release seedframe bench_expansion bench_twin bench_frame bench_export bench_store stability
mkdir -p results/bench results/stability results/reliability results/determinism
if [ "${1:-}" = quick ]; then
  quick=build/quick
  rm -rf $quick && mkdir -p $quick
  failed=0
  tests/bench/twin.py --rounds 1 --report $quick/twin.md || failed=1
  tests/bench/frame.py --rounds 1 --report $quick/frame.md || failed=1
  tests/bench/startup.py --report $quick/startup.md || failed=1
  tests/bench/overhead.py --case small --pairs 2 --report $quick/overhead.md || failed=1
  tests/bench/worker_memory.py --frames 60 --report $quick/memory.md || failed=1
  tests/bench/throughput.py --only scheduler --scheduler-frames 500 --rounds 1 --report $quick/throughput.md || failed=1
  tests/bench/patches.py --config configs/parts.yaml --frames 6 --samples 4 --rounds 1 --report $quick/patches.md || failed=1
  tests/bench/scaling.py --axis objects --axis pixels --axis workers --report $quick/scaling || failed=1
  build/release/seedframe bench error configs/parts.yaml -o $quick/error --width 96 --frames 1 --budget 60s || failed=1
  exit $failed
fi
[ $# -gt 0 ] || set -- error quality fireflies patches scaling forecast expansion twin frame stability overhead memory export report store audit startup determinism throughput slurm stream likeness detector
failed=0
for name in "$@"; do
  case $name in
    expansion) tests/bench/expansion.py --report results/bench/expansion.md ;;
    twin) tests/bench/twin.py --report results/bench/twin.md ;;
    frame) tests/bench/frame.py --report results/bench/frame.md ;;
    stability) tests/stability/stability.py ;;  # of both Blenders: 10 minutes
    overhead) tests/bench/overhead.py --report results/bench/overhead.md ;;
    memory) tests/bench/worker_memory.py --report results/bench/memory.md ;;
    export) tests/bench/export.py --report results/bench/export.md ;;
    report) tests/browser/install.sh && tests/bench/report.py --report results/bench/report.md ;;
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
    patches) tests/bench/patches.py --report results/bench/patches.md ;;
    forecast) tests/bench/forecast.py --report results/bench/forecast.md ;;
    scaling) tests/bench/scaling.py --largest-mesh 4000000 --report results/scaling ;;
    quality) tests/bench/quality.py --errors results/quality/errors.json --report results/quality/quality.md ;;
    fireflies) tests/bench/fireflies.py --report results/scenes/fireflies.md ;;  # 20 minutes
    stream) tests/bench/stream.py --report results/bench/stream.md ;;
    likeness) tests/bench/preview_likeness.py --report results/bench/preview_likeness.md --picture results/bench/preview_likeness.jpg ;;
    startup) tests/bench/startup.py --report results/bench/startup.md ;;
    throughput) tests/bench/throughput.py --report results/bench/throughput.md ;;
    slurm) scripts/slurm-dev.sh install && tests/slurm/scaling.py --report results/scaling/slurm ;;
    detector) # the short version: ten minutes, one training with each dataset
      scripts/torch_wheels.sh &&
        venv/torch/bin/python tests/bench/detector/study.py --report results/detector/short
      ;;
    detector-full)
      scripts/torch_wheels.sh &&
        venv/torch/bin/python tests/bench/detector/study.py --full --report results/detector
      ;;
    determinism)
      build/release/seedframe bench determinism -o results/determinism &&
        tests/bench/audit_demo.sh results/determinism/audit_demo.md
      ;;
    *) echo "bench.sh: there is no benchmark '$name'" >&2; exit 2 ;;
  esac || failed=1
done
exit $failed
