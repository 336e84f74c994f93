#!/bin/sh
# clang-tidy over the program's sources (.clang-tidy says which checks). Prints what it finds, each finding
# of a header once a source that includes it, and fails if there is any.
#
#   scripts/lint.sh                     all of scheduler/
#   scripts/lint.sh scheduler/a/b.cpp   only these files
set -eu
cd "$(dirname "$0")/.."
# A folder of its own: clang cannot read GCC's precompiled headers.
cmake --preset release -B build/lint -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null

[ $# -gt 0 ] || set -- $(git ls-files 'scheduler/*.cpp')
# One file a process, each one's output in one piece; clang-tidy counts the warnings it hides on standard error.
printf '%s\n' "$@" | xargs -P "$(nproc)" -n 1 sh -c '
  found=$(clang-tidy --quiet -p build/lint "$1" 2>&1) && exit 0
  printf "%s\n" "$found" | grep -vE "^[0-9]+ warnings?( and [0-9]+ errors?)? generated"
  exit 1' lint
