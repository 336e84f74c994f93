#!/bin/sh
# Installs what is missing, builds, and runs every test: format, module edges and lint, the pages in a browser, the unit
# tests (also under AddressSanitizer and UndefinedBehaviorSanitizer), the tests with the real Blender, and those on a Slurm
# cluster, which is brought up here.
#
#   scripts/test.sh            all
#   scripts/test.sh unit       unit tests of the release build only, exports read by small programs from PyPI, pages in a browser
#   scripts/test.sh clients    exports read and trained on by torchvision, torchmetrics, webdataset and ultralytics, in an
#                              environment of 6 GB that is made for it
#   scripts/test.sh python     the Python package: mypy, ruff, its tests with PyTorch, installed as a user would
#   scripts/test.sh slurm      campaigns on a Slurm cluster of three nodes on this machine
#   scripts/test.sh versions   what depends on Blender's version, with 4.2 and 5.0, and with 5.2 where there is a Python 3.13
set -u
cd "$(dirname "$0")/.."
export SEEDFRAME_CACHE=off  # what is rendered here is rendered
export SEEDFRAME_BLENDER=blender  # Debian's; steps with another one say so
what=${1:-all}
scripts/setup.sh --packages || exit 1

passed=0
failed=0
skipped=0
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
configure() { # preset
  [ -f "build/$1/build.ninja" ] || cmake --preset "$1" >/dev/null
}
run_tests() { # preset, label, how many at once, which of them, and which not
  log=$(mktemp)
  ctest --test-dir "build/$1" -L "$2" -R "${4:-.}" -E "${5:-^$}" --output-on-failure -j "$3" 2>&1 |
    tee "$log" | grep -vE '^ *(Start +[0-9]+:|[0-9]+/[0-9]+ Test +#.* Passed)'
  tally "$log"
  rm -f "$log"
}

# Tests that do a thing thousands of times over, or whose path others take too: a sanitizer learns nothing more.
long_anyway='^python_package$|^(Reliability|Install|RobocupScene|PartsStudy|ShippedConfigs|BenchErrorTest)\.|EveryPicture.*(jpeg|webp|tiff)'
long_anyway="$long_anyway"'|\.(Bombs|AKilledExportLeaves|EveryFaultIsRetried|NoOrderOfReports|WhatFlipsAPixel|TheFramesBeforeAreFound|TwoConditions)'

# Tests that another Blender could fail; not what follows from our own code alone.
of_versions='^RealBlender(|Levers|Error|Instances|Twin|Color|Reading|Campaign|Region|Versions|Study)\.'
run_version() { # of Blender: as a module of Python, if it can be installed
  echo "== tests with the real Blender $1"
  if scripts/setup.sh --blender "$1"; then
    SEEDFRAME_BLENDER=python:$PWD/venv/blender-$1
    run_tests release blender "$(nproc)" "$of_versions"
    SEEDFRAME_BLENDER=blender
  else
    skipped=$((skipped + 1))
    echo "SKIPPED: all tests with Blender $1, which could not be installed (why stands above)"
  fi
}

read_exports() { # name of the environment and of the test, what makes it, what is in it
  if "scripts/$2"; then
    step "exports read by $3" \
      env PYTHONDONTWRITEBYTECODE=1 "venv/$1/bin/python" "tests/export/clients/$1_test.py" build/release/seedframe
  else
    skipped=$((skipped + 1))
    echo "SKIPPED: exports read by $3, which could not be installed (is PyPI reached from here?)"
  fi
}

browse_pages() { # by tests/browser: in Debian's Chromium, driven by packages of npm that a lock file names
  echo "== pages in Chromium"
  if ! tests/browser/install.sh; then
    skipped=$((skipped + 1))
    echo "SKIPPED: pages in Chromium, which could not be installed (why stands above)"
    return
  fi
  log=$(mktemp)
  node --test --test-reporter=tap tests/browser/*_test.mjs >"$log" 2>&1
  good=$(sed -n 's/^# pass \([0-9]*\)$/\1/p' "$log")
  bad=$(sed -n 's/^# fail \([0-9]*\)$/\1/p' "$log")
  [ "${good:-0}" -gt 0 ] || bad=$((${bad:-0} + 1))
  [ "${bad:-0}" = 0 ] || cat "$log"
  passed=$((passed + ${good:-0}))
  failed=$((failed + ${bad:-0}))
  rm -f "$log"
}

check_python() {
  echo "== the Python package"
  if scripts/python_checks.sh install; then
    step "Python package (mypy, ruff, installed, with PyTorch)" scripts/python_checks.sh
  else
    skipped=$((skipped + 1))
    echo "SKIPPED: checks of the Python package, whose tools could not be installed (why stands above)"
  fi
}

run_on_cluster() {
  echo "== tests on a Slurm cluster"
  if scripts/slurm-dev.sh install; then
    run_tests release slurm 1
  else
    skipped=$((skipped + 1))
    echo "SKIPPED: tests on a Slurm cluster, whose programs could not be installed (why stands above)"
  fi
}

# More at once than there are cores: many tests wait for a process or for a timeout to pass.
at_once=$(($(nproc) * 3 / 2))
if ! configure release || ! ninja --quiet -C build/release all; then
  echo "0 passed, 1 failed"
  exit 1
fi
if [ "$what" = all ]; then
  # Built meanwhile of what the other steps leave idle.
  sanitized_log=$(mktemp)
  {
    configure asan-ubsan &&
      exec nice -n 19 ninja --quiet -j "$(nproc)" -C build/asan-ubsan unit_tests
  } >"$sanitized_log" 2>&1 &
  sanitized=$!
  trap 'kill "$sanitized" 2>/dev/null; rm -f "$sanitized_log"' EXIT
  trap 'exit 130' INT TERM
fi
if [ "$what" = versions ]; then
  for version in 4.2 5.0 5.2; do run_version "$version"; done
elif [ "$what" = slurm ]; then
  run_on_cluster
elif [ "$what" = python ]; then
  check_python
elif [ "$what" = clients ]; then
  read_exports clients client_wheels.sh "pycocotools and webdataset"
  read_exports trainers trainer_wheels.sh "torchvision, torchmetrics, webdataset and ultralytics"
else
  echo "== unit tests"
  run_tests release unit "$at_once"
  read_exports clients client_wheels.sh "pycocotools and webdataset"
  browse_pages
fi
if [ "$what" = all ]; then
  step "format (clang-format)" sh -c \
    'git ls-files "*.cpp" "*.h" | xargs clang-format --dry-run --Werror'
  step "module edges and sizes" scripts/check_modules.py
  step "lint (clang-tidy)" scripts/lint.sh
  check_python
  echo "== tests with the real Blender"
  run_tests release blender "$(nproc)"
  run_version 4.5
  run_on_cluster
  echo "== unit tests under AddressSanitizer and UndefinedBehaviorSanitizer"
  if wait "$sanitized"; then
    run_tests asan-ubsan unit "$at_once" . "$long_anyway"
  else
    cat "$sanitized_log"
    failed=$((failed + 1))
  fi
fi
echo
echo "$passed passed, $failed failed$([ "$skipped" = 0 ] || echo ", $skipped skipped")"
[ "$failed" = 0 ]
