#!/bin/sh
# Builds everything with address and undefined-behaviour sanitizers and runs the suite with them.
# usage: sanitizers.sh SOURCE BUILD [CTEST ARGUMENTS]   such as -L unit; else all but slow tests
set -eu
source=$1 build=$2
shift 2
[ $# -gt 0 ] || set -- -LE 'slow|nightly'
cmake -S "$source" -B "$build" -G Ninja -Wno-dev -DCMAKE_BUILD_TYPE=Debug -DSHROUDHB_SANITIZE=ON \
  >"$build.log" 2>&1 && cmake --build "$build" >>"$build.log" 2>&1 ||
  { tail -30 "$build.log"; exit 1; }
cd "$build"
export LSAN_OPTIONS="suppressions=$source/tests/support/library_leaks.txt:print_suppressions=0"
code=0
ctest -j "$(nproc)" --output-on-failure "$@" -R '^(mesh|mhb|postproc)\.' || code=$?
# MPI leaks from plugins that it unloads, whose names are lost then
export ASAN_OPTIONS=detect_leaks=0
ctest -j "$(nproc)" --output-on-failure "$@" -E '^(mesh|mhb|postproc)\.' || code=$?
exit $code
