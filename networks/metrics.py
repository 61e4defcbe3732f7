# SPDX-License-Identifier: MIT
"""Decodes the network's answers and compares them with a sample's truth. Pictures are at input size.

A goal object counts as asked for when its visible box fills 1/64 of the picture or more and its nearest
point is within 5 m. It is found by a claim of its category with a box IoU of 0.5 or more. A claim is false
when it overlaps no visible instance of its category with an IoU of 0.3 or more.
"""

import common
import numpy as np
import targets

FOUND_IOU, FALSE_IOU = 0.5, 0.3
MIN_SHARE, MAX_M = 1 / 64, 5.0
NMS_IOU = 0.5
LOWEST_SCORE = 0.02
FALSE_PER_FRAME = 0.1
MASK_SHARE = 0.5
STAIR_SHARE = 0.01  # minimum share of a picture of stairs


def overlap(a, b):
    """IoU of boxes [n,4] and [m,4] (left, top, right, bottom)."""
    a, b = np.asarray(a, float).reshape(-1, 4), np.asarray(b, float).reshape(-1, 4)
    low, high = np.maximum(a[:, None, :2], b[None, :, :2]), np.minimum(a[:, None, 2:], b[None, :, 2:])
    both = np.prod(np.clip(high - low, 0, None), axis=2)
    area = lambda e: (e[:, 2] - e[:, 0]) * (e[:, 3] - e[:, 1])
    return both / np.maximum(area(a)[:, None] + area(b)[None] - both, 1e-9)


def peaks(heat):
    """Cells that are the highest of their 3 x 3 neighbours."""
    padded = np.pad(heat, 1, constant_values=-1)
    around = [padded[1 + y : padded.shape[0] - 1 + y, 1 + x : padded.shape[1] - 1 + x]
              for y in (-1, 0, 1) for x in (-1, 0, 1)]
    return np.argwhere((heat >= np.max(around, axis=0)) & (heat > LOWEST_SCORE))


def decode(heat, box, size):
    """Claims of one picture, best first: rows of (goal, score, box in input pixels)."""
    claims = []
    for goal in range(heat.shape[0]):
        rows = []
        for row, column in peaks(heat[goal]):
            x, y = (column + 0.5) * targets.STRIDE, (row + 0.5) * targets.STRIDE
            left, top, right, bottom = box[:, row, column]
            edges = np.clip([x - left, y - top, x + right, y + bottom], 0, size)
            rows.append((goal, float(heat[goal, row, column]), edges))
        rows.sort(key=lambda claim: -claim[1])
        kept = []
        for claim in rows[:40]:
            if not kept or overlap(claim[2], [k[2] for k in kept]).max() < NMS_IOU:
                kept.append(claim)
        claims += kept
    return sorted(claims, key=lambda claim: -claim[1])


def upsample(planes, size, window=None):
    """Bilinear, cell centres as in the network's own resizing: [c,h,w] -> [c,size,size]. The planes cover the
    picture, or `window` (left, top, right, bottom) of it; beyond it the edge repeats."""
    left, top, right, bottom = (0, 0, size, size) if window is None else window
    rows, down = between(size, planes.shape[1], top, bottom)
    columns, across = between(size, planes.shape[2], left, right)
    tall = planes[:, rows] * (1 - down)[:, None] + planes[:, rows + 1] * down[:, None]
    return tall[:, :, columns] * (1 - across) + tall[:, :, columns + 1] * across


def between(size, cells, low, high):
    """Of each pixel: the cell before it, and how far it is towards the next one."""
    at = np.clip((np.arange(size) + 0.5 - low) * cells / (high - low) - 0.5, 0, cells - 1)
    first = np.minimum(at.astype(int), cells - 2)
    return first, (at - first).astype(np.float32)


def asked_for(sample, box, one):
    size = sample.depth.shape[0]
    area = (box[2] - box[0]) * (box[3] - box[1])
    depth = sample.depth[(sample.instance == one) & (sample.depth > 0)]
    return area >= MIN_SHARE * size * size and depth.size > 0 and depth.min() <= MAX_M


def judge_claims(sample, answer):
    """Of one picture: found scores and mask overlaps of asked instances, and scores of false claims."""
    size = sample.depth.shape[0]
    seen = targets.instances(sample)
    claims = decode(answer["heat"], answer["box"], size)
    found, false = [], []
    taken = set()
    for goal, score, box in claims:
        mine = [row for row in seen if row[1] == goal]
        match = overlap(box, [row[2] for row in mine])[0] if mine else np.zeros(0)
        if not mine or match.max() < FALSE_IOU:
            false.append({"goal": goal, "score": score, "box": box})
            continue
        best = mine[int(match.argmax())]
        if match.max() < FOUND_IOU or best[0] in taken:
            continue
        taken.add(best[0])
        found.append({"id": best[0], "score": score, "claim": box,
                      "mask_iou": mask_iou(sample, claim_mask(answer, goal, box, size), best[0])})
    asked = [row for row in seen if asked_for(sample, row[2], row[0])]
    by_id = {row["id"]: row for row in found}
    return [{"goal": row[1], "box": row[2], "id": row[0], **by_id.get(row[0], {"score": 0.0})} for row in asked], false


def claim_mask(answer, goal, box, size):
    """The program's mask of a claim (crossnav/inference/crossnav_network.cpp): the pixels of its box where the
    second network's share of the object, or else the first network's share of the goal, is at least a half."""
    left, top, right, bottom = np.floor(np.asarray(box) + 0.5).astype(int)
    mask = np.zeros((size, size), bool)
    if right <= left or bottom <= top:
        return mask
    if "drawn" in answer:
        share, window = answer["drawn"](goal, (left, top, right, bottom))
        share = upsample(share[None], size, window)[0]
    else:
        share = upsample(answer["mask"][goal : goal + 1], size)[0]
    mask[top:bottom, left:right] = share[top:bottom, left:right] >= MASK_SHARE
    return mask


def mask_iou(sample, mask, one):
    """Of a claim's mask and the instance's pixels."""
    truth = sample.instance == one
    return float((mask & truth).sum() / max((mask | truth).sum(), 1))


def recall_curve(asked, false, frames):
    """Rows of (threshold, recall, false claims a frame), the highest threshold first."""
    scores = np.array([row["score"] for row in asked])
    wrong = np.sort([row["score"] for row in false])[::-1]
    return [(t, float((scores >= t).mean()) if len(scores) else 0.0, float((wrong >= t).sum() / frames))
            for t in np.round(np.arange(0.95, 0.02, -0.01), 2)]


def at_false_rate(curve, rate=FALSE_PER_FRAME):
    """The row of highest recall that stays at or below `rate`."""
    fitting = [row for row in curve if row[2] <= rate]
    return fitting[-1] if fitting else curve[0]


class StairCount:
    """Pixels and pictures of stairs at a threshold of probability."""

    def __init__(self, thresholds):
        self.thresholds = thresholds
        self.pixels = np.zeros((len(thresholds), 3))  # both, either, -
        self.pictures = np.zeros((len(thresholds), 3))  # right, claimed, true

    def add(self, sample, stairs):
        size = sample.depth.shape[0]
        share, truth = upsample(stairs, size)[0], sample.house.is_stairs[sample.instance]
        is_true = truth.mean() > STAIR_SHARE
        for i, threshold in enumerate(self.thresholds):
            said = share > threshold
            self.pixels[i, :2] += [(said & truth).sum(), (said | truth).sum()]
            is_said = said.mean() > STAIR_SHARE
            self.pictures[i] += [is_true and is_said, is_said, is_true]

    def rows(self):
        """(threshold, pixel IoU, image precision, image recall)"""
        return [(t, p[0] / max(p[1], 1), q[0] / max(q[1], 1), q[0] / max(q[2], 1))
                for t, p, q in zip(self.thresholds, self.pixels, self.pictures, strict=True)]


def dense_right(sample, dense, table):
    """(right, named) per class of the truth."""
    truth = targets.dense(sample, sample.depth.shape[0]).ravel()
    said = (dense.reshape(-1, dense.shape[-1]) @ table.T).argmax(1)
    right = np.zeros((len(common.CLASS_NAMES), 2), int)
    np.add.at(right, (truth[truth >= 0], 1), 1)
    np.add.at(right, (truth[(truth >= 0) & (said == truth)], 0), 1)
    return right
