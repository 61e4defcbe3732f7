# SPDX-License-Identifier: MIT
"""Training targets of whole batches on the training device.

The rules are those of targets.py; tests/test_batches.py compares both.
"""

import common
import torch
from batches import at_pixels
from targets import GRID, MIN_PX, NAMED_SHARE, STRIDE

GOALS = len(common.GOALS)


def instances(batch):
    """Visible goal instances of all pictures: picture, goal, pixels [R] and boxes [R,4] (last excluded)."""
    slot = batch.of("slot")
    count, size, slots = len(batch), slot.shape[1], batch.store.tables["goal_of_slot"].shape[1]
    picture = torch.arange(count, device=slot.device)[:, None, None]
    line = torch.arange(size, device=slot.device)
    in_row = torch.zeros((count, slots, size), dtype=torch.bool, device=slot.device)
    in_column = in_row.clone()
    in_row[picture, slot, line[None, :, None]] = True
    in_column[picture, slot, line[None, None, :]] = True
    pixels = torch.bincount((picture * slots + slot).flatten(), minlength=count * slots).reshape(count, slots)
    pixels[:, 0] = 0
    of_picture, which = pixels.nonzero(as_tuple=True)
    first = lambda seen: seen.to(torch.uint8).argmax(1)
    sides = lambda seen: (first(seen), size - first(seen.flip(1)))
    (left, right), (top, bottom) = sides(in_column[of_picture, which]), sides(in_row[of_picture, which])
    goal = batch.store.tables["goal_of_slot"][batch.house[of_picture], which]
    return of_picture, goal, pixels[of_picture, which], torch.stack([left, top, right, bottom], 1)


def largest(shape, index, values):
    """For each row of `shape`, the largest of the values with its index, else 0."""
    return torch.zeros(shape, device=values.device).index_reduce_(0, index, values, "amax")


def boxes(batch):
    """targets.boxes"""
    count, cells = len(batch), batch.ids.shape[1] // STRIDE
    picture, goal, pixels, box = instances(batch)
    left, top, right, bottom = box.float().unbind(1)
    is_small = pixels < MIN_PX
    middle = (torch.arange(cells, device=box.device) + 0.5) * STRIDE
    at = torch.arange(cells, device=box.device)
    within = lambda low, high: (at >= low[:, None] // STRIDE) & (at < -(-high[:, None] // STRIDE))
    covered = (within(top, bottom)[:, :, None] & within(left, right)[:, None, :] & is_small[:, None, None]).float()
    row = picture * GOALS + goal
    asked = 1 - largest((count * GOALS, cells, cells), row, covered)

    bell = lambda low, high: torch.exp(
        -0.5 * ((middle - (low + high)[:, None] / 2) / ((high - low).clamp(min=8)[:, None] * 0.13)) ** 2)
    blob = (bell(top, bottom)[:, :, None] * bell(left, right)[:, None, :]).flatten(1)
    blob = blob.scatter(1, blob.argmax(1, keepdim=True), 1.0) * ~is_small[:, None]
    heat = largest((count * GOALS, cells * cells), row, blob)

    inside = blob > 0.4
    rank = torch.where(inside, 1 / pixels.float()[:, None], 0.0)  # the smallest object of a cell
    is_mine = inside & (rank == largest((count, cells * cells), picture, rank)[picture])
    edges = torch.stack([x.expand(-1, cells, cells).flatten(1) for x in (
        (middle - left[:, None])[:, None, :], (middle - top[:, None])[:, :, None],
        (right[:, None] - middle)[:, None, :], (bottom[:, None] - middle)[:, :, None])], 2)
    which, cell = is_mine.nonzero(as_tuple=True)
    made = torch.zeros((count, cells * cells, 4), device=box.device)
    weight = torch.zeros((count, cells * cells), device=box.device)
    made[picture[which], cell] = edges[which, cell]
    weight[picture[which], cell] = (1 / inside.sum(1).clamp(min=1))[which]
    square = (count, -1, cells, cells)
    return {"heat": heat.reshape(square), "asked": asked.reshape(square), "box": made.transpose(1, 2).reshape(square),
            "weight": weight.reshape(count, cells, cells)}


def all_of(batch):
    """targets.all_of for a batch."""
    size = batch.ids.shape[1]
    middle = slice(STRIDE // 2, None, STRIDE)
    goal, stairs = batch.of("goal")[:, middle, middle], batch.of("stairs")[:, middle, middle]
    at = ((torch.arange(GRID * 4, device=goal.device) + 0.5) * size / (GRID * 4)).long()
    names = at_pixels(batch.store.tables["name"][batch.house], batch.ids[:, at][:, :, at])
    names = names.reshape(len(batch), GRID, 4, GRID, 4).transpose(2, 3).reshape(-1, 16)
    unnamed = len(common.CLASS_NAMES)
    votes = torch.zeros((len(names), unnamed + 1), dtype=torch.int16, device=goal.device)
    votes.scatter_add_(1, torch.where(names < 0, unnamed, names), torch.ones_like(names, dtype=torch.int16))
    most, best = votes[:, :unnamed].max(1)
    dense = torch.where(most > NAMED_SHARE * 16, best, -1).reshape(len(batch), GRID, GRID)
    return {**boxes(batch), "mask": torch.where(goal < 0, GOALS, goal), "stairs": stairs.float(), "dense": dense}
