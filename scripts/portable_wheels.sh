#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds wheels that bring the distribution's libraries with them: manylinux wheels for this machine's
# glibc and newer ones, in build/portable; and tries each interpreter with the wheel that pip chooses for it.
#   scripts/portable_wheels.sh BUILD_DIR [PYTHON...]     default: every Python from 3.10 on in PATH and in pyenv
# One wheel for each interpreter older than 3.12; one wheel serves 3.12 and all later ones. BUILD_DIR must
# have the targets `rooms` and `crossnav`.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
prebuilt=$(cd "$1" && pwd)
shift
out="$root/build/portable"
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"

# OpenVINO's TBB also serves Embree, so that a process with both has one version of it.
openvino=$(sed -n 's/^OpenVinoWheel_LIBS:INTERNAL=//p' "$prebuilt/CMakeCache.txt")
export LD_LIBRARY_PATH="$openvino${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

say() { printf 'portable_wheels: %s\n' "$*"; }
tag_of() { "$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])'; }

# Interpreters with headers and pip: one of each version.
find_pythons() {
  local minor candidate
  for minor in 10 11 12 13 14; do
    for candidate in "python3.$minor" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3."$minor".*/bin/python3; do
      if "$candidate" -c 'import ensurepip, os, sysconfig
os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null; then
        echo "$candidate"
        break
      fi
    done
  done
}

# build_one PYTHON: the wheel of one interpreter.
build_one() {
  local tag venv raw
  tag=$(tag_of "$1")
  venv="$root/build/portable-venv-$tag"
  raw="$root/build/portable-raw-$tag"
  rm -rf "$venv" "$raw"
  "$1" -m venv "$venv"
  pip() { "$venv/bin/python" -m pip --disable-pip-version-check "$@"; }
  pip install -q --no-input -r "$root/scripts/wheel.txt" \
    $(grep -E '^(nanobind|scikit-build-core|packaging|pathspec)==' "$root/python/requirements.txt") 'numpy<3'
  pip wheel -q "$root" --no-build-isolation --no-deps --wheel-dir "$raw" \
    --config-settings=build-dir="$root/build/portable-$tag" \
    --config-settings=cmake.define.CROSSNAV_PREBUILT="$prebuilt"
  PATH="$venv/bin:$PATH" "$venv/bin/auditwheel" repair --strip --exclude 'libopenvino.so.*' \
    --wheel-dir "$out" "$raw"/crossnav-*.whl
}

# try_one PYTHON: install, import, one step and the program, in an environment of nothing else.
try_one() {
  local venv
  venv="$root/build/portable-try-$(tag_of "$1")"
  rm -rf "$venv"
  "$1" -m venv "$venv"
  "$venv/bin/python" -m pip --disable-pip-version-check install -q --no-input 'numpy<3'
  "$venv/bin/python" -m pip --disable-pip-version-check install -q --no-index --find-links "$out" crossnav
  (cd "$venv" && bin/crossnav --version && bin/python - "$("$1" -V)") <<'EOP'
import sys
import crossnav
crossnav.write_embedded_house("house")
scene = crossnav.Scene("house", config={"sensor": {"width_px": 64, "height_px": 64}})
simulator = crossnav.Simulator(scene)
simulator.reset(crossnav.AgentPose(scene.random_point(seed=1)))
agent = crossnav.Agent(simulator.ground_truth(), scene.config)
agent.set_goal("plant")
print(f"portable_wheels: {sys.argv[1]}: {agent.step(simulator.observe()).action.name}")
EOP
  rm -rf "$venv"
}

rm -rf "$out"
mkdir -p "$out"
mapfile -t pythons < <([[ $# -gt 0 ]] && printf '%s\n' "$@" || find_pythons)
abi3=""
for python in "${pythons[@]}"; do
  [[ -z $abi3 ]] || continue
  build_one "$python"
  [[ $(tag_of "$python") < cp312 ]] || abi3=$python
done
for python in "${pythons[@]}"; do try_one "$python"; done
for tag in cp310-cp310 cp311-cp311 cp312-abi3; do
  compgen -G "$out/*-$tag-*.whl" >/dev/null || say "no $tag: no such Python with its headers here (python3.N-dev, or pyenv)"
done
ls -l "$out"/*.whl
for wheel in "$out"/*.whl; do
  [[ $(stat -c %s "$wheel") -le 60000000 ]] || { say "$wheel is larger than 60 MB" >&2; exit 1; }
done
