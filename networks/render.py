# SPDX-License-Identifier: MIT
"""Makes houses and renders their frames: one process a house and verb, arrays on disk.

Existing houses are kept, so that an interrupted run resumes.
"""

import argparse
import concurrent.futures
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
    """Every tenth training house has simple shapes only, two of ten the faults of a scan."""
    options = ["--furniture", str(parts[common.SETS[name]["furniture"]])]
    if name == "train" and seed % 10 == 0:
        options = ["--furniture", "none"]
    if seed % 5 == 3:
        options.append("--scan")
    return options


def render_house(program, name, seed, parts, out):
    made = out.parent / f".house{seed}"
    shutil.rmtree(made, ignore_errors=True)
    generate = [program, "world", "generate", "--seed", seed, "--count", 1, "--floors", 0,
                "--out", made, *house_options(name, seed, parts)]
    run = subprocess.run([str(a) for a in generate], capture_output=True, text=True, check=False)
    if run.returncode != 0:  # a few seeds fail the generator's gate
        print(f"{name} {seed}: {run.stderr.strip().splitlines()[-1]}")
        return
    scene = next(p for p in made.iterdir() if p.is_dir())
    frames = [program, "scene", "frames", scene, "--count", common.SETS[name]["frames"],
              "--size", common.STORED_PX, "--seed", seed, "--out", out]
    subprocess.run([str(a) for a in frames], capture_output=True, check=True)
    house = json.loads(next(scene.glob("*.house.json")).read_text(encoding="utf-8"))
    models = sorted(credit["id"] for credit in house["credits"])
    (out / "models.json").write_text(json.dumps(models) + "\n", encoding="utf-8")
    shutil.rmtree(made)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    parser.add_argument("--pack", type=pathlib.Path, default=furniture.default_pack())
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--sets", nargs="+", default=list(common.SETS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="houses at a time")
    args = parser.parse_args()
    train, held = furniture.split(args.pack, args.data / "furniture")
    parts = {"train": train, "held": held}
    for name in args.sets:
        start = time.time()
        folder = args.data / name
        folder.mkdir(parents=True, exist_ok=True)
        wanted = [(seed, folder / f"{seed:05}") for seed in common.SETS[name]["seeds"]]
        missing = [(seed, out) for seed, out in wanted if not (out / "models.json").exists()]
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            made = pool.map(lambda house: render_house(args.program, name, house[0], parts, house[1]), missing)
            for done, _ in enumerate(made, 1):
                if done % 10 == 0:
                    print(f"{name}: {done} of {len(missing)} houses, {time.time() - start:.0f} s", flush=True)
        print(f"{name}: {len(list(folder.glob('*/models.json')))} houses, "
              f"{time.time() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
