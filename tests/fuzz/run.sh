#!/bin/sh
# Builds the fuzzers with clang and runs each for some seconds from its seeds.
# usage: run.sh SOURCE BUILD SECONDS   exit code 77 where clang or its fuzzer library is missing
# Inputs that broke a target stay in BUILD/found; keep them in tests/fuzz/regressions/TARGET.
set -eu
source=$1 build=$2 seconds=$3
clang=$(command -v clang-14 || command -v clang) || { echo "skipped: no clang"; exit 77; }
echo 'int LLVMFuzzerTestOneInput(const char *d, unsigned long n) { return !d && n; }' |
  "$clang" -fsanitize=fuzzer -x c -o /dev/null - 2>/dev/null ||
  { echo "skipped: clang has no fuzzer library"; exit 77; }
gomp=$(gcc -print-file-name=libgomp.so)
cmake -S "$source" -B "$build" -G Ninja -Wno-dev -DCMAKE_C_COMPILER="$clang" \
  -DCMAKE_BUILD_TYPE=Debug -DSHROUDHB_FUZZ=ON -DOpenMP_C_FLAGS=-fopenmp=libgomp \
  -DOpenMP_C_LIB_NAMES=gomp -DOpenMP_gomp_LIBRARY="$gomp" >"$build.log" 2>&1 ||
  { cat "$build.log"; exit 1; }
ninja -C "$build" fuzzers >>"$build.log" 2>&1 || { tail -30 "$build.log"; exit 1; }

# inputs are files: in memory where that is there
[ -w /dev/shm ] && export TMPDIR=/dev/shm
failed=0
for target in units case override motion study inp msh stamp harmonic table; do
  mkdir -p "$build/corpus/$target" "$build/found/$target"
  seeds="$source/tests/fuzz/seeds/$target"
  [ -d "$source/tests/fuzz/regressions/$target" ] &&
    seeds="$seeds $source/tests/fuzz/regressions/$target"
  case $target in case | study) seeds="$seeds $build/cases" ;; esac
  rm -rf "$build/cases"
  mkdir "$build/cases"
  for file in "$source"/cases/*/*.yaml; do
    cp "$file" "$build/cases/$(echo "${file#"$source"/cases/}" | tr / _)"
  done
  # shellcheck disable=SC2086
  if ! "$build/tests/bin/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 \
    -max_len=8192 -dict="$source/tests/fuzz/words.dict" -artifact_prefix="$build/found/$target/" \
    "$build/corpus/$target" $seeds >"$build/$target.log" 2>&1; then
    echo "FAILED: fuzz_$target"
    tail -40 "$build/$target.log"
    failed=1
  fi
  sed -n "s/^Done \(.*\)/$target: \1/p" "$build/$target.log"
done
exit $failed
