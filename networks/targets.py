# SPDX-License-Identifier: MIT
"""Training targets, computed from a sample's instance ids at input size."""

import common
import numpy as np

STRIDE = 4
GRID = 24  # of the dense head
MIN_PX = 40  # chosen: of an instance; smaller instances at input size are ignored in training
NAMED_SHARE = 0.5  # minimum share of a dense cell's pixels for a name


def instances(sample, min_px=1):
    """Visible goal instances: rows of (id, goal, box in pixels (last excluded), pixels)."""
    ids = sample.instance
    rows = []
    for one in np.unique(ids):
        goal = sample.house.goal_of[one]
        if one == 0 or goal < 0:
            continue
        mask = ids == one
        count = int(mask.sum())
        if count < min_px:
            continue
        columns, lines = np.flatnonzero(mask.any(0)), np.flatnonzero(mask.any(1))
        box = (columns[0], lines[0], columns[-1] + 1, lines[-1] + 1)
        rows.append((int(one), int(goal), box, count))
    return rows


def _blob(cells, centre, sigma):
    return np.exp(-0.5 * ((cells - centre) / sigma) ** 2)


def boxes(sample, size):
    """heat [G,h,w], box [4,h,w] and its weight [h,w], and where heat is asked for [G,h,w]."""
    cells = size // STRIDE
    middle = (np.arange(cells) + 0.5) * STRIDE
    heat = np.zeros((len(common.GOALS), cells, cells), np.float32)
    asked = np.ones_like(heat)
    box = np.zeros((4, cells, cells), np.float32)
    weight = np.zeros((cells, cells), np.float32)
    found = instances(sample)
    for _, goal, (left, top, right, bottom), count in sorted(found, key=lambda row: -row[3]):
        if count < MIN_PX:
            y0, y1, x0, x1 = top // STRIDE, -(-bottom // STRIDE), left // STRIDE, -(-right // STRIDE)
            asked[goal, y0:y1, x0:x1] = 0
            continue
        x = _blob(middle, (left + right) / 2, max(right - left, 8) * 0.13)
        y = _blob(middle, (top + bottom) / 2, max(bottom - top, 8) * 0.13)
        blob = (y[:, None] * x[None, :]).astype(np.float32)
        blob[np.unravel_index(blob.argmax(), blob.shape)] = 1
        heat[goal] = np.maximum(heat[goal], blob)
        inside = blob > 0.4
        edges = np.stack(np.broadcast_arrays((middle - left)[None, :], (middle - top)[:, None],
                                             (right - middle)[None, :], (bottom - middle)[:, None]))
        box[:, inside] = edges[:, inside]
        weight[inside] = 1 / inside.sum()
    return heat, asked, box, weight


def masks(sample, size):
    """Goal of each cell's middle pixel [h,w], background last; 1 where it is stairs [h,w]."""
    index = np.arange(STRIDE // 2, size, STRIDE)
    ids = sample.instance[index][:, index]
    goal = sample.house.goal_of[ids].astype(np.int64)
    return np.where(goal < 0, len(common.GOALS), goal), sample.house.is_stairs[ids].astype(np.float32)


def dense(sample, size):
    """Class of each of the 24 x 24 cells, -1 where less than half of it has one name."""
    at = ((np.arange(GRID * 4) + 0.5) * size / (GRID * 4)).astype(int)
    names = sample.house.class_of[sample.instance[at][:, at]]
    names = names.reshape(GRID, 4, GRID, 4).transpose(0, 2, 1, 3).reshape(GRID * GRID, 16)
    count = np.zeros((GRID * GRID, len(common.CLASS_NAMES) + 1), np.int16)
    for i in range(16):
        count[np.arange(GRID * GRID), names[:, i]] += 1  # -1 counts in the last column
    count = count[:, :-1]
    best = count.argmax(1)
    return np.where(count.max(1) > NAMED_SHARE * 16, best, -1).reshape(GRID, GRID).astype(np.int64)


def all_of(sample, size):
    heat, asked, box, weight = boxes(sample, size)
    mask, stairs = masks(sample, size)
    return {"heat": heat, "asked": asked, "box": box, "weight": weight, "mask": mask,
            "stairs": stairs, "dense": dense(sample, size)}
