#!/bin/sh
# The front command: exit codes, messages, files left alone. The stages are scripts that log how
# they were called, beside copies of shroudhb and of what does run, check and keys.
# usage: test_commands.sh PATH_OF_SHROUDHB
set -u
front=$1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

# run CODE WORD...: stdout to $work/out, stderr to $work/err
run() {
  expected=$1
  shift
  (cd "$work/dir" && "$work/bin/shroudhb" "$@") >"$work/out" 2>"$work/err" </dev/null
  code=$?
  [ "$code" -eq "$expected" ] || {
    fail "shroudhb $*: exit code $code, expected $expected"
    cat "$work/out" "$work/err"
  }
}

says() { # out|err TEXT
  grep -qF -e "$2" "$work/$1" || {
    fail "no '$2' in:"
    cat "$work/$1"
  }
}

silent() { # out|err
  [ ! -s "$work/$1" ] || {
    fail "unexpected on $1:"
    cat "$work/$1"
  }
}

called() { # the log, on one line
  calls=$(tr '\n' ';' <"$work/log")
  [ "$calls" = "$1" ] || fail "called '$calls', expected '$1'"
  : >"$work/log"
}

script() { # NAME COMMANDS
  printf '#!/bin/sh\n%s\n' "$2" >"$work/bin/$1"
  chmod +x "$work/bin/$1"
}

stage() { # NAME COMMANDS: a stand-in
  case $1 in
  modal) script shroudhb-modal "echo modal \"\$@\" >>'$work/log'
$2" ;;
  *) script "stage-$1" "echo \"\$@\" >>'$work/log'
$2" ;;
  esac
}

mkdir "$work/bin" "$work/dir" "$work/dir/a b"
cp "$front" "$work/bin/shroudhb"
cp "$front-pool" "$work/bin/real"
script shroudhb-pool "case \$1 in run|check|keys) exec '$work/bin/real' \"\$@\" ;; esac
exec '$work/bin/stage-'\$1 \"\$@\""
: >"$work/log"
for name in mesh modal mhb post integrate inspect contact; do stage $name 'exit 0'; done

cat >"$work/dir/good.yaml" <<'END'
name: good
mesh:
  blade:
    root: {length: 61 mm, width: 43 mm, height: 19 mm}
    sections:
      - {radius: 0.31, chord: 53 mm, thickness: 5 mm, camber: 3 mm, twist: 20 deg}
      - {radius: 0.47 m, chord: 41 mm, thickness: 2.9 mm}
    shroud: {length: 37 mm, thickness: 6.1 mm, contact: 23 mm}
    size: 8 mm
material: {E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}
rotor: {blades: 37, speed: 2900 rpm}
modal: {damping: 0.23 %}
excitation: {engine_order: 7, pressure: 210 Pa}
contact: {mu: 0.31, ku: 0.5 MN/m, kv: 0.8 MN/m, n0: [0, 300 N]}
mhb: {frequency: [90 Hz, 0.12 kHz]}
END
sed 's/mu: 0.31/mue: 0.31/; s/90 Hz/90 Hx/' "$work/dir/good.yaml" >"$work/dir/bad.yaml"
cp "$work/dir/good.yaml" "$work/dir/a b/case.yaml"
cat >"$work/dir/brought.yaml" <<'END'
modal: {file: given.modal.h5}
contact: {to: ground, mu: 0.31, ku: 0.5, kv: 0.8, n0: 1}
mhb: {frequency: [0.1, 0.2]}
END
echo x >"$work/dir/given.modal.h5"
ls -l "$work/dir" >"$work/before"

# help, version, nothing, nonsense
run 0 --help; says out 'usage: shroudhb COMMAND'; silent err
run 0 check --help; says out 'usage: shroudhb check'
run 0 keys --help; says out 'usage: shroudhb keys'
run 0 help; says out 'usage: shroudhb COMMAND'; silent err
run 0 help check; says out 'usage: shroudhb check'; silent err
run 0 help mhb; says out 'usage: shroudhb mhb'; says out '--set KEY=VALUE'; silent err
called ''
run 0 help --help; says out 'usage: shroudhb COMMAND'; silent err
run 2 help chek; says err "unknown command 'chek'; did you mean 'check'?"; silent out
run 2 help check more; says err "help takes one command; unexpected 'more'"; silent out
run 0 --version; says out 'shroudhb 0.'; silent err
run 2; says err 'usage: shroudhb COMMAND'; silent out
run 2 chek good.yaml; says err "shroudhb: error: unknown command 'chek'; did you mean 'check'?"
run 2 frobnicate; says err "unknown command 'frobnicate'; see shroudhb --help"
run 2 --frobnicate; says err "unknown option '--frobnicate'"
run 2 check; says err 'no file given'
run 2 check good.yaml bad.yaml; says err "one file is enough; unexpected 'bad.yaml'"
run 2 check --frobnicate good.yaml; says err "unknown option '--frobnicate'"
run 2 run; says err 'no file given'
run 2 keys more; says err "unexpected 'more'"

# an output that cannot be written (here: closed) is told, and is no success
for words in '--help' '--version' 'keys' 'check good.yaml' 'run good.yaml' 'contact --help'; do
  (cd "$work/dir" && touch good.html && "$work/bin/shroudhb" $words) >&- 2>"$work/err" </dev/null
  code=$?
  [ $code -eq 4 ] || fail "$words with a closed output: exit code $code, expected 4"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "$words with a closed output: not one line"
  says err 'standard output cannot be written'
  rm "$work/dir/good.html"
done
: >"$work/log"

# keys, check
run 0 keys; says out 'contact.mu '; says out 'friction coefficient'; silent err
run 0 keys --markdown; says out '# Case reference'; says out '| `mu` | number |'; silent err
run 2 keys --markdown more; says err "unexpected 'more'"
run 0 check good.yaml; says out 'good.yaml: ok'; says out '37 blades, engine order 7'; silent err
run 0 check --quiet good.yaml; silent out; silent err
run 0 check brought.yaml; says out 'from given.modal.h5'
called 'post --facts brought.yaml;' # what the modal file holds
run 2 check bad.yaml; silent out
says err 'bad.yaml:14:11: error: contact.mue: unknown key; did you mean'
says err "bad.yaml:15:19: error: mhb.frequency[0]: '90 Hx': unknown unit 'Hx'; expected Hz"
says err '2 errors'
[ "$(tail -n 1 "$work/err")" = '2 errors' ] || fail 'something is said after the errors'
run 4 check missing.yaml
says err 'shroudhb: error: missing.yaml: cannot be opened: No such file or directory'
called ''

# run: the stages in turn
run 0 run good.yaml; silent err
called 'mesh good.yaml;modal good.yaml;mhb good.yaml;post good.yaml;'
run 0 run --quiet --force good.yaml; silent out; silent err
forced='--quiet --force good.yaml'
called "mesh $forced;modal $forced;mhb $forced;post $forced;"
run 0 run brought.yaml
called 'mhb brought.yaml;post brought.yaml;'
run 0 run 'a b/case.yaml'
called 'mesh a b/case.yaml;modal a b/case.yaml;mhb a b/case.yaml;post a b/case.yaml;'
run 0 run --verbose good.yaml; says err 'peak MB'; says err 'modal '
: >"$work/log"
run 2 run bad.yaml; silent out; says err '2 errors'
run 4 run missing.yaml
called ''

# one stage, and the modes of stages
run 0 modal --verbose good.yaml; called 'modal --verbose good.yaml;'
run 0 integrate --force good.yaml; called 'integrate --force good.yaml;'
run 0 inspect x.h5; called 'inspect x.h5;'
run 0 contact x.yaml; called 'contact x.yaml;'
run 0 contact x.yaml --svg x.svg; called 'contact x.yaml --svg x.svg;'
run 2 check good.yaml --svg x.svg; says err '--svg goes with contact, not with check'
run 2 run --svg x.svg good.yaml; says err '--svg goes with contact, not with run'
called ''

# former programs are links
former() { # NAME WORD...
  name=$1
  shift
  ln -sf shroudhb "$work/bin/shroudhb-$name"
  (cd "$work/dir" && "$work/bin/shroudhb-$name" "$@") >"$work/out" 2>"$work/err"
}
former integrate --force good.yaml; called 'integrate --force good.yaml;'
former mhb --contact x.yaml; called 'contact x.yaml;'
former post --inspect x.h5; called 'inspect x.h5;'
former mhb --help; says out 'usage: shroudhb mhb'; called ''

# codes
stage modal 'exit 2'
run 2 run good.yaml; silent err
called 'mesh good.yaml;modal good.yaml;'
run 2 modal good.yaml
stage modal 'exit 4'
run 4 run good.yaml
stage modal 'kill -9 $$'
run 4 run good.yaml
says err 'shroudhb: error: shroudhb-modal was killed by signal 9 (Killed); out of memory?'
stage modal 'exit 0'
stage mhb 'exit 3'
: >"$work/log"
run 3 run good.yaml; says out 'not converged everywhere'; silent err
called 'mesh good.yaml;modal good.yaml;mhb good.yaml;post good.yaml;'
stage post 'exit 4'
run 4 run good.yaml
stage post 'exit 0'
rm "$work/bin/shroudhb-modal"
(PATH=/usr/bin:/bin; run 4 run good.yaml; says err 'shroudhb-modal: cannot be started'
  exit $failed) || failed=$((failed + 1))
stage modal 'exit 0'
: >"$work/log"

# results are named
stage mhb 'exit 0'
stage post 'touch good.html good.csv'
run 0 run good.yaml; says out 'report    good.html'; says out 'curves    good.csv'
rm "$work/dir/good.html" "$work/dir/good.csv"
: >"$work/log"

# a signal to the front command reaches the stage, which ends in its own way; no other stage starts
stage mhb "trap 'echo caught >>\"$work/log\"; exit 130' TERM; echo ready >>'$work/log'
while :; do sleep 0.05; done"
(cd "$work/dir" && exec "$work/bin/shroudhb" run good.yaml) >"$work/out" 2>"$work/err" &
pid=$!
for _ in $(seq 100); do
  grep -q ready "$work/log" && break
  sleep 0.05
done
kill -TERM $pid
wait $pid
code=$?
[ $code -eq 130 ] || fail "SIGTERM: exit code $code, expected 130"
called 'mesh good.yaml;modal good.yaml;mhb good.yaml;ready;caught;'

# bad input and all the above wrote nothing
ls -l "$work/dir" >"$work/after"
cmp -s "$work/before" "$work/after" || {
  fail 'files changed:'
  diff "$work/before" "$work/after"
}

[ $failed -eq 0 ] && echo 'all passed'
exit $((failed > 0))
