#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints the table of docs/robustness.md from the statistics of scripts/fuzz.sh.
#
#   scripts/fuzz_table.sh            the table
#   scripts/fuzz_table.sh --write    puts it into docs/robustness.md, between its two marks
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# stat NAME FILE...: the values of a statistic, one a line.
stat_of() { sed -n "s/^stat::$1: *//p" "${@:2}"; }

table() {
  echo '| target | executions | slowest input [s] | most memory [MB] | inputs kept | findings |'
  echo '|---|--:|--:|--:|--:|--:|'
  local log target runs slowest memory kept findings
  for target in $(find build/fuzz/logs -name '*.log' -printf '%f\n' | cut -d. -f1 | sort -u); do
    log=(build/fuzz/logs/"$target".*.log)
    runs=$(stat_of number_of_executed_units "${log[@]}" | awk '{n += $1} END {print n + 0}')
    slowest=$(stat_of slowest_unit_time_sec "${log[@]}" | sort -n | tail -n 1)
    memory=$(stat_of peak_rss_mb "${log[@]}" | sort -n | tail -n 1)
    kept=$(find "build/fuzz/corpus/$target" -type f | wc -l)
    findings=$(find build/fuzz/findings -name "$target-*" | wc -l)
    echo "| \`$target\` | $runs | ${slowest:-?} | ${memory:-?} | $kept | $findings |"
  done
}

if [[ ${1:-} == --write ]]; then
  page=docs/robustness.md
  table >build/fuzz/table.md
  sed -i -e '/^<!-- table -->$/,/^<!-- end -->$/{/^<!-- table -->$/{p;r build/fuzz/table.md
};/^<!-- end -->$/p;d}' "$page"
else
  table
fi
