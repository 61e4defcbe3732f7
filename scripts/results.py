#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs a suite in every variant and writes docs/results.md: ours, and every table of the paper.

  scripts/results.py SUITE [--jobs N] [--every K] [--out FILE] [EVAL OPTION...]

e.g. scripts/results.py crossnav-mfmon-1-val-pack --jobs 2. Existing results are reused:
an interrupted run resumes. --every 3 runs episodes 1, 4, 7, ... of each house. A suite with tracks
gets a section for each track, and no pooled figure (--homes and --buildings as for `suite run`).
CROSSNAV names the program.
"""

import argparse
import gzip
import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("CROSSNAV", str(ROOT / "build/release/apps/crossnav/crossnav"))
# The methods of the paper's tables, then ours. Comparisons are with the last of its list.
METHODS = ("onemap", "paper-no-history-poi", "paper")
OURS = ("planar", "no-history-poi", "no-history-poi-pure", "full")
VARIANTS = (*reversed(OURS), *reversed(METHODS))
# tab:single_object_results has no row without History POIs: one goal has no history.
SINGLE = ("onemap", "paper")
SINGLE_CONFIG = ROOT / "config/objectnav_paper.toml"
# Options of `suite run` that `eval` lacks.
OF_HOUSES = ("--homes", "--buildings", "--furniture")


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


def sections(report: str) -> dict:
    """Title to text of the level-2 sections of a report."""
    parts = report.split("\n## ")[1:]
    return {part.split("\n", 1)[0]: part.split("\n", 1)[1].strip() for part in parts}


def paper_tables(report: str, methods: tuple) -> list:
    """The report's tables beside the paper's, one heading level deeper.

    Without its plots, which stand in files beside it, and without its comparisons: the page has
    its own.
    """
    found = sections(report)
    lines = []
    for title, text in found.items():
        if title not in methods and title != "Plots" and not title.endswith(", paired"):
            lines += [f"### {title}", "", text, ""]
    for method in methods:
        if method in found and "### Outcomes" in found[method]:
            outcomes = found[method].split("### Outcomes", 1)[1].split("\n### ", 1)[0].strip()
            lines += [f"### Outcomes of `{method}`", "", outcomes, ""]
    return lines


def section(runs: dict, comparisons: list, papers: list, depth: int) -> list:
    """Tables of a suite or of one track; `runs`: documents of `metrics` by variant."""
    any_run = next(iter(runs.values()))
    required = any_run["groups"]["cfr"]["episodes"]
    lines = [f"{any_run['episodes']} episodes of {any_run['goals']} goals, {required} of which "
             "require a floor change.", ""]
    if any_run["episodes"] < 100:
        lines += ["Fewer than a hundred episodes are an anecdote: read the intervals.", ""]
    names = ("SR", "SPL", "PR", "PPL")
    lines += table("variant", names, [row(f"`{v}`", r["metrics"], names) for v, r in runs.items()])
    if required:
        lines += ["Episodes that require a floor change:", ""]
        lines += table("variant", names, [row(f"`{v}`", r["groups"]["cfr"]["metrics"], names)
                                          for v, r in runs.items()])
    goals = range(1, any_run["goals"] + 1)
    lines += ["By goal, of the episodes that reached it:", ""]
    names = tuple(f"{m}_cond_{k}" for m in ("SR", "SPL") for k in goals)
    lines += table("variant", names, [row(f"`{v}`", r["metrics"], names) for v, r in runs.items()])
    lines += ["Pairwise, episode by episode, resampled by house; positive where the second is "
              "better:", "", *map(comparison_line, comparisons)]
    return lines + ["", "#" * depth + " The paper's tables", "",
                    "Its methods on these episodes, and its own figures, which were taken on HM3D "
                    "with networks and are no target.", "",
                    *(line.replace("### ", "#" * (depth + 1) + " ", 1) for line in papers)]


def comparison_line(comparison: dict) -> str:
    differences = comparison["differences"]
    shown = [f"{n} {percent(differences[n], 'difference')}" for n in ("SR", "SPL")]
    return f"- `{comparison['before']}` to `{comparison['after']}`: " + ", ".join(shown)


def page(suite: str, every: int, options: list, tracks: dict, commit: str) -> str:
    """`tracks`: (runs, comparisons, papers) by track, "" for a suite without tracks."""
    part = [] if every == 1 else ["--every", str(every)]
    command = " ".join(["scripts/results.py", suite, *part, *options])
    which = f", one of every {every} episodes of a house" if part else ""
    lines = [
        "# Results", "",
        f"The suite `{suite}`{which}. Values in percent, with 95 % intervals by bootstrap over "
        f"episodes. Ground-truth perception. Measured at `{commit}`, written by", "",
        f"```\n{command}\n```", ""]
    for name, measured in tracks.items():
        lines += [*([f"## Track {name}", ""] if name else []),
                  *section(*measured, depth=3 if name else 2), ""]
    return "\n".join(lines).rstrip() + "\n"


def report_of(folders: list, place: Path) -> dict:
    """The comparisons of the runs; `place` gets report.md."""
    return json.loads(crossnav("report", *(str(f) for f in folders), "--out", str(place), "--json",
                               "--quiet"))


def run_suite(suite: str, jobs: str, options: list) -> None:
    for variant in VARIANTS:
        crossnav("suite", "run", suite, "--variant", variant, "--jobs", jobs, *options)


def run_part(place: Path, every: int, jobs: str, options: list) -> Path:
    """Runs one of every `every` episodes of a house; a folder with `runs`, as that of a suite."""
    part = place / f"every-{every}"
    file = part / "episodes.json.gz"
    if not file.exists():
        document = json.loads(gzip.decompress((place / file.name).read_bytes()))
        kept, seen = [], Counter()  # seen: by house, as a suite goes round its houses
        for episode in document["episodes"]:
            if seen[episode["scene_id"]] % every == 0:
                kept.append(episode)
            seen[episode["scene_id"]] += 1
        document["episodes"] = kept
        part.mkdir(exist_ok=True)
        file.write_bytes(gzip.compress(json.dumps(document).encode(), mtime=0))
    for variant in VARIANTS:
        crossnav("eval", "--scenes", str(place / "scenes"), "--episodes", str(file), "--variant",
                 variant, "--out", str(part / "runs" / variant), "--jobs", jobs,
                 *parted(OF_HOUSES, options)[1])
    return part


def tracks_of(place: Path) -> dict:
    """Folders of the tracks that `suite run` made, by name; the suite's own where it has none."""
    if (place / "manifest.json").exists():
        return {"": place}
    manifests = sorted(place.glob("*/manifest.json"))
    return {manifest.parent.name: manifest.parent for manifest in manifests} or {"": place}


def measured(place: Path) -> tuple:
    """(metrics by variant, comparisons) of a track's folder."""
    runs, comparisons = {}, []
    for variants in (OURS, METHODS):
        for variant in reversed(variants):
            folder = place / "runs" / variant
            runs[variant] = json.loads(crossnav("metrics", str(folder / "results.jsonl"), "--json",
                                                "--quiet"))
            if variant == variants[-1]:
                continue
            against = place / "runs" / variants[-1]
            comparisons += report_of([folder, against], place / "compared" / variant)["comparisons"]
    return runs, comparisons


def parted(names: tuple, options: list) -> tuple:
    """(those of `names`, the others) of `options`, written as "--homes JAR" or as "--homes=JAR"."""
    parts, is_value = ([], []), False
    for word in options:
        is_named = is_value or word.split("=")[0] in names
        is_value = word in names
        parts[0 if is_named else 1].append(word)
    return parts


def run_single(place: Path, scenes: Path, episodes: int, jobs: str, options: list) -> list:
    """Single-object navigation in the suite's houses, in the paper's frozen configuration."""
    single = place / "single"
    file = single / "episodes.json.gz"
    if not file.exists():
        crossnav("episodes", "generate", "--scenes", str(scenes), "--count",
                 str(episodes), "--goals", "1", "--seed", "7", "--out", str(file))
    for variant in SINGLE:
        crossnav("eval", "--config", str(SINGLE_CONFIG), "--scenes", str(scenes),
                 "--episodes", str(file), "--variant", variant, "--out", str(single / variant),
                 "--jobs", jobs, *parted((*OF_HOUSES, "--config"), options)[1])
    report_of([single / variant for variant in SINGLE], single / "report")
    lines = paper_tables((single / "report/report.md").read_text(encoding="utf-8"), ())[:4]
    note = (f"{episodes} episodes of one goal in the suite's houses, in the paper's frozen "
            f"configuration, `{SINGLE_CONFIG.relative_to(ROOT)}`.")
    return [*lines[:2], note, "", *lines[2:]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("suite")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--every", type=int, default=1, metavar="K",
                        help="one of every K episodes of a house")
    parser.add_argument("--commit", default=head(), help="which CROSSNAV is of, if not HEAD")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results.md")
    args, options = parser.parse_known_args()
    suite, jobs = Path("out/suites") / args.suite, str(args.jobs)
    if args.every < 1:
        parser.error("--every is at least 1")
    if args.every == 1:
        run_suite(args.suite, jobs, options)
    else:
        crossnav("suite", "make", args.suite, "--jobs", jobs, *parted(OF_HOUSES, options)[0])
    tracks = {}
    for name, place in tracks_of(suite).items():
        scenes = place / "scenes"
        if args.every > 1:
            place = run_part(place, args.every, jobs, options)
        runs, comparisons = measured(place)
        report_of([place / "runs" / method for method in METHODS], place / "paper")
        papers = paper_tables((place / "paper/report.md").read_text(encoding="utf-8"), METHODS)
        papers += run_single(place, scenes, runs["full"]["episodes"], jobs, options)
        tracks[name] = runs, comparisons, papers
    text = page(args.suite, args.every, options, tracks, args.commit)
    args.out.write_text(text, encoding="utf-8")
    print(args.out)


if __name__ == "__main__":
    main()
