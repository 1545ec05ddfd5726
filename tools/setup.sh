# Sourced by the tools: makes a fresh checkout ready to build, and is quick when it is ready.
# Leaves Debian packages, a .venv with the pinned Python packages, and the package itself,
# built in build/release (one tree for the extension, the controller and the tests).
# shellcheck shell=bash
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
venv="$root/.venv"
tree="$root/build/release"
logs="$root/build/logs"
# Compilations of one checkout serve every other one on the machine.
export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1

say() { printf '%s\n' "$*"; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# run_logged <log name> <reason if it fails> <command...>: quiet unless it fails.
run_logged() {
  local log="$logs/$1.log" reason="$2"
  shift 2
  mkdir -p "$logs"
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    fail "$reason (the whole output is in ${log#"$root"/})"
  fi
}

debian_packages() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/tools/debian-packages.txt"; }

install_debian_packages() {
  local missing=() package state
  if ! command -v dpkg-query >/dev/null; then
    fail "this is no Debian: install what tools/debian-packages.txt lists, and put dpkg-query in the PATH or build with cmake by hand (CONTRIBUTING.md)"
  fi
  for package in $(debian_packages); do
    state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
  done
  [[ ${#missing[@]} -gt 0 ]] || return 0

  local as_root=()
  if [[ $(id -u) != 0 ]]; then
    command -v sudo >/dev/null ||
      fail "Debian packages are missing and there is no sudo; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
    # With nobody there to type a password, say so instead of waiting.
    if [[ ! -t 0 ]] && ! sudo -n true 2>/dev/null; then
      fail "Debian packages are missing and sudo wants a password; as root: apt-get install ${missing[*]}"
    fi
    sudo -v || fail "sudo was refused; as root: apt-get install ${missing[*]}"
  fi
  say "Installing Debian packages: ${missing[*]}"
  run_logged apt-update "apt-get update failed: is there a network?" \
    "${as_root[@]}" apt-get update
  run_logged apt-install "apt-get could not install ${missing[*]}" \
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}

# Prints the first Python >= 3.11 that can make virtual environments and build extensions.
find_python() {
  local candidate
  for candidate in "${VIAPOINT_PYTHON:-}" python3.11 /usr/bin/python3.11 python3.12 python3.13 \
    python3.14 python3 /usr/bin/python3; do
    [[ -n $candidate ]] || continue
    if "$candidate" - 2>/dev/null <<'PYTHON'; then
import ensurepip, pathlib, sys, sysconfig, venv
header = pathlib.Path(sysconfig.get_path("include")) / "Python.h"
sys.exit(sys.version_info < (3, 11) or not header.exists())
PYTHON
      "$candidate" -c 'import sys; print(sys.executable)'
      return 0
    fi
  done
  return 1
}

# What the environment is made from; another text means it has to be made again.
environment_stamp() {
  {
    say "$root"
    "$venv/bin/python" --version
    cat "$root/pyproject.toml" "$root/tools/debian-packages.txt" "$root/tools/setup.sh"
  } | sha256sum
}

make_environment() {
  local python requirements
  if ! "$venv/bin/python" -c 'import pip' 2>/dev/null; then
    python=$(find_python) ||
      fail "no Python 3.11 or newer with venv and headers found; set VIAPOINT_PYTHON to one"
    say "Making .venv with $("$python" --version)"
    rm -rf "$venv"
    run_logged venv "python -m venv failed" "$python" -m venv "$venv"
  fi
  say "Installing the pinned Python packages"
  requirements=$("$venv/bin/python" "$root/tools/pinned_packages.py")
  # shellcheck disable=SC2086  # one word a package
  run_logged pip-packages "pip could not install the Python packages: is there a network?" \
    "$venv/bin/python" -m pip install --disable-pip-version-check $requirements
  say "Building the package (some minutes the first time)"
  run_logged pip-viapoint "the package did not build" \
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-build-isolation --no-deps \
    -e "$root" --config-settings=build-dir="$tree" \
    --config-settings=cmake.define.VIAPOINT_BUILD_TESTS=ON
}

# Builds what changed and puts it where pip put it the first time.
update_package() {
  run_logged build "the C++ part does not compile" cmake --build "$tree" --target "$@"
  local site
  site=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
  install_changed "$tree"/cpp/bindings/_core*.so "$site/viapoint"
  install_changed "$tree/cpp/controller/controller.binpb" "$site/viapoint"
  install_changed "$tree/cpp/controller/viapoint-controller" "$venv/bin"
  local robot
  for robot in "$root"/python/viapoint/robots/*; do
    install_changed "$robot" "$venv/share/viapoint/robots"
  done
}

install_changed() { # <file> <folder>; by rename, so that a running program keeps its own
  local target="$2/${1##*/}"
  cmp -s "$1" "$target" && return 0
  cp -p "$1" "$target.new" && mv "$target.new" "$target"
}

# setup [CMake target...]: everything the caller needs, by default what runs and not the tests.
setup() {
  local stamp_file="$venv/.viapoint-stamp"
  [[ $# -gt 0 ]] || set -- _core viapoint-controller
  cd "$root"
  mkdir -p "$root/build"
  exec 9>"$root/build/.setup-lock"
  flock 9 # two tools at once would build in one tree
  install_debian_packages
  if [[ ! -f $stamp_file || ! -f $tree/build.ninja ||
    $(environment_stamp 2>/dev/null) != "$(cat "$stamp_file")" ]]; then
    make_environment
    environment_stamp >"$stamp_file"
  fi
  update_package "$@"
  exec 9>&-
}
