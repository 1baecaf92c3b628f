#!/bin/sh
# A limit of the address space below what OpenBLAS takes, or of open files: one line and exit code
# 4, no endless wait.
# usage: test_address_space.sh FOLDER_OF_THE_PROGRAMS
set -u
programs=$1
err=$(mktemp) || exit 1
trap 'rm -f "$err"' EXIT
failed=0
for name in shroudhb shroudhb-mesh shroudhb-mhb shroudhb-post shroudhb-study; do
  (ulimit -v 180000; timeout 60 "$programs/$name" --version) >"$err" 2>&1
  code=$?
  [ $code -eq 4 ] || { echo "FAILED: $name: exit code $code, expected 4"; failed=1; }
  [ "$(wc -l <"$err")" -eq 1 ] && grep -q 'address space is limited to 175 MB' "$err" || {
    echo "FAILED: $name said:"
    cat "$err"
    failed=1
  }
done
# one thread needs less, and the line says so
(ulimit -v 180000; OPENBLAS_NUM_THREADS=1 "$programs/shroudhb" --version) 2>"$err" >/dev/null
grep -q '1 thread needs 240 MB: raise ulimit -v$' "$err" || { cat "$err"; failed=1; }
(ulimit -v 8000000; "$programs/shroudhb" --version) >/dev/null 2>"$err" || { cat "$err"; failed=1; }
(ulimit -n 20; timeout 60 "$programs/shroudhb-mhb" --version) 2>"$err" >/dev/null
[ $? -eq 4 ] &&
  grep -q 'open files is limited to 20; [0-9]* are asked for: raise ulimit -n$' "$err" &&
  [ "$(wc -l <"$err")" -eq 1 ] || { echo "FAILED: open files:"; cat "$err"; failed=1; }
(ulimit -n 256; "$programs/shroudhb-mhb" --version) >/dev/null 2>"$err" || { cat "$err"; failed=1; }
exit $failed
