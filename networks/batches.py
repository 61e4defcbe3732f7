# SPDX-License-Identifier: MIT
"""Batches of pictures on the training device, in whose memory the frames stay.

They are augmented (batch_augmentation.py) and get their targets (batch_targets.py) there as a whole, so that a GPU
trains without waiting for the CPU.
"""

import dataclasses
import math

import common
import numpy as np
import torch

MOST_MM = 32767  # of a depth in 16 bits with a sign


def padded(rows, fill):
    """Arrays of different lengths as one, filled up."""
    out = np.full((len(rows), max(len(row) for row in rows)), fill, np.int64)
    for line, row in zip(out, rows, strict=True):
        line[: len(row)] = row
    return out


def at_pixels(table, ids):
    """Rows [B,M,...] of values by instance, at the pixels of `ids` [B,S,S]."""
    batch, index = len(table), ids.reshape(len(table), -1)
    return table[torch.arange(batch, device=ids.device)[:, None], index].reshape(*ids.shape, *table.shape[2:])


class Store:
    """Frames of houses in a device's memory; houses can be added until `capacity` frames are there."""

    def __init__(self, capacity, device, size=common.STORED_PX):
        make = lambda dtype, *more: torch.empty((capacity, size, size, *more), dtype=dtype, device=device)
        self.rgb, self.depth_mm, self.instance = make(torch.uint8, 3), make(torch.int16), make(torch.int16)
        self.house = torch.empty(capacity, dtype=torch.long, device=device)
        self.pose = torch.empty((capacity, 2), device=device)  # pitch [rad], camera height [m]
        self.device, self.size, self.count, self.houses, self.tables = device, size, 0, [], None

    def is_full(self, house):
        return self.count + len(house.frames) > len(self.rgb)

    def add(self, house):
        """Copies the frames of a house; their places."""
        at = slice(self.count, self.count + len(house.frames))
        load = lambda array: torch.from_numpy(np.array(array)).to(self.device)
        self.rgb[at] = load(house.rgb)
        self.depth_mm[at] = load(house.depth_mm).int().clamp(max=MOST_MM).short()
        self.instance[at] = load(house.instance).short()
        self.house[at] = len(self.houses)
        pose = [(math.radians(row["pitch_deg"]), row["camera_height_m"]) for row in house.frames]
        self.pose[at] = torch.tensor(pose, device=self.device)
        self.count = at.stop
        self.houses.append(house)
        return at

    def close(self):
        """Makes the tables by instance of all houses; to be called after houses were added."""
        slots = [np.where(house.goal_of >= 0, np.cumsum(house.goal_of >= 0), 0) for house in self.houses]
        goals = [np.append(-1, house.goal_of[house.goal_of >= 0]) for house in self.houses]
        rows = {"goal": (self.houses_of("goal_of"), -1), "name": (self.houses_of("class_of"), -1),
                "stairs": (self.houses_of("is_stairs"), 0), "alike": (self.houses_of("is_lookalike"), 0),
                "slot": (slots, 0), "goal_of_slot": (goals, -1)}
        self.tables = {key: torch.from_numpy(padded(*row)).to(self.device) for key, row in rows.items()}

    def shown(self, at):
        """Which goals, stairs last, the frames of the last house show [n,7], and whether a seat that looks like
        another goal: on half a percent of the picture."""
        house, ids = self.houses[-1], self.instance[at, ::4, ::4].flatten(1).long()
        size = len(house.goal_of)
        line = torch.arange(len(ids), device=self.device)[:, None]
        big = torch.bincount((line * size + ids).flatten(), minlength=len(ids) * size).reshape(len(ids), size) > 20
        table = lambda values: torch.from_numpy(np.asarray(values)).to(self.device)
        goal = table(house.goal_of)
        kinds = [goal == kind for kind in range(len(common.GOALS))] + [table(house.is_stairs)]
        return torch.stack([(big & kind).any(1) for kind in kinds], 1).float(), (big & table(house.is_lookalike)).any(1)

    def name_counts(self):
        """How often each class is seen, by a sample of pixels."""
        count = torch.ones(len(common.CLASS_NAMES) + 1, device=self.device)
        for first in range(0, self.count, 4096):
            at = slice(first, min(first + 4096, self.count), 6)
            names = at_pixels(self.tables["name"][self.house[at]], self.instance[at, ::5, ::5].long())
            count += torch.bincount(torch.where(names < 0, len(count) - 1, names).flatten(), minlength=len(count))
        return count[:-1]

    def houses_of(self, table):
        return [getattr(house, table) for house in self.houses]


@dataclasses.dataclass
class Batch:
    """B pictures of S pixels: image f32 [B,S,S,3], 0 to 255; depth f32 [m] and ids [B,S,S]."""

    store: Store
    house: torch.Tensor  # [B]
    image: torch.Tensor
    depth: torch.Tensor
    ids: torch.Tensor
    rows: torch.Tensor  # [B,S], below the principal point [px of `focal`]
    columns: torch.Tensor  # [B,S], right of it
    focal: float
    pitch: torch.Tensor  # [B], rad
    camera_height: torch.Tensor  # [B], m

    def __len__(self):
        return len(self.house)

    def part(self, index):
        """The pictures of an index [n]."""
        names = ["house", "image", "depth", "ids", "rows", "columns", "pitch", "camera_height"]
        return dataclasses.replace(self, **{name: getattr(self, name)[index] for name in names})

    def of(self, key):
        """A table of the houses at every pixel."""
        return at_pixels(self.store.tables[key][self.house], self.ids)

    def inputs(self):
        """As of frames.Sample.inputs, with the image as bytes."""
        step = lambda at: (at[:, -1] - at[:, 0]).abs() / (at.shape[1] - 1)
        focal = self.focal / (step(self.rows) * step(self.columns)).sqrt()
        slope = self.pitch.sin()[:, None] - self.rows / self.focal * self.pitch.cos()[:, None]
        height = self.camera_height[:, None, None] + self.depth * slope[:, :, None]
        return {"image": self.image.to(torch.uint8).permute(0, 3, 1, 2),
                "depth": (self.depth * (common.FOCAL_PX / focal)[:, None, None])[:, None],
                "height": torch.where(self.depth > 0, height, 0)[:, None]}
