#!/bin/sh
# From a fresh Debian 12 to a forced-response report: installs missing packages (root or sudo),
# builds in build/release, runs the case z_notch_blade, prints where the report is.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
cd "$root"
. "$root/cases/packages.sh"

# shellcheck disable=SC2086
packages_install $packages_build
packages_build_release programs # the tests are for tests/run.sh
code=0
build/release/bin/shroudhb run cases/z_notch_blade/case.yaml || code=$?
report=$root/cases/z_notch_blade/z_notch_blade.html
if [ $code -eq 0 ] || [ $code -eq 3 ]; then
  echo
  echo "Open the report in a browser: $report"
fi
exit $code
