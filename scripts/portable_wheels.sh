#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds wheels that bring the distribution's libraries with them: manylinux wheels for this machine's
# glibc and newer ones, in build/portable.
#   scripts/portable_wheels.sh BUILD_DIR [PYTHON...]     default: python3
# One wheel for each interpreter older than 3.12; one wheel serves 3.12 and all later ones. BUILD_DIR must
# have the targets `rooms` and `crossnav`.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
prebuilt=$(cd "$1" && pwd)
shift
out="$root/build/portable"
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"

# OpenVINO's TBB serves Embree too, so that a process with both has one version of it.
openvino=$(sed -n 's/^OpenVinoWheel_LIBS:INTERNAL=//p' "$prebuilt/CMakeCache.txt")
export LD_LIBRARY_PATH="$openvino${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

# build_one PYTHON: the wheel of one interpreter.
build_one() {
  local tag venv raw
  tag=$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  venv="$root/build/portable-venv-$tag"
  raw="$root/build/portable-raw-$tag"
  rm -rf "$venv" "$raw"
  "$1" -m venv "$venv"
  pip() { "$venv/bin/python" -m pip --disable-pip-version-check "$@"; }
  pip install -q --no-input -r "$root/scripts/wheel.txt" \
    $(grep -E '^(nanobind|scikit-build-core|packaging|pathspec)==' "$root/python/requirements.txt") numpy
  pip wheel -q "$root" --no-build-isolation --no-deps --wheel-dir "$raw" \
    --config-settings=build-dir="$root/build/portable-$tag" \
    --config-settings=cmake.define.CROSSNAV_PREBUILT="$prebuilt"
  PATH="$venv/bin:$PATH" "$venv/bin/auditwheel" repair --strip --exclude 'libopenvino.so.*' \
    --wheel-dir "$out" "$raw"/crossnav-*.whl
}

mkdir -p "$out"
for python in "${@:-${PYTHON:-python3}}"; do build_one "$python"; done
ls -l "$out"/*.whl
