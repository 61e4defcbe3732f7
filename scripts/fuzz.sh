#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the fuzz targets of tests/fuzz in sequence, each for the given seconds.
#
#   scripts/fuzz.sh SECONDS [TARGET...]      default: all targets
#
# Interesting inputs go to build/fuzz/corpus, statistics to build/fuzz/logs (scripts/fuzz_table.sh
# sums them up), inputs that crash, hang (2 s) or take 2 GB to build/fuzz/findings. Exit 1 if there
# are findings. One process at a time. The 2 s are wall time: on a busy machine, FUZZ_TIMEOUT=60.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:?usage: scripts/fuzz.sh SECONDS [TARGET...]}
shift
build=build/fuzz
[[ -e $build/build.ninja ]] || cmake --preset fuzz >/dev/null
targets=("$@")
if [[ ${#targets[@]} -eq 0 ]]; then
  mapfile -t targets < <(ninja -C "$build" -t targets all | sed -n 's/^fuzz_\([a-z_]*\): phony.*/\1/p' | sort -u)
fi
cmake --build --preset fuzz -j "${JOBS:-2}" --target crossnav_seeds "${targets[@]/#/fuzz_}" >&2

export LSAN_OPTIONS="suppressions=$PWD/scripts/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS=print_stacktrace=1
mkdir -p "$build/findings" "$build/logs"
"$build/tests/fuzz/crossnav_seeds" "$build/seeds"
failed=()
for target in "${targets[@]}"; do
  folders=("$build/corpus/$target" "$build/seeds/$target")
  mkdir -p "${folders[@]}"
  [[ -d tests/fuzz/corpus/$target ]] && folders+=("tests/fuzz/corpus/$target")
  log="$build/logs/$target.$(date +%s).log"
  status=0
  "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout="${FUZZ_TIMEOUT:-2}" -rss_limit_mb=2048 \
    -detect_leaks=0 -print_final_stats=1 -artifact_prefix="$build/findings/$target-" "${folders[@]}" \
    >"$log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-16s %10s executions, exit %s\n' "$target" "${runs:-?}" "$status"
  [[ $status -eq 0 ]] || failed+=("$target: $log")
done
[[ ${#failed[@]} -eq 0 ]] || { printf 'found something: %s\n' "${failed[@]}" >&2; exit 1; }
