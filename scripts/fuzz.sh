#!/bin/sh
# Coverage-guided fuzzing (libFuzzer, with AddressSanitizer and UndefinedBehaviorSanitizer) of what reads bytes
# from elsewhere, tests/fuzz/targets.h. Each target starts from its corpus in tests/fuzz/corpus/. Prints a line a
# target; fails if an input crashes, hangs, leaks, breaks a promise, or asks for 256 MB at once, and keeps it in
# build/fuzz/crashes/: fix the program, and add the input to the corpus.
#
#   scripts/fuzz.sh [--table FILE] [SECONDS [TARGET…]]    600 seconds each; all targets
#
# JOBS: so many targets at once (1).
set -eu
cd "$(dirname "$0")/.."
table=""
if [ "${1:-}" = --table ]; then
  table=$2
  shift 2
fi
seconds=${1:-600}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- $(ls tests/fuzz/corpus)
for target in "$@"; do
  [ -d "tests/fuzz/corpus/$target" ] || { echo "fuzz.sh: there is no target '$target'" >&2; exit 2; }
done

scripts/setup.sh --packages
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
ninja --quiet -C build/fuzz $(printf 'fuzz_%s ' "$@")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p build/fuzz/crashes

run_target() { # leaves its log and a line of figures: target, runs, seconds, edges, inputs, crashes, MiB
  target=$1
  mkdir "$work/$target"
  dictionary=""
  [ ! -f "tests/fuzz/$target.dict" ] || dictionary="-dict=tests/fuzz/$target.dict"
  start=$(date +%s)
  crashes=0
  "build/fuzz/tests/fuzz_$target" -max_total_time="$seconds" -print_final_stats=1 -max_len=4096 -timeout=20 \
    -rss_limit_mb=2048 -malloc_limit_mb=256 -artifact_prefix="build/fuzz/crashes/$target-" $dictionary \
    "$work/$target" "tests/fuzz/corpus/$target" >"$work/$target.log" 2>&1 || crashes=1
  sed -n 's/^#[0-9]*\t.* cov: \([0-9]*\) ft: [0-9]* corp: \([0-9]*\)\/.*/\1 \2/p' "$work/$target.log" | tail -n 1 |
    awk -v target="$target" -v seconds=$(($(date +%s) - start)) -v crashes="$crashes" \
      -v runs="$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$target.log")" \
      -v mib="$(sed -n 's/^stat::peak_rss_mb: *//p' "$work/$target.log")" \
      '{ edges = $1; inputs = $2 } END { print target, runs + 0, seconds, edges + 0, inputs + 0, crashes, mib + 0 }' \
      >"$work/$target.figures"
  awk '{ printf "%s: %d executions in %d s (%d/s), %d edges, corpus of %d, %d crashes\n",
         $1, $2, $3, $2 / ($3 > 0 ? $3 : 1), $4, $5, $6 }' "$work/$target.figures"
  [ "$crashes" = 0 ] || tail -n 60 "$work/$target.log" >&2
}

running=0
for target in "$@"; do
  run_target "$target" &
  running=$((running + 1))
  if [ "$running" -ge "${JOBS:-1}" ]; then
    wait
    running=0
  fi
done
wait

if [ -n "$table" ]; then
  mkdir -p "$(dirname "$table")"
  {
    echo "# Fuzzing of what reads bytes from elsewhere"
    echo
    echo "Made by \`scripts/fuzz.sh --table FILE $seconds\`; \`tests/fuzz/targets.h\` says what each target does. libFuzzer, guided by"
    echo "coverage, with AddressSanitizer and UndefinedBehaviorSanitizer, from the inputs in \`tests/fuzz/corpus/\`."
    echo
    echo "$(date +%Y-%m-%d); $(clang++ --version | sed -n 's/.*\(clang version [0-9.]*\).*/\1/p'); ${JOBS:-1} at a time on" \
      "$(nproc) cores ($(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1))."
    echo
    echo "| target | executions | seconds | executions/s | coverage, edges | corpus, inputs | peak memory, MiB | crashes |"
    echo "|---|---:|---:|---:|---:|---:|---:|---:|"
    for target in "$@"; do
      awk 'function thousands(n, text) {
             for (; n >= 1000; n = int(n / 1000)) text = sprintf(",%03d%s", n % 1000, text)
             return n text
           }
           { printf "| `%s` | %s | %d | %s | %s | %s | %s | %d |\n", $1, thousands($2), $3,
               thousands(int($2 / ($3 > 0 ? $3 : 1))), thousands($4), thousands($5), thousands($7), $6 }' \
        "$work/$target.figures"
    done
    echo
    echo "A crash is any of: a signal, a sanitizer's report, a leak, a broken promise, more than 20 s for one input, more than"
    echo "256 MB asked for at once. Edges are those of our own code and of headers; Draco, OpenEXR and yaml-cpp are Debian's libraries,"
    echo "without coverage and sanitizers in them: what they do out of bounds is seen where it crashes, goes through libc or reaches our"
    echo "code. Executions/s are of a machine that may have had other work."
  } >"$table"
fi
awk '$6 != 0 { bad = 1 } END { exit bad }' "$work"/*.figures
