# SPDX-License-Identifier: MIT
"""The pipeline on a made-up house: targets, decoding, losses, shapes, export. `pytest networks/tests`.

Skipped where torch is not installed; nothing else of the project needs it.
"""

import pathlib
import sys
import types

import pytest

torch = pytest.importorskip("torch")
cv2 = pytest.importorskip("cv2")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import augment
import common
import frames
import furniture
import losses
import metrics
import model
import numpy as np
import targets

SIZE = 96
CHAIR, STAIRS, WALL = 1, 2, 3


def house():
    goal = np.array([-1, 0, -1, -1], np.int16)
    names = np.array([-1, 0, common.CLASS_NAMES.index("stairs"), common.CLASS_NAMES.index("wall")], np.int16)
    return types.SimpleNamespace(name="toy", goal_of=goal, class_of=names,
                                 is_stairs=np.array([False, False, True, False]))


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
    made.rows = np.arange(size) - centre
    return made


def answer_of(made):
    """What a perfect network would say."""
    target = targets.all_of(made, SIZE)
    goals = len(common.GOALS)
    mask = np.eye(goals + 1, dtype=np.float32)[target["mask"]].transpose(2, 0, 1)
    return {"heat": target["heat"], "box": target["box"], "mask": mask, "stairs": target["stairs"][None],
            "dense": np.eye(len(common.CLASS_NAMES), dtype=np.float32)[np.maximum(target["dense"], 0)]}


def test_height_of_the_floor_is_zero_and_of_the_horizon_is_the_camera():
    focal, _ = frames.intrinsics(SIZE)
    depth = np.array([[2.0], [2.0]], np.float32)
    rows = np.array([0.0, 0.88 / 2.0 * focal])
    height = frames.height_above_foot(depth, rows, focal, 0.0, 0.88)
    assert height[:, 0] == pytest.approx([0.88, 0.0], abs=1e-6)
    up = frames.height_above_foot(depth[:1], rows[:1], focal, np.radians(30), 0.88)
    assert up[0, 0] == pytest.approx(0.88 + 1.0)


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


def batch():
    made = sample()
    target = {key: torch.from_numpy(np.stack([value] * 2)) for key, value in targets.all_of(made, SIZE).items()}
    inputs = {key: torch.from_numpy(np.stack([value] * 2)) for key, value in made.inputs().items()}
    return (inputs["image"].float() / 255, inputs["depth"], inputs["height"]), target


def test_the_loss_falls_on_a_toy_batch():
    torch.manual_seed(1)
    network = model.Network(widths=(8, 16, 16, 24, 32))
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


def test_the_exported_file_has_the_agreed_shapes_and_answers_as_torch_does(tmp_path):
    onnx = pytest.importorskip("onnx")
    pytest.importorskip("onnxruntime")
    import export
    import onnxruntime

    torch.manual_seed(1)
    text = torch.nn.functional.normalize(torch.randn(len(common.CLASS_NAMES), 512), dim=1)
    network = export.fold_norms(model.Network(widths=(8, 16, 16, 24, 32), text=text).eval())
    file = tmp_path / "toy.onnx"
    export.export(network, file, SIZE)
    assert onnx.load(file).opset_import[0].version <= 17
    session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    cells, goals = SIZE // 4, len(common.GOALS)
    shapes = {output.name: output.shape for output in session.get_outputs()}
    assert shapes == {"heat": [1, goals, cells, cells], "box": [1, 4, cells, cells],
                      "mask": [1, goals + 1, cells, cells], "stairs": [1, 1, cells, cells], "dense": [1, 24, 24, 512]}
    inputs = [value[:1] for value in batch()[0]]
    feed = {name: value.numpy() for name, value in zip(("image", "depth", "height"), inputs, strict=True)}
    answers = session.run(model.OUTPUTS, feed)
    with torch.no_grad():
        for name, mine, theirs in zip(model.OUTPUTS, answers, network(*inputs), strict=True):
            assert np.abs(mine - theirs.numpy()).max() < 0.01 * max(1, np.abs(mine).max()), name
    assert np.linalg.norm(answers[4], axis=-1) == pytest.approx(1, abs=1e-4)


def test_a_third_of_each_kind_is_held_out_by_its_name():
    models = [{"id": f"chair{i}", "kind": "chair"} for i in range(9)] + [
        {"id": f"bed{i}", "kind": "bed"} for i in range(2)] + [{"id": "book", "kind": "book"}]
    held = furniture.held_out_ids(models)
    assert sum(name.startswith("chair") for name in held) == 3
    assert sum(name.startswith("bed") for name in held) == 1
    assert "book" not in held
    assert furniture.held_out_ids(models[::-1]) == held


def test_held_out_houses_and_furniture_are_never_trained_on():
    seeds = {name: set(spec["seeds"]) for name, spec in common.SETS.items()}
    assert not seeds["train"] & seeds["dev"] and min(seeds["test"]) >= 5001
    assert max(seeds["train"] | seeds["dev"]) < 5001
    assert common.SETS["train"]["furniture"] == common.SETS["dev"]["furniture"] == "train"
    assert common.SETS["test"]["furniture"] == "held"
