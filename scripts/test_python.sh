#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the wheel, installs it into the virtual environment of the tools and runs the Python tests
# there.
#
#   scripts/test_python.sh [BUILD_DIR]      exit status 77: skipped, see build_wheel.sh
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/scripts/build_wheel.sh" "$@"
python="$root/build/python-venv/bin/python"
wheel=$(echo "$root"/build/wheel/*.whl)
"$python" -m pip install -q --disable-pip-version-check --no-deps --force-reinstall "$wheel"
program="${1:-$root/build/release}/apps/crossnav/crossnav"  # in its build folder it writes replays
program=$([ -x "$program" ] && realpath "$program" || true)
cd "$root/build/python-venv"  # outside the sources
CROSSNAV_PROGRAM="$program" CROSSNAV_ROOT="$root" CROSSNAV_WHEEL="$wheel" \
  "$python" -m pytest -q -p no:cacheprovider --durations=5 "$root/python/tests"
