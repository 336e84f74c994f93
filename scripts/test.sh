#!/bin/sh
# Installs what is missing, builds, and runs every test: format and lint, the unit tests (also under
# AddressSanitizer and UndefinedBehaviorSanitizer), and the tests with the real Blender.
#
#   scripts/test.sh         all
#   scripts/test.sh unit    unit tests of the release build only
set -u
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
what=${1:-all}
scripts/setup.sh --packages || exit 1

passed=0
failed=0
tally() { # counts what a ctest run printed to the file $1
  bad=$(sed -n 's/.*, \([0-9]*\) tests failed out of .*/\1/p' "$1" | tail -n 1)
  all=$(sed -n 's/.* tests failed out of \([0-9]*\).*/\1/p' "$1" | tail -n 1)
  passed=$((passed + ${all:-0} - ${bad:-0}))
  failed=$((failed + ${bad:-0}))
  [ "${all:-0}" -gt 0 ] || failed=$((failed + 1))
}
step() { # name, command: one check that counts as one test
  name=$1
  shift
  echo "== $name"
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $name"; fi
}
build() { # preset, targets
  preset=$1
  shift
  { [ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null; } &&
    ninja --quiet -C "build/$preset" "$@"
}
run_tests() { # preset, label
  log=$(mktemp)
  ctest --test-dir "build/$1" -L "$2" --output-on-failure -j "$3" 2>&1 |
    tee "$log" | grep -vE '^ *(Start +[0-9]+:|[0-9]+/[0-9]+ Test +#.* Passed)'
  tally "$log"
  rm -f "$log"
}

cores=$(nproc)
if ! build release all; then
  echo "0 passed, 1 failed"
  exit 1
fi
echo "== unit tests"
run_tests release unit "$cores"
if [ "$what" = all ]; then
  step "format (clang-format)" sh -c \
    'git ls-files "*.cpp" "*.h" | xargs clang-format --dry-run --Werror'
  step "lint (clang-tidy)" scripts/lint.sh
  echo "== tests with the real Blender"
  run_tests release blender 1
  echo "== unit tests under AddressSanitizer and UndefinedBehaviorSanitizer"
  if build asan-ubsan unit_tests; then
    run_tests asan-ubsan unit "$cores"
  else
    failed=$((failed + 1))
  fi
fi
echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
