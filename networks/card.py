# SPDX-License-Identifier: MIT
"""Writes the card beside the exported networks: description, training, figures and limits.

Without --figures the figures of an earlier card of the same file are kept, and so are its thresholds.
"""

import argparse
import hashlib
import json
import pathlib
import subprocess

import common
import export
import numpy as np
import torch
from evaluate import read_card
from runtime import masks_file

# chosen: cosine by which one name has to answer better than another. CLIP's own vectors lie within 0.2 of each other
# (verify.refute_margin is 0.02 for them), ours without their mean within 1.
MARGIN = 0.15

LIMITS = [
    "Trained on renders alone, of generated houses and two drawn homes: in five real frames it finds most chairs, but with low scores, and "
    "calls a dining table sofa and bed (docs/networks-training.md). In two frames of a real flight of stairs it draws one, with all its treads, "
    "and misses the other.",
    "Square pictures with a field of view of about 90 degrees, a camera 0.6 to 1.2 m above the floor, depth in "
    "metres: other cameras change what sizes and heights mean.",
    "Six goals only. Armchairs and sofas, low tables and beds, balusters and plants are taken for each other; landings "
    "of stairs are missed, see the worst cases.",
    "Masks end where their box ends, and are drawn at the input's size: what is thinner than a pixel there, such as "
    "leaves from afar, is lost; where depth is missing, edges are those of colour.",
]


def commit():
    run = subprocess.run(["git", "-C", str(common.REPO), "rev-parse", "--short", "HEAD"], capture_output=True,
                         text=True, check=False)
    return run.stdout.strip() or "unknown"


def listed(values):
    return "[" + ", ".join(json.dumps(value) for value in values) + "]"


def rows(values):
    return "".join(f"{key} = {json.dumps(value)}\n" for key, value in values.items())


def table(name, values):
    return f"\n[{name}]\n" + rows(values)


def houses_of(data, name):
    return sorted(int(path.parent.name) for path in (data / name).glob("*/models.json"))


def from_seeds(sets, names):
    return ", ".join(f"{len(sets[name])} houses, seeds from {common.SETS[name]['seeds'].start}" for name in names if sets[name])


def data_text(data, state):
    sets = {name: houses_of(data, name) for name in common.SETS}
    seeds = ", ".join(f"seeds {min(sets[name])} to {max(sets[name])} (edition {common.SETS[name].get('edition', 1)})"
                      for name in common.TRAIN_SETS if sets[name])
    start = {"from": f"the weights of an earlier {state['from']}"} if "from" in state else {}
    homes = [home for name in common.TRAIN_STYLES for home in common.STYLES[name]["homes"] if (data / name / home).exists()]
    return table("data", {
        "houses": f"{sum(len(sets[name]) for name in common.TRAIN_SETS)} of crossnav world generate, {seeds}, {state.get('frames', 0)} frames",
        "homes": f"of Sweet Home 3D, drawn by people: {', '.join(homes) or 'none'}",
        **start,
        "furniture": "two thirds of the models of sweethome3d-furniture (CC0, CC-BY 3.0), parametric shapes, and Sweet Home 3D's own "
                     "catalogue; the last third of sweethome3d-furniture, chosen by the hash of the models' names, is never trained on",
        "development": from_seeds(sets, common.DEV_SETS),
        "held_out": f"{from_seeds(sets, common.TEST_SETS)}, with held-out furniture",
        "frames_seen": state.get("frames_seen", 0), "minutes": round(state.get("used_s", 0) / 60, 1),
        "seed": state.get("seed", 0), "commit": commit()})


def digest_of(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def masks_text(state):
    return table("data.masks", {"windows": state.get("windows", 0), "steps": state.get("steps", 0),
                                "batch": state.get("batch", 0), "seed": state.get("seed", 0)})


def numbers_of(checkpoint):
    state = torch.load(checkpoint, map_location="cpu", weights_only=True)
    return {key: value for key, value in state.items() if isinstance(value, (int, float, str))}


def masks_numbers(file, card):
    """Of the run that trained the masks; without its file the masks are those of the card."""
    return numbers_of(file) if file.exists() else card.get("data", {}).get("masks", {})


def write(network_file, data, states, figures):
    old = read_card(network_file.with_suffix(".toml"))
    digests = {"sha256": digest_of(network_file), "decoder_sha256": digest_of(masks_file(network_file))}
    is_same = all(old.get(key) == digest for key, digest in digests.items())
    figures = figures or (old.get("figures", {}) if is_same else {})
    thresholds = old.get("thresholds", {})
    size = common.INPUT_PX
    text = f"""# SPDX-License-Identifier: MIT
# Model card of {network_file.name}, written by networks/card.py. docs/networks-training.md explains the fields.
family = "crossnav"
name = "crossnav-small"
file = "{network_file.name}"
sha256 = "{digests["sha256"]}"
decoder = "{masks_file(network_file).name}"  # draws the mask in a box
decoder_sha256 = "{digests["decoder_sha256"]}"
licence = "MIT"
source = "networks/ of this repository (make networks)"
goals = {listed(common.GOALS)}
limits = {listed(LIMITS)}

[input]
size = {size}
focal_px = {common.FOCAL_PX:g}  # depth is scaled by the ratio to the camera's
image = "image"    # f32 [1, 3, {size}, {size}], RGB, 0 to 1
depth = "depth"    # f32 [1, 1, {size}, {size}], planar [m], scaled, 0 = no reading
height = "height"  # f32 [1, 1, {size}, {size}], of the seen point above the foot [m], 0 where no depth

[output]
stride = 4
heat = "heat"      # [1, {len(common.GOALS)}, {size // 4}, {size // 4}], claims are its 3 x 3 maxima
box = "box"        # [1, 4, {size // 4}, {size // 4}], left, top, right, bottom of the cell's middle [input px]
mask = "mask"      # [1, {len(common.GOALS) + 1}, {size // 4}, {size // 4}], goals, then background
stairs = "stairs"  # [1, 1, {size // 4}, {size // 4}]
dense = "dense"    # [1, 24, 24, 512], unit vectors in the space of the text table

[text]
table = "text_vectors.npy"  # f16 [N, 512], CLIP ViT-B/32; the last four rows are made up
names = {listed(common.CLASS_NAMES)}

[thresholds]  # chosen on development houses by networks/thresholds.py
heat = {listed(thresholds.get("heat", [0.3] * len(common.GOALS)))}
nms_iou = 0.5
mask = 0.5
stairs = {thresholds.get("stairs", 0.5)}
"""
    text += "\n[retrieval]  # numbers but `margin` by `crossnav networks calibrate`\n" + rows(
        {"margin": MARGIN, **old.get("retrieval", {})})
    if "evidence" in old:
        text += "\n[evidence]  # by benchmarks/detector_calibration\n" + rows(old["evidence"])
    text += data_text(data, states[0]) + masks_text(states[1])
    if figures:
        text += "\n# Of networks/evaluate.py --set test: held-out houses with held-out furniture." + table(
            "figures", {key: value for key, value in figures.items() if not isinstance(value, dict)})
        for goal in common.GOALS:
            if isinstance(figures.get(goal), dict):
                text += table(f"figures.{goal}", figures[goal])
    network_file.with_suffix(".toml").write_text(text, encoding="utf-8")


def rounded(values):
    if isinstance(values, dict):
        return {key: rounded(value) for key, value in values.items()}
    return None if isinstance(values, float) and np.isnan(values) else round(values, 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--masks", type=pathlib.Path, default=None)
    parser.add_argument("--network", type=pathlib.Path, default=export.FILE)
    parser.add_argument("--figures", type=pathlib.Path, default=None)
    args = parser.parse_args()
    states = [numbers_of(args.checkpoint or args.data / "checkpoint.pt"),
              masks_numbers(args.masks or args.data / "masks.pt", read_card(args.network.with_suffix(".toml")))]
    figures = rounded(json.loads(args.figures.read_text(encoding="utf-8"))) if args.figures else None
    write(args.network, args.data, states, figures)
    print(args.network.with_suffix(".toml").name, *states)


if __name__ == "__main__":
    main()
