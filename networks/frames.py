# SPDX-License-Identifier: MIT
"""Frames of a set of houses as memory-mapped arrays, and their conversion to network input."""

import json
import math

import common
import numpy as np


class House:
    """One folder of `crossnav scene frames` (docs/formats/frames.md)."""

    def __init__(self, folder):
        self.name = folder.name
        document = json.loads((folder / "frames.json").read_text(encoding="utf-8"))
        self.frames = document["frames"]
        self.rgb = np.load(folder / "rgb.npy", mmap_mode="r")
        self.depth_mm = np.load(folder / "depth_mm.npy", mmap_mode="r")
        self.instance = np.load(folder / "instance.npy", mmap_mode="r")
        size = max([row["id"] for row in document["instances"]] + [0]) + 1
        self.goal_of = np.full(size, -1, np.int16)  # by instance id
        self.class_of = np.full(size, -1, np.int16)
        self.is_stairs = np.zeros(size, bool)
        self.is_lookalike = np.zeros(size, bool)
        for row in document["instances"]:
            if row["category"]:
                self.goal_of[row["id"]] = common.GOALS.index(row["category"])
            self.class_of[row["id"]] = common.CLASS_OF.get(row["name"], -1)
            self.is_stairs[row["id"]] = row["name"] in common.STAIR_NAMES
            self.is_lookalike[row["id"]] = row["name"] in common.LOOKALIKES


def read_set(data, *names):
    """The scenes of the sets that are there."""
    folders = [path.parent for name in names for path in sorted((data / name).glob("*/models.json"))]
    if not folders:
        raise SystemExit(f"no frames in {data} of {', '.join(names)}: run networks/render.py first")
    return [House(folder) for folder in folders]


def intrinsics(size, hfov_deg=common.HFOV_DEG):
    """Focal length and principal point [px] of a square picture; pixel centres are at integers."""
    return size / 2 / math.tan(math.radians(hfov_deg) / 2), (size - 1) / 2


def height_above_foot(depth, rows, focal, pitch_rad, camera_height_m):
    """Of every seen point [m]; `rows` is each image row's distance below the principal point [px]."""
    slope = math.sin(pitch_rad) - (rows / focal) * math.cos(pitch_rad)
    return np.where(depth > 0, camera_height_m + depth * slope[:, None], 0).astype(np.float32)


class Sample:
    """A picture with its truth, at any size: rgb u8 [H,W,3], depth f32 [m], instance u16."""

    def __init__(self, house, index):
        frame = house.frames[index]
        self.house, self.index = house, index
        self.rgb = np.array(house.rgb[index])
        self.depth = house.depth_mm[index].astype(np.float32) / 1000
        self.instance = np.array(house.instance[index])
        self.pitch_rad = math.radians(frame["pitch_deg"])
        self.camera_height_m = frame["camera_height_m"]
        size = self.depth.shape[0]
        self.focal, centre = intrinsics(size)
        self.rows = np.arange(size) - centre  # below the principal point [px of `focal`]
        self.columns = np.arange(size) - centre  # right of it

    def focal_px(self):
        """Focal length of the picture as it is now: the mean of both axes, which may be stretched."""
        step = lambda at: abs(at[-1] - at[0]) / (len(at) - 1)
        return self.focal / math.sqrt(step(self.rows) * step(self.columns))

    def inputs(self):
        """Depth is scaled to the network's focal length, so that a thing's pixels times its depth are always its
        size in metres: in an enlarged part of a picture, an armchair is as wide as a sofa otherwise."""
        height = height_above_foot(self.depth, self.rows, self.focal, self.pitch_rad, self.camera_height_m)
        depth = self.depth * np.float32(common.FOCAL_PX / self.focal_px())
        return {"image": self.rgb.transpose(2, 0, 1),  # u8: divided by 255 on input
                "depth": depth[None], "height": height[None]}
