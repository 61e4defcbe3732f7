#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the wheel, installs it into a fresh virtual environment and runs the Python tests there.
#   scripts/test_python.sh [BUILD_DIR]      exit status 77: skipped, see build_wheel.sh
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/scripts/build_wheel.sh" "$@"
python="$root/build/python-venv/bin/python"
wheel=$(echo "$root"/build/wheel/*.whl)
"$python" -m pip install -q --disable-pip-version-check --no-deps "$wheel"
program="$(cd "${1:-$root/build/release}" && pwd)/apps/crossnav/crossnav"
cd "$root/build/python-venv"  # not where the sources lie
CROSSNAV_ROOT="$root" CROSSNAV_WHEEL="$wheel" CROSSNAV_PROGRAM="$program" \
  "$python" -m pytest -q -p no:cacheprovider --durations=5 "$root/python/tests"
