#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The figures of docs/navigation.md: makes the houses and episodes of a set and evaluates them.
#
#   scripts/navigation_figures.sh SET OUT [JOBS] [EVAL OPTION...]
#
# Sets: development, held-out (edition 1 of the generator), development-2, held-out-2 (edition 2),
# big (edition 2: offices of four floors and 1,200 m2, about 100 rooms, 3,600 actions).
# e.g. scripts/navigation_figures.sh held-out out/navigation 2 --variant paper
# CROSSNAV_HOMES=DIR adds the homes in DIR (scene folders; docs/homes.md) to a new development set.
# Needs the furniture pack (crossnav assets import). An interrupted evaluation resumes.
set -euo pipefail

set_name=${1:?a set, see the head of this file} out=${2:?a folder} jobs=${3:-2}
shift 2
[[ $# -gt 0 ]] && shift
program=${CROSSNAV:-build/release/apps/crossnav/crossnav}

case $set_name in
  development) first=1 homes=${CROSSNAV_HOMES:-} ;;
  held-out) first=5001 homes= ;;
  development-2) first=1 homes=${CROSSNAV_HOMES:-} edition=2 ;;
  held-out-2) first=6001 homes= edition=2 ;;
  big) first=1 homes= edition=2 ;;
  *) echo "no set '$set_name'; there are: development, held-out, development-2, held-out-2, big" >&2
     exit 2 ;;
esac
edition=${edition:-1}

# Twenty houses of two floors and twelve of three, four of four, four of two floors with the faults of
# a scan; four episodes of each.
scenes=$out/$set_name/scenes
file=$out/$set_name/episodes.json.gz
if [[ ! -e $file ]]; then
  house() { "$program" world generate --seed "$1" --count "$2" --edition "$edition" \
    --out "$scenes" "${@:3}" >&2; }
  if [[ $set_name == big ]]; then
    house "$first" 10 --building office --floors 4 --area 300
  else
    house "$first" 20 --floors 2
    house $((first + 20)) 12 --floors 3 --furniture none
    house $((first + 32)) 4 --floors 4
    house $((first + 36)) 4 --floors 2 --scan
  fi
  [[ -z $homes ]] || cp -r "$homes"/*/ "$scenes"
  count=$((4 * $(find "$scenes" -mindepth 1 -maxdepth 1 -type d | wc -l)))
  alternate=()
  [[ $edition == 1 ]] || alternate=(--alternate 0.25 --certify detection)
  "$program" episodes generate "${alternate[@]}" --scenes "$scenes" --count "$count" --goals 3 \
    --cross-floor 0.5 --seed 7 --out "$file" >&2
fi
run=$out/$set_name/$(printf '%s' "full $*" | tr -c 'A-Za-z0-9=.\n' '_')
[[ $set_name != big ]] || set -- --set eval.action_budget=3600 "$@"
"$program" eval --scenes "$scenes" --episodes "$file" --out "$run" --jobs "$jobs" "$@"
