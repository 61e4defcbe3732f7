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
import batches
import common
import frames
import furniture
import losses
import masks
import metrics
import model
import numpy as np
import targets
import train

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


def answer_of(made):
    """Output of a perfect network."""
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


def test_frames_of_drawn_homes_are_drawn_more_often():
    scenes = [house(), house()]
    for one, name in zip(scenes, ["02001", common.LOOKED_AT[0]], strict=True):
        one.name, one.frames, one.instance = name, [{}], sample().instance[None]
    _, weights, _ = train.frame_weights(scenes)
    assert weights[1] == pytest.approx(train.DRAWN * weights[0])


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


def test_frames_with_false_claims_are_drawn_more_often():
    house_of = types.SimpleNamespace(name="toy")
    draw = train.Draw([(house_of, 0), (house_of, 1)], np.array([0.5, 0.5]))
    for _ in range(8):
        draw.learn(np.array([0]), np.array([0.0]))
        draw.learn(np.array([1]), np.array([1.0]))
    share = (draw.choose(2000, np.random.default_rng(1)) == 1).mean()
    assert share == pytest.approx(0.8, abs=0.05)
    grown = train.Draw([*draw.places, (house_of, 2)], np.full(3, 1 / 3), draw)
    assert grown.false[1] == pytest.approx(draw.false[1]) and grown.false[2] == train.UNSEEN


def test_a_claim_on_a_thing_is_not_false():
    target = {"heat": torch.zeros(2, 1, 4, 4), "asked": torch.ones(2, 1, 4, 4)}
    target["heat"][0, 0, 1, 1] = 1
    heat = torch.full((2, 1, 4, 4), -9.0)
    heat[:, 0, 1, 1] = 9
    assert train.false_scores(heat, target) == pytest.approx([0, 1], abs=1e-3)


def narrow_network():
    return model.Network(widths=(8, 16, 16, 24, 32))


def used_network():
    """A narrow network whose norms are not those of a new one, and its inputs."""
    torch.manual_seed(1)
    network = narrow_network()
    inputs, _ = batch()
    network.raw(*inputs)
    return network, inputs


def started_from(file, inputs):
    import warm

    network = narrow_network()
    warm.load(network, file)
    warm.settle(network, [{"image": (inputs[0] * 255).round().to(torch.uint8), "depth": inputs[1], "height": inputs[2]}] * 2)
    return network


def test_a_run_from_an_exported_file_starts_with_its_answers(tmp_path):
    pytest.importorskip("onnx")
    import export

    first, inputs = used_network()
    file = tmp_path / "toy.onnx"
    export.export(export.fold_norms(first.eval()), file, SIZE)
    second = started_from(file, inputs)
    with torch.no_grad():
        mine, theirs = second.raw(*inputs), first.raw(*inputs)
        trained = second.train().raw(*inputs)
    for name, value in theirs.items():
        scale = max(1, float(value.abs().max()))
        assert (mine[name] - value).abs().max() < 0.01 * scale, name
        assert (trained[name] - value).abs().max() < 0.02 * scale, name  # the norms are those of the batch


def test_blocks_that_an_exported_file_lacks_change_none_of_its_answers(tmp_path):
    pytest.importorskip("onnx")
    import export
    import onnx

    first, inputs = used_network()
    with torch.no_grad():  # the file of a network without these blocks: they are not in it and added nothing
        for block in first.deepest_more:
            block.body[-1][1].weight.zero_()
            block.body[-1][1].bias.zero_()
    file = tmp_path / "toy.onnx"
    export.export(export.fold_norms(first.eval()), file, SIZE)
    graph = onnx.load(file)
    kept = [row for row in graph.graph.initializer if not row.name.startswith("deepest_more")]
    assert len(kept) < len(graph.graph.initializer)
    del graph.graph.initializer[:]
    graph.graph.initializer.extend(kept)
    onnx.save(graph, file)
    second = started_from(file, inputs)
    with torch.no_grad():
        mine, theirs = second.raw(*inputs), first.raw(*inputs)
    for name, value in theirs.items():
        assert (mine[name] - value).abs().max() < 0.01 * max(1, float(value.abs().max())), name
    second.train().raw(*inputs)["heat"].mean().backward()
    assert second.deepest_more[0].body[-1][1].weight.grad.abs().max() > 0  # and it can learn


def test_integers_answer_nearly_as_float_does_and_can_be_trained_on(tmp_path):
    pytest.importorskip("onnx")
    ort = pytest.importorskip("onnxruntime")
    import export
    import warm

    torch.manual_seed(1)
    text = torch.nn.functional.normalize(torch.randn(len(common.CLASS_NAMES), 512), dim=1)
    network = export.fold_norms(model.Network(widths=(8, 16, 16, 24, 32), text=text).eval())
    for name, parameter in network.named_parameters():
        if name.endswith("bias"):  # equal ones would be stored once
            torch.nn.init.normal_(parameter, std=0.01)
    inputs = [value[:1] for value in batch()[0]]
    feed = {name: value.numpy() for name, value in zip(("image", "depth", "height"), inputs, strict=True)}
    plain, file = tmp_path / "plain.onnx", tmp_path / "integers.onnx"
    export.export(network, plain, SIZE)
    export.export(network, file, SIZE, feeds=[feed] * 2)
    session = ort.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    with torch.no_grad():
        for name, mine, theirs in zip(model.OUTPUTS, session.run(model.OUTPUTS, feed), network(*inputs), strict=True):
            assert np.abs(mine - theirs.numpy()).max() < 0.1 * max(1, np.abs(mine).max()), name
    exact, rounded = warm.weights_of(plain), warm.weights_of(file)
    for name, parameter in network.named_parameters():
        largest = float(parameter.detach().abs().max())
        assert (rounded[name] - exact[name]).abs().max() <= largest / 63 / 2 + 1e-3, name
    assert file.read_bytes() == (export.export(network, plain, SIZE, feeds=[feed] * 2), plain.read_bytes())[1]


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


def test_the_exported_masks_are_those_of_torch(tmp_path):
    pytest.importorskip("onnx")
    pytest.importorskip("onnxruntime")
    import export
    import onnxruntime

    torch.manual_seed(1)
    head = export.fold_norms(masks.Masks(fine=8, coarse=16).eval())
    file = tmp_path / "toy_masks.onnx"
    export.export_masks(head, file, SIZE)
    session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    inputs = [value[:1] for value in batch()[0]]
    inputs += [torch.rand(1, 1, SIZE // 4, SIZE // 4), torch.tensor([[20.0, 40.0, 44.0, 72.0]])]
    names = ["image", "depth", "height", "share", "box"]
    mine = session.run(masks.OUTPUTS, {name: value.numpy() for name, value in zip(names, inputs, strict=True)})
    with torch.no_grad():
        theirs = masks.MaskOfBox(head)(*inputs)
    assert mine[0].shape == (1, 1, masks.SIZE, masks.SIZE)
    assert np.abs(mine[0] - theirs[0].numpy()).max() < 0.01
    assert mine[1][0] == pytest.approx([18.56, 38.08, 45.44, 73.92], abs=1e-3)


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
    looked_at, held = [*common.TRAIN_SETS, *common.DEV_SETS], ["test", "test-2"]
    assert sorted(looked_at + held) == sorted(common.SETS)
    assert sum(len(rows) for rows in seeds.values()) == len(set().union(*seeds.values()))
    assert max(max(seeds[name]) for name in looked_at) < 5001 <= min(min(seeds[name]) for name in held)
    assert {common.SETS[name]["furniture"] for name in looked_at} == {"train", "program"}
    assert {common.SETS[name]["furniture"] for name in held} == {"held"}
    assert not set(common.STYLES) & set(common.TRAIN_SETS) and not set(common.LOOKED_AT) & set(common.HOMES)
    assert {home for name in common.TRAIN_STYLES for home in common.STYLES[name]["homes"]} == set(common.LOOKED_AT)


def test_masks_of_an_exported_file_are_the_same_at_another_size(tmp_path):
    pytest.importorskip("onnx")
    import export

    torch.manual_seed(3)
    network = masks.Masks()
    for module in network.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            module.running_mean.normal_(0, 0.2)
            module.running_var.uniform_(0.5, 2)
    seen = torch.rand(2, 7, masks.SIZE, masks.SIZE)
    with torch.no_grad():
        before = network.eval()(seen)
        export.export_masks(export.fold_norms(network), tmp_path / "a_masks.onnx", size=64)
        after = export.exported_masks(tmp_path / "a_masks.onnx")[0](seen)
    assert torch.allclose(before, after, atol=0.02)  # weights were stored in half precision


def stored(size=SIZE, count=6):
    """A store on the CPU with pictures of the toy house."""
    made = sample(size)
    pose = [{"pitch_deg": 5.0 * index, "camera_height_m": 0.88} for index in range(count)]
    many = lambda plane: np.stack([plane] * count)
    house = types.SimpleNamespace(**vars(made.house), frames=pose, rgb=many(made.rgb), instance=many(made.instance),
                                  depth_mm=many((made.depth * 1000).astype(np.uint16)))
    store = batches.Store(count, torch.device("cpu"), size)
    return store, store.add(house)


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
    batch = batches.augmented(store, torch.arange(6).repeat(4), size, batches.Random(store.device, 3))
    inputs, answers = batch.inputs(), batches.targets_of(batch)
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
    batch = batches.place(store, torch.arange(6).repeat(8), 64, batches.Random(store.device, 5))
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
    batch = batches.augmented(store, torch.arange(6).repeat(40), 64, batches.Random(store.device, 7))
    assert batch.image.min() >= 0 and batch.image.max() <= 255
    assert batch.depth.min() == 0 and batch.depth.max() < 4
    assert 0.01 < (batch.depth == 0).float().mean() < 0.3
    assert 1 < batch.camera_height.sub(0.88).abs().max() * 100 < 15
    again = batches.augmented(store, torch.arange(6).repeat(40), 64, batches.Random(store.device, 7))
    assert torch.equal(batch.image, again.image)


def test_a_jpeg_of_high_quality_is_nearly_the_picture():
    smooth = torch.linspace(20, 230, 64)[None, None, :, None].expand(2, 64, 64, 3)
    made = batches.jpeg(smooth, batches.Random(torch.device("cpu"), 1))
    assert 0.01 < (made - smooth).abs().mean() < 4


def test_training_in_memory_draws_frames_with_false_claims_more_often(tmp_path, monkeypatch):
    store, _ = stored(320)
    house = store.houses[0]
    monkeypatch.setattr(train, "folders_of", lambda *_: [tmp_path])
    monkeypatch.setattr(frames, "House", lambda _: house)
    args = types.SimpleNamespace(data=tmp_path, sets=["train"], most_frames=6, batch=64)
    source = train.InMemory(args, torch.device("cpu"), 1)
    inputs, answers = source.take(64)
    assert inputs["image"].shape == (64, 3, 64, 64) and answers["mask"].shape == (64, 16, 16)
    assert source.class_weight.shape == (len(common.CLASS_NAMES),)
    for _ in range(12):
        source.learn((source.at == 2).float())
        source.take(64)
    drawn = torch.bincount(torch.cat([source.at for _ in range(20) if source.take(64)]), minlength=6)
    assert drawn[2] > 2 * drawn[[0, 1, 3, 4, 5]].max()
