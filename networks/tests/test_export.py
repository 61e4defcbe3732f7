# SPDX-License-Identifier: MIT
"""Exported files answer as the networks do, and runs start from them."""

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("cv2")

import common
import masks
import model
import numpy as np
from toy import SIZE, batch, narrow_network


def test_the_exported_file_has_the_agreed_shapes_and_answers_as_torch_does(tmp_path):
    onnx = pytest.importorskip("onnx")
    pytest.importorskip("onnxruntime")
    import export
    import onnxruntime

    torch.manual_seed(1)
    text = torch.nn.functional.normalize(torch.randn(len(common.CLASS_NAMES), 512), dim=1)
    network = export.fold_norms(narrow_network(text=text).eval())
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


def test_integers_answer_nearly_as_float_does_and_can_be_trained_on(tmp_path):
    pytest.importorskip("onnx")
    ort = pytest.importorskip("onnxruntime")
    import export
    import warm

    torch.manual_seed(1)
    text = torch.nn.functional.normalize(torch.randn(len(common.CLASS_NAMES), 512), dim=1)
    network = export.fold_norms(narrow_network(text=text).eval())
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
