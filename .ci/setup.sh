#!/usr/bin/env bash
# What ./check and ./demo share: headings, and getting what they need onto the machine.
# Sourced, never run. Expects the caller to have set -euo pipefail and the root as directory.

# Programs and libraries that run Lvis on a Debian-like system. Building needs only the C compiler.
readonly RUN_PACKAGES=(
  libx11-6 libx11-xcb1 libxcursor1 libxi6 libxrandr2 libxkbcommon0 libxkbcommon-x11-0
  libwayland-client0 libvulkan1 mesa-vulkan-drivers
)
# What driving the window from a test needs besides.
readonly TEST_PACKAGES=(xvfb xdotool imagemagick)
readonly TYPOS_VERSION=1.52.0
# What docs/examples/watch.py runs with.
readonly GRPCIO_VERSION=1.85.1
readonly NUMPY_VERSION=2.4.6

target_dir=${CARGO_TARGET_DIR:-$PWD/target}

say() { printf '%s\n' "$*"; }

complain() { printf '%s\n' "$*" >&2; }

# step HEADING COMMAND...: announces a step, runs it, and tells how long it took. The command is
# run plainly, not as a condition, so that a failure anywhere inside it ends the script.
step() {
  local start=$SECONDS
  running=$1
  shift
  printf '\n== %s\n' "$running"
  "$@"
  say "== $running: done in $((SECONDS - start)) s"
  running=
}

# Names the step that failed. A script that must tidy up defines clean_up.
finish() {
  local status=$?
  if [[ -n $running ]]; then
    complain "== $running: FAILED"
  fi
  if declare -F clean_up >/dev/null; then
    clean_up
  fi
  exit "$status"
}
running=
trap finish EXIT

# Rust is the one thing that is not installed behind anyone's back.
require_cargo() {
  if ! command -v cargo >/dev/null && [[ -x $HOME/.cargo/bin/cargo ]]; then
    PATH=$HOME/.cargo/bin:$PATH
  fi
  if ! command -v cargo >/dev/null; then
    complain "Lvis is built with Rust, and cargo was not found. Install it from https://rustup.rs"
    complain "and run this again in a new shell."
    exit 1
  fi
}

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# install_packages PACKAGE...: the C compiler and these, where that can be done.
install_packages() {
  local package missing=()
  command -v cc >/dev/null || missing+=(gcc libc6-dev)
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    advise_other_systems
    return
  fi
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  if [[ ${#missing[@]} -eq 0 ]]; then
    say "Everything is installed: a C compiler, $*"
  elif [[ $EUID -eq 0 ]]; then
    say "Installing with apt-get: ${missing[*]}"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
  else
    complain "Some of what Lvis needs is missing, and only root can install it. Please run:"
    complain "    sudo apt-get install ${missing[*]}"
    need_compiler
  fi
}

# Names what a system without apt needs; goes on when there is at least a compiler.
advise_other_systems() {
  say "Packages are installed only on Debian-like systems. Here, please see to it that there are:"
  if [[ $(uname -s) == Darwin ]]; then
    say "  a C compiler (xcode-select --install); Vulkan is not needed, Metal is used"
  else
    say "  a C compiler; a Vulkan driver (Mesa's software driver lavapipe will do) and its loader"
    say "  the client libraries of X11 (with XCB, Xcursor, Xi, Xrandr) or Wayland, and xkbcommon"
    say "  to drive the window from tests: Xvfb, xdotool, ImageMagick"
  fi
  need_compiler
}

need_compiler() {
  if ! command -v cc >/dev/null; then
    complain "Without a C compiler (cc) nothing can be built."
    return 1
  fi
}

# Puts the path of the right typos into $typos, or leaves it empty. It lives in an environment of
# its own under the target directory, because a system's Python packages are none of our business.
find_typos() {
  local home=$target_dir/tools/typos-$TYPOS_VERSION
  typos=
  if [[ $(typos --version 2>/dev/null) == "typos-cli $TYPOS_VERSION" ]]; then
    typos=typos
  elif [[ -x $home/bin/typos ]]; then
    typos=$home/bin/typos
  elif install_typos "$home" >/dev/null 2>&1; then
    typos=$home/bin/typos
  fi
}

install_typos() {
  mkdir -p "$1" && python3 -m venv "$1" &&
    "$1/bin/pip" install --disable-pip-version-check "typos==$TYPOS_VERSION" ||
    { rm -rf "$1"; return 1; }
}

# Puts the Python that has what docs/examples needs into $example_python, or leaves it empty.
find_example_python() {
  local home=$target_dir/tools/python-grpcio-$GRPCIO_VERSION
  example_python=
  if [[ -x $home/bin/python ]] || install_example_python "$home" >/dev/null 2>&1; then
    example_python=$home/bin/python
  fi
}

install_example_python() {
  mkdir -p "$1" && python3 -m venv "$1" &&
    "$1/bin/pip" install --disable-pip-version-check "grpcio==$GRPCIO_VERSION" \
      "grpcio-tools==$GRPCIO_VERSION" "numpy==$NUMPY_VERSION" ||
    { rm -rf "$1"; return 1; }
}
