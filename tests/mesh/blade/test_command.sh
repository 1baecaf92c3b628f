#!/bin/sh
# shroudhb-mesh: meshes once, skips when up to date, checks given meshes; exit codes, messages.
# usage: test_command.sh PATH_OF_SHROUDHB_MESH CASE.yaml
set -u
program=$1
scene=$2
sanitized=${3:-0} # a sanitizer reports crashes in place of the program
damaged=$(dirname "$0")/../io/damaged
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0
export HOME="$work/home" # gmsh must leave it alone (its FLTK makes an empty preferences file)
mkdir "$work/home" "$work/dir"
sed 's/^    size: .*/    size: 12 mm\n    shroud_size: 7 mm\n    elements: tet10/' \
  "$scene" >"$work/dir/case.yaml"
mesh=$work/dir/z_notch_blade.msh

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

run() { # CODE WORD...
  expected=$1
  shift
  (cd "$work/dir" && "$program" "$@") >"$work/out" 2>"$work/err" </dev/null
  code=$?
  [ "$code" -eq "$expected" ] || {
    fail "shroudhb-mesh $*: exit code $code, expected $expected"
    cat "$work/out" "$work/err"
  }
}

says() { # TEXT
  grep -qF -e "$1" "$work/err" || {
    fail "no '$1' in:"
    cat "$work/err"
  }
}

lines() { # COUNT
  [ "$(wc -l <"$work/err")" -eq "$1" ] || {
    fail "expected $1 lines:"
    cat "$work/err"
  }
}

inode() {
  ls -i "$mesh" | cut -d' ' -f1
}

# A small case that names a mesh file.
bring() { # FILE
  sed -e '/^mesh:/,/^material:/{/^material:/!d}' "$scene" >"$work/dir/brought.yaml"
  printf 'mesh: {file: %s}\n' "$1" >>"$work/dir/brought.yaml"
}

run 0 --quiet case.yaml
lines 0
[ -s "$mesh" ] || fail "no mesh written"
[ "$(sed -n 2p "$mesh")" = "4.1 0 8" ] || fail "not format 4.1: $(sed -n 2p "$mesh")"
cp "$mesh" "$work/first.msh"
first=$(inode)

run 0 --verbose case.yaml
says "is up to date"
[ "$(inode)" = "$first" ] || fail "an up-to-date mesh was written again"

run 0 --quiet --force case.yaml
cmp -s "$mesh" "$work/first.msh" || fail "the same case gave another mesh"

first=$(inode)
run 0 --quiet --inp case.yaml
[ "$(inode)" = "$first" ] || fail "an up-to-date mesh was written again for --inp"
mv "$work/dir/z_notch_blade.inp" "$work/dir/own.inp"
bring own.inp
run 0 --verbose brought.yaml
says "is sound"
sed -i 's/^\*ELEMENT, TYPE=C3D10/*ELEMENT, TYPE=C3D4/' "$work/dir/own.inp"
run 2 brought.yaml
lines 1
says "C3D4 is not supported; C3D10 and C3D20 are"
rm "$work/dir/own.inp"

sed -i 's/mu: 0.3/mu: 0.4/' "$work/dir/case.yaml"
run 0 --verbose case.yaml
says "is up to date"

sed -i 's/psi: 35 deg/psi: 30 deg/' "$work/dir/case.yaml"
run 0 --verbose case.yaml
cmp -s "$mesh" "$work/first.msh" && fail "a change of psi was not seen"

cp "$mesh" "$work/second.msh"
sed -i 's/contact: 24 mm/contact: 70 mm/' "$work/dir/case.yaml"
run 2 case.yaml
lines 1
says "shroudhb: error: mesh.blade.shroud.contact: 70 mm is too long"
cmp -s "$mesh" "$work/second.msh" || fail "a refused case touched the earlier mesh"

cp "$work/first.msh" "$work/dir/own.msh"
bring own.msh
run 0 --verbose brought.yaml
says "is sound"
sed -i 's/blades: 40/blades: 41/' "$work/dir/brought.yaml"
run 2 brought.yaml
lines 1
says "own.msh: contact faces do not match"

sed -i 's/"contact_left"/"somewhere"/' "$work/dir/own.msh"
bring own.msh
run 2 brought.yaml
lines 1
says "group contact_left is absent"

head -c 100000 "$work/first.msh" >"$work/dir/own.msh"
run 2 brought.yaml
lines 1
says "own.msh: cut short"

rm "$work/dir/own.msh"
run 4 brought.yaml
says "own.msh: cannot be read: No such file"

# A solid: meshed once, its groups by rule, its sides alike.
cat >"$work/dir/sector.geo" <<'GEO'
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 300, 0, 50, 40};
Extrude {{1, 0, 0}, {0, 0, 0}, 2*Pi/40} { Surface{1}; }
MeshSize{ PointsOf{ Surface{1}; } } = 7;
GEO
solid() { # MESH-BLOCK
  sed -e '/^mesh:/,/^material:/{/^material:/!d}' -e '/psi:/d' "$scene" >"$work/dir/solid.yaml"
  printf 'name: solid\nmesh:\n  file: sector.geo\n%s\n' "$1" >>"$work/dir/solid.yaml"
  sed -i '0,/^name: z/{/^name: z/d}' "$work/dir/solid.yaml"
}
rules='  unit: mm
  size: 12 mm
  groups:
    root: {radius: 300 mm}
    contact_right: {nearest: [20 mm, 320 mm, 0 m]}
    contact_left: {plane: [0, 0, 0], normal: [0, -0.15643446504023087, 0.98768834059513777]}
    load: {nearest: [25 mm, 350 mm, 25 mm]}'
solid "$rules"
run 0 --verbose solid.yaml
[ -s "$work/dir/solid.msh" ] || fail "no solid.msh"
run 0 --verbose solid.yaml
says "is up to date"
echo "// touched" >>"$work/dir/sector.geo"
run 0 --verbose solid.yaml
says "nodes"
sed -i 's/contact_left: .*/contact_left: {radius: 2 m}/' "$work/dir/solid.yaml"
run 2 solid.yaml
lines 1
says "mesh.groups.contact_left: "
says "has no face at radius 2 m"
solid "  unit: mm
  groups:
    root: {radius: 300 mm, nearest: [0, 0, 0]}
    rot: {radius: 1}
    load: {plane: [0, 0, 0]}"
run 2 solid.yaml
says "mesh.groups.root.nearest: is a second rule for its group"
says "mesh.groups.rot: unknown group"
says "mesh.groups.load: lacks normal"

# Coordinates in mm taken as m: told, but not where the case says that they are in m.
in_metres=$(echo "$rules" | sed -e 's/unit: mm/unit: m/' -e 's/12 mm/12 m/' \
  -e 's/300 mm/300 m/' -e 's/ mm/ m/g' -e '/load:/d')
solid "$in_metres"
run 0 solid.yaml
lines 0
solid "$(echo "$in_metres" | sed '/unit:/d')"
run 0 --force solid.yaml
lines 1
says "shroudhb: warning: sector.geo: the body measures "
says "are its coordinates in mm? Say so with mesh.unit"

# What OpenCASCADE says of a file that is none is one line, without colours.
printf 'ISO-10303-21;\nnothing\n' >"$work/dir/none.step"
solid "$(echo "$rules" | sed '/unit:/d')"
sed -i 's/sector.geo/none.step/' "$work/dir/solid.yaml"
run 2 solid.yaml
lines 1
says "shroudhb: error: none.step: "
[ -s "$work/out" ] && fail "OpenCASCADE spoke on standard output"
rm "$work/dir/none.step"

# A script that ends the program is no success.
solid "$rules"
echo 'Exit;' >>"$work/dir/sector.geo"
run 2 solid.yaml
lines 1
says "shroudhb: error: sector.geo: ends the program while it is read; leave out Exit"
sed -i '/Exit/d' "$work/dir/sector.geo"

# The first signal ends it where gmsh returns, a second one ends it at once, even inside gmsh.
# signalled SIGNAL SECOND|-: sets code
signalled() {
  (cd "$work/dir" && exec "$program" --force solid.yaml) >"$work/out" 2>"$work/err" &
  pid=$!
  sleep 1.5
  kill -"$1" $pid
  sleep 0.05
  [ "$2" = - ] || kill -"$2" $pid 2>"$work/late"
  wait $pid
  code=$?
}
solid "$(echo "$rules" | sed 's/12 mm/.9 mm/')"
signalled TERM -
[ $code -eq 130 ] || [ $code -eq 143 ] || fail "signal TERM: exit code $code"
for signals in 'INT INT 130' 'TERM TERM 143'; do
  set -- $signals
  # gmsh may return between the two signals; then both are sent to another run
  for _ in 1 2 3 4 5 6; do
    signalled "$1" "$2"
    grep -q 'interrupted while meshing; nothing written' "$work/err" || break
    [ $code -eq 130 ] || fail "signal $1: exit code $code, expected 130"
  done
  [ $code -eq "$3" ] || fail "signals $1 $2: exit code $code, expected $3"
  says "ended at once"
done
rm "$work/dir/sector.geo" "$work/dir/solid.yaml" "$work/dir/solid.msh"

# Damaged meshes over which gmsh crashes: one line.
[ "$sanitized" = 1 ] || for name in segmentation_fault assertion; do
  cp "$damaged/$name.msh" "$work/dir"
  sed "s/^mesh:.*/mesh: {file: $name.msh}/; /^  blade:/,/^    size:/d" "$scene" \
    >"$work/dir/damaged.yaml"
  run 2 damaged.yaml
  lines 1
  says "shroudhb: error: $name.msh: is damaged: gmsh crashed while it was read; mesh or copy it"
  rm "$work/dir/$name.msh"
done
rm -f "$work/dir/damaged.yaml"

left=$(ls -A "$work/home" | grep -v -e '^.fltk$')
[ -z "$left" ] || fail "something was written to HOME: $left"
left=$(ls -A "$work/dir" | grep -v -e '^case.yaml$' -e '^brought.yaml$' -e '^z_notch_blade.msh$')
[ -z "$left" ] || fail "left behind: $left"

[ "$failed" -eq 0 ] || exit 1
echo "shroudhb-mesh: all checks passed"
