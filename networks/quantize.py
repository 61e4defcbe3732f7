# SPDX-License-Identifier: MIT
"""Convolutions of the exported networks in 8-bit integers: half the time on a CPU, and two thirds of the file.

Ranges of the values are those of training frames, without the outermost 0.001 % on either side. Weights have seven
bits: a CPU without instructions for whole 8-bit products adds two of them in 16 bits, which seven bits cannot overflow.
"""

import random
import tempfile
from pathlib import Path

import augment
import common
import frames
import numpy as np
import onnx
import runtime
import train_masks
from onnxruntime.quantization import CalibrationDataReader, CalibrationMethod, QuantFormat, QuantType, quantize_static
from onnxruntime.quantization.shape_inference import quant_pre_process

# Each network's first convolution sees colours, metres and inverse metres at once, and each head's last ends in
# small differences.
KEPT = ("stem.0.0", "label.1", "detect.1", "name.1", "masks.fine.0.0", "masks.out.2")
HOUSES, FRAMES_OF_A_HOUSE = 60, 4  # chosen: twice as many give the same ranges within a percent
SEED = 1


def feeds_of(inputs):
    return {"image": inputs["image"][None].astype(np.float32) / 255,
            "depth": inputs["depth"][None], "height": inputs["height"][None]}


def samples(data, size):
    """Some frames of the training sets in `data`."""
    chosen = random.Random(SEED)
    houses = [house for house in frames.read_set(data, *common.TRAIN_SETS, *common.TRAIN_STYLES) if house.frames]
    for house in chosen.sample(houses, min(HOUSES, len(houses))):
        for index in chosen.sample(range(len(house.frames)), min(FRAMES_OF_A_HOUSE, len(house.frames))):
            sample = frames.Sample(house, index)
            augment.resize(sample, size)
            yield sample


def feeds(data, size=common.INPUT_PX):
    """Inputs of the first network."""
    return (feeds_of(sample.inputs()) for sample in samples(data, size))


def mask_feeds(data, file, size=common.INPUT_PX):
    """Inputs of the second network for the objects there; `file`: the first network."""
    network, rng = runtime.Runtime(file), np.random.default_rng(SEED)
    for sample in samples(data, size):
        inputs = sample.inputs()
        answer = network(**inputs)
        for _, goal, box in train_masks.boxes_of(sample, rng):
            yield feeds_of(inputs) | {"share": answer["mask"][None, goal : goal + 1], "box": box[None]}


class Reader(CalibrationDataReader):
    def __init__(self, some_feeds):
        self.rest = iter(some_feeds)

    def get_next(self):
        return next(self.rest, None)


def quantized(network, some_feeds):
    """The ONNX model `network` with integer convolutions but for KEPT; `some_feeds`: inputs that tell the ranges."""
    with tempfile.TemporaryDirectory() as folder:
        plain, ready, out = (str(Path(folder) / name) for name in ("plain.onnx", "ready.onnx", "out.onnx"))
        onnx.save(network, plain)
        quant_pre_process(plain, ready)
        kept = [node.name for node in onnx.load(ready).graph.node
                if node.op_type == "Conv" and node.input[1].removesuffix(".weight") in KEPT]
        quantize_static(ready, out, Reader(some_feeds), quant_format=QuantFormat.QDQ, op_types_to_quantize=["Conv"],
                        per_channel=True, reduce_range=True, activation_type=QuantType.QUInt8,
                        weight_type=QuantType.QInt8, calibrate_method=CalibrationMethod.Percentile,
                        nodes_to_exclude=kept)
        return onnx.load(out)
