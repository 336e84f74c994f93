#!/bin/sh
# clang-tidy over the program's sources (.clang-tidy says which checks), with the commands of the
# release build, as that puts them together. Fails if there is any finding. All of it takes two
# minutes on two cores: scripts/lint/own_code.cpp keeps the checks out of the libraries' headers, and
# those that most files include are read once.
#
#   scripts/lint.sh                     all of scheduler/
#   scripts/lint.sh scheduler/a/b.cpp   what is compiled together with these files
set -eu
cd "$(dirname "$0")/.."
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
mkdir -p build/lint

# Clang cannot read GCC's precompiled header. It gets its own, made with the same options.
commands=build/release/compile_commands.json
sed "s|-include [^ ]*/cmake_pch.hxx|-include-pch $PWD/build/lint/headers.pch|" $commands >build/lint/compile_commands.json
options=$(sed -n 's|.*"command": "[^ ]* \(.*\) -x c++-header .*/seedframe_headers.dir/.*|\1|p' $commands)
cp build/release/CMakeFiles/seedframe_headers.dir/cmake_pch.hxx build/lint/headers.h
clang++ $options -Wno-unknown-warning-option -x c++-header -include build/lint/headers.h \
  build/release/CMakeFiles/seedframe_headers.dir/cmake_pch.hxx.cxx -o build/lint/headers.pch

plugin=build/lint/own_code.so
llvm=$(dirname "$(realpath "$(command -v clang-tidy)")")/../include
[ $plugin -nt scripts/lint/own_code.cpp ] ||
  clang++ -O1 -std=c++17 -fno-rtti -fPIC -shared -isystem "$llvm" scripts/lint/own_code.cpp -o $plugin
tidy="clang-tidy --quiet --load=$plugin --checks=seedframe-own-code -p build/lint --extra-arg=-Wno-unknown-warning-option"

# What is planted in tests/lint/ is found, each where it is, and nothing else.
planted=$(grep -n '// planted: ' tests/lint/* | sed 's/^\([^:]*:[0-9]*\):.*planted: /\1 /' | sort)
found=$($tidy --header-filter='.*/tests/lint/.*' tests/lint/planted.cpp -- -std=c++20 2>&1 |
  sed -n 's|^.*/\(tests/lint/[^:]*:[0-9]*\):[0-9]*: error: .*\[\([a-z-]*\).*\]$|\1 \2|p' | sort)
if [ "$planted" != "$found" ]; then
  printf 'lint.sh: planted was\n%s\nand found was\n%s\n' "$planted" "$found" >&2
  exit 1
fi

sources=$(find build/release/CMakeFiles -path '*seedframe*/Unity/*.cxx' | sort)
if [ $# != 0 ]; then
  for file in "$@"; do printf '%s/%s\n' "$PWD" "$file"; done >build/lint/asked
  sources=$(printf '%s\n' "$sources" | xargs grep -lFf build/lint/asked) ||
    { echo "lint.sh: the program has no such source" >&2; exit 2; }
fi
# One piece a process, each one's output together; clang-tidy counts the warnings it hides on standard error.
printf '%s\n' "$sources" | xargs -P "$(nproc)" -n 1 sh -c '
  found=$($0 "$PWD/$1" 2>&1) && exit 0
  printf "%s\n" "$found" | grep -vE "^[0-9]+ warnings?( and [0-9]+ errors?)? generated"
  exit 1' "$tidy"
