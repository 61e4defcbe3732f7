# SPDX-License-Identifier: MIT
"""A made-up house: its pictures, a batch, a store, and a narrow network for them."""

import types

import batches
import common
import frames
import model
import numpy as np
import targets
import torch

SIZE = 96
CHAIR, STAIRS, WALL = 1, 2, 3


def house():
    goal = np.array([-1, 0, -1, -1], np.int16)
    names = np.array([-1, 0, common.CLASS_NAMES.index("stairs"), common.CLASS_NAMES.index("wall")], np.int16)
    return types.SimpleNamespace(name="toy", goal_of=goal, class_of=names,
                                 is_stairs=np.array([False, False, True, False]), is_lookalike=np.zeros(4, bool))


def sample(size=SIZE):
    """A chair in front of a wall, and stairs on the right."""
    made = frames.Sample.__new__(frames.Sample)
    made.house, made.index = house(), 0
    made.instance = np.full((size, size), WALL, np.uint16)
    made.instance[40:72, 20:44] = CHAIR
    made.instance[:, 70:] = STAIRS
    made.rgb = np.random.default_rng(1).integers(0, 255, (size, size, 3), np.uint8)
    made.depth = np.where(made.instance == CHAIR, 1.5, 3.0).astype(np.float32)
    made.pitch_rad, made.camera_height_m = 0.0, 0.88
    made.focal, centre = frames.intrinsics(size)
    made.rows = made.columns = np.arange(size) - centre
    return made


def batch():
    made = sample()
    target = {key: torch.from_numpy(np.stack([value] * 2)) for key, value in targets.all_of(made, SIZE).items()}
    inputs = {key: torch.from_numpy(np.stack([value] * 2)) for key, value in made.inputs().items()}
    return (inputs["image"].float() / 255, inputs["depth"], inputs["height"]), target


def stored(size=SIZE, count=6):
    """A store on the CPU with pictures of the toy house."""
    made = sample(size)
    pose = [{"pitch_deg": 5.0 * index, "camera_height_m": 0.88} for index in range(count)]
    many = lambda plane: np.stack([plane] * count)
    house = types.SimpleNamespace(**vars(made.house), frames=pose, rgb=many(made.rgb), instance=many(made.instance),
                                  depth_mm=many((made.depth * 1000).astype(np.uint16)))
    store = batches.Store(count, torch.device("cpu"), size)
    return store, store.add(house)


def narrow_network(**more):
    return model.Network(widths=(8, 16, 16, 24, 32), **more)
