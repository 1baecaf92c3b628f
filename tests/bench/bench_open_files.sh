#!/bin/sh
# How many open files each command needs: the least limit with which it ends well. The program's own
# check of the limit is hidden by a library of one function.
# usage: bench_open_files.sh FOLDER_OF_PROGRAMS CASE_OF_A_BLADE
set -u
PATH=$1:$PATH
blade=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cat >"$work/hide.c" <<'END'
#define _GNU_SOURCE
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
int getrlimit(__rlimit_resource_t of, struct rlimit *limit) {
  if (of != RLIMIT_NOFILE) return (int)syscall(SYS_prlimit64, 0, of, 0, limit);
  limit->rlim_cur = limit->rlim_max = RLIM_INFINITY;
  return 0;
}
END
cc -shared -fPIC -o "$work/hide.so" "$work/hide.c" || exit 1
sed -e '/^ *tolerance:/d' "$blade" >"$work/z.yaml"
cd "$work" || exit 1
set_up="--set name=z --set mesh.blade.size=20mm --set modal.modes=4 --set mhb.harmonics=1
  --set mhb.stability=never --set mhb.search.starts=0 --set contact.n0=30N
  --set integrate.frequencies=[150Hz] --set integrate.start=balance"
printf 'name: s\ncase: coarse.yaml\nvary: {contact.n0: [20 N, 30 N]}\n' >s.yaml
sed -e 's/^name:.*/name: z/' -e 's/^    size: .*/    size: 20 mm/' z.yaml >coarse.yaml

# least NAME WORD...
least() {
  name=$1
  shift
  low=3 high=128
  while [ $((high - low)) -gt 1 ]; do
    middle=$(((low + high) / 2))
    (
      ulimit -n $middle
      LD_PRELOAD="$work/hide.so" timeout 300 shroudhb "$@"
    ) >/dev/null 2>&1
    case $? in
    0 | 3) high=$middle ;;
    *) low=$middle ;;
    esac
  done
  printf '%-10s %3d\n' "$name" "$high"
}

# shellcheck disable=SC2086 # words
{
  shroudhb run --quiet $set_up z.yaml >/dev/null 2>&1
  for command in mesh modal mhb integrate; do least $command $command --force $set_up z.yaml; done
  least post post $set_up z.yaml
  least field field --steps 3 z.response.h5
  least inspect inspect z.response.h5
  least run run --force $set_up z.yaml
  least "study, $(nproc)" study --force s.yaml
}
