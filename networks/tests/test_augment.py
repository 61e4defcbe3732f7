# SPDX-License-Identifier: MIT
"""Samples and their augmentation."""

import pytest

pytest.importorskip("torch")
pytest.importorskip("cv2")

import augment
import common
import frames
import numpy as np
from toy import CHAIR, SIZE, STAIRS, WALL, sample


def test_height_of_the_floor_is_zero_and_of_the_horizon_is_the_camera():
    focal, _ = frames.intrinsics(SIZE)
    depth = np.array([[2.0], [2.0]], np.float32)
    rows = np.array([0.0, 0.88 / 2.0 * focal])
    height = frames.height_above_foot(depth, rows, focal, 0.0, 0.88)
    assert height[:, 0] == pytest.approx([0.88, 0.0], abs=1e-6)
    up = frames.height_above_foot(depth[:1], rows[:1], focal, np.radians(30), 0.88)
    assert up[0, 0] == pytest.approx(0.88 + 1.0)


def test_augmentation_keeps_shapes_and_the_same_generator_gives_the_same():
    results = []
    for _ in range(2):
        made = sample(128)
        augment.augment(made, SIZE, np.random.default_rng(5))
        inputs = made.inputs()
        assert inputs["image"].shape == (3, SIZE, SIZE) and inputs["image"].dtype == np.uint8
        assert inputs["depth"].shape == inputs["height"].shape == (1, SIZE, SIZE)
        assert made.instance.shape == (SIZE, SIZE)
        results.append(inputs)
    for name, value in results[0].items():
        assert (value == results[1][name]).all(), name


def test_enlarged_parts_keep_sizes_in_metres(monkeypatch):
    """A thing's pixels times its depth are its size, whatever part of the picture is shown."""
    monkeypatch.setattr(augment, "ENLARGED", 1.0)
    sizes = []
    for seed in range(12):
        made = sample(320)
        made.instance[:] = WALL
        made.instance[150:170, 150:170] = CHAIR
        made.depth[:] = 1.5
        augment.place(made, 192, np.random.default_rng(seed))
        chair = made.instance == CHAIR
        if chair.any() and not (chair[[0, -1]].any() or chair[:, [0, -1]].any()):  # whole
            sizes.append(np.sqrt(chair.sum()) * made.inputs()["depth"].mean() / common.FOCAL_PX)
    assert len(sizes) > 4
    assert sizes == pytest.approx([20 * 1.5 / 160] * len(sizes), rel=0.06)


def test_parts_of_a_picture_are_as_large_as_in_the_whole(monkeypatch):
    monkeypatch.setattr(augment, "ENLARGED", 0.0)
    for size in (192, common.INPUT_PX):
        made = sample(320)
        augment.place(made, size, np.random.default_rng(1))
        assert made.focal_px() == pytest.approx(common.FOCAL_PX, rel=0.08)


def test_some_paints_are_vivid_and_some_nearly_black():
    colours = augment.paints(2000, np.random.default_rng(1))
    bright, spread = colours.max(1), np.ptp(colours, axis=1)
    assert 0.08 < (bright < 52).mean() < 0.25  # of 255
    assert 0.1 < (spread > 0.7 * bright).mean() < 0.5
    assert (spread < 0.3 * bright).mean() > 0.4  # most are pale


def test_a_thing_in_another_material_keeps_its_shape():
    made = sample()
    image = made.rgb.astype(np.float32)
    other = augment.restyle(image, made, np.random.default_rng(2))
    assert other.shape == image.shape and np.isfinite(other).all()
    assert (other != image).any()
    still = [(other == image)[made.instance == one].all() for one in (CHAIR, STAIRS, WALL)]
    changed = [(other != image).any(axis=-1)[made.instance == one].mean() > 0.9 for one in (CHAIR, STAIRS, WALL)]
    assert all(a or b for a, b in zip(still, changed, strict=True))  # a thing whole, or not at all


def test_points_of_the_floor_lie_under_the_camera():
    made = sample()
    made.depth = np.full((SIZE, SIZE), 2.0, np.float32)
    made.rows = np.full(SIZE, 0.5 * made.focal)
    assert augment.points(made)[..., 2] == pytest.approx(-1.0)
    assert augment.points(made)[0, 0, 0] == pytest.approx(-augment.points(made)[0, -1, 0])
