#!/bin/sh
# test_install.sh CMAKE BUILD WORK: the installed program works away from its sources, and so does
# the Debian package, which dpkg unpacks into a folder of its own.
set -eu
cmake=$1 build=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"

fail() {
  echo "$1" >&2
  exit 1
}

# check_tree ROOT: programs, examples, pages and completion below ROOT
check_tree() {
  "$1/bin/shroudhb" --version | grep -q '^shroudhb ' || fail "$1: no version"
  "$1/bin/shroudhb" check "$1/share/shroudhb/cases/z_notch_blade/case.yaml" >/dev/null
  cp -r "$1/share/shroudhb/cases/first_case" "$work/own"
  chmod -R u+w "$work/own"
  sed 's/^  n0: .*/  n0: 1 kN/' "$1/share/shroudhb/cases/first_case/case.yaml" \
    >"$work/own/case.yaml"
  "$1/bin/shroudhb" run --quiet "$work/own/case.yaml" || [ $? -eq 3 ] || fail "$1: the run failed"
  grep -q '</html>' "$work"/own/*.html || fail "$1: no report"
  rm -r "$work/own"
  [ -z "$(find "$1" -name 'test_*')" ] || fail "$1: tests were installed"
  [ -f "$1/share/shroudhb/docs/user/commands.md" ] || fail "$1: no pages"
  for page in shroudhb.1 shroudhb-modal.1 shroudhb-case.5; do
    file=$(find "$1/share/man" -name "$page*")
    [ -n "$file" ] || fail "$1: no page $page"
    case $file in
      *.gz) text=$(gzip -dc "$file") ;;
      *) text=$(cat "$file") ;;
    esac
    # requests that the page's own text would make by a leading dot
    odd=$(printf '%s\n' "$text" | grep '^[.'"'"']' | grep -v '^\.\(TH\|SH\|nf\|fi\|BR\)' || true)
    [ -z "$odd" ] || fail "$page: $odd"
  done
}

"$cmake" --install "$build" --prefix "$work/tree" >install.log
check_tree "$work/tree"

# bash completes commands, options and case files
if command -v bash >/dev/null; then
  touch one.yaml other.txt
  complete() {
    PATH="$work/tree/bin:$PATH" bash -c '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
      _shroudhb 2>/dev/null; printf "%s " "${COMPREPLY[@]}"' \
      "$work/tree/share/bash-completion/completions/shroudhb" "$@"
  }
  [ "$(complete shroudhb insp)" = 'inspect ' ] || fail "command: $(complete shroudhb insp)"
  [ "$(complete shroudhb mesh --inp)" = '--inp ' ] || fail "option: $(complete shroudhb mesh --inp)"
  [ "$(complete shroudhb run o)" = 'one.yaml ' ] || fail "file: $(complete shroudhb run o)"
fi

command -v dpkg-shlibdeps >/dev/null && command -v cpack >/dev/null || exit 0
cpack --config "$build/CPackConfig.cmake" -B "$work/package" >package.log 2>&1 ||
  fail "$(cat package.log)"
package=$(find "$work/package" -name '*.deb' -maxdepth 1)
depends=$(dpkg-deb -f "$package" Depends | tr ',' '\n' | sed 's/^ *//; s/ .*//; s/:.*//')
[ -n "$depends" ] || fail "the package depends on nothing"
for name in $depends; do
  dpkg-query -W "$name" >/dev/null 2>&1 || fail "$name is not installed, but the build needs it"
done
mkdir -p staged admin/info admin/updates
touch admin/status admin/available
dpkg --instdir="$work/staged" --admindir="$work/admin" --log=/dev/null --force-not-root \
  --force-depends --force-script-chrootless -i "$package" >dpkg.log 2>&1 || fail "$(cat dpkg.log)"
check_tree "$work/staged/usr"
