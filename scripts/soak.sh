#!/bin/sh
# What takes too long for scripts/test.sh: run it for a night before a release.
#
#   scripts/soak.sh            all
#   scripts/soak.sh NAME…      of campaign, fuzz, assets, slurm, stream
#   scripts/soak.sh stream --requests N --preview N   with options of tests/reliability/stream_soak.py
set -eu
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
ninja --quiet -C build/release seedframe
soak_stream() {
  echo "== a stream that is asked for very many frames"
  tests/reliability/stream_soak.py --report results/reliability/stream.md "$@"
}
[ $# -gt 0 ] || set -- campaign fuzz assets slurm stream
if [ "$1" = stream ]; then
  case ${2:-} in --*) shift; soak_stream "$@"; exit ;; esac
fi
for name in "$@"; do
  case $name in
    campaign)
      echo "== a long campaign with the real Blender"
      tests/reliability/soak.py --report results/reliability/soak.md
      ;;
    fuzz)
      echo "== everything that reads bytes from elsewhere, guided by coverage"
      scripts/fuzz.sh --table results/reliability/fuzz.md 3600
      ;;
    assets)
      echo "== damaged assets and mesh files"
      scripts/fuzz_assets.sh 500000 "$(date +%Y%m%d)"
      ;;
    slurm)
      echo "== clusters that break"
      scripts/slurm-dev.sh install
      tests/slurm/faults.py --report results/reliability/slurm.md
      tests/slurm/flaky.py --report results/reliability/slurm.md
      ;;
    stream) soak_stream ;;
    *) echo "soak.sh: there is no '$name': campaign, fuzz, assets, slurm, stream" >&2; exit 2 ;;
  esac
done
