#!/bin/sh
# shroudhb-integrate as a program: its file, repeated runs, its part of the report, its errors.
# usage: test_integrate.sh FOLDER_OF_PROGRAMS SCENE PYTHON
set -u
bin=$1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cp "$2"/case.yaml "$2"/write_modal.py "$work" && cd "$work" || exit 1
"$3" write_modal.py || exit 77 # no h5py
failed=0

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

# run CODE STAGE WORD...: stdout to out, stderr to err
run() {
  expected=$1 stage=$2
  shift 2
  "$bin/shroudhb-$stage" "$@" >out 2>err </dev/null
  code=$?
  [ $code -eq "$expected" ] || {
    fail "$stage $*: exit code $code, expected $expected"
    cat out err
  }
}

says() { # out|err TEXT
  grep -qF -e "$2" $1 || {
    fail "no '$2' in:"
    cat $1
  }
}

silent() { # out|err
  [ ! -s $1 ] || {
    fail "unexpected on $1:"
    cat $1
  }
}

add() { # LINES under integrate:, in place of those before
  sed -i '/^integrate:/,$d' case.yaml
  printf 'integrate:\n%s\n' "$1" >>case.yaml
}

run 2 integrate case.yaml; silent out
says err 'three_degree.response.h5: not there to start on; run `shroudhb mhb'
run 0 mhb case.yaml
run 0 integrate case.yaml; says out '84 points'; silent err
stamp=$(cksum three_degree.integration.h5)
run 0 integrate case.yaml; silent out; silent err
[ "$stamp" = "$(cksum three_degree.integration.h5)" ] || fail 'written again though up to date'
run 0 post case.yaml; silent err
[ "$(grep -c '<circle class="integration c' three_degree.svg)" -eq 84 ] || fail 'not 84 dots'
[ "$(grep -c ',integration,' three_degree.csv)" -eq 84 ] || fail 'not 84 rows'

# a balance computed anew, with its points left, and the other way round
run 0 mhb --force case.yaml; [ -e three_degree.integration.h5 ] || fail 'the points are gone'
add '  frequencies: [0.15 Hz, 0.2 Hz]
  start: state
  direction: down
  tolerance: 1e-7'
run 0 post case.yaml
says err 'three_degree.integration.h5 was made from other settings and is left out'
grep -q '<circle class="integration c' three_degree.svg && fail 'old points are drawn'
run 0 integrate --quiet case.yaml; silent out; silent err
run 0 post case.yaml
[ "$(grep -c ',integration,' three_degree.csv)" -eq 8 ] || fail 'not 8 rows'

add '  frequencies: [0.2 Hz, 0.15 Hz]'
run 2 integrate case.yaml; says err 'frequencies must ascend'
add '  frequencies: 0'; run 2 integrate case.yaml; says err '0 frequencies; there may be 1 to'
add '  frequencies: 2.5'; run 2 integrate case.yaml; says err 'integrate.frequencies'
add '  start: somewhere'; run 2 integrate case.yaml; says err 'balance, rest, state'
exit $failed
