# SPDX-License-Identifier: MIT
"""The second network, for masks, and its windows."""

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("cv2")

import losses
import masks
import numpy as np
from toy import SIZE, batch


def window_of(box, share=None):
    """Input of the second network for a box of the toy picture."""
    inputs, _ = batch()
    if share is None:
        share = torch.zeros(1, 1, SIZE // 4, SIZE // 4)
        share[..., 10:18, 5:11] = 1  # the chair
    return masks.window(*[value[:1] for value in inputs], share, torch.tensor([box], dtype=torch.float32))


def test_a_window_shows_range_beside_that_of_the_object_and_a_margin_around_the_box():
    seen = window_of((20, 40, 44, 72))
    assert seen.shape == (1, 7, masks.SIZE, masks.SIZE)
    middle, corner = masks.SIZE // 2, 1
    assert seen[0, 3, middle, middle] == pytest.approx(0, abs=0.02)
    assert seen[0, 3, corner, corner] == pytest.approx(np.log(3.0 / 1.5), abs=0.02)  # the wall beyond the box
    assert seen[0, 6, middle, middle] == pytest.approx(1) and seen[0, 4].min() == 1


def test_a_window_of_nothing_seen_is_finite():
    inputs = [torch.zeros(1, channels, SIZE, SIZE) for channels in (3, 1, 1)]
    seen = masks.window(*inputs, torch.zeros(1, 1, SIZE // 4, SIZE // 4), torch.tensor([[0.0, 0.0, 1.0, 1.0]]))
    assert torch.isfinite(masks.Masks().eval()(seen)).all()


def test_the_loss_of_windows_falls_on_a_toy_batch():
    torch.manual_seed(1)
    head = masks.Masks(fine=8, coarse=16)
    optimizer = torch.optim.AdamW(head.parameters(), lr=5e-3)
    seen = window_of((20, 40, 44, 72)).expand(2, -1, -1, -1)
    own = (seen[:, 3].abs() < 0.1).float()
    falling = []
    for _ in range(15):
        loss, _ = losses.window(head(seen)[:, 0], own)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        falling.append(float(loss.detach()))
    assert falling[-1] < 0.6 * falling[0]
