# SPDX-License-Identifier: MIT
"""Training: which frames are drawn, false claims, the loss."""

import types

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("cv2")

import common
import draws
import frames
import losses
import numpy as np
import sources
import train
from toy import batch, house, narrow_network, sample, stored


def test_frames_of_drawn_homes_are_drawn_more_often():
    scenes = [house(), house()]
    for one, name in zip(scenes, ["02001", common.LOOKED_AT[0]], strict=True):
        one.name, one.frames, one.instance = name, [{}], sample().instance[None]
    _, weights, _ = draws.frame_weights(scenes)
    assert weights[1] == pytest.approx(draws.DRAWN * weights[0])


def test_frames_with_false_claims_are_drawn_more_often():
    house_of = types.SimpleNamespace(name="toy")
    draw = draws.Draw([(house_of, 0), (house_of, 1)], np.array([0.5, 0.5]))
    for _ in range(8):
        draw.learn(np.array([0]), np.array([0.0]))
        draw.learn(np.array([1]), np.array([1.0]))
    share = (draw.choose(2000, np.random.default_rng(1)) == 1).mean()
    assert share == pytest.approx(0.8, abs=0.05)
    grown = draws.Draw([*draw.places, (house_of, 2)], np.full(3, 1 / 3), draw)
    assert grown.false[1] == pytest.approx(draw.false[1]) and grown.false[2] == draws.UNSEEN


def test_a_claim_on_a_thing_is_not_false():
    target = {"heat": torch.zeros(2, 1, 4, 4), "asked": torch.ones(2, 1, 4, 4)}
    target["heat"][0, 0, 1, 1] = 1
    heat = torch.full((2, 1, 4, 4), -9.0)
    heat[:, 0, 1, 1] = 9
    assert train.false_scores(heat, target) == pytest.approx([0, 1], abs=1e-3)


def test_the_loss_falls_on_a_toy_batch():
    torch.manual_seed(1)
    network = narrow_network()
    optimizer = torch.optim.AdamW(network.parameters(), lr=5e-3)
    inputs, target = batch()
    weight = torch.ones(len(common.CLASS_NAMES))
    seen = []
    for _ in range(12):
        loss, parts = losses.total(network.raw(*inputs), target, weight)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        seen.append(float(loss.detach()))
    assert set(parts) == set(losses.WEIGHTS)
    assert seen[-1] < 0.7 * seen[0]


def test_training_in_memory_draws_frames_with_false_claims_more_often(tmp_path, monkeypatch):
    store, _ = stored(320)
    house = store.houses[0]
    monkeypatch.setattr(sources, "folders_of", lambda *_: [tmp_path])
    monkeypatch.setattr(frames, "House", lambda _: house)
    args = types.SimpleNamespace(data=tmp_path, sets=["train"], most_frames=6, batch=64)
    source = sources.InMemory(args, torch.device("cpu"), 1)
    inputs, answers = source.take(64)
    assert inputs["image"].shape == (64, 3, 64, 64) and answers["mask"].shape == (64, 16, 16)
    assert source.class_weight.shape == (len(common.CLASS_NAMES),)
    for _ in range(12):
        source.learn((source.at == 2).float())
        source.take(64)
    drawn = torch.bincount(torch.cat([source.at for _ in range(20) if source.take(64)]), minlength=6)
    assert drawn[2] > 2 * drawn[[0, 1, 3, 4, 5]].max()
