# SPDX-License-Identifier: MIT
"""Batches on a device: their pictures, augmentation and targets are as those of samples."""

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("cv2")

import batch_augmentation
import batch_targets
import common
import frames
import numpy as np
import targets
from toy import CHAIR, SIZE, stored


def one_of(batch, index):
    """A picture of a batch as a sample."""
    made = frames.Sample.__new__(frames.Sample)
    made.house, made.index = batch.store.houses[int(batch.house[index])], index
    made.rgb = batch.image[index].to(torch.uint8).numpy()
    made.depth, made.instance = batch.depth[index].numpy(), batch.ids[index].numpy().astype(np.uint16)
    made.rows, made.columns = batch.rows[index].numpy(), batch.columns[index].numpy()
    made.focal, made.pitch_rad, made.camera_height_m = batch.focal, float(batch.pitch[index]), float(batch.camera_height[index])
    return made


def test_a_store_tells_what_its_frames_show():
    store, at = stored(320)
    goals, alike = store.shown(at)
    assert goals[:, common.GOALS.index("chair")].tolist() == [1.0] * 6
    assert goals[:, common.GOALS.index("bed")].tolist() == [0.0] * 6
    assert goals[:, -1].tolist() == [1.0] * 6
    assert not alike.any()
    assert store.is_full(store.houses[0])


@pytest.mark.parametrize("size", [96, 64])
def test_batches_have_the_targets_and_inputs_of_their_pictures(size):
    store, _ = stored()
    store.close()
    batch = batch_augmentation.augmented(store, torch.arange(6).repeat(4), size, batch_augmentation.Random(store.device, 3))
    inputs, answers = batch.inputs(), batch_targets.all_of(batch)
    assert (answers["heat"] == 1).any()
    for index in range(len(batch)):
        made = one_of(batch, index)
        for name, value in targets.all_of(made, size).items():
            assert answers[name][index].numpy() == pytest.approx(value, abs=1e-5), name
        for name, value in made.inputs().items():
            assert inputs[name][index].numpy() == pytest.approx(value, abs=1e-4), name


def test_batches_keep_the_place_of_every_pixel():
    """What a pixel shows lies in the direction that its row and column tell."""
    store, _ = stored()
    store.rgb[:, :, :, 0] = torch.arange(SIZE)
    store.rgb[:, :, :, 1] = torch.arange(SIZE)[:, None]
    store.close()
    batch = batch_augmentation.place(store, torch.arange(6).repeat(8), 64, batch_augmentation.Random(store.device, 5))
    across = batch.columns.abs() - (batch.image[..., 0].mean(1) - (SIZE - 1) / 2).abs()
    assert across.abs().max() < 1.1  # half a pixel of the coarser grid
    down = batch.rows - (batch.image[..., 1].mean(2) - (SIZE - 1) / 2)
    assert down.abs().max() < 1.1
    chair = batch.ids == CHAIR
    assert (batch.depth[chair] == 1.5).all()
    assert (batch.columns[:, 0] > 0).any() and (batch.columns[:, 0] < 0).any()  # some are mirrored


def test_batches_change_colours_and_depth_within_bounds():
    store, _ = stored()
    store.close()
    batch = batch_augmentation.augmented(store, torch.arange(6).repeat(40), 64, batch_augmentation.Random(store.device, 7))
    assert batch.image.min() >= 0 and batch.image.max() <= 255
    assert batch.depth.min() == 0 and batch.depth.max() < 4
    assert 0.01 < (batch.depth == 0).float().mean() < 0.3
    assert 1 < batch.camera_height.sub(0.88).abs().max() * 100 < 15
    again = batch_augmentation.augmented(store, torch.arange(6).repeat(40), 64, batch_augmentation.Random(store.device, 7))
    assert torch.equal(batch.image, again.image)


def test_a_jpeg_of_high_quality_is_nearly_the_picture():
    smooth = torch.linspace(20, 230, 64)[None, None, :, None].expand(2, 64, 64, 3)
    made = batch_augmentation.jpeg(smooth, batch_augmentation.Random(torch.device("cpu"), 1))
    assert 0.01 < (made - smooth).abs().mean() < 4
