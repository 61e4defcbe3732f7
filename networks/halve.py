# SPDX-License-Identifier: MIT
"""Half the size: float constants of an ONNX model as float16 behind a cast, which inference programs fold."""

import numpy as np
import onnx
from onnx import helper, numpy_helper

MIN_VALUES = 256  # chosen: smaller constants stay in float32


def halve(model):
    """Converts large float constants to float16 with a cast; their uses are unchanged."""
    graph, casts = model.graph, []
    for constant in graph.initializer:
        values = numpy_helper.to_array(constant)
        if values.dtype != np.float32 or values.size < MIN_VALUES:
            continue
        half = numpy_helper.from_array(np.clip(values, -65504, 65504).astype(np.float16), constant.name + "_half")
        casts.append(helper.make_node("Cast", [half.name], [constant.name], to=onnx.TensorProto.FLOAT))
        constant.CopyFrom(half)
    for cast in reversed(casts):
        graph.node.insert(0, cast)
    return model
