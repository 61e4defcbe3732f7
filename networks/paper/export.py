#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes one of the paper's networks as ONNX with its card, ready for crossnav (docs/networks-paper.md).

    export.py segformer_b2 --weights FOLDER --out ~/networks
    export.py yolo_world --weights yolov8s-worldv2.pt --clip FOLDER --labels chair bed sofa --out ~/networks

Without --weights they are random: good for trying out, and for tests.
"""

import argparse
import hashlib
import pathlib
import warnings

import torch

import architectures

OPSET = 17


@torch.no_grad()
def set_random(modules, seed):
    """Random running statistics, too: a new network's statistics would hide errors."""
    generator = torch.Generator().manual_seed(seed)
    for module in modules:
        for norm in module.modules():
            if isinstance(norm, torch.nn.modules.batchnorm._BatchNorm) and norm.running_mean is not None:
                norm.running_mean.copy_(0.1 * torch.randn(norm.running_mean.shape, generator=generator))
                norm.running_var.copy_(0.5 + torch.rand(norm.running_var.shape, generator=generator))


def write(part, path):
    with torch.no_grad(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        part.module(*[x.clone() for x in part.inputs.values()])  # creates grids and anchors
        torch.onnx.export(part.module, tuple(part.inputs.values()), str(path), input_names=list(part.inputs), output_names=part.outputs,
                          opset_version=OPSET, dynamo=False, do_constant_folding=True)


def export(name, wish, out, prepare=None):
    """Writes files and card of network `name` to folder `out`; returns the network. `prepare` may change it before."""
    torch.manual_seed(wish.seed)
    made = architectures.NETWORKS[name](wish)
    if not wish.weights:
        set_random([part.module for part in made.parts], wish.seed)
    for part in made.parts:
        part.module.eval()  # the exporter restores the previous mode of modules
    if prepare:
        prepare(made)
    out.mkdir(parents=True, exist_ok=True)
    hashes = []
    for part in made.parts:
        path = out / f"{name}{part.suffix}.onnx"
        write(part, path)
        hashes.append(hashlib.sha256(path.read_bytes()).hexdigest())
    card = made.card
    for texts in (out / "clip_text.onnx", out / "sed_text.onnx"):
        if f'encoder = "{texts.name}"' in card and texts.exists():  # its last lines belong to [text]
            card += f'sha256 = "{hashlib.sha256(texts.read_bytes()).hexdigest()}"\n'
    keys = {"clip_text": [], "sed": ["sha256"]}.get(name, ["sha256", "decoder_sha256"])
    head = "".join(f'{key} = "{value}"\n' for key, value in zip(keys, hashes))
    source = wish.weights or "random weights"
    suffix = "toml" if name != "clip_text" else "text"
    (out / f"{name}.{suffix}").write_text(f'# Written by networks/paper/export.py from {source}.\n{head}{card}')
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("network", choices=sorted(architectures.NETWORKS))
    parser.add_argument("--weights", default="", help="file or folder; without it they are random")
    parser.add_argument("--labels", nargs="+", default=list(architectures.GOALS), help="names of the classes, where the weights do not say")
    parser.add_argument("--clip", default="", help="folder of a CLIP text model, for the words of yolo_world")
    parser.add_argument("--size", type=int, default=0, help="side of the input [px]; default: the network's own")
    parser.add_argument("--small", action="store_true", help="the same classes with few channels, random")
    parser.add_argument("--seed", type=int, default=1, help="of random weights")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    args = parser.parse_args()
    wish = architectures.Wish(args.weights, args.labels, args.small, args.size, args.clip, args.seed)
    made = export(args.network, wish, args.out)
    print(args.out / args.network, f"{len(made.parts)} file(s)")


if __name__ == "__main__":
    main()
