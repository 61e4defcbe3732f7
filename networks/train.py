# SPDX-License-Identifier: MIT
"""Trains the network on a number of frames or for a number of minutes, or resumes an earlier run.

The learning rate follows the share of the frames or minutes that is used up, whichever is more, so that a run
is whole however fast the machine is. Every few minutes the state goes to `checkpoint.pt`; the mean of the
weights is what counts. Frames in which the network claims a goal that is not there are drawn more often.

With --from-onnx a new run starts from the weights of an exported file instead of from nothing. On a GPU the frames
are kept in its memory and batches are made there (sources.py).
"""

import argparse
import copy
import math
import os
import pathlib
import time

import common
import cv2
import losses
import torch
import warm
from model import Network
from sources import FromDisk, InMemory

SAVE_EVERY_S = 180
TELL_EVERY_S = 30
SETTLE_FRAMES = 384  # chosen: for the norms of a run that starts from a file


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--from-onnx", type=pathlib.Path, default=None, help="file whose weights a new run starts from")
    parser.add_argument("--sets", nargs="+", default=[*common.TRAIN_SETS, *common.TRAIN_STYLES])
    parser.add_argument("--frames", type=int, default=200_000, help="to look at in all")
    parser.add_argument("--minutes", type=float, default=120, help="at most; the end comes at the earlier of both")
    parser.add_argument("--batch", type=int, default=None, help="16 on a CPU, 128 on a GPU")
    parser.add_argument("--size", type=int, default=common.INPUT_PX)
    parser.add_argument("--small-size", type=int, default=192, help="of the parts of pictures in the first part of the run")
    parser.add_argument("--small-share", type=float, default=0.75, help="of the run")
    parser.add_argument("--rate", type=float, default=2.5e-3)
    parser.add_argument("--device", default=None, help="default: cuda where there is one, else cpu")
    parser.add_argument("--most-frames", type=int, default=60_000, help="in the memory of a GPU, 0.7 MB each")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def autocast(device):
    """bfloat16 where it is the faster: on a GPU, and on a CPU that has instructions for it."""
    able = torch.cpu.get_capabilities()
    fast = device.type != "cpu" or able.get("amx_bf16", False) or able.get("avx512_bf16", False)
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=fast)


def false_scores(heat, answers):
    """Of each picture, the highest score of a claim away from all goal objects."""
    away = (answers["heat"] < 0.05) & (answers["asked"] > 0)
    return (torch.sigmoid(heat.detach().float()) * away).amax((1, 2, 3))


def to_device(arrays, device):
    return {key: value.to(device) for key, value in arrays.items()}


class Average:
    """Running mean of the weights, quicker at the beginning."""

    def __init__(self, network):
        self.network, self.steps = copy.deepcopy(network).eval(), 0

    def update(self, network):
        self.steps += 1
        keep = min(0.997, self.steps / (self.steps + 10))
        with torch.no_grad():
            mine, theirs = self.network.state_dict(), network.state_dict()
            names = [name for name, value in mine.items() if value.dtype.is_floating_point]
            torch._foreach_lerp_([mine[name] for name in names], [theirs[name] for name in names], 1 - keep)


class Run:
    def __init__(self, args, device):
        self.network = Network().to(device, memory_format=torch.channels_last)
        decayed = [p for p in self.network.parameters() if p.ndim > 1]
        others = [p for p in self.network.parameters() if p.ndim <= 1]
        self.optimizer = torch.optim.AdamW([{"params": decayed, "weight_decay": 0.02},
                                            {"params": others, "weight_decay": 0.0}], lr=args.rate,
                                           fused=device.type != "cpu")
        self.average = Average(self.network)
        self.used_s, self.steps, self.frames_seen = 0.0, 0, 0
        self.start = args.from_onnx.name if args.from_onnx else ""  # file of its first weights

    def state(self):
        return {"network": self.network.state_dict(), "average": self.average.network.state_dict(),
                "average_steps": self.average.steps, "optimizer": self.optimizer.state_dict(),
                "used_s": self.used_s, "steps": self.steps, "frames_seen": self.frames_seen}

    def restore(self, state):
        self.network.load_state_dict(state["network"])
        self.average.network.load_state_dict(state["average"])
        self.average.steps = state["average_steps"]
        self.optimizer.load_state_dict(state["optimizer"])
        self.used_s, self.steps, self.frames_seen = state["used_s"], state["steps"], state["frames_seen"]
        self.start = state.get("from", self.start)

    def save(self, path, extra):
        torch.save({**self.state(), **extra}, path.with_suffix(".part"))
        path.with_suffix(".part").replace(path)


def rate_at(share, top):
    """Up during 3 % of the time, then down a cosine."""
    return top * min(1.0, share / 0.03 + 0.02) * (0.5 + 0.5 * math.cos(math.pi * min(share, 1.0))) + 1e-6


def start_from(network, file, source, args):
    """Loads an exported file's weights, with norms as the training frames have them."""
    warm.load(network, file)
    device = next(network.parameters()).device
    count = max(1, SETTLE_FRAMES // args.batch)
    warm.settle(network, (to_device(source.take(args.size)[0], device) for _ in range(count)))


def step(run, inputs, answers, class_weight, device):
    with autocast(device):
        raw = run.network.raw(inputs["image"].float() / 255, inputs["depth"], inputs["height"])
    loss, parts = losses.total(raw, answers, class_weight)
    run.optimizer.zero_grad(set_to_none=True)
    loss.backward()
    torch.nn.utils.clip_grad_norm_(run.network.parameters(), 5.0)
    run.optimizer.step()
    run.average.update(run.network)
    return {name: value.detach() for name, value in parts.items()}, false_scores(raw["heat"], answers)


def share_of(run, args):
    """Of the run, that is used up."""
    return max(run.frames_seen / args.frames, run.used_s / 60 / args.minutes)


def size_at(share, args):
    return args.small_size if share < args.small_share else args.size


def about(args, run, source):
    """What the card tells of the run."""
    start = {"from": run.start} if run.start else {}
    return {"seed": args.seed, "houses": len(source.houses), "frames": len(source.places), **start}


def begin(args, device, path):
    """The run and its batches: new, continued, or from a file's weights."""
    run = Run(args, device)
    if path.exists():
        run.restore(torch.load(path, map_location=device, weights_only=True))
        print(f"goes on after {run.used_s / 60:.1f} minutes, {run.steps} steps", flush=True)
    seed = [args.seed, run.steps]
    source = FromDisk(args, seed) if device.type == "cpu" else InMemory(args, device, args.seed + run.steps)
    if args.from_onnx and not path.exists():
        start_from(run.network, args.from_onnx, source, args)
        run.average = Average(run.network)
        print(f"starts from {args.from_onnx.name}", flush=True)
    return run, source


def tell(run, means):
    print(f"{run.used_s / 60:6.1f} min {run.steps:6} steps {run.frames_seen:7} frames",
          " ".join(f"{name} {float(value):.3f}" for name, value in means.items()), flush=True)


def train(args):
    device = torch.device(args.device or ("cuda" if torch.cuda.is_available() else "cpu"))
    args.batch = args.batch or (16 if device.type == "cpu" else 128)
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    torch.backends.cudnn.benchmark = True
    path = args.checkpoint or args.data / "checkpoint.pt"
    cv2.setNumThreads(args.threads)
    run, source = begin(args, device, path)
    run.network.train()
    last = saved = told = grown = time.time()
    means = {}
    while (share := share_of(run, args)) < 1:
        for group in run.optimizer.param_groups:
            group["lr"] = rate_at(share, args.rate)
        inputs, answers = source.take(size_at(share, args))
        parts, false = step(run, to_device(inputs, device), to_device(answers, device), source.class_weight.to(device), device)
        source.learn(false)
        parts["false"] = false.mean()
        run.steps, run.frames_seen = run.steps + 1, run.frames_seen + args.batch
        now = time.time()
        run.used_s, last = run.used_s + now - last, now
        means = {name: means.get(name, value).lerp(value, 0.03) for name, value in parts.items()}
        if now - told > TELL_EVERY_S:
            told = now
            tell(run, means)
        if now - saved > SAVE_EVERY_S:
            saved = now
            run.save(path, about(args, run, source))
        if now - grown > source.grows_every_s:
            grown = now
            source.grow()
    source.close()
    run.save(path, about(args, run, source))
    print(f"{path}: {run.steps} steps, {run.frames_seen} frames in {run.used_s / 60:.1f} minutes")


if __name__ == "__main__":
    train(arguments())
