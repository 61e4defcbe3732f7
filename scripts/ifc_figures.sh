#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The figure of docs/homes.md: an IFC building furnished with five seeds, 40 episodes, 320 px.
#
#   scripts/ifc_figures.sh FILE.ifc OUT [JOBS] [EVAL OPTION...]
#
# Needs IfcOpenShell (scripts/setup.sh ifc) and the furniture pack (crossnav assets import). An
# interrupted evaluation resumes.
set -euo pipefail

building=${1:?an IFC file} out=${2:?a folder} jobs=${3:-2}
shift 2
[[ $# -gt 0 ]] && shift
program=${CROSSNAV:-build/release/apps/crossnav/crossnav}
small=(--set sensor.width_px=320 --set sensor.height_px=320)

if [[ ! -e $out/episodes.json.gz ]]; then
  for seed in 1 2 3 4 5; do
    "$program" scene import "$building" --out "$out/scenes" --name "Furnished$seed" \
      --furnish "$seed" --seconds 120 >&2
  done
  "$program" episodes generate --scenes "$out/scenes" --count 40 --goals 3 --cross-floor 0.5 \
    --seed 1 --out "$out/episodes.json.gz" "${small[@]}" >&2
fi
"$program" eval --scenes "$out/scenes" --episodes "$out/episodes.json.gz" --out "$out/run" \
  --jobs "$jobs" "${small[@]}" "$@"
