# SPDX-License-Identifier: MIT
"""Trains the second network (`masks.py`) on windows around goal objects; the first is unchanged.

The windows, with the first network's output, are kept in `windows/`, a file for each part, so that only the
small network is run again and again. The mean of its weights goes to `masks.pt`.
"""

import argparse
import os
import pathlib
import time

import augment
import common
import cv2
import draws
import frames
import losses
import masks
import numpy as np
import targets
import torch
import train
from model import GOALS, Network

MIN_SHARE = 1 / 100  # chosen: minimum share of the picture in an object's box
MIN_PX = 40  # chosen: of an object in its window
BOX_ERROR = 0.05  # chosen: of a box's sides, similar to claims
TELL_EVERY_S = 60


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--out", type=pathlib.Path, default=None)
    parser.add_argument("--parts", type=int, nargs="+", default=[1, 2], help="of windows, each drawn anew")
    parser.add_argument("--windows", type=int, default=3600, help="of a part")
    parser.add_argument("--steps", type=int, default=1500)
    parser.add_argument("--minutes", type=float, default=60, help="at most; the end comes at the earlier of both")
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def boxes_of(sample, rng):
    """Goal objects of some size: rows of (id, goal, box as a claim may have it)."""
    size = sample.depth.shape[0]
    for one, goal, box, _ in targets.instances(sample, MIN_PX):
        left, top, right, bottom = box
        sides = np.array([right - left, bottom - top] * 2)
        if sides[0] * sides[1] < size * size * MIN_SHARE:
            continue
        box = np.clip(np.round(box + rng.normal(0, BOX_ERROR, 4) * sides), 0, size)
        if (box[2:] - box[:2]).min() >= 4:
            yield one, goal, box.astype(np.float32)


def windows_of(sample, inputs, share, rng):
    """Inputs of the second network for a frame, and the object's pixels."""
    tensor = lambda x: torch.from_numpy(np.ascontiguousarray(x))[None]
    image, depth, height = tensor(inputs["image"]).float() / 255, tensor(inputs["depth"]), tensor(inputs["height"])
    for one, goal, box in boxes_of(sample, rng):
        own = tensor((sample.instance == one)[None].astype(np.float32)).expand(-1, 3, -1, -1)
        seen = masks.window(image, depth, height, share[None, goal : goal + 1], torch.from_numpy(box)[None])
        own = masks.window(own, depth, height, share[None, goal : goal + 1], torch.from_numpy(box)[None])[0, 0] > 0
        if own.sum() >= MIN_PX:
            yield {"seen": seen[0].numpy().astype(np.float16), "own": own.numpy(), "goal": np.uint8(goal)}


def collect(network, places, weights, count, rng):
    """`count` windows of frames that are drawn and changed as for training."""
    rows = []
    while len(rows) < count:
        sample = frames.Sample(*places[rng.choice(len(places), p=weights)])
        augment.augment(sample, common.INPUT_PX, rng)
        inputs = sample.inputs()
        image, depth, height = (torch.from_numpy(np.ascontiguousarray(inputs[key]))[None]
                                for key in ("image", "depth", "height"))
        image = (image.float() / 255).contiguous(memory_format=torch.channels_last)
        with torch.no_grad(), train.autocast(torch.device("cpu")):
            share = torch.softmax(network.raw(image, depth, height)["mask"].float(), 1)
        rows += windows_of(sample, inputs, share[0], rng)
    return {key: np.stack([row[key] for row in rows[:count]]) for key in rows[0]}


def frames_with_goals(data):
    places, weights, goals = draws.frame_weights(frames.read_set(data, *common.TRAIN_SETS, *common.TRAIN_STYLES))
    weights = weights * goals[:, :-1].any(1)
    return places, weights / weights.sum()


def read_windows(args, network):
    """All parts together; missing parts are collected first."""
    parts, drawn = [], None
    for part in args.parts:
        path = args.data / "windows" / f"{args.seed}-{part}.npz"
        if not path.exists():
            drawn = drawn or frames_with_goals(args.data)
            path.parent.mkdir(exist_ok=True)
            started = path.with_suffix(".part.npz")
            np.savez(started, **collect(network, *drawn, args.windows, np.random.default_rng([args.seed, part])))
            started.replace(path)
            print(f"{path.name}: {args.windows} windows", flush=True)
        with np.load(path) as file:
            parts.append(dict(file))
    return {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}


def batch_of(windows, chosen, rng):
    """Windows and their objects, half of them mirrored."""
    seen, own = (torch.from_numpy(windows[key][chosen]).float() for key in ("seen", "own"))
    turned = torch.from_numpy(rng.random(len(chosen)) < 0.5)[:, None, None]
    seen = torch.where(turned[:, None], seen.flip(-1), seen)
    return seen.contiguous(memory_format=torch.channels_last), torch.where(turned, own.flip(-1), own)


def step(head, optimizer, seen, own):
    with train.autocast(torch.device("cpu")):
        logits = head(seen)
    loss, parts = losses.window(logits.float()[:, 0], own)
    optimizer.zero_grad(set_to_none=True)
    loss.backward()
    torch.nn.utils.clip_grad_norm_(head.parameters(), 1.0)
    optimizer.step()
    return {name: float(value.detach()) for name, value in parts.items()}


def fit(head, windows, args):
    """The running mean of the weights, and after how many steps."""
    rng = np.random.default_rng(args.seed)
    chance = np.bincount(windows["goal"], minlength=GOALS).clip(1)[windows["goal"]] ** -0.5  # rare goals more often
    chance /= chance.sum()
    optimizer = torch.optim.AdamW(head.parameters(), lr=args.rate, weight_decay=0.02)
    average, done, begun, told, means = train.Average(head), 0, time.time(), 0.0, {}
    while (share := max(done / args.steps, (time.time() - begun) / 60 / args.minutes)) < 1:
        done += 1
        optimizer.param_groups[0]["lr"] = train.rate_at(share, args.rate)
        chosen = np.sort(rng.choice(len(chance), args.batch, p=chance))
        parts = step(head, optimizer, *batch_of(windows, chosen, rng))
        average.update(head)
        means = {name: 0.98 * means.get(name, value) + 0.02 * value for name, value in parts.items()}
        if time.time() - told > TELL_EVERY_S:
            told = time.time()
            print(f"{done:6} steps", " ".join(f"{name} {value:.3f}" for name, value in means.items()), flush=True)
    return average.network, done


def main():
    args = arguments()
    torch.set_num_threads(args.threads)
    cv2.setNumThreads(args.threads)
    torch.manual_seed(args.seed)
    network = Network().eval()
    state = torch.load(args.checkpoint or args.data / "checkpoint.pt", map_location="cpu", weights_only=True)
    network.load_state_dict(state["average"])
    windows = read_windows(args, network.to(memory_format=torch.channels_last))
    mean, steps = fit(masks.Masks().to(memory_format=torch.channels_last), windows, args)
    path = args.out or args.data / "masks.pt"
    torch.save({"average": mean.state_dict(), "windows": len(windows["goal"]), "steps": steps,
                "batch": args.batch, "seed": args.seed}, path)
    print(f"{path.name}: {steps} steps of {args.batch} of {len(windows['goal'])} windows")


if __name__ == "__main__":
    main()
