# SPDX-License-Identifier: MIT
"""Starts a training run from the weights of an exported file, in which batch norms are folded into convolutions.

The file's convolutions are taken unchanged. A norm after a convolution gets the mean and the deviation of that
convolution's output on training frames, and undoes them with its own scale and bias: the network's output is that of
the file, and its norms are ready to train.
"""

import onnx
import torch
from onnx import numpy_helper

HALF = "_half"  # of names of constants stored in half precision (halve.py)
INTEGERS = "_quantized"  # and of those in integers, which have a "_scale"


def weights_of(file, prefix=""):
    """Constants of the file by the names of the network's parameters, which begin with `prefix` there."""
    rows = {row.name.removesuffix(HALF): torch.from_numpy(numpy_helper.to_array(row).copy()).float()
            for row in onnx.load(file).graph.initializer}
    for name in [name for name in rows if name.endswith(INTEGERS)]:  # quantize.py; zero is zero
        plain = name.removesuffix(INTEGERS)
        steps = rows.get(f"{plain}_scale", rows.get(f"{name}_scale"))
        rows[plain] = rows[name] * steps.reshape(-1, *[1] * (rows[name].dim() - 1))
    return {name.removeprefix(prefix): value for name, value in rows.items() if name.startswith(prefix)}


def pairs(network):
    """(name, convolution, norm behind it) in the network."""
    for path, module in network.named_modules():
        if isinstance(module, torch.nn.Sequential):
            for name, child in module.named_children():
                after = module._modules.get(str(int(name) + 1))
                if isinstance(child, torch.nn.Conv2d) and isinstance(after, torch.nn.BatchNorm2d):
                    yield f"{path}.{name}", child, after


def load(network, file, prefix=""):
    """Norms only add the folded bias afterwards; `settle` is still needed before training. Blocks that the file
    lacks add nothing to their input at first."""
    stored = weights_of(file, prefix)
    with torch.no_grad():
        for name, module in network.named_modules():
            if hasattr(module, "body") and f"{name}.body.0.0.weight" not in stored:
                module.body[-1][1].weight.zero_()
        for name, convolution, norm in pairs(network):
            if f"{name}.weight" not in stored:
                continue
            convolution.weight.copy_(stored.pop(f"{name}.weight"))
            norm.bias.copy_(stored.pop(f"{name}.bias"))
            norm.weight.fill_(1)
            norm.running_mean.zero_()
            norm.running_var.fill_(1 - norm.eps)
        for name, parameter in network.named_parameters():
            if name in stored:
                parameter.copy_(stored[name])


class Moments:
    """Mean and variance by channel of what enters a norm."""

    def __init__(self, norm):
        self.count, self.sum, self.squares = 0, 0, 0
        self.hook = norm.register_forward_pre_hook(self.add)

    def add(self, _, inputs):
        x = inputs[0].double()
        self.count += x.numel() // x.shape[1]
        self.sum = self.sum + x.sum((0, 2, 3))
        self.squares = self.squares + x.square().sum((0, 2, 3))


def settle(network, batches):
    """Gives each norm the moments that it sees on `batches` of inputs; the network's output stays the same."""
    norms = [norm for _, _, norm in pairs(network)]
    moments = [Moments(norm) for norm in norms]
    network.eval()
    with torch.no_grad():
        for inputs in batches:
            network.raw(inputs["image"].float() / 255, inputs["depth"], inputs["height"])
        for norm, seen in zip(norms, moments, strict=True):
            seen.hook.remove()
            mean = seen.sum / seen.count
            variance = (seen.squares / seen.count - mean.square()).clamp(min=0)
            norm.running_mean.copy_(mean)
            norm.running_var.copy_(variance)
            if norm.weight.any():
                norm.weight.copy_((norm.running_var + norm.eps).sqrt())
                norm.bias.add_(norm.running_mean)
