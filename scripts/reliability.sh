#!/bin/sh
# Kills the scheduler and its workers, breaks its disk and damages its files, and writes what comes of it to results/reliability/.
# The scripts of tests/reliability/ say how; each fails if anything was lost, duplicated, torn or wrongly called done.
#
#   scripts/reliability.sh [full]          everything: every call, 1,000 kills, 30 of them… takes about an hour on two cores
#   scripts/reliability.sh quick [BUILD [SCRIPT]]
#                                          a sample, in two minutes, into no report: of one script, or all;
#                                          BUILD is build/release by default
set -u
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
what=${1:-full}
build=${2:-build/release}
only=${3:-}
failed=0

run() { # script, arguments…
  script=$1
  shift
  [ "${only:-${script%.py}}" = "${script%.py}" ] || return 0
  ran=yes
  echo "== $script $*"
  "tests/reliability/$script" --build "$build" "$@" || failed=1
}

case $what in
  quick)
    run damage_files.py --every 101
    run kill_scheduler.py --kills 10
    run kill_at_every_call.py --kinds labels --every 23
    run kill_at_every_call.py --kinds fake --every 97
    run fail_every_write.py --kinds labels --every 83
    run kill_stream.py --every 37
    run worker_faults.py --faults 40
    ;;
  full)
    ninja --quiet -C "$build" seedframe faulty_io || exit 1
    reports=results/reliability
    run kill_at_every_call.py --report $reports/kill_at_every_call.md
    run fail_every_write.py --report $reports/fail_every_write.md
    run kill_stream.py --report $reports/kill_stream.md
    run kill_scheduler.py --kills 1000 --blender fake --report $reports/kill_scheduler_fake.md
    run kill_scheduler.py --kills 30 --blender real --report $reports/kill_scheduler_real.md
    run worker_faults.py --faults 200 --report $reports/worker_faults.md
    run damage_files.py --report $reports/damage_files.md
    ;;
  *)
    echo "reliability.sh: there is no '$what': full or quick" >&2
    exit 2
    ;;
esac
[ -n "${ran:-}" ] || { echo "reliability.sh: there is no script '$only'" >&2; exit 2; }
exit $failed
