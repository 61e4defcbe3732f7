#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The figures of docs/navigation.md: makes the houses and episodes of a set and evaluates them.
#   scripts/navigation_figures.sh development|held-out OUT [JOBS] [EVAL OPTION...]
# e.g. scripts/navigation_figures.sh held-out out/navigation 2 --variant paper
# CROSSNAV_HOMES=DIR adds the homes in DIR (scene folders; docs/homes.md) to a development set that is
# made anew. Needs the furniture pack (crossnav assets import). An evaluation that was cut off goes on.
set -euo pipefail

set_name=${1:?development or held-out} out=${2:?a folder} jobs=${3:-2}
shift 2
[[ $# -gt 0 ]] && shift
program=${CROSSNAV:-build/release/apps/crossnav/crossnav}

case $set_name in
  development) first=1 homes=${CROSSNAV_HOMES:-} ;;
  held-out) first=5001 homes= ;;
  *) echo "no set '$set_name'; there are: development, held-out" >&2; exit 2 ;;
esac

# Twenty houses of two floors and twelve of three, four of four, four of two floors with the faults of
# a scan; four episodes of each.
scenes=$out/$set_name/scenes
file=$out/$set_name/episodes.json.gz
if [[ ! -e $file ]]; then
  house() { "$program" world generate --seed "$1" --count "$2" --out "$scenes" "${@:3}" >&2; }
  house "$first" 20 --floors 2
  house $((first + 20)) 12 --floors 3 --furniture none
  house $((first + 32)) 4 --floors 4
  house $((first + 36)) 4 --floors 2 --scan
  [[ -z $homes ]] || cp -r "$homes"/*/ "$scenes"
  count=$((4 * $(find "$scenes" -mindepth 1 -maxdepth 1 -type d | wc -l)))
  "$program" episodes generate --scenes "$scenes" --count "$count" --goals 3 \
    --cross-floor 0.5 --seed 7 --out "$file" >&2
fi
run=$out/$set_name/$(printf '%s' "full $*" | tr -c 'A-Za-z0-9=.\n' '_')
"$program" eval --scenes "$scenes" --episodes "$file" --out "$run" --jobs "$jobs" "$@"
