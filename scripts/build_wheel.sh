#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the Python wheel from the rooms of an existing CMake build folder.
#
#   scripts/build_wheel.sh [BUILD_DIR]      default: build/release; its target `rooms` must be built
#
# Leaves the wheel in build/wheel and a virtual environment with the pinned tools in
# build/python-venv, which is remade when the pins, this script or the interpreter change. Exit
# status 77: pip reaches no package registry. PYTHON chooses the interpreter.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
prebuilt=$(cd "${1:-$root/build/release}" && pwd)
venv="$root/build/python-venv"
log="$root/build/python-pip.log"

unreachable='NewConnectionError|ConnectTimeout|ReadTimeout|ProxyError|NameResolutionError'
unreachable+='|Max retries exceeded|Temporary failure in name|\(from versions: none\)'

pip() { "$venv/bin/python" -m pip --disable-pip-version-check "$@"; }

# Tools and packages of the tests. Modules are compiled on import: few of all are imported.
make_environment() {
  rm -rf "$venv"
  if ! "${PYTHON:-python3}" -m venv "$venv"; then
    echo "build_wheel: no virtual environment; scripts/setup.sh installs python3-venv" >&2
    exit 1
  fi
  if ! pip install -q --no-input --no-compile -r "$root/python/requirements.txt" >"$log" 2>&1; then
    tail -n 5 "$log" >&2
    if grep -qE "$unreachable" "$log"; then
      echo "build_wheel: skipped, as pip reaches no package registry"
      exit 77
    fi
    exit 1
  fi
}

rm -rf "$root/build/wheel"
mkdir -p "$root/build"
contents=$("${PYTHON:-python3}" -VV && cat "$root/python/requirements.txt" "${BASH_SOURCE[0]}")
if [[ $contents != "$(cat "$venv/contents" 2>/dev/null)" ]]; then
  make_environment
  printf '%s\n' "$contents" >"$venv/contents"
fi

export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
pip wheel -q "$root" --no-build-isolation --no-deps --wheel-dir "$root/build/wheel" \
  -C build-dir="$root/build/python" -C cmake.define.CROSSNAV_PREBUILT="$prebuilt"
ls -l "$root"/build/wheel/*.whl
