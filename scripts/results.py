#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs a suite in every variant and writes docs/results.md.

  scripts/results.py SUITE [--jobs N] [--out FILE] [EVAL OPTION...]

e.g. scripts/results.py crossnav-mfmon-1-val-pack --jobs 2. What was run before is not run again:
a run that was cut off goes on. CROSSNAV names the program.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("CROSSNAV", str(ROOT / "build/release/apps/crossnav/crossnav"))
VARIANTS = ("full", "no-history-poi", "planar", "paper")


def crossnav(*words: str) -> str:
    done = subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"crossnav {' '.join(words)}: exit status {done.returncode}")
    return done.stdout


def percent(figure: dict, value: str = "value") -> str:
    return "-" if figure is None else "{:.1f} [{:.1f}, {:.1f}]".format(
        *(100 * figure[key] for key in (value, "low", "high")))


def row(name: str, metrics: dict, names: tuple) -> str:
    return f"| {name} | " + " | ".join(percent(metrics.get(n)) for n in names) + " |"


def table(title: str, names: tuple, rows: list) -> list:
    return [f"| {title} | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|", *rows, ""]


def head() -> str:
    done = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"],
                          stdout=subprocess.PIPE, text=True, check=False)
    return done.stdout.strip() or "no commit"


def page(suite: str, options: list, runs: dict, comparisons: list, commit: str) -> str:
    any_run = next(iter(runs.values()))
    required = any_run["groups"]["cfr"]["episodes"]
    command = " ".join(["scripts/results.py", suite, *options])
    lines = [
        "# Results", "",
        f"The suite `{suite}`: {any_run['episodes']} episodes of {any_run['goals']} goals, "
        f"{required} of which require a floor change. Values in percent, with 95 % intervals by "
        f"bootstrap over episodes. Ground-truth perception. Measured at `{commit}`, written by", "",
        f"```\n{command}\n```", ""]
    if any_run["episodes"] < 100:
        lines += ["Fewer than a hundred episodes are an anecdote: read the intervals.", ""]
    names = ("SR", "SPL", "PR", "PPL")
    lines += table("variant", names, [row(f"`{v}`", r["metrics"], names) for v, r in runs.items()])
    lines += ["Episodes that require a floor change:", ""]
    lines += table("variant", names, [row(f"`{v}`", r["groups"]["cfr"]["metrics"], names)
                                      for v, r in runs.items()])
    goals = range(1, any_run["goals"] + 1)
    lines += ["By goal, of the episodes that reached it:", ""]
    names = tuple(f"{m}_cond_{k}" for m in ("SR", "SPL") for k in goals)
    lines += table("variant", names, [row(f"`{v}`", r["metrics"], names) for v, r in runs.items()])
    lines += ["Pairwise, episode by episode, resampled by house; positive where the second is "
              "better:", ""]
    for comparison in comparisons:
        pair = f"`{comparison['before']}` to `{comparison['after']}`"
        differences = comparison["differences"]
        shown = [f"{n} {percent(differences[n], 'difference')}" for n in ("SR", "SPL")]
        lines.append(f"- {pair}: " + ", ".join(shown))
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("suite")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--commit", default=head(), help="which CROSSNAV is of, if not HEAD")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results.md")
    args, options = parser.parse_known_args()
    place = Path("out/suites") / args.suite
    runs, comparisons = {}, []
    for variant in VARIANTS:
        crossnav("suite", "run", args.suite, "--variant", variant, "--jobs", str(args.jobs),
                 *options)
        folder = place / "runs" / variant
        runs[variant] = json.loads(crossnav("metrics", str(folder / "results.jsonl"), "--json", "--quiet"))
        if variant == "full":
            continue
        found = json.loads(crossnav("report", str(folder), str(place / "runs/full"), "--out",
                                    str(place / "compared" / variant), "--json", "--quiet"))
        comparisons += found["comparisons"]
    args.out.write_text(page(args.suite, options, runs, comparisons, args.commit), encoding="utf-8")
    print(args.out)


if __name__ == "__main__":
    main()
