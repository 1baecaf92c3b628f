#!/bin/sh
# Nothing stale, nothing foreign: stages make again what is out of date, and refuse a modal file
# that is not the one of the response.
# usage: test_stale.sh PATH_OF_SHROUDHB CASE_OF_A_BLADE
set -u
front=$1
blade=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0
cd "$work" || exit 1

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

# run CODE WORD...
run() {
  expected=$1
  shift
  "$front" "$@" >out 2>err </dev/null
  code=$?
  [ "$code" -eq "$expected" ] || {
    fail "shroudhb $*: exit code $code, expected $expected"
    cat out err
  }
}

says() { # TEXT: the only error
  [ "$(grep -c 'error: ' err)" -eq 1 ] && grep -qF -e "$1" err || {
    fail "not the one error '$1' in:"
    cat err
  }
}

first_mode() { # FILE
  "$front" inspect --csv "$1" modes/frequency | sed -n 2p
}

# as the modes of a run from nothing, at the same keys
fresh() { # CASE NAME
  "$front" run --quiet --force --set "name=fresh_$2" "$1" >/dev/null 2>&1
  first_mode "fresh_$2.modal.h5"
}

# a bar of modes alone; what its script includes counts
cat >bar.geo <<'END'
SetFactory("OpenCASCADE");
Include "height.geo";
Box(1) = {0, 0, 0.1, 0.01, 0.01, height};
Physical Volume("steel") = {1};
Physical Surface("root") = {5};
Mesh.ElementOrder = 2;
Mesh.MeshSizeMax = 0.01;
END
cat >bar.yaml <<'END'
mesh: {file: bar.geo}
material: {E: 200 GPa, nu: 0.3, rho: 7800 kg/m3}
modal: {modes: 2}
END
echo 'height = 0.10;' >height.geo
run 0 run bar.yaml
grep -q '^modes  *bar.modal.h5' out || { fail "run does not name the modes"; cat out; }
[ -e bar.html ] && fail "run made a report of modes alone"
long=$(first_mode bar.modal.h5)
run 0 run --json bar.yaml
grep -q '"modes"' out || { fail "run --json tells no modes"; cat out; }
for command in run modal; do
  echo 'height = 0.08;' >height.geo
  run 0 $command --quiet bar.yaml
  short=$(first_mode bar.modal.h5)
  [ "$short" != "$long" ] || fail "$command: the included file changed, the modes did not"
  [ "$short" = "$(fresh bar.yaml short)" ] || fail "$command: not the modes of the new script"
  echo 'height = 0.10;' >height.geo
  run 0 $command --quiet bar.yaml
  [ "$(first_mode bar.modal.h5)" = "$long" ] || fail "$command: not the modes of the old script"
done
run 0 modal --quiet --set mesh.size=8mm bar.yaml
run 0 modal --quiet bar.yaml
[ "$(first_mode bar.modal.h5)" = "$long" ] || fail "modal: the mesh of another size was kept"
for command in mhb integrate; do
  run 2 $command bar.yaml
  says 'describes modes alone'
done

# mhb and integrate make mesh and modes again, as run does
sed '/^ *tolerance:/d' "$blade" >z.yaml
coarse="--set name=z --set mesh.blade.size=20mm --set modal.modes=4 --set mhb.harmonics=1 \
  --set mhb.stability=never --set mhb.search.starts=0 --set contact.n0=30N"
# shellcheck disable=SC2086 # words
{
  run 0 mhb --quiet $coarse z.yaml
  one=$(first_mode z.modal.h5)
  cp z.response.h5 one.response.h5
  cp z.modal.h5 one.modal.h5
  run 0 field --steps 3 z.response.h5
  run 0 post --quiet $coarse z.yaml
  run 0 mhb --quiet $coarse --set 'mesh.blade.sections[0].thickness=7mm' z.yaml
  [ "$(first_mode z.modal.h5)" != "$one" ] || fail "mhb: the modes of another blade were kept"
  # the modes of another blade beside the response
  run 0 modal --quiet $coarse z.yaml
  run 2 post $coarse --set 'mesh.blade.sections[0].thickness=7mm' z.yaml
  says 'z.response.h5 was not computed from z.modal.h5'
  run 2 field --steps 3 z.response.h5
  says 'z.response.h5 was not computed from z.modal.h5'
  run 2 field --steps 3 --modal z.modal.h5 one.response.h5
  says 'one.response.h5 was not computed from z.modal.h5'
  run 2 integrate $coarse --set 'integrate.frequencies=[150Hz]' --set 'integrate.start=balance' \
    z.yaml
  says 'was not computed from z.modal.h5'
  run 0 mhb --quiet $coarse z.yaml
  run 0 post --quiet $coarse z.yaml
  run 0 field --steps 3 z.response.h5
}

[ "$failed" -eq 0 ] && echo "stale: passed"
exit "$failed"
