# SPDX-License-Identifier: MIT
"""Opens the first side of an exported network, the frames, for batches of several agents.

    open_batch.py IN.onnx OUT.onnx

Resize by a fixed size becomes Resize by the same scale, because a size includes the frames. The
computation for one frame stays the same. `networks.batch` in docs/networks.md uses such files.
"""
import sys

import numpy as np
import onnx
from onnx import numpy_helper, shape_inference

FRAMES = "frames"


def open_batch(model: onnx.ModelProto) -> onnx.ModelProto:
    """A copy of `model`, whose ports have 1 as first side, for any number of frames."""
    sizes = {value.name: [d.dim_value for d in value.type.tensor_type.shape.dim]
             for value in shape_inference.infer_shapes(model).graph.value_info}
    out = onnx.ModelProto()
    out.CopyFrom(model)
    numbers = {number.name: number for number in out.graph.initializer}
    for node in out.graph.node:
        if node.op_type != "Resize" or len(node.input) < 4 or not node.input[3]:
            continue
        size = numpy_helper.to_array(numbers[node.input[3]])
        scale = size.astype(np.float32) / np.array(sizes[node.input[0]], np.float32)
        name = node.output[0] + "_factors"
        out.graph.initializer.append(numpy_helper.from_array(scale, name))
        node.input[2] = name
        del node.input[3:]
    used = {name for node in out.graph.node for name in node.input}
    for name, number in numbers.items():
        if name not in used:
            out.graph.initializer.remove(number)
    del out.graph.value_info[:]
    for port in [*out.graph.input, *out.graph.output]:
        side = port.type.tensor_type.shape.dim[0]
        if side.dim_value != 1:
            raise ValueError(f"{port.name} does not begin with one frame")
        side.dim_param = FRAMES
    onnx.checker.check_model(out)
    return out


def main() -> None:
    source, target = sys.argv[1:]
    onnx.save(open_batch(onnx.load(source)), target)


if __name__ == "__main__":
    main()
