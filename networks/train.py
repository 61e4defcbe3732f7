# SPDX-License-Identifier: MIT
"""Trains the network on a number of frames or for a number of minutes, or resumes an earlier run.

The learning rate follows the share of the frames or minutes that is used up, whichever is more, so that a run
is whole however fast the machine is. Every few minutes the state goes to `checkpoint.pt`; the mean of the
weights is what counts.
"""

import argparse
import concurrent.futures
import copy
import math
import os
import pathlib
import time

import augment
import common
import cv2
import frames
import losses
import numpy as np
import targets
import torch
from model import Network

SAVE_EVERY_S = 180


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--frames", type=int, default=200_000, help="to look at in all")
    parser.add_argument("--minutes", type=float, default=120, help="at most; the end comes at the earlier of both")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--size", type=int, default=common.INPUT_PX)
    parser.add_argument("--small-size", type=int, default=160, help="of the first part of the run")
    parser.add_argument("--small-share", type=float, default=0.85, help="of the run")
    parser.add_argument("--rate", type=float, default=2.5e-3)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def autocast(device):
    """bfloat16 where it is the faster: on a GPU, and on a CPU that has matrix units for it."""
    fast = device.type != "cpu" or torch.cpu.get_capabilities().get("amx_bf16", False)
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=fast)


def frame_weights(houses):
    """Frames with goals that few frames show are drawn more often; frames without any less. Also which frame
    shows which goal, stairs last."""
    places, goals = [], []
    for house in houses:
        for index in range(len(house.frames)):
            seen = np.zeros(len(common.GOALS) + 1)
            ids, count = np.unique(house.instance[index][::4, ::4], return_counts=True)
            big = ids[count > 20]  # half a percent of the picture
            for goal in house.goal_of[big]:
                seen[goal] = seen[goal] or goal >= 0
            seen[-1] = house.is_stairs[big].any()
            places.append((house, index))
            goals.append(seen)
    goals = np.array(goals)
    rarity = 1 / np.maximum(goals.mean(0), 0.01) ** 0.5
    weights = 1.0 + (goals * rarity).max(1)
    return places, weights / weights.sum(), goals


def dense_weights(houses, size=64):
    """Rare names count more, common ones less: by the square root of how often they are seen."""
    count = np.ones(len(common.CLASS_NAMES))
    step = common.STORED_PX // size
    for house in houses:
        names = house.class_of[house.instance[::6, ::step, ::step]]
        count += np.bincount(names[names >= 0], minlength=len(count))
    weights = (count / count.sum()) ** -0.5
    return torch.tensor(np.clip(weights / np.median(weights), 0.2, 5), dtype=torch.float32)


def batch_of(places, weights, batch, size, rng):
    inputs, answers = [], []
    for at in rng.choice(len(places), batch, p=weights):
        sample = frames.Sample(*places[at])
        augment.augment(sample, size, rng)
        inputs.append(sample.inputs())
        answers.append(targets.all_of(sample, size))
    stack = lambda rows: {key: torch.from_numpy(np.stack([row[key] for row in rows])) for key in rows[0]}
    return stack(inputs), stack(answers)


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
            for name, value in mine.items():
                if value.dtype.is_floating_point:
                    value.lerp_(theirs[name], 1 - keep)
                else:
                    value.copy_(theirs[name])


class Run:
    def __init__(self, args, device):
        self.network = Network().to(device, memory_format=torch.channels_last)
        decayed = [p for p in self.network.parameters() if p.ndim > 1]
        others = [p for p in self.network.parameters() if p.ndim <= 1]
        self.optimizer = torch.optim.AdamW([{"params": decayed, "weight_decay": 0.02},
                                            {"params": others, "weight_decay": 0.0}], lr=args.rate)
        self.average = Average(self.network)
        self.used_s, self.steps, self.frames_seen = 0.0, 0, 0

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

    def save(self, path, extra):
        torch.save({**self.state(), **extra}, path.with_suffix(".part"))
        path.with_suffix(".part").replace(path)


def rate_at(share, top):
    """Up during 3 % of the time, then down a cosine."""
    return top * min(1.0, share / 0.03 + 0.02) * (0.5 + 0.5 * math.cos(math.pi * min(share, 1.0))) + 1e-6


def step(run, inputs, answers, class_weight, device):
    with autocast(device):
        raw = run.network.raw(inputs["image"].float() / 255, inputs["depth"], inputs["height"])
    loss, parts = losses.total(raw, answers, class_weight)
    run.optimizer.zero_grad(set_to_none=True)
    loss.backward()
    torch.nn.utils.clip_grad_norm_(run.network.parameters(), 5.0)
    run.optimizer.step()
    run.average.update(run.network)
    return {name: float(value.detach()) for name, value in parts.items()}


def read_places(data):
    houses = frames.read_set(data, "train")
    places, weights, goals = frame_weights(houses)
    print(f"{len(houses)} houses, {len(places)} frames with",
          ", ".join(f"{n} {goal}" for n, goal in zip(goals.sum(0).astype(int), [*common.GOALS, "stairs"], strict=True)), flush=True)
    return houses, places, weights


def is_grown(data, houses):
    """Whether houses were rendered since: training may begin before all of them are there."""
    return len(list((data / "train").glob("*/models.json"))) > len(houses)


def share_of(run, args):
    """Of the run, that is used up."""
    return max(run.frames_seen / args.frames, run.used_s / 60 / args.minutes)


def size_at(share, args):
    return args.small_size if share < args.small_share else args.size


def train(args):
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    path = args.checkpoint or args.data / "checkpoint.pt"
    houses, places, weights = read_places(args.data)
    class_weight = dense_weights(houses).to(device)
    run = Run(args, device)
    if path.exists():
        run.restore(torch.load(path, map_location=device, weights_only=True))
        print(f"goes on after {run.used_s / 60:.1f} minutes, {run.steps} steps", flush=True)
    rng = np.random.default_rng([args.seed, run.steps])
    cv2.setNumThreads(args.threads)
    run.network.train()
    last, saved, told, means = time.time(), time.time(), time.time(), {}
    pool = concurrent.futures.ThreadPoolExecutor(1)
    draw = lambda: pool.submit(batch_of, places, weights, args.batch, size_at(share_of(run, args), args), rng)
    coming = draw()  # the next batch, prepared during the step
    while (share := share_of(run, args)) < 1:
        for group in run.optimizer.param_groups:
            group["lr"] = rate_at(share, args.rate)
        (inputs, answers), coming = coming.result(), draw()
        parts = step(run, to_device(inputs, device), to_device(answers, device), class_weight, device)
        run.steps, run.frames_seen = run.steps + 1, run.frames_seen + args.batch
        now = time.time()
        run.used_s, last = run.used_s + now - last, now
        means = {name: 0.97 * means.get(name, value) + 0.03 * value for name, value in parts.items()}
        if now - told > 30:
            told = now
            print(f"{run.used_s / 60:6.1f} min {run.steps:6} steps {run.frames_seen:7} frames",
                  " ".join(f"{name} {value:.3f}" for name, value in means.items()), flush=True)
        if now - saved > SAVE_EVERY_S:
            saved = now
            run.save(path, {"seed": args.seed, "houses": len(houses), "frames": len(places)})
            if is_grown(args.data, houses):
                houses, places, weights = read_places(args.data)
    pool.shutdown(cancel_futures=True)
    run.save(path, {"seed": args.seed, "houses": len(houses), "frames": len(places)})
    print(f"{path}: {run.steps} steps, {run.frames_seen} frames in {run.used_s / 60:.1f} minutes")


if __name__ == "__main__":
    train(arguments())
