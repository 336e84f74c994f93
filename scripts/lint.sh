#!/bin/sh
# clang-tidy over the program's sources (.clang-tidy says which checks); needs build/release to be configured.
set -eu
cd "$(dirname "$0")/.."
git ls-files 'scheduler/*.cpp' | xargs -P "$(nproc)" -n 4 clang-tidy --quiet -p build/release 2>/dev/null
