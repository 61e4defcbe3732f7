#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# `make networks`: frames, training, export, thresholds and figures. Existing results are kept: an
# interrupted run resumes. NETWORKS_DATA (default build/networks) takes 60 GB. NETWORKS_PYTHON is a
# Python with networks/requirements.txt; without it a virtual environment is made in the data
# folder.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

data=${NETWORKS_DATA:-../build/networks}
mkdir -p "$data"
if [[ -z ${NETWORKS_PYTHON:-} ]]; then
  NETWORKS_PYTHON=$data/venv/bin/python
  if [[ ! -x $NETWORKS_PYTHON ]]; then
    python3 -m venv "$data/venv"
    "$NETWORKS_PYTHON" -m pip install --quiet -r requirements.txt
  fi
fi
python() { nice -n 4 "$NETWORKS_PYTHON" -u "$@"; }

python render.py --data "$data"
[[ ! -d ../../shared/data/clip ]] || python text_table.py
python train.py --data "$data" --frames "${NETWORKS_FRAMES:-200000}" --minutes "${NETWORKS_MINUTES:-110}"
python train_masks.py --data "$data"
python export.py --data "$data"
python card.py --data "$data"
python thresholds.py --data "$data"
python evaluate.py --data "$data" --set test --worst "$data/worst" --json "$data/figures.json"
python card.py --data "$data" --figures "$data/figures.json"
