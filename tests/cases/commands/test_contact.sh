#!/bin/sh
# shroudhb-mhb contact as a program: its text, its picture, its errors.
# usage: test_contact.sh PATH_OF_SHROUDHB SCENE PYTHON (or an empty word)
set -u
program=$1
scene=$2
python=$3
work=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

# run CODE WORD...: stdout to out, stderr to err
run() {
  expected=$1
  shift
  "$program" "$@" >out 2>err </dev/null
  code=$?
  [ $code -eq "$expected" ] || {
    fail "$*: exit code $code, expected $expected"
    cat err
  }
}

one_line() { # TEXT: all that is on stderr
  [ "$(wc -l <err)" -eq 1 ] && grep -qF -e "$1" err || {
    fail "expected one line with '$1', found:"
    cat err
  }
}

cat >motion.yaml <<'END'
contact: {mu: 0.4, ku: [1 MN/m, 0.3 MN/m, 0.6 MN/m], kv: 0.5 MN/m, n0: 80 N}
motion:
  v: [0, [300 um, 50 deg], 0, [200 um, 10 deg]]
  u: [0, [200 um, 20 deg], [100 um, 100 deg]]
  w: [0, [70 um, 120 deg]]
END

# what is printed does not depend on the picture
run 0 contact motion.yaml
cp out plain
grep -q '^dissipation: 0\.0' out || fail 'no dissipation is printed'
grep -q '^error: ' out || fail 'no error estimate is printed'
grep -q '^states: {stick: ' out || fail 'no states are printed'
run 0 contact motion.yaml --svg loops.svg
cmp -s out plain || fail '--svg changes what is printed'
[ -s err ] && fail 'something is said though all went well'
[ -s loops.svg ] || fail 'no picture'
run 0 contact --svg again.svg motion.yaml
cmp -s loops.svg again.svg || fail 'the same motion gives another picture'
ls | grep -q tmp && fail 'a temporary file is left'

# a key from the command line is as one in the file, and the picture goes where it is told
sed 's/mu: 0.4/mu: 0.2/' motion.yaml >other.yaml
run 0 contact other.yaml
cp out other
run 0 contact --set contact.mu=0.2 --into there motion.yaml --svg loops.svg
cmp -s out other || fail '--set contact.mu=0.2 is not as in the file'
[ -s there/loops.svg ] || fail 'the picture is not in the folder of --into'
run 2 contact --set contact.mue=0.2 motion.yaml
grep -qF "contact.mue: unknown key; did you mean 'mu'?" err || fail 'a wrong --set is not told'

# the picture is XML with the dissipation in it
if [ -n "$python" ]; then
  "$python" - <<'END' || fail 'the picture is not what it should be'
import math, re, xml.etree.ElementTree as tree
root = tree.parse('loops.svg').getroot()
assert root.tag == '{http://www.w3.org/2000/svg}svg', root.tag
text = [''.join(t.itertext()) for t in root.iter('{http://www.w3.org/2000/svg}text')]
printed = float(re.search(r'^dissipation: (\S+)', open('plain').read(), re.M)[1])
def energies(word):
    return [float(re.search(word + r' (\S+)\u00a0mJ', t.replace('\u2212', '-'))[1])
            for t in text if t.startswith(word)]
told, loops = energies('dissipation'), energies('encloses')
assert len(told) == 1 and math.isclose(told[0] * 1e-3, printed, rel_tol=1e-3), (told, printed)
assert len(loops) == 2 and math.isclose(sum(loops), told[0], rel_tol=1e-3), (loops, told)
paths = root.iter('{http://www.w3.org/2000/svg}path')
curves = [p for p in paths if p.get('class', '').startswith('line ')]
assert len(curves) == 3 * 4 + 3, len(curves)  # three states: three panels and time, and the legend
END
fi

# an earlier picture is replaced as a whole or left alone
run 4 contact motion.yaml --svg missing/loops.svg
one_line 'shroudhb: error: missing/loops.svg: cannot be written: No such file or directory'
cmp -s out plain || fail 'an unwritable picture changes what is printed'
mkdir folder
run 4 contact motion.yaml --svg folder
one_line 'shroudhb: error: folder: cannot be written: Is a directory'
cp motion.yaml kept.yaml
run 2 contact motion.yaml --svg ./motion.yaml
one_line 'shroudhb: error: --svg ./motion.yaml would overwrite the motion file; name another file'
cmp -s motion.yaml kept.yaml || fail 'the motion file was overwritten'
ls . folder | grep -q tmp && fail 'a temporary file is left'

# words on the command line
run 2 contact motion.yaml --svg
one_line 'shroudhb: error: --svg needs the name of a file to write; see --help'
run 2 contact --svg --quiet motion.yaml
one_line 'shroudhb: error: --svg needs the name of a file to write; see --help'
run 2 contact motion.yaml --svg a.svg --svg b.svg
one_line "shroudhb: error: one --svg is enough; unexpected 'b.svg'; see --help"
run 2 mhb motion.yaml --svg a.svg
one_line 'shroudhb: error: --svg goes with contact, not with mhb; see --help'
[ -e a.svg ] && fail 'a refused command wrote a picture'
sed 's/mu: 0.4/mu: x/' motion.yaml >bad.yaml
run 2 contact bad.yaml --svg bad.svg
[ -e bad.svg ] && fail 'a bad file gave a picture'

# the scene's README tells what the scene gives
run 0 contact "$scene/motion.yaml" --svg scene.svg
sed -n 's/\(0\.[0-9]\{4\}\)[0-9]*/\1/g; s/^transitions: //p' out >transitions
[ "$(cat transitions)" = '[[0.2341, slip], [0.5007, open], [0.7214, slip], [0.9172, stick]]' ] ||
  fail 'other transitions than in README.md'
for figure in '22.1' '10.50' '8.699' '19.20'; do
  grep -q "$figure" "$scene/README.md" || fail "$figure is not in README.md"
  grep -q "$figure" scene.svg || fail "$figure is not in the picture"
done

# looking at a contact pays for no PETSc
if command -v ldd >/dev/null; then
  ldd "$program" | grep -qi petsc && fail 'PETSc is linked'
fi

[ $failed -eq 0 ] && echo 'all passed'
exit $((failed > 0))
