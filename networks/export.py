# SPDX-License-Identifier: MIT
"""Writes the trained network as ONNX with fixed shapes; weights are stored in half precision.

Each weight is a float16 constant behind a cast, which inference programs fold: they compute in float32.
"""

import argparse
import hashlib
import pathlib

import common
import numpy as np
import onnx
import torch
from halve import halve
from model import OUTPUTS, Network

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
    """The mean of the weights, with the text table in the graph, and what the run says of itself."""
    text = torch.from_numpy(np.load(common.REPO / "networks/text_vectors.npy").astype(np.float32))
    network = Network(text=text / text.norm(dim=1, keepdim=True))
    state = torch.load(checkpoint, map_location="cpu", weights_only=True)
    network.load_state_dict(state["average"])
    about = {key: value for key, value in state.items() if isinstance(value, (int, float))}
    return fold_norms(network.eval()), about


def export(network, out, size=common.INPUT_PX):
    shapes = {"image": 3, "depth": 1, "height": 1}
    inputs = tuple(torch.zeros(1, channels, size, size) for channels in shapes.values())
    torch.onnx.export(network, inputs, out, input_names=list(shapes), output_names=OUTPUTS,
                      opset_version=OPSET, dynamo=False)
    model = halve(onnx.load(out))
    model.producer_name, model.producer_version = "crossnav", ""
    onnx.checker.check_model(model, full_check=True)
    out.write_bytes(model.SerializeToString())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--out", type=pathlib.Path, default=FILE)
    args = parser.parse_args()
    network, about = trained(args.checkpoint or args.data / "checkpoint.pt")
    export(network, args.out)
    content = args.out.read_bytes()
    count = sum(p.numel() for p in network.parameters())
    print(f"{args.out.name}: {len(content)} bytes, {count} weights, sha256 {hashlib.sha256(content).hexdigest()}")
    print(f"trained: {about}")


if __name__ == "__main__":
    main()
