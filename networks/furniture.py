# SPDX-License-Identifier: MIT
"""Splits a furniture pack in two by the models' names: a training part and a held-out part.

Of every kind of furniture a third of the models is held out (rounded; of two models one, of a
single one none), those with the smallest hash of their id. A part is a pack of its own: the same
geometry file with a shorter manifest.
"""

import argparse
import hashlib
import json
import os
import pathlib
import shutil
import subprocess

import common


def held_out_ids(models):
    kinds = {}
    for model in models:
        kinds.setdefault(model["kind"], []).append(model["id"])
    held = set()
    for ids in kinds.values():
        ids.sort(key=lambda name: hashlib.sha256(name.encode()).hexdigest())
        held.update(ids[: int(len(ids) / 3 + 0.5)])
    return held


def write_part(pack, out, models, manifest):
    out.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(pack / "furniture.pack", out / "furniture.pack")
    shutil.copyfile(pack / "ATTRIBUTION.md", out / "ATTRIBUTION.md")
    text = json.dumps({**manifest, "models": models}, indent=1)
    (out / "manifest.json").write_text(text + "\n", encoding="utf-8")


def split(pack, out):
    """Folders of the part to train on and of the held-out part."""
    manifest = json.loads((pack / "manifest.json").read_text(encoding="utf-8"))
    held = held_out_ids(manifest["models"])
    parts = {"train": [], "held": []}
    for model in manifest["models"]:
        parts["held" if model["id"] in held else "train"].append(model)
    for name, models in parts.items():
        write_part(pack, out / name, models, manifest)
    return out / "train", out / "held"


def program_part(program, jar, out):
    """Folder of a pack of the drawing program's own catalogue, made where it is missing; None without its archive."""
    if not (out / "manifest.json").exists():
        if not jar.exists():
            print(f"no {jar}: the package sweethome3d is not there, nor are its furniture and its homes")
            return None
        subprocess.run([program, "assets", "import", jar, "--out", out], capture_output=True, check=True)
    return out


def default_pack():
    base = os.environ.get("XDG_DATA_HOME") or pathlib.Path.home() / ".local/share"
    return pathlib.Path(base) / "crossnav/furniture"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pack", type=pathlib.Path, default=default_pack())
    parser.add_argument("--data", type=pathlib.Path, default=common.DATA)
    args = parser.parse_args()
    train, held = split(args.pack, args.data / "furniture")
    for part in (train, held):
        models = json.loads((part / "manifest.json").read_text(encoding="utf-8"))["models"]
        counts = {}
        for model in models:
            counts[model["kind"]] = counts.get(model["kind"], 0) + 1
        print(f"{part.name}: {len(models)} models,", ", ".join(
            f"{n} {kind}" for kind, n in sorted(counts.items())))


if __name__ == "__main__":
    main()
