#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what the build and the tests need, from the distribution's own packages.
#   scripts/setup.sh [GROUP...]      groups: build (default), homes, bench, lint, docs
# Tested on Debian 12 and 13; the names are those of Ubuntu 24.04 too. Nothing is asked for and
# nothing is touched when everything is there. CROSSNAV_SKIP_SETUP=1 makes it do nothing.
set -euo pipefail

declare -A PACKAGES=(
  [build]="g++ cmake ninja-build ccache python3-dev python3-venv \
    libeigen3-dev libexpected-dev libfmt-dev libembree-dev libtbb-dev libtinygltf-dev \
    librecast-dev nlohmann-json3-dev libsimdjson-dev libtomlplusplus-dev libcli11-dev libhwy-dev \
    zlib1g-dev libpng-dev libjpeg-dev libsqlite3-dev libzstd-dev libxxhash-dev libprotobuf-dev \
    protobuf-compiler libmeshoptimizer-dev libpugixml-dev libgtest-dev"
  [homes]="libassimp-dev"
  [bench]="libbenchmark-dev liboctomap-dev"
  [lint]="clang clang-format clang-tidy"
  [docs]="doxygen"
)

say() { printf 'setup: %s\n' "$*" >&2; }

# Prints those of the given packages that dpkg does not have installed, one a line.
missing_of() {
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
  comm -23 <(printf '%s\n' "$@" | sort -u) \
           <(sed -n 's/^installed //p' <<<"$installed" | sort -u)
}

# Says so and stops where the distribution is known to be too old, or is none with apt.
check_system() {
  local id=unknown version=""
  if [[ -r /etc/os-release ]]; then
    id=$(. /etc/os-release && echo "${ID:-unknown}")
    version=$(. /etc/os-release && echo "${VERSION_ID:-}")
  fi
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    say "this is '$id $version', and only Debian 12/13 and Ubuntu 24.04 are set up automatically."
    say "Install the equivalents of these packages, then run again with CROSSNAV_SKIP_SETUP=1:"
    printf '  %s\n' "${wanted[@]}" >&2
    exit 1
  fi
  local oldest=""
  case "$id" in
    debian) oldest=12 ;;
    ubuntu) oldest=24.04 ;;
  esac
  if [[ -n $oldest && -n $version ]] &&
     [[ $(printf '%s\n' "$oldest" "$version" | sort -V | head -n1) != "$oldest" ]]; then
    say "$id $version is too old: its packages lack what is needed. Use $id $oldest or newer."
    exit 1
  fi
}

# Runs apt-get as root, through sudo where needed.
as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

main() {
  [[ ${CROSSNAV_SKIP_SETUP:-} == 1 ]] && return 0
  local group
  wanted=()
  for group in "${@:-build}"; do
    if [[ -z ${PACKAGES[$group]:-} ]]; then
      say "no group '$group'; there are: ${!PACKAGES[*]}"
      exit 2
    fi
    read -r -a list <<<"${PACKAGES[$group]}"
    wanted+=("${list[@]}")
  done
  check_system
  mapfile -t missing < <(missing_of "${wanted[@]}")
  [[ ${#missing[@]} -eq 0 ]] && return 0

  say "installing ${#missing[@]} packages: ${missing[*]}"
  if [[ $(id -u) -ne 0 ]] && ! command -v sudo >/dev/null; then
    say "neither root nor sudo here. As root, run:"
    printf '  apt-get update && apt-get install --no-install-recommends %s\n' "${missing[*]}" >&2
    exit 1
  fi
  local apt=(apt-get -q -o DPkg::Lock::Timeout=300)
  as_root "${apt[@]}" update </dev/null >&2
  as_root "${apt[@]}" install -y --no-install-recommends "${missing[@]}" </dev/null >&2
  say "done"
}

main "$@"
