# SPDX-License-Identifier: MIT
"""Where the batches of a training run come from: frames on disk, or frames in a GPU's memory (batches.py)."""

import concurrent.futures

import augment
import batch_augmentation
import batch_targets
import batches
import common
import draws
import frames
import numpy as np
import targets
import torch


def folders_of(data, sets):
    """Of the scenes that are rendered: training may begin before all of them are there."""
    return [path.parent for name in sets for path in sorted((data / name).glob("*/models.json"))]


def is_grown(data, sets, houses):
    return len(folders_of(data, sets)) > len(houses)


def read_places(data, sets):
    houses = frames.read_set(data, *sets)
    places, weights, goals = draws.frame_weights(houses)
    print(f"{len(houses)} houses, {len(places)} frames with",
          ", ".join(f"{n} {goal}" for n, goal in zip(goals.sum(0).astype(int), [*common.GOALS, "stairs"], strict=True)), flush=True)
    return houses, places, weights


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


def batch_of(places, size, rng):
    inputs, answers = [], []
    for place in places:
        sample = frames.Sample(*place)
        augment.augment(sample, size, rng)
        inputs.append(sample.inputs())
        answers.append(targets.all_of(sample, size))
    stack = lambda rows: {key: torch.from_numpy(np.stack([row[key] for row in rows])) for key in rows[0]}
    return stack(inputs), stack(answers)


class FromDisk:
    """Batches made on the CPU, each during the step before."""

    grows_every_s = 180

    def __init__(self, args, seed):
        self.args, self.rng = args, np.random.default_rng(seed)
        self.frames_of, self.pool, self.coming, self.at = None, concurrent.futures.ThreadPoolExecutor(1), None, None
        self.read()

    def read(self):
        self.houses, self.places, weights = read_places(self.args.data, self.args.sets)
        self.frames_of = draws.Draw(self.places, weights, self.frames_of)
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
        self.args, self.device, self.rng = args, device, batch_augmentation.Random(device, seed)
        self.store = batches.Store(args.most_frames, device)
        self.false, self.known = torch.full((args.most_frames,), draws.UNSEEN, device=device), set()
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
            self.extra[at] = torch.where(alike, draws.LOOKALIKE, 1.0) * (draws.DRAWN if house.name in common.LOOKED_AT else 1.0)
        if new:
            self.store.close()
            goals = self.goals[: self.store.count]
            rarity = 1 / goals.mean(0).clamp(min=0.01).sqrt()
            self.weights = (1 + (goals * rarity).amax(1)) * self.extra[: self.store.count]
            self.class_weight = class_weights(self.store.name_counts())
            print(f"{len(self.known)} houses, {self.store.count} frames", flush=True)

    def take(self, size):
        chance = self.weights * (1 + draws.HARD * self.false[: len(self.weights)])
        self.at = torch.multinomial(chance, self.args.batch, replacement=True, generator=self.rng.generator)
        with torch.no_grad():
            batch = batch_augmentation.augmented(self.store, self.at, size, self.rng)
            return batch.inputs(), batch_targets.all_of(batch)

    def learn(self, false):
        self.false[self.at] = 0.5 * (self.false[self.at] + false)

    def close(self):
        pass
