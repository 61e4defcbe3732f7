#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The figures of docs/navigation.md: makes the houses and episodes of a set and evaluates them.
#   scripts/navigation_figures.sh development|held-out OUT [JOBS] [EVAL OPTION...]
# e.g. scripts/navigation_figures.sh held-out out/navigation 2 --variant paper
# Needs the furniture pack (crossnav assets import). An evaluation that was cut off goes on.
set -euo pipefail

set_name=${1:?development or held-out} out=${2:?a folder} jobs=${3:-2}
shift 2
[[ $# -gt 0 ]] && shift
program=${CROSSNAV:-build/release/apps/crossnav/crossnav}

case $set_name in
  development) first=1 unit=1 episodes=80 ;;
  held-out) first=5001 unit=2 episodes=160 ;;
  *) echo "no set '$set_name'; there are: development, held-out" >&2; exit 2 ;;
esac

# Ten houses of two floors and six of three, two of four, two of two floors with the faults of a
# scan; the held-out set has twice as many of each.
scenes=$out/$set_name/scenes
file=$out/$set_name/episodes.json.gz
if [[ ! -e $file ]]; then
  house() { "$program" world generate --seed "$1" --count "$2" --out "$scenes" "${@:3}" >&2; }
  house "$first" $((10 * unit)) --floors 2
  house $((first + 10 * unit)) $((6 * unit)) --floors 3 --furniture none
  house $((first + 16 * unit)) $((2 * unit)) --floors 4
  house $((first + 18 * unit)) $((2 * unit)) --floors 2 --scan
  "$program" episodes generate --scenes "$scenes" --count "$episodes" --goals 3 \
    --cross-floor 0.5 --seed 7 --out "$file" >&2
fi
run=$out/$set_name/$(printf '%s' "full $*" | tr -c 'A-Za-z0-9=.\n' '_')
"$program" eval --scenes "$scenes" --episodes "$file" --out "$run" --jobs "$jobs" "$@"
