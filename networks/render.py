# SPDX-License-Identifier: MIT
"""Makes houses and renders their frames: one process a house and verb, arrays on disk.

Existing houses are kept, so that an interrupted run resumes. The sets take turns, so that training may begin before all
are there.
"""

import argparse
import concurrent.futures
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import time

import common
import furniture

PROGRAM = common.REPO / "build/release/apps/crossnav/crossnav"


def house_options(name, seed, parts):
    """Every tenth training house of edition 1, and every fourth of edition 2, has simple shapes only; two of ten
    have the faults of a scan."""
    edition = common.SETS[name].get("edition", 1)
    furniture = parts[common.SETS[name]["furniture"]]
    if furniture == parts["train"] and name in common.TRAIN_SETS and seed % (10 if edition == 1 else 4) == 0:
        furniture = "none"
    scan = ["--scan"] if seed % 5 == 3 else []
    return ["--furniture", furniture, "--edition", edition, *common.SETS[name].get("options", []), *scan]


def generate(name, seed, parts):
    """Arguments that make a house."""
    return ["world", "generate", "--seed", seed, "--count", 1, "--floors", 0, *house_options(name, seed, parts)]


def imports(style, parts):
    """(folder of the frames, arguments that make the scene, seed) for each scene of a style."""
    for seed, home in enumerate(style.get("homes", []), 1):
        yield home, ["scene", "import", style["input"], "--home", home, "--name", home], seed
    for seed in style.get("furnish", []):
        name = f"{style['input'].stem}{seed}"
        yield name, ["scene", "import", style["input"], "--name", name, "--furnish", seed,
                     "--furniture", parts["held"]], seed


def scenes_of(name, parts):
    if name in common.STYLES:
        return list(imports(common.STYLES[name], parts))
    return [(f"{seed:05}", generate(name, seed, parts), seed) for seed in common.SETS[name]["seeds"]]


def models_of(scene):
    """Furniture models with credits, of a generated house."""
    for house in scene.glob("*.house.json"):
        return sorted(credit["id"] for credit in json.loads(house.read_text(encoding="utf-8"))["credits"])
    return []


def render_scene(program, make, count, seed, out):
    """Makes a scene, renders `count` frames into `out`, and removes the scene."""
    made = out.parent / f".scene-{out.name}"
    shutil.rmtree(made, ignore_errors=True)
    run = subprocess.run([str(a) for a in [program, *make, "--out", made]], capture_output=True, text=True, check=False)
    if run.returncode != 0:  # a few seeds fail the generator's gate
        print(f"{out.name}: {run.stderr.strip().splitlines()[-1]}")
        return
    scene = next(p for p in made.iterdir() if p.is_dir())
    frames = [program, "scene", "frames", scene, "--count", count, "--size", common.STORED_PX, "--seed", seed, "--out", out]
    subprocess.run([str(a) for a in frames], capture_output=True, check=True)
    (out / "models.json").write_text(json.dumps(models_of(scene)) + "\n", encoding="utf-8")
    shutil.rmtree(made)


def can_make(name, parts):
    """Whether the package is there that the set's homes or furniture are of."""
    if name in common.STYLES:
        return common.STYLES[name]["input"].exists()
    return parts[common.SETS[name]["furniture"]] is not None


def missing_of(data, name, parts):
    if not can_make(name, parts):
        return []
    folder = data / name
    folder.mkdir(parents=True, exist_ok=True)
    count = (common.STYLES.get(name) or common.SETS[name])["frames"]
    wanted = [(make, count, seed, folder / scene) for scene, make, seed in scenes_of(name, parts)]
    return [job for job in wanted if not (job[-1] / "models.json").exists()]


def in_turn(lists):
    """One of each list, then the next of each."""
    return [job for turn in itertools.zip_longest(*lists) for job in turn if job is not None]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--pack", type=pathlib.Path, default=furniture.default_pack())
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--sets", nargs="+", default=[*common.SETS, *common.TRAIN_STYLES])
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="houses at a time")
    args = parser.parse_args()
    train, held = furniture.split(args.pack, args.data / "furniture")
    parts = {"train": train, "held": held,
             "program": furniture.program_part(args.program, common.HOMES_JAR, args.data / "furniture/program")}
    start, jobs = time.time(), in_turn([missing_of(args.data, name, parts) for name in args.sets])
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for done, _ in enumerate(pool.map(lambda job: render_scene(args.program, *job), jobs), 1):
            if done % 10 == 0:
                print(f"{done} of {len(jobs)} scenes, {time.time() - start:.0f} s", flush=True)
    for name in args.sets:
        print(f"{name}: {len(list((args.data / name).glob('*/models.json')))} scenes", flush=True)


if __name__ == "__main__":
    main()
