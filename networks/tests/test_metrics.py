# SPDX-License-Identifier: MIT
"""Decoding and judging of a network's output: the answer of a perfect network on the made-up house."""

import pytest

pytest.importorskip("torch")
pytest.importorskip("cv2")

import common
import metrics
import numpy as np
import targets
from toy import SIZE, sample


def answer_of(made):
    """Output of a perfect network."""
    target = targets.all_of(made, SIZE)
    goals = len(common.GOALS)
    mask = np.eye(goals + 1, dtype=np.float32)[target["mask"]].transpose(2, 0, 1)
    return {"heat": target["heat"], "box": target["box"], "mask": mask, "stairs": target["stairs"][None],
            "dense": np.eye(len(common.CLASS_NAMES), dtype=np.float32)[np.maximum(target["dense"], 0)]}


def test_decoding_the_targets_gives_the_instances_back():
    made = sample()
    asked, false = metrics.judge_claims(made, answer_of(made))
    assert [(row["goal"], row["score"]) for row in asked] == [(0, 1.0)]
    assert not false
    assert tuple(asked[0]["box"]) == (20, 40, 44, 72)
    assert asked[0]["claim"] == pytest.approx([20, 40, 44, 72])
    assert asked[0]["mask_iou"] > 0.85


def test_a_claim_where_nothing_is_counts_as_false():
    made = sample()
    answer = answer_of(made)
    answer["heat"][3, 2, 2] = 0.9
    answer["box"][:, 2, 2] = 8
    _, false = metrics.judge_claims(made, answer)
    assert [(row["goal"], pytest.approx(row["score"])) for row in false] == [(3, 0.9)]


def test_the_curve_stays_at_the_asked_rate_of_false_claims():
    asked = [{"score": score} for score in (0.9, 0.7, 0.5, 0.2)]
    false = [{"score": score} for score in (0.6, 0.4)]
    curve = metrics.recall_curve(asked, false, frames=10)
    score, recall, rate = metrics.at_false_rate(curve, 0.1)
    assert (recall, rate) == (0.75, 0.1)
    assert 0.4 < score <= 0.5


def test_dense_cells_have_the_name_of_most_of_their_pixels():
    made = sample()
    right = metrics.dense_right(made, answer_of(made)["dense"], np.eye(len(common.CLASS_NAMES), dtype=np.float32))
    assert right[:, 0].sum() == right[:, 1].sum() > 500
    assert right[common.CLASS_NAMES.index("stairs"), 1] > 100


def test_stairs_are_counted_per_pixel_and_per_picture():
    made, count = sample(), metrics.StairCount([0.5])
    count.add(made, answer_of(made)["stairs"])
    _, iou, precision, recall = count.rows()[0]
    assert iou > 0.9 and precision == recall == 1


def test_a_claims_mask_is_what_was_drawn_within_its_box():
    half = np.zeros((4, 4), np.float32)
    half[:, 2:] = 1
    asked = []

    def drawn(goal, box):
        asked.append((goal, box))
        return half, (0.0, 0.0, 80.0, 80.0)

    mask = metrics.claim_mask({"drawn": drawn}, 3, (10.4, 20, 60, 39.6), SIZE)
    assert asked == [(3, (10, 20, 60, 40))]
    assert mask.sum() == 20 * 20 and mask[20:40, 40:60].all()
