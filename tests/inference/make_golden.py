#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes data/crossnav_small.tsv: the Python pipeline's masks of boxes in a synthetic picture (own_network_test.cpp).

    make_golden.py

Needs networks/requirements.txt, and is run again when networks/crossnav_small*.onnx change. A line: the box, the goal,
the mean share of the object within its mask, and the lengths of the mask's runs, row by row, zeros first.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "networks"))

import common
import export
import frames
import metrics
import numpy as np
import runtime

SIZE = common.INPUT_PX
CAMERA_HEIGHT_M = 0.88
BOXES = [(50, 122, 203, 205), (72, 129, 182, 155), (0, 137, 256, 256), (171, 23, 245, 103)]
RED, LIGHT_RED = [160, 40, 40], [185, 65, 65]


def picture():
    """A red sofa before a wall, with a picture on it; the same in the C++ test."""
    v, u = np.mgrid[0:SIZE, 0:SIZE]
    focal, centre = frames.intrinsics(SIZE)
    depth = np.minimum(3.5, CAMERA_HEIGHT_M * focal / np.maximum(v - centre, 1))
    rgb = np.stack([150 + u // 8, 150 + v // 8, 140 + 0 * u], -1)
    back = (u >= 72) & (u < 182) & (v >= 129) & (v < 155)
    seat = (u >= 55) & (u < 199) & (v >= 155) & (v < 163)
    front = (u >= 55) & (u < 199) & (v >= 163) & (v < 198)
    for where, range_m, colour in [(back, 2.1, RED), (seat, 1.85, LIGHT_RED), (front, 1.6, RED)]:
        depth = np.where(where, range_m, depth)
        rgb = np.where(where[..., None], colour, rgb)
    hung = (u >= 183) & (u < 234) & (v >= 34) & (v < 91)
    rgb = np.where(hung[..., None], [30, 60, 160], rgb)
    return rgb.astype(np.uint8), depth.astype(np.float32)


def label_of(mask, box):
    """The goal that fills the box most, as LabelIn in crossnav_network.cpp."""
    cells = mask.shape[-1]
    left, top, right, bottom = np.clip(np.array(box) * cells // SIZE, 0, cells - 1)
    return int(mask[:-1, top : bottom + 1, left : right + 1].sum((1, 2)).argmax())


def runs(mask):
    flat = mask.ravel()
    lengths = np.diff([0, *np.flatnonzero(flat[1:] != flat[:-1]) + 1, flat.size])
    return [0, *lengths] if flat[0] else list(lengths)


def main():
    rgb, depth = picture()
    focal, centre = frames.intrinsics(SIZE)
    height = frames.height_above_foot(depth, np.arange(SIZE) - centre, focal, 0.0, CAMERA_HEIGHT_M)
    answer = runtime.Runtime(export.FILE)(rgb.transpose(2, 0, 1), depth[None], height[None])
    lines = []
    for box in BOXES:
        goal = label_of(answer["mask"], box)
        share, window = answer["drawn"](goal, box)
        mask = metrics.claim_mask(answer, goal, box, SIZE)
        inside = metrics.upsample(share[None], SIZE, window)[0][mask]
        quality = float(inside.mean()) if inside.size else 0.0
        lines.append("\t".join(map(str, [*box, common.GOALS[goal], f"{quality:.6f}", *runs(mask)])))
        print(lines[-1][:60], int(mask.sum()))
    (HERE / "data/crossnav_small.tsv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
