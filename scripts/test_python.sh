#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Python tests, run on the wheel in the virtual environment of the tools.
#   scripts/test_python.sh BUILD_DIR                 builds and installs the wheel, then runs every test
#   scripts/test_python.sh BUILD_DIR install         only the former; exit status 77: skipped, see build_wheel.sh
#   scripts/test_python.sh BUILD_DIR FILE...         only these tests of python/tests, with the installed wheel
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)
venv="$root/build/python-venv"
files=("${@:2}")

install_wheel() {
  rm -f "$venv/installed"
  "$root/scripts/build_wheel.sh" "$build"
  "$venv/bin/python" -m pip install -q --disable-pip-version-check --no-deps --force-reinstall \
    "$root"/build/wheel/*.whl
  touch "$venv/installed"
}

# Exit status 77 where every file of tests skips itself as a whole (pytest's status 5).
run_tests() {
  local program status=0
  program=$([ -x "$build/apps/crossnav/crossnav" ] && realpath "$build/apps/crossnav/crossnav" || true)
  cd "$venv"  # not where the sources lie
  CROSSNAV_PROGRAM="$program" CROSSNAV_ROOT="$root" CROSSNAV_WHEEL=$(echo "$root"/build/wheel/*.whl) \
    "$venv/bin/python" -m pytest -q -p no:cacheprovider --durations=5 -rs "$@" || status=$?
  return $((status == 5 ? 77 : status))
}

if [[ ${files[*]:-} == install ]]; then
  install_wheel
elif [[ ${#files[@]} -eq 0 ]]; then
  install_wheel
  run_tests "$root/python/tests"
elif [[ ! -e $venv/installed ]]; then
  echo "test_python: skipped, as no wheel is installed in $venv"
  exit 77
else
  run_tests "${files[@]/#/$root/python/tests/}"
fi
