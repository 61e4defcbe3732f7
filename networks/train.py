# SPDX-License-Identifier: MIT
"""Trains the network on a number of frames or for a number of minutes, or resumes an earlier run.

The learning rate follows the share of the frames or minutes that is used up, whichever is more, so that a run
is whole however fast the machine is. Every few minutes the state goes to `checkpoint.pt`; the mean of the
weights is what counts. Frames in which the network claims a goal that is not there are drawn more often.

With --from-onnx a new run starts from the weights of an exported file instead of from nothing. On a GPU the frames
are kept in its memory and batches are made there (batches.py).
"""

import argparse
import concurrent.futures
import copy
import math
import os
import pathlib
import time

import augment
import batches
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
TELL_EVERY_S = 30
DRAWN = 4.0  # chosen: two homes among seven hundred houses are a seventh of what is drawn
LOOKALIKE = 2.0  # chosen: an armchair is told from a sofa by its width alone, if both are of one series
HARD = 3.0  # chosen: a frame with a sure false claim is drawn four times as often as one without
UNSEEN = 0.3  # chosen: score of the false claims of frames not yet drawn
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


def frame_weights(houses):
    """Frames with goals that few frames show are drawn more often, and frames of homes that people drew or of seats
    that look like another goal; frames without goals less. Also which frame shows which goal, stairs last."""
    places, goals, alike = [], [], []
    for house in houses:
        for index in range(len(house.frames)):
            seen = np.zeros(len(common.GOALS) + 1)
            ids, count = np.unique(house.instance[index][::4, ::4], return_counts=True)
            big = ids[count > 20]  # half a percent of the picture
            for goal in house.goal_of[big]:
                seen[goal] = seen[goal] or goal >= 0
            seen[-1] = house.is_stairs[big].any()
            alike.append(house.is_lookalike[big].any())
            places.append((house, index))
            goals.append(seen)
    goals = np.array(goals)
    rarity = 1 / np.maximum(goals.mean(0), 0.01) ** 0.5
    weights = 1.0 + (goals * rarity).max(1)
    weights *= [DRAWN if house.name in common.LOOKED_AT else 1.0 for house, _ in places]
    weights *= np.where(alike, LOOKALIKE, 1.0)
    return places, weights / weights.sum(), goals


def dense_weights(houses, size=64):
    """Of the names, for the houses on disk."""
    count = np.ones(len(common.CLASS_NAMES))
    step = common.STORED_PX // size
    for house in houses:
        names = house.class_of[house.instance[::6, ::step, ::step]]
        count += np.bincount(names[names >= 0], minlength=len(count))
    return class_weights(torch.from_numpy(count))


def class_weights(count):
    """Rare names count more, common ones less: by the square root of how often they are seen."""
    weights = (count / count.sum()) ** -0.5
    return (weights / weights.median()).clamp(0.2, 5).float()


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
    return (torch.sigmoid(heat.detach().float()) * away).amax((1, 2, 3))


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


class FromDisk:
    """Batches made on the CPU, each during the step before."""

    grows_every_s = 180

    def __init__(self, args, seed):
        self.args, self.rng = args, np.random.default_rng(seed)
        self.frames_of, self.pool, self.coming, self.at = None, concurrent.futures.ThreadPoolExecutor(1), None, None
        self.read()

    def read(self):
        self.houses, self.places, weights = read_places(self.args.data, self.args.sets)
        self.frames_of = Draw(self.places, weights, self.frames_of)
        self.class_weight = dense_weights(self.houses)

    def prepare(self, size):
        at = self.frames_of.choose(self.args.batch, self.rng)
        chosen = [self.frames_of.places[index] for index in at]
        return self.frames_of, at, self.pool.submit(batch_of, chosen, size, self.rng)

    def take(self, size):
        """Inputs and answers."""
        self.drawn_of, self.at, batch = self.coming or self.prepare(size)
        made = batch.result()
        self.coming = self.prepare(size)
        return made

    def learn(self, false):
        self.drawn_of.learn(self.at, false.cpu().numpy())

    def grow(self):
        if is_grown(self.args.data, self.args.sets, self.houses):
            self.read()

    def close(self):
        self.pool.shutdown(cancel_futures=True)


class InMemory:
    """Batches made on a GPU from frames in its memory."""

    grows_every_s = 20

    def __init__(self, args, device, seed):
        self.args, self.device, self.rng = args, device, batches.Random(device, seed)
        self.store = batches.Store(args.most_frames, device)
        self.false, self.known = torch.full((args.most_frames,), UNSEEN, device=device), set()
        self.goals = torch.zeros((args.most_frames, len(common.GOALS) + 1), device=device)
        self.extra = torch.ones(args.most_frames, device=device)
        self.grow()
        if not self.known:
            raise SystemExit(f"no frames in {args.data} of {', '.join(args.sets)}: run networks/render.py first")

    @property
    def houses(self):
        return self.store.houses

    @property
    def places(self):
        return range(self.store.count)

    def grow(self):
        """Adds the houses that were rendered since, as far as they fit."""
        new = [folder for folder in folders_of(self.args.data, self.args.sets) if folder not in self.known]
        for folder in new:
            house = frames.House(folder)
            if self.store.is_full(house):
                print(f"{folder.name} and later houses do not fit --most-frames {self.args.most_frames}", flush=True)
                break
            self.known.add(folder)
            at = self.store.add(house)
            self.goals[at], alike = self.store.shown(at)
            self.extra[at] = torch.where(alike, LOOKALIKE, 1.0) * (DRAWN if house.name in common.LOOKED_AT else 1.0)
        if new:
            self.store.close()
            goals = self.goals[: self.store.count]
            rarity = 1 / goals.mean(0).clamp(min=0.01).sqrt()
            self.weights = (1 + (goals * rarity).amax(1)) * self.extra[: self.store.count]
            self.class_weight = class_weights(self.store.name_counts())
            print(f"{len(self.known)} houses, {self.store.count} frames", flush=True)

    def take(self, size):
        chance = self.weights * (1 + HARD * self.false[: len(self.weights)])
        self.at = torch.multinomial(chance, self.args.batch, replacement=True, generator=self.rng.generator)
        with torch.no_grad():
            batch = batches.augmented(self.store, self.at, size, self.rng)
            return batch.inputs(), batches.targets_of(batch)

    def learn(self, false):
        self.false[self.at] = 0.5 * (self.false[self.at] + false)

    def close(self):
        pass


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


def read_places(data, sets):
    houses = frames.read_set(data, *sets)
    places, weights, goals = frame_weights(houses)
    print(f"{len(houses)} houses, {len(places)} frames with",
          ", ".join(f"{n} {goal}" for n, goal in zip(goals.sum(0).astype(int), [*common.GOALS, "stairs"], strict=True)), flush=True)
    return houses, places, weights


def folders_of(data, sets):
    """Of the scenes that are rendered: training may begin before all of them are there."""
    return [path.parent for name in sets for path in sorted((data / name).glob("*/models.json"))]


def is_grown(data, sets, houses):
    return len(folders_of(data, sets)) > len(houses)


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
