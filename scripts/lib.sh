# shellcheck shell=bash disable=SC2034
# What the scripts beside this one share. Source it; it changes to the repository's root.
#   ensure_packages PACKAGE...    installs the Debian packages that are missing; costs nothing when none is
#   configure DIR [OPTION...]     runs CMake (Ninja, Release unless an option says otherwise)
#   build DIR [TARGET...]         builds, on all cores
#   build_program                 everything needed for the program alone, which is then "${goniofit}"
#   say TEXT                      one line of progress on stderr

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DEBIAN_FRONTEND=noninteractive

build_packages=(g++ cmake ninja-build ccache libceres-dev libeigen3-dev libopenexr-dev libpng-dev libembree-dev libcli11-dev nlohmann-json3-dev
  libtomlplusplus-dev libyaml-cpp-dev libfmt-dev libfast-float-dev libboost-dev
  nettle-dev gnuplot-nox)
test_packages=(libgtest-dev librapidcheck-dev libmpfr-dev python3-lmfit chromium)
# Where they came from elsewhere, Debian's packages of the same names would be in the way.
command -v node >/dev/null || build_packages+=(nodejs)
command -v npm >/dev/null || build_packages+=(npm)

say() { printf '%s\n' "== $*" >&2; }

# Runs a command with its output in a log, shown only when the command fails.
quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 || status=$?
  if ((status != 0)); then
    cat "$log" >&2
    say "failed: $*"
  fi
  rm -f "$log"
  return "$status"
}

as_root() {
  if ((EUID == 0)); then "$@"; else sudo --preserve-env=DEBIAN_FRONTEND "$@"; fi
}

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

ensure_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system; needed are what these packages hold: $*"
    return
  fi
  local package missing=()
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  say "installing ${missing[*]}"
  quietly as_root apt-get -o DPkg::Lock::Timeout=300 update
  quietly as_root apt-get -o DPkg::Lock::Timeout=300 install --yes --no-install-recommends "${missing[@]}"
}

configure() {
  local dir=$1
  shift
  quietly cmake -S . -B "$dir" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@"
}

build() {
  local dir=$1
  local options=(-C "$dir" -j "$(nproc)")
  shift
  [[ -t 1 ]] || options+=(--quiet)  # on a terminal ninja keeps one line up to date
  say "building in $dir"
  ninja "${options[@]}" "$@" >&2
}

# The program needs no test packages; a build directory that was set up for tests keeps them.
build_program() {
  local options=()
  [[ -e build/CMakeCache.txt ]] || options=(-DGONIOFIT_TESTS=OFF)
  ensure_packages "${build_packages[@]}"
  configure build "${options[@]}"
  build build goniofit_program
}
goniofit=build/src/cli/goniofit
