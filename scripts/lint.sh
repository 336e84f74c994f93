#!/bin/sh
# clang-tidy over the program's sources (.clang-tidy says which checks), as the build puts them together: most
# of its time goes to the headers that they share. Fails if there is any finding.
#
#   scripts/lint.sh                     all of scheduler/
#   scripts/lint.sh scheduler/a/b.cpp   what is compiled together with these files
set -eu
cd "$(dirname "$0")/.."
# A folder of its own: clang cannot read GCC's precompiled headers.
cmake --preset release -B build/lint -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null

sources=$(find build/lint/CMakeFiles -path '*seedframe*/Unity/*.cxx' | sort)
for file in "$@"; do printf '%s/%s\n' "$PWD" "$file"; done >build/lint/asked
[ $# = 0 ] || sources=$(printf '%s\n' "$sources" | xargs grep -lFf build/lint/asked)
# One piece a process, each one's output together; clang-tidy counts the warnings it hides on standard error.
printf '%s\n' "$sources" | xargs -P "$(nproc)" -n 1 sh -c '
  found=$(clang-tidy --quiet -p build/lint --extra-arg=-Wno-unknown-warning-option "$PWD/$1" 2>&1) && exit 0
  printf "%s\n" "$found" | grep -vE "^[0-9]+ warnings?( and [0-9]+ errors?)? generated"
  exit 1' lint
