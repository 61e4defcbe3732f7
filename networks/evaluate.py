# SPDX-License-Identifier: MIT
"""Accuracy of the exported network on a set of houses: the figures of its card.

`--set test` and `test-2` are held-out houses with held-out furniture, `drawn` and `building` styles that no training
house has; on `dev` and `dev-2` `thresholds.py` chose. Several networks are shown side by side. --worst DIR draws the pictures with the largest errors.
"""

import argparse
import json
import pathlib
import tomllib

import augment
import common
import frames
import metrics
import numpy as np
import panels
import targets
from export import FILE
from runtime import Runtime

STAIR_THRESHOLDS = [0.3, 0.4, 0.5, 0.6, 0.7]


class Tally:
    def __init__(self, table):
        self.table = table
        self.asked, self.false, self.frames = [], [], 0
        self.stairs = metrics.StairCount(STAIR_THRESHOLDS)
        self.dense = np.zeros((len(common.CLASS_NAMES), 2), int)
        self.cases = []

    def add(self, sample, answer):
        asked, false = metrics.judge_claims(sample, answer)
        where = {"house": sample.house.name, "index": sample.index}
        self.asked += [{**row, **where} for row in asked]
        self.false += [{**row, **where} for row in false]
        self.stairs.add(sample, answer["stairs"])
        self.dense += metrics.dense_right(sample, answer["dense"], self.table)
        truth = sample.house.is_stairs[sample.instance]
        said = metrics.upsample(answer["stairs"], truth.shape[0])[0] > 0.5
        self.cases.append({**where, "stair_error": float((truth != said).mean())})
        self.frames += 1

    def goals(self, name=None):
        """Asked instances and false claims of one goal, or of all."""
        goal = None if name is None else common.GOALS.index(name)
        return [[row for row in rows if goal is None or row["goal"] == goal] for rows in (self.asked, self.false)]

    def curve(self, name=None):
        asked, false = self.goals(name)
        return metrics.recall_curve(asked, false, self.frames)

    def mask_iou(self, name, threshold):
        found = [row["mask_iou"] for row in self.goals(name)[0] if row["score"] >= threshold]
        return float(np.mean(found)) if found else float("nan")


def run(network, houses, table, every=1):
    tally = Tally(table)
    for house in houses:
        for index in range(0, len(house.frames), every):
            sample = frames.Sample(house, index)
            augment.resize(sample, network.size)
            tally.add(sample, network(**sample.inputs()))
    return tally


def print_goals(tally, thresholds):
    print(f"\nGoal objects that fill 1/64 of the picture within {metrics.MAX_M:.0f} m, {tally.frames} frames")
    print("| goal | asked for | recall at .1 false claims a frame | at score | mask IoU | card's threshold | recall "
          "| false a frame |\n|---|---|---|---|---|---|---|---|")
    summary = {}
    for name in [*common.GOALS, None]:
        asked, false = tally.goals(name)
        score, recall, _ = metrics.at_false_rate(tally.curve(name))
        limits = thresholds if name is None else [thresholds[common.GOALS.index(name)]]
        limit = lambda row: thresholds[row["goal"]]
        mine = np.mean([row["score"] >= limit(row) for row in asked]) if asked else 0
        wrong = sum(row["score"] >= limit(row) for row in false) / tally.frames
        masks = tally.mask_iou(name, score)
        shown = f"{limits[0]:.2f}" if name else "each"
        print(f"| {name or 'all, one threshold'} | {len(asked)} | {recall:.3f} | {score:.2f} | {masks:.3f} "
              f"| {shown} | {mine:.3f} | {wrong:.3f} |")
        summary[name or "all"] = {"asked": len(asked), "recall": recall, "mask_iou": masks,
                                  "card_recall": float(mine), "card_false": wrong}
    per_goal = [row for name, row in summary.items() if name != "all"]
    count = sum(row["asked"] for row in per_goal)
    for key in ("recall", "mask_iou"):
        summary[f"goals_{key}"] = sum(row[key] * row["asked"] for row in per_goal if row["asked"]) / max(count, 1)
    summary["goals_card_recall"], summary["goals_card_false"] = summary["all"]["card_recall"], summary["all"]["card_false"]
    print(f"All goals, each at .1 false claims of its own a frame: recall {summary['goals_recall']:.3f}, "
          f"mask IoU {summary['goals_mask_iou']:.3f}")
    return summary


def print_stairs(tally):
    print("\nStairs\n| threshold | pixel IoU | image precision | image recall |\n|---|---|---|---|")
    for row in tally.stairs.rows():
        print("| {:.1f} | {:.3f} | {:.3f} | {:.3f} |".format(*row))
    threshold, iou, precision, recall = tally.stairs.rows()[STAIR_THRESHOLDS.index(0.5)]
    return {"stairs_iou": iou, "stairs_precision": precision, "stairs_recall": recall}


def print_dense(tally):
    right, named = tally.dense.sum(0)
    print(f"\nDense: top-1 {right / max(named, 1):.3f} over {named} named cells")
    rows = [(r / n, n, name) for name, (r, n) in zip(common.CLASS_NAMES, tally.dense, strict=True) if n > 0]
    print("by class:", ", ".join(f"{name} {share:.2f} ({n})" for share, n, name in sorted(rows, reverse=True)))
    mean = float(np.mean([share for share, _, _ in rows]))
    print(f"mean over classes {mean:.3f}")
    return {"dense_top1": float(right / max(named, 1)), "dense_class_mean": mean}


def read_card(path):
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def evaluate(file, houses, names, args):
    """Prints the tables of one network, whose text vectors lie beside it; also the tally and the summary."""
    beside = file.with_name("text_vectors.npy")
    table = np.load(beside if beside.exists() else common.REPO / "networks/text_vectors.npy").astype(np.float32)
    network = Runtime(file)
    thresholds = read_card(file.with_suffix(".toml")).get("thresholds", {}).get("heat", [0.3] * 6)
    tally = run(network, houses, table, args.every)
    print(f"{file.name} on {names}: {len(houses)} scenes, {network.name}")
    summary = print_goals(tally, thresholds)
    if args.curve:
        for score, recall, false in tally.curve()[::5]:
            print(f"  score {score:.2f}: recall {recall:.3f}, false claims a frame {false:.3f}")
    summary |= print_stairs(tally) | print_dense(tally)
    sample = frames.Sample(houses[0], 0)
    augment.resize(sample, network.size)
    summary["ms"], summary["ms_box"] = network.milliseconds(sample.inputs())
    print(f"\nTime: {summary['ms']:.1f} ms of one thread, all heads at {network.size} px, and {summary['ms_box']:.1f} ms "
          f"for the mask of each box, {network.name}\n", flush=True)
    if args.worst:
        panels.draw_worst(tally, houses, network, args.worst)
    return summary


SHOWN = ["goals_recall", "goals_card_recall", "goals_card_false", "goals_mask_iou", "stairs_iou", "stairs_precision",
         "stairs_recall", "dense_top1"]


def print_side_by_side(files, summaries):
    print("| | " + " | ".join(str(file) for file in files) + " |\n|---|" + "---|" * len(files))
    for key in SHOWN:
        print(f"| {key} | " + " | ".join(f"{summary[key]:.3f}" for summary in summaries) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--network", type=pathlib.Path, nargs="+", default=[FILE])
    parser.add_argument("--set", dest="names", nargs="+", default=["test"], choices=[*common.SETS, *common.STYLES])
    parser.add_argument("--every", type=int, default=1, help="take every n-th frame")
    parser.add_argument("--worst", type=pathlib.Path, default=None)
    parser.add_argument("--curve", action="store_true", help="print the whole curve of all goals")
    parser.add_argument("--json", type=pathlib.Path, default=None)
    args = parser.parse_args()
    houses = frames.read_set(args.data, *args.names)
    summaries = [evaluate(file, houses, " ".join(args.names), args) for file in args.network]
    if len(summaries) > 1:
        print_side_by_side(args.network, summaries)
    if args.json:
        args.json.write_text(json.dumps(summaries[0], indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
