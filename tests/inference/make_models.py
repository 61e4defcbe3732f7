#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the small ONNX files of these tests into data/ beside this script (needs the package onnx).

    make_models.py

Each computes something that a test can work out in its head.
"""
import pathlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

DATA = pathlib.Path(__file__).resolve().parent / "data"


def value(name, shape, kind=TensorProto.FLOAT):
    return helper.make_tensor_value_info(name, kind, shape)


def number(name, array):
    return numpy_helper.from_array(np.asarray(array), name)


def save(name, nodes, inputs, outputs, numbers=(), check=True):
    graph = helper.make_graph(nodes, name, inputs, outputs, list(numbers))
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], producer_name="crossnav")
    model.ir_version = 7
    if check:
        onnx.checker.check_model(model)
    (DATA / f"{name}.onnx").write_bytes(model.SerializeToString())


def node(kind, inputs, output, **attributes):
    return helper.make_node(kind, inputs.split(), [output], **attributes)


def conv(name, source, output, weights, bias):
    """A 1 x 1 convolution and its numbers."""
    weights = np.asarray(weights, np.float32)[:, :, None, None]
    return (node("Conv", f"{source} {name}_w {name}_b", output),
            [number(f"{name}_w", weights), number(f"{name}_b", np.asarray(bias, np.float32))])


def arithmetic():
    """sum = a + 2 b; log = log a."""
    save("arithmetic",
         [node("Mul", "b two", "doubled"), node("Add", "a doubled", "sum"), node("Log", "a", "log")],
         [value("a", [1, 3]), value("b", ["n", 3])], [value("sum", [1, 3]), value("log", [1, 3])],
         [number("two", np.float32(2))])


def huge():
    """`sum` is a tensor of 2^60 zeros; `declared` has a constant of 2^44 numbers, of which four are there."""
    side = number("side", np.array([1 << 30, 1 << 30], np.int64))
    save("huge", [node("ConstantOfShape", "side", "sum"), node("Identity", "a", "log")],
         [value("a", [1, 3]), value("b", [1, 3])], [value("sum", ["n", "m"]), value("log", [1, 3])], [side])
    few = number("few", np.zeros(4, np.float32))
    few.dims[:] = [1 << 22, 1 << 22]
    save("declared", [node("Identity", "few", "sum"), node("Identity", "a", "log")],
         [value("a", [1, 3]), value("b", [1, 3])], [value("sum", ["n", "m"]), value("log", [1, 3])], [few], check=False)


def detr():
    """Four boxes in shares of the picture; scores are multiplied by the picture's brightest byte."""
    boxes = np.array([[[0.1, 0.1, 0.5, 0.5], [0.12, 0.1, 0.5, 0.5], [0.6, 0.2, 0.9, 1.1],
                       [0.1, 0.1, 0.5, 0.5]]], np.float32)
    save("detr",
         [node("Cast", "orig_target_sizes", "sizes", to=TensorProto.FLOAT),
          node("Concat", "sizes sizes", "twice", axis=1), node("Unsqueeze", "twice one", "row"),
          node("Mul", "shares row", "boxes"),
          node("ReduceMax", "images", "most", axes=[1, 2, 3], keepdims=0),
          node("Mul", "likely most", "scores"),
          node("Identity", "classes", "labels")],
         [value("images", ["N", 3, 8, 8]), value("orig_target_sizes", ["N", 2], TensorProto.INT64)],
         [value("labels", [1, 4], TensorProto.INT64), value("boxes", [1, 4, 4]),
          value("scores", [1, 4])],
         [number("shares", boxes), number("one", np.array([1], np.int64)),
          number("likely", np.array([[0.9, 0.8, 0.7, 0.95]], np.float32)),
          number("classes", np.array([[1, 1, 2, 0]], np.int64))])


def crossnav(name="crossnav", frames=1):
    """Goals named by colours: red cells are chairs, green beds, blue plants, and nothing is one of
    the three others; boxes of 12 px;
    a cell whose mean height is h is stairs with probability h; dense: mean colour and depth."""
    colour = np.eye(3, dtype=np.float32)
    others = np.zeros((3, 3), np.float32)
    mask = np.vstack([20 * colour, others, -20 * np.ones((1, 3), np.float32)])
    nodes, numbers = [], []
    for made, own in (conv("heat", "cells", "heat", np.vstack([colour, others]), [0] * 6),
                      conv("edge", "far", "box", np.zeros((4, 1)), [6, 6, 6, 6]),
                      conv("share", "cells", "logits", mask, [0, 0, 0, -10, -10, -10, 10])):
        nodes.append(made)
        numbers += own
    save(name,
         [node("AveragePool", "image", "cells", kernel_shape=[4, 4], strides=[4, 4]),
          node("AveragePool", "depth", "far", kernel_shape=[4, 4], strides=[4, 4]),
          node("AveragePool", "height", "stairs", kernel_shape=[4, 4], strides=[4, 4]),
          *nodes, node("Softmax", "logits", "mask", axis=1),
          node("Concat", "cells far", "all", axis=1),
          node("AveragePool", "all", "coarse", kernel_shape=[2, 2], strides=[2, 2]),
          node("Transpose", "coarse", "dense", perm=[0, 2, 3, 1])],
         [value("image", [frames, 3, 32, 32]), value("depth", [frames, 1, 32, 32]),
          value("height", [frames, 1, 32, 32])],
         [value("heat", [frames, 6, 8, 8]), value("box", [frames, 4, 8, 8]),
          value("mask", [frames, 7, 8, 8]), value("stairs", [frames, 1, 8, 8]),
          value("dense", [frames, 4, 4, 4])], numbers)


def yolo(name, output, table, size=16):
    """A fixed table, times the brightest byte of the picture."""
    save(name,
         [node("ReduceMax", "images", "most", axes=[0, 1, 2, 3], keepdims=0),
          node("Mul", "table most", output)],
         [value("images", [1, 3, size, size])], [value(output, list(table.shape))],
         [number("table", table)])


def yolo8_segment():
    """Two classes, three boxes (the second doubles the first), one prototype: 20 x red - 10."""
    table = np.array([[[6, 6, 12], [8, 8, 12], [8, 8, 4], [8, 8, 4],  # centre and size
                       [0.1, 0.1, 0.9], [0.8, 0.7, 0.2],  # classes
                       [1, 1, 1]]], np.float32)
    save("yolov8-seg",
         [node("ReduceMax", "images", "most", axes=[0, 1, 2, 3], keepdims=0),
          node("Mul", "table most", "output0"),
          node("Slice", "images zero one one", "red"),
          node("AveragePool", "red", "cells", kernel_shape=[4, 4], strides=[4, 4]),
          node("Mul", "cells twenty", "more"), node("Sub", "more ten", "output1")],
         [value("images", [1, 3, 16, 16])],
         [value("output0", [1, 7, 3]), value("output1", [1, 1, 4, 4])],
         [number("table", table), number("zero", np.array([0], np.int64)),
          number("one", np.array([1], np.int64)), number("twenty", np.float32(20)),
          number("ten", np.float32(10))])


def yolo_world():
    """Two cells; a text's score in a cell is their vectors' product, times 0.9."""
    boxes = np.array([[[6, 12], [8, 4], [8, 4], [8, 4]]], np.float32)  # centre and size
    save("yolo-world",
         [node("ReduceMax", "images", "most", axes=[0, 1, 2, 3], keepdims=0),
          node("MatMul", "texts cells", "likely"), node("Mul", "likely most", "scores"),
          node("Concat", "boxes scores", "output0", axis=1)],
         [value("images", [1, 3, 16, 16]), value("texts", [1, 3, 2])], [value("output0", [1, 7, 2])],
         [number("boxes", boxes), number("cells", np.array([[0.9, 0], [0, 0.9]], np.float32))])


def grids():
    """Cells of 4 x 4 px: 10 x mean colour as logits of three classes; mean colour as features."""
    save("segformer",
         [node("AveragePool", "pixel_values", "cells", kernel_shape=[4, 4], strides=[4, 4]),
          node("Mul", "cells ten", "logits")],
         [value("pixel_values", ["n", 3, "h", "w"])], [value("logits", ["n", 3, "y", "x"])],
         [number("ten", np.float32(10))])
    save("dense",
         [node("AveragePool", "image", "features", kernel_shape=[4, 4], strides=[4, 4])],
         [value("image", [1, 3, 16, 16])], [value("features", [1, 3, 4, 4])])


if __name__ == "__main__":
    DATA.mkdir(exist_ok=True)
    yolo("yolov7", "output", np.array([[[6, 8, 8, 8, 0.9, 0.1, 1.0], [6, 8, 8, 8, 0.2, 0.1, 1.0],
                                        [12, 4, 4, 4, 1.0, 0.8, 0.1]]], np.float32))
    yolo("yolov7-end2end", "output", np.array([[0, 2, 4, 10, 12, 1, 0.9],
                                               [0, 10, 2, 14, 6, 0, 0.8]], np.float32))
    cells = np.zeros((1, 21, 7), np.float32)  # 4 x 4, 2 x 2 and 1 cell of a picture of 32 px
    cells[0, 6] = [0.5, 0.25, np.log(2), np.log(1), 0.9, 0.1, 1.0]  # second row, third column
    cells[0, 20] = [0.5, 0.5, 0, 0, 1.0, 0.8, 0.1]
    yolo("yolox", "output", cells, 32)
    yolo8_segment()
    yolo_world()
    grids()
    arithmetic()
    huge()
    detr()
    crossnav()
    crossnav("crossnav_frames", "frames")  # for batches
