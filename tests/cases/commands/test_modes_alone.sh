#!/bin/sh
# Modes alone: a bracket with a mesh, a material and a clamp. Its frequencies are those of a
# cantilever; every other stage says in one line what is missing.
# usage: test_modes_alone.sh PATH_OF_SHROUDHB CASE_OF_A_BLADE
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

# steel, 15 mm by 10 mm, 300 mm long
cat >bracket.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, -0.005, 0.1, 0.015, 0.010, 0.300};
Physical Volume("steel") = {1};
Physical Surface("root") = {5};
Mesh.ElementOrder = 2;
Mesh.MeshSizeMax = 0.010;
END
cat >bracket.yaml <<'END'
mesh: {file: bracket.geo}
material: {E: 207 GPa, nu: 0.29, rho: 7850 kg/m3}
modal: {modes: 5}
END

run 0 modal --quiet bracket.yaml # meshes too
[ -s bracket.msh ] || fail "no mesh was made"
run 0 inspect --csv bracket.modal.h5 modes/frequency
# Euler and Bernoulli: (beta L)^2 / 2 pi sqrt(E / rho) h / sqrt(12) / L^2
awk -F, 'BEGIN {
  c = sqrt(207e9 / 7850) / sqrt(12) / 0.300 ^ 2 / (2 * 3.141592653589793)
  want[1] = 3.516015 * c * 0.010; want[2] = 3.516015 * c * 0.015
  want[3] = 22.03449 * c * 0.010; want[4] = 22.03449 * c * 0.015
}
$NF + 0 > 0 {
  n++
  if (n > 4) next
  off = $NF / want[n] - 1
  printf "mode %d: %.3f Hz, a slender beam %.3f Hz: %.2f %%\n", n, $NF, want[n], 100 * off
  if (off > 0.005 || off < -0.02) bad = 1
}
END { exit bad || n != 5 }' out || {
  fail "these are not the frequencies of a cantilever:"
  cat out
}
run 0 inspect bracket.modal.h5
grep -q '5 modes .*; no contact' out || fail "inspect says nothing of missing contact"
run 0 check bracket.yaml
grep -q 'modes alone' out || fail "check says nothing of modes alone"
grep -q 'lowest mode 92.41[0-9]* Hz, mass 0.353[23] kg' out || {
  fail "check does not tell what the modal file holds"
  cat out
}

for command in mhb integrate; do
  run 2 $command bracket.yaml
  says 'describes modes alone, for `shroudhb modal`; the balance needs contact'
done
cat >own.yaml <<'END'
modal: {file: bracket.modal.h5}
rotor: {blades: 40}
excitation: {engine_order: 5}
contact: {mu: 0.3, ku: 1 MN/m, kv: 1 MN/m, n0: 10 N}
mhb: {frequency: [100 Hz, 300 Hz]}
END
run 2 mhb own.yaml
says 'bracket.modal.h5: has no /contact'
run 2 modal --set modal.modes=auto --set modal.band=1kHz bracket.yaml
says 'there is no contact; give a number'

# at speed, with a probe
run 0 modal --quiet --set 'rotor.speed=[0 rpm, 3000 rpm]' --set 'probe={tip: [0, 0, 0.4]}' \
  bracket.yaml
run 0 inspect bracket.modal.h5
grep -q '2 speeds' out || fail "no Campbell diagram"

# the blade count that fits is told
sed '/^mesh:/,/^ *$/d; /^excitation:/,/^ *$/d' "$blade" >ring.yaml
cat >>ring.yaml <<'END'
mesh: {file: ring.msh}
END
run 0 mesh --quiet --set mesh.blade.size=20mm --set name=ring "$blade" --into .
run 2 modal --quiet --set rotor.blades=41 --set name=counted ring.yaml
says 'with rotor.blades: 40, not 41, they match'

# a blade without a load: modes and contact, but nothing for the balance to answer to
sed '/^excitation:/,/^ *$/d' "$blade" >blade.yaml
grep -q excitation blade.yaml && fail "the case still has a load"
run 0 modal --quiet --set mesh.blade.size=20mm --set name=blade --set modal.modes=6 blade.yaml
run 2 mhb --set mesh.blade.size=20mm --set name=blade --set modal.modes=6 \
  --set excitation.engine_order=5 blade.yaml
says 'blade.modal.h5: its load is 0'

[ "$failed" -eq 0 ] && echo "modes alone: passed"
exit "$failed"
