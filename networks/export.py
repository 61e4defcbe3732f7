# SPDX-License-Identifier: MIT
"""Writes the trained networks as ONNX with fixed shapes.

Convolutions are in 8-bit integers (quantize.py), unless --float is given. Other weights are float16
constants behind a cast, which inference programs fold: they compute in float32.
"""

import argparse
import hashlib
import pathlib

import common
import masks
import model
import numpy as np
import onnx
import quantize
import torch
import warm
from halve import halve
from runtime import masks_file
from targets import STRIDE

FILE = common.REPO / "networks/crossnav_small.onnx"
OPSET = 17


def fold_norms(network):
    """Batch norms go into the convolutions before them."""
    for module in network.modules():
        if isinstance(module, torch.nn.Sequential):
            for name, child in list(module.named_children()):
                after = str(int(name) + 1)
                if isinstance(child, torch.nn.Conv2d) and isinstance(module._modules.get(after), torch.nn.BatchNorm2d):
                    module._modules[name] = torch.nn.utils.fuse_conv_bn_eval(child, module._modules[after])
                    module._modules[after] = torch.nn.Identity()
    return network


def trained(checkpoint):
    """The mean of the weights, with the text table in the graph, and the run's metadata."""
    text = torch.from_numpy(np.load(common.REPO / "networks/text_vectors.npy").astype(np.float32))
    return averaged(model.Network(text=text / text.norm(dim=1, keepdim=True)), checkpoint)


def averaged(network, checkpoint):
    state = torch.load(checkpoint, map_location="cpu", weights_only=True)
    network.load_state_dict(state["average"])
    about = {key: value for key, value in state.items() if isinstance(value, (int, float))}
    return fold_norms(network.eval()), about


def exported_masks(file):
    """The second network of an exported file: it sees windows, so that it fits any size of the input."""
    network = masks.Masks()
    warm.load(network, file, prefix="masks.")
    return fold_norms(network.eval()), {"from": file.name}


def inputs_of(size):
    return {"image": (1, 3, size, size), "depth": (1, 1, size, size), "height": (1, 1, size, size)}


def export(network, out, size=common.INPUT_PX, feeds=None):
    """`feeds`: inputs that tell the ranges of integers; without them all is computed in float32."""
    write(network, out, inputs_of(size), model.OUTPUTS, feeds)


def export_masks(trained_masks, out, size=common.INPUT_PX, feeds=None):
    more = {"share": (1, 1, size // STRIDE, size // STRIDE), "box": (1, 4)}
    write(masks.MaskOfBox(trained_masks).eval(), out, inputs_of(size) | more, masks.OUTPUTS, feeds)


def write(network, out, shapes, outputs, feeds=None):
    inputs = tuple(torch.ones(shape) for shape in shapes.values())
    torch.onnx.export(network, inputs, out, input_names=list(shapes), output_names=outputs,
                      opset_version=OPSET, dynamo=False)
    made = onnx.load(out)
    made = halve(made if feeds is None else quantize.quantized(made, feeds))
    made.producer_name, made.producer_version = "crossnav", ""
    onnx.checker.check_model(made, full_check=True)
    out.write_bytes(made.SerializeToString())


def tell(network, out, about):
    content = out.read_bytes()
    count = sum(p.numel() for p in network.parameters())
    print(f"{out.name}: {len(content)} bytes, {count} weights, sha256 {hashlib.sha256(content).hexdigest()}")
    print(f"trained: {about}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--masks", type=pathlib.Path, default=None, help="checkpoint, or an exported file of another size")
    parser.add_argument("--out", type=pathlib.Path, default=FILE)
    parser.add_argument("--float", action="store_true", help="compute in float32, as before integers: to compare")
    args = parser.parse_args()
    network, about = trained(args.checkpoint or args.data / "checkpoint.pt")
    export(network, args.out, feeds=None if args.float else quantize.feeds(args.data))
    tell(network, args.out, about)
    chosen = args.masks or args.data / "masks.pt"
    second, about = exported_masks(chosen) if chosen.suffix == ".onnx" else averaged(masks.Masks(), chosen)
    export_masks(second, masks_file(args.out), feeds=None if args.float else quantize.mask_feeds(args.data, args.out))
    tell(second, masks_file(args.out), about)


if __name__ == "__main__":
    main()
