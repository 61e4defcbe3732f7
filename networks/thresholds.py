# SPDX-License-Identifier: MIT
"""Chooses the card's thresholds on the development houses: prints the curves, changes only the card.

Of each goal: the lowest score with at most 0.01 false claims a frame. Held-out houses are never read.
"""

import argparse
import pathlib
import re

import common
import evaluate
import frames
import metrics
import numpy as np
from export import FILE
from runtime import Runtime

FALSE_PER_FRAME = 0.01  # chosen: a search has a hundred frames or more, and a single claim ends it


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--network", type=pathlib.Path, default=FILE)
    args = parser.parse_args()
    table = np.load(common.REPO / "networks/text_vectors.npy").astype(np.float32)
    tally = evaluate.run(Runtime(args.network), frames.read_set(args.data, *common.DEV_SETS), table)
    chosen = []
    for name in common.GOALS:
        curve = tally.curve(name)
        chosen.append(metrics.at_false_rate(curve, FALSE_PER_FRAME)[0])
        print(f"{name}: {chosen[-1]:.2f}")
        for score, recall, false in curve[::9]:
            print(f"  score {score:.2f}: recall {recall:.3f}, false claims a frame {false:.3f}")
    for row in tally.stairs.rows():
        print("stairs {:.1f}: pixel IoU {:.3f}, image precision {:.3f}, image recall {:.3f}".format(*row))
    card = args.network.with_suffix(".toml")
    text = card.read_text(encoding="utf-8")
    line = "heat = [" + ", ".join(f"{value:.2f}" for value in chosen) + "]"
    card.write_text(re.sub(r"(?m)^heat = \[.*\]", line, text), encoding="utf-8")
    print(f"{card.name}: {line}")


if __name__ == "__main__":
    main()
