# SPDX-License-Identifier: MIT
"""Trains the network on a number of frames or for a number of minutes, or resumes an earlier run.

The learning rate follows the share of the frames or minutes that is used up, whichever is more, so that a run
is whole however fast the machine is. Every few minutes the state goes to `checkpoint.pt`; the mean of the
weights is what counts. Frames in which the network claims a goal that is not there are drawn more often.

With --from-onnx a new run starts from the weights of an exported file instead of from nothing.
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
import warm
from model import Network

SAVE_EVERY_S = 180
DRAWN = 2.5  # chosen: two homes among a hundred houses are a fifth of what is drawn
HARD = 3.0  # chosen: a frame with a sure false claim is drawn four times as often as one without
UNSEEN = 0.3  # chosen: score of the false claims of frames not yet drawn
SETTLE_BATCHES = 24  # chosen: 384 frames for the norms of a run that starts from a file


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--checkpoint", type=pathlib.Path, default=None)
    parser.add_argument("--from-onnx", type=pathlib.Path, default=None, help="file whose weights a new run starts from")
    parser.add_argument("--sets", nargs="+", default=[*common.TRAIN_SETS, *common.TRAIN_STYLES])
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
    """bfloat16 where it is the faster: on a GPU, and on a CPU that has instructions for it."""
    able = torch.cpu.get_capabilities()
    fast = device.type != "cpu" or able.get("amx_bf16", False) or able.get("avx512_bf16", False)
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=fast)


def frame_weights(houses):
    """Frames with goals that few frames show are drawn more often, and frames of homes that people drew; frames
    without goals less. Also which frame shows which goal, stairs last."""
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
    weights *= [DRAWN if house.name in common.LOOKED_AT else 1.0 for house, _ in places]
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


class Draw:
    """Frames of the training houses, of which the hard ones come more often."""

    def __init__(self, places, weights, before=None):
        """`before`: the draw of fewer houses, whose scores are kept."""
        self.places, self.weights = places, weights
        known = before.scores() if before else {}
        self.false = np.array([known.get((house.name, index), UNSEEN) for house, index in places])

    def scores(self):
        return {(house.name, index): score for (house, index), score in zip(self.places, self.false, strict=True)}

    def choose(self, batch, rng):
        chance = self.weights * (1 + HARD * self.false)
        return rng.choice(len(self.places), batch, p=chance / chance.sum())

    def learn(self, chosen, false):
        """Scores of the highest false claims of the chosen frames."""
        self.false[chosen] = 0.5 * (self.false[chosen] + false)


def false_scores(heat, answers):
    """Of each picture, the highest score of a claim away from all goal objects."""
    away = (answers["heat"] < 0.05) & (answers["asked"] > 0)
    return (torch.sigmoid(heat.detach().float()) * away).amax((1, 2, 3)).cpu().numpy()


def batch_of(places, size, rng):
    inputs, answers = [], []
    for place in places:
        sample = frames.Sample(*place)
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


def start_from(network, file, draw, args, rng):
    """Loads an exported file's weights, with norms as the training frames have them."""
    warm.load(network, file)
    device = next(network.parameters()).device
    sets = (batch_of([draw.places[at] for at in draw.choose(args.batch, rng)], args.size, rng)[0] for _ in range(SETTLE_BATCHES))
    warm.settle(network, (to_device(inputs, device) for inputs in sets))


def step(run, inputs, answers, class_weight, device):
    with autocast(device):
        raw = run.network.raw(inputs["image"].float() / 255, inputs["depth"], inputs["height"])
    loss, parts = losses.total(raw, answers, class_weight)
    run.optimizer.zero_grad(set_to_none=True)
    loss.backward()
    torch.nn.utils.clip_grad_norm_(run.network.parameters(), 5.0)
    run.optimizer.step()
    run.average.update(run.network)
    return {name: float(value.detach()) for name, value in parts.items()}, false_scores(raw["heat"], answers)


def read_places(data, sets):
    houses = frames.read_set(data, *sets)
    places, weights, goals = frame_weights(houses)
    print(f"{len(houses)} houses, {len(places)} frames with",
          ", ".join(f"{n} {goal}" for n, goal in zip(goals.sum(0).astype(int), [*common.GOALS, "stairs"], strict=True)), flush=True)
    return houses, places, weights


def is_grown(data, sets, houses):
    """Whether houses were rendered since: training may begin before all of them are there."""
    return sum(len(list((data / name).glob("*/models.json"))) for name in sets) > len(houses)


def share_of(run, args):
    """Of the run, that is used up."""
    return max(run.frames_seen / args.frames, run.used_s / 60 / args.minutes)


def size_at(share, args):
    return args.small_size if share < args.small_share else args.size


def about(args, run, houses, places):
    """What the card tells of the run."""
    start = {"from": run.start} if run.start else {}
    return {"seed": args.seed, "houses": len(houses), "frames": len(places), **start}


def train(args):
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    path = args.checkpoint or args.data / "checkpoint.pt"
    cv2.setNumThreads(args.threads)
    houses, places, weights = read_places(args.data, args.sets)
    class_weight = dense_weights(houses).to(device)
    frames_of = Draw(places, weights)
    run = Run(args, device)
    if path.exists():
        run.restore(torch.load(path, map_location=device, weights_only=True))
        print(f"goes on after {run.used_s / 60:.1f} minutes, {run.steps} steps", flush=True)
    elif args.from_onnx:
        start_from(run.network, args.from_onnx, frames_of, args, np.random.default_rng(args.seed))
        run.average = Average(run.network)
        print(f"starts from {args.from_onnx.name}", flush=True)
    rng = np.random.default_rng([args.seed, run.steps])
    run.network.train()
    last, saved, told, means = time.time(), time.time(), time.time(), {}
    pool = concurrent.futures.ThreadPoolExecutor(1)

    def draw():
        at = frames_of.choose(args.batch, rng)
        chosen = [frames_of.places[index] for index in at]
        return frames_of, at, pool.submit(batch_of, chosen, size_at(share_of(run, args), args), rng)

    coming = draw()  # the next batch, prepared during the step
    while (share := share_of(run, args)) < 1:
        for group in run.optimizer.param_groups:
            group["lr"] = rate_at(share, args.rate)
        drawn_of, at, batch = coming
        (inputs, answers), coming = batch.result(), draw()
        parts, false = step(run, to_device(inputs, device), to_device(answers, device), class_weight, device)
        drawn_of.learn(at, false)
        parts["false"] = float(false.mean())
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
            run.save(path, about(args, run, houses, places))
            if is_grown(args.data, args.sets, houses):
                houses, places, weights = read_places(args.data, args.sets)
                frames_of = Draw(places, weights, frames_of)
    pool.shutdown(cancel_futures=True)
    run.save(path, about(args, run, houses, places))
    print(f"{path}: {run.steps} steps, {run.frames_seen} frames in {run.used_s / 60:.1f} minutes")


if __name__ == "__main__":
    train(arguments())
