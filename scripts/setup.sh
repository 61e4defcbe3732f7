#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the dependencies of the build and the tests, from the distribution's own packages.
#
#   scripts/setup.sh [GROUP...]      groups: build (default), homes, bench, lint, fuzz, docs,
#                                    slurm, hm3d, ifc, viewer, roots
# The build group comes with OpenVINO, the inference library, as no distribution packages it: its
# Python wheel, pinned in scripts/openvino.txt, in ${XDG_DATA_HOME:-~/.local/share}/crossnav. Where
# it cannot be had, the build goes on without networks. ONNX Runtime, another such library, is
# installed where the distribution has it (Debian 13). The lint group comes with clang-tidy, pinned
# in scripts/clang-tidy.txt, beside OpenVINO. The hm3d group is Basis Universal, whose textures HM3D
# ships: compiled from the sources in a crate that scripts/basis/Cargo.lock pins, beside OpenVINO too.
# The ifc group is IfcOpenShell, pinned in scripts/ifcopenshell.txt, in a Python environment there, where
# the program looks for it. The viewer group is Chromium and Node.js, with the packages that
# viewer/package-lock.json pins: for the tests of the replay page, and for `make viewer`. The roots group is
# debootstrap, for `make try-packages`.
# Tested on Debian 12 and 13; the names are those of Ubuntu 24.04 too. Nothing is asked for and
# nothing is touched when everything is there. CROSSNAV_SKIP_SETUP=1 makes it do nothing.
set -euo pipefail

declare -A PACKAGES=(
  [build]="g++ cmake ninja-build ccache python3-dev python3-venv \
    libeigen3-dev libexpected-dev libfmt-dev libembree-dev libtbb-dev libtinygltf-dev \
    librecast-dev nlohmann-json3-dev libsimdjson-dev libtomlplusplus-dev libcli11-dev libhwy-dev \
    zlib1g-dev libzip-dev libpng-dev libjpeg-dev libsqlite3-dev libzstd-dev libxxhash-dev libprotobuf-dev libevent-dev \
    protobuf-compiler libmeshoptimizer-dev libpugixml-dev libgtest-dev"
  [homes]="libassimp-dev"
  [bench]="libbenchmark-dev liboctomap-dev"
  [lint]="clang-format python3-venv"
  [fuzz]="clang libclang-rt-dev"
  [docs]="doxygen"
  [slurm]="slurm-wlm munge"
  [hm3d]="g++ libzstd-dev"
  [ifc]="python3-venv"
  [viewer]="chromium"
  [roots]="debootstrap"
)

say() { printf 'setup: %s\n' "$*" >&2; }

# Prints the given packages that are not installed, one a line.
missing_of() {
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
  comm -23 <(printf '%s\n' "$@" | sort -u) \
           <(sed -n 's/^installed //p' <<<"$installed" | sort -u)
}

# Stops with a message if the distribution is too old or has no apt.
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

# Installs optional packages that the distribution has, if no password is needed.
install_optional() {
  local package absent
  [[ $(id -u) -eq 0 ]] || sudo -n true 2>/dev/null || return 0
  mapfile -t absent < <(missing_of "$@")
  for package in "${absent[@]}"; do
    apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [0-9]' || continue
    say "installing $package, which is optional"
    as_root apt-get -q -o DPkg::Lock::Timeout=300 install -y --no-install-recommends "$package" \
      </dev/null >&2 || say "$package cannot be had; the build goes on without it"
  done
}

# The wheel's headers and used libraries, in the folder where CMake looks. A failure is a notice:
# the build then omits networks.
install_openvino() {
  local pin data home work
  pin="$(dirname "${BASH_SOURCE[0]}")/openvino.txt"
  data="${XDG_DATA_HOME:-$HOME/.local/share}/crossnav"
  home="$data/openvino-$(sed -n 's/^openvino==\([0-9.]*\).*/\1/p' "$pin")"
  [[ -e $home/openvino/include/openvino/openvino.hpp ]] && return 0
  say "fetching OpenVINO into $home"
  mkdir -p "$data" && work=$(mktemp -d "$data/setup.XXXXXX") || return 0
  if python3 -m venv "$work/venv" && fetch_openvino "$work" "$pin" >"$work/log" 2>&1; then
    rm -rf "$home"
    mv "$work/wheel" "$home"
  else
    tail -n 3 "$work/log" 2>/dev/null >&2 || true
    say "OpenVINO cannot be had; the build goes on without networks"
  fi
  rm -rf "$work"
}

# fetch_openvino WORK PIN: downloads, checks the hash, unpacks and drops unused files.
fetch_openvino() {
  local tag=manylinux_2_28_x86_64
  [[ $(uname -m) == aarch64 ]] && tag=manylinux_2_35_aarch64
  "$1/venv/bin/python" -m pip --disable-pip-version-check download -q --no-input --no-deps \
    --require-hashes --only-binary=:all: --implementation cp --python-version 3.11 --abi cp311 \
    --platform "$tag" -r "$2" -d "$1" &&
    python3 -m zipfile -e "$1"/openvino-*.whl "$1/wheel" &&
    find "$1/wheel/openvino" -mindepth 1 -maxdepth 1 ! -name include ! -name libs \
      -exec rm -rf {} + &&
    find "$1/wheel/openvino/libs" -type f ! -name 'libopenvino.so.*' ! -name 'libtbb.so.*' \
      ! -name 'libopenvino_onnx_frontend.so.*' ! -name 'libopenvino_*_cpu_plugin.so' -delete
}

# The linter in a separate Python environment, where the Makefile looks.
install_clang_tidy() {
  local pin data home
  pin="$(dirname "${BASH_SOURCE[0]}")/clang-tidy.txt"
  data="${XDG_DATA_HOME:-$HOME/.local/share}/crossnav"
  home="$data/clang-tidy-$(sed -n 's/^clang-tidy==\([0-9.]*\).*/\1/p' "$pin")"
  [[ -e $home/complete ]] && return 0
  say "fetching clang-tidy into $home"
  rm -rf "$home"
  mkdir -p "$data"
  python3 -m venv "$home"
  "$home/bin/python" -m pip --disable-pip-version-check install -q --no-input --no-deps \
    --require-hashes --only-binary=:all: -r "$pin" || {
    say "clang-tidy cannot be had; see above. Try again later, it is needed for make lint only"
    exit 1
  }
  touch "$home/complete"
}

# Transcoder and encoder (for tests) as static libraries, where CMake looks.
install_basis() {
  local here data home work
  here="$(cd "$(dirname "${BASH_SOURCE[0]}")/basis" && pwd)"
  data="${XDG_DATA_HOME:-$HOME/.local/share}/crossnav"
  home="$data/basis-universal-$(sed -n 's/^basis-universal-sys = "=\([0-9.]*\)"/\1/p' "$here/Cargo.toml")"
  [[ -e $home/libbasisu_encoder.a ]] && return 0
  say "compiling Basis Universal into $home"
  mkdir -p "$data"
  work=$(mktemp -d "$data/setup.XXXXXX")
  if ! build_basis "$work" "$here" >"$work/log" 2>&1; then
    tail -n 5 "$work/log" >&2
    rm -rf "$work"
    say "Basis Universal cannot be had; see above. Without it HM3D's scenes load untextured"
    exit 1
  fi
  rm -rf "$home"
  mv "$work/home" "$home"
  rm -rf "$work"
}

# build_basis WORK MANIFEST_FOLDER: zstd is the system's, as the library has only one.
build_basis() {
  local source=$1/crates/basis-universal-sys/vendor/basis_universal file
  cargo vendor --locked --manifest-path "$2/Cargo.toml" "$1/crates" || return 1
  mkdir -p "$1/home/include" "$1/transcoder" "$1/encoder" || return 1
  local flags=(-std=c++17 -O2 -fPIC -fno-strict-aliasing -ffp-contract=off -w
    -ffile-prefix-map="$1/crates/"= -DBASISU_SUPPORT_SSE=0
    -DBASISU_SUPPORT_OPENCL=0 -DBASISD_SUPPORT_KTX2_ZSTD=1)
  for file in "$source"/transcoder/*.cpp; do
    g++ "${flags[@]}" -c "$file" -o "$1/transcoder/$(basename "$file").o" || return 1
  done
  for file in "$source"/encoder/*.cpp; do
    g++ "${flags[@]}" -c "$file" -o "$1/encoder/$(basename "$file").o" || return 1
  done
  ar rcs "$1/home/libbasisu_transcoder.a" "$1"/transcoder/*.o || return 1
  ar rcs "$1/home/libbasisu_encoder.a" "$1"/encoder/*.o || return 1
  (cd "$source" && cp --parents {transcoder,encoder,zstd}/*.h LICENSE "$1/home/include")
}

# IfcOpenShell in a separate Python environment, where the program looks.
install_ifcopenshell() {
  local pin home
  pin="$(dirname "${BASH_SOURCE[0]}")/ifcopenshell.txt"
  home="${XDG_DATA_HOME:-$HOME/.local/share}/crossnav/ifcopenshell"
  cmp -s "$pin" "$home/complete" && return 0
  say "fetching IfcOpenShell into $home"
  rm -rf "$home"
  mkdir -p "$(dirname "$home")"
  python3 -m venv "$home"
  "$home/bin/python" -m pip --disable-pip-version-check install -q --no-input --no-deps \
    --only-binary=:all: -r "$pin" || {
    say "IfcOpenShell cannot be had; see above. Without it, scene import reads no .ifc"
    exit 1
  }
  cp "$pin" "$home/complete"
}

# three.js, the bundler and the driver of the browser, where the tests look.
install_viewer() {
  local viewer
  viewer="$(cd "$(dirname "${BASH_SOURCE[0]}")/../viewer" && pwd)"
  cmp -s "$viewer/package-lock.json" "$viewer/node_modules/installed" && return 0
  say "fetching the viewer's packages into $viewer/node_modules"
  (cd "$viewer" && npm ci --no-audit --no-fund </dev/null >&2) || {
    say "the viewer's packages cannot be had; see above. Only tests of the page and make viewer need them"
    exit 1
  }
  cp "$viewer/package-lock.json" "$viewer/node_modules/installed"
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
  if [[ " $* " == *" hm3d "* ]] && ! command -v cargo >/dev/null; then wanted+=(cargo); fi
  if [[ " $* " == *" viewer "* ]] && ! command -v npm >/dev/null; then wanted+=(nodejs npm); fi
  check_system
  mapfile -t missing < <(missing_of "${wanted[@]}")
  [[ ${#missing[@]} -eq 0 ]] || install_packages
  if [[ " ${*:-build} " == *" build "* ]]; then
    install_optional libonnxruntime-dev
    install_openvino
  fi
  [[ " $* " != *" lint "* ]] || install_clang_tidy
  [[ " $* " != *" hm3d "* ]] || install_basis
  [[ " $* " != *" ifc "* ]] || install_ifcopenshell
  [[ " $* " != *" viewer "* ]] || install_viewer
  return 0
}

install_packages() {
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
