# shellcheck shell=sh disable=SC2034
# Debian packages that shroudhb needs, and how they come onto the machine. Sourced by quickstart.sh,
# tests/run.sh and .ci/run; defines functions only. POSIX sh.

packages_build="gcc libc6-dev cmake ninja-build pkg-config git
libgmsh-dev libpetsc-real-dev libslepc-real-dev libhdf5-openmpi-dev libfftw3-dev
liblapacke-dev libopenblas-dev libsuitesparse-dev libmumps-dev libyaml-dev libgsl-dev libnlopt-dev
libcmocka-dev openmpi-bin"

# The tests also read files with h5dump and python3, compare frequencies with CalculiX, check case
# files by the JSON Schema, make a Debian package, and open the pages in a browser; node runs the
# modules of their scripts, which eslint reads.
packages_test="hdf5-tools python3 python3-h5py python3-matplotlib python3-jsonschema python3-yaml
calculix-ccx dpkg-dev chromium-headless-shell nodejs eslint"

# continuous integration also checks the sources, and tries random inputs
packages_check="clang-format clang-tidy clang-14 libclang-rt-14-dev python3"

# packages_missing NAME...: those that are not installed, on one line
packages_missing() {
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      printf '%s ' "$package"
  done
}

# packages_install NAME...: installs the missing ones. Lists them and returns 1 if the user may not.
# If nothing is missing, neither the network nor the package lists are touched.
packages_install() {
  command -v dpkg-query >/dev/null || {
    echo "shroudhb: this script installs Debian packages; elsewhere install the like of: $*" >&2
    return 1
  }
  packages_wanted=$(packages_missing "$@")
  [ -n "$packages_wanted" ] || return 0
  packages_sudo=
  if [ "$(id -u)" -ne 0 ]; then
    packages_sudo='sudo -n'
    if [ -t 0 ] && [ -z "${CI:-}" ]; then packages_sudo=sudo; fi # may ask for a password
    if ! command -v sudo >/dev/null || ! $packages_sudo true 2>/dev/null; then
      echo "shroudhb: these packages are missing, and installing them needs root or sudo:" >&2
      echo "  apt-get install $packages_wanted" >&2
      return 1
    fi
  fi
  echo "installing: $packages_wanted"
  # shellcheck disable=SC2086
  if ! $packages_sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq update </dev/null ||
    ! $packages_sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq -y \
      --no-install-recommends install $packages_wanted </dev/null >/dev/null; then
    echo "shroudhb: apt-get could not install: $packages_wanted" >&2
    return 1
  fi
}

# packages_build_release [TARGET]: configure and build in build/release of the current folder
packages_build_release() {
  cmake --preset release -Wno-dev >/dev/null && cmake --build --preset release --target "${1:-all}"
}
