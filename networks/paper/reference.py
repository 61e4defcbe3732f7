#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small random networks of the paper's architectures as files for crossnav's tests, and PyTorch's output for a synthetic picture.

    reference.py OUT [NETWORK ...]

Writes each network's ONNX files (weights rounded to half precision), its card, and golden.tsv: one line for each number that the adapters
must reproduce. With --full the networks have their own size: nothing for a repository, but the same test reads it.
"""

import argparse
import pathlib
import shutil
import sys

import numpy as np
import onnx
import torch

import architectures
import export

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
MERGES = pathlib.Path(__file__).resolve().parents[2] / "tests/inference/data/tokens/merges.txt"
OTHER = "floor lamp"  # a goal without a label
TEXTS = ["chair", "a photo of a bed.", "tv monitor", "Küchentisch", "椅子"]
BEST = 3  # boxes per label


def picture(size):
    """The same numbers as in tests/inference/paper_test.cpp: rows x columns x RGB."""
    v, u = np.mgrid[0:size, 0:size]
    return np.stack([(7 * u + 3 * v) % 256, (u * v) // 8 % 256, (u * u // 16 + 5 * v) % 256], -1).astype(np.uint8)


def tensor(size, scale=1 / 255, mean=(0, 0, 0), deviation=(1, 1, 1), bgr=False):
    pixels = picture(size)[..., ::-1] if bgr else picture(size)
    x = (pixels.astype(np.float64) * scale - np.array(mean)) / np.array(deviation)
    return torch.from_numpy(x.astype(np.float32).transpose(2, 0, 1)[None].copy())


def boxes(name, found, labels, size):
    """`found`: rows of x0, y0, x1, y1, then a score for each class. The best of each label, where it is the row's best class."""
    scores, best = found[:, 4:].max(1)
    for label, goal in enumerate(labels):
        mine = [(float(s), *b.tolist()) for s, b, c in zip(scores, found[:, :4], best) if int(c) == label]
        mine = [m for m in mine if min(m[3], size) - max(m[1], 0) > 2 and min(m[4], size) - max(m[2], 0) > 2]
        for score, *box in sorted(mine, reverse=True)[:BEST]:
            yield [name, "box", goal, score, *(min(max(x, 0), size) for x in box)]


def corners(x, y, w, h):
    return torch.stack([x - w / 2, y - h / 2, x + w / 2, y + h / 2], 1)


def golden(name, made, wish):
    module, size = made.parts[0].module, made.size
    if name == "clip_text":
        yield from texts(name, made)
    elif name == "segformer_b2":
        logits = module(tensor(size, 1 / 255, [0.485, 0.456, 0.406], [0.229, 0.224, 0.225]))
        stairs = logits.softmax(1)[:, [53, 59, 121]].sum(1, keepdim=True)
        whole = torch.nn.functional.interpolate(stairs, size=(size, size), mode="bilinear", align_corners=False)[0, 0]
        for i in range(0, size, max(1, size // 8)):
            yield [name, "stairs", i, (3 * i) % size, float(whole[(3 * i) % size, i])]
    elif name == "sed":
        x = tensor(size, 1 / 255, [0.48145466, 0.4578275, 0.40821073], [0.26862954, 0.26130258, 0.27577711])
        features = module(x)[0]
        for row, col in ((0, 0), (0, features.shape[2] - 1), (features.shape[1] - 1, 0)):
            yield [name, "feature", row, col, *features[:, row, col].tolist()]
        yield from sed_texts(made)
    elif name == "mobile_sam":
        box = torch.tensor([[0.25, 0.25, 0.75, 0.875]]) * size
        x = tensor(size, 1, module.model.pixel_mean.flatten().tolist(), module.model.pixel_std.flatten().tolist())
        masks, quality = architectures.decode_box(module.model, module(x), box)
        whole = torch.nn.functional.interpolate(masks, size=(size, size), mode="bilinear", align_corners=False)[0, 0]
        yield [name, "quality", *box[0].tolist(), float(quality.clamp(0, 1))]
        yield [name, "pixels", *box[0].tolist(), int((whole > 0).sum())]
    elif name == "yolo_world_open":
        speak = speaker(wish)
        for goals in (wish.labels, [OTHER]):
            known = wish.labels + ([] if goals == wish.labels else goals)
            count = module_texts(made)
            vectors = torch.stack([speak(w.replace("_", " ")) for w in (known + known[-1:] * count)[:count]])[None]
            raw = module(tensor(size), vectors)[0].T
            found = torch.cat([corners(*raw[:, :4].T), raw[:, 4:4 + len(known)]], 1)
            yield from (row for row in boxes(name, found, known, size) if row[2] in goals)
    elif name == "rtdetr":
        labels, found, scores = module(tensor(size), torch.tensor([[size, size]]))
        table = torch.zeros(scores.shape[1], len(wish.labels))
        table[torch.arange(len(table)), labels[0]] = scores[0]
        yield from boxes(name, torch.cat([found[0], table], 1), wish.labels, size)
    elif name == "yolox":
        raw = module(tensor(size, 1, bgr=True))[0]
        cells = [(s, y, x) for s in (8, 16, 32) for y in range(size // s) for x in range(size // s)]
        stride, y, x = (torch.tensor(c, dtype=torch.float32) for c in zip(*cells))
        found = corners((raw[:, 0] + x) * stride, (raw[:, 1] + y) * stride, raw[:, 2].exp() * stride, raw[:, 3].exp() * stride)
        yield from boxes(name, torch.cat([found, raw[:, 4:5] * raw[:, 5:]], 1), wish.labels, size)
    elif name == "yolov7":
        raw = module(tensor(size))[0]
        yield from boxes(name, torch.cat([corners(*raw[:, :4].T), raw[:, 4:5] * raw[:, 5:]], 1), wish.labels, size)
    else:
        out = module(tensor(size))
        raw = (out[0] if isinstance(out, tuple) else out)[0].T
        yield from boxes(name, torch.cat([corners(*raw[:, :4].T), raw[:, 4:4 + len(wish.labels)]], 1), wish.labels, size)


def module_texts(made):
    return made.parts[0].inputs["texts"].shape[1]


def tokenizer():
    """The tests' merges as a tokenizer of transformers."""
    sys.path.insert(0, str(MERGES.parents[2]))
    import make_tokens

    return make_tokens.clip([tuple(line.split()) for line in MERGES.read_text().splitlines()[1:]])


def encoder(made):
    """A text's unit vector. Padded with the end, as transformers does."""
    tokens = tokenizer()
    length = made.parts[0].inputs["input_ids"].shape[1]

    def encode(text):
        ids = tokens(text)["input_ids"]
        ids += [ids[-1]] * (length - len(ids))
        vector = made.parts[0].module(torch.tensor([ids]))[0]
        return vector / vector.norm()

    return encode


def sed_texts(made):
    """The mean of the templates' unit vectors, as a unit vector. Padded with zeros, as open_clip does."""
    tokens = tokenizer()
    length = made.parts[1].inputs["input_ids"].shape[1]
    templates = next(line for line in made.card.splitlines() if line.startswith("templates")).split('"')[1::2]
    for text in TEXTS[:3]:
        ids = [tokens(template.format(text))["input_ids"] for template in templates]
        vectors = made.parts[1].module(torch.tensor([i + [0] * (length - len(i)) for i in ids]))
        mean = (vectors / vectors.norm(dim=1, keepdim=True)).mean(0)
        yield ["sed", "text", text, *(mean / mean.norm()).tolist()]


def texts(name, made):
    encode = encoder(made)
    for text in TEXTS:
        yield [name, "text", text, *encode(text).tolist()]


def speaker(wish):
    """The text network as `clip_text` of the same wish is written."""
    torch.manual_seed(wish.seed)
    made = architectures.clip_text(wish)
    export.set_random([part.module for part in made.parts], wish.seed)
    round_weights(made)
    return encoder(made)


def round_weights(made):
    for part in made.parts:
        for value in [*part.module.parameters(), *part.module.buffers()]:
            if value.is_floating_point():
                value.data = value.data.half().float()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("networks", nargs="*", default=list(architectures.NETWORKS))
    parser.add_argument("--full", action="store_true")
    args = parser.parse_args()
    from export import export as write
    from halve import halve

    args.out.mkdir(parents=True, exist_ok=True)
    if args.full:
        shutil.copy(MERGES, args.out)  # named by the card of yolo_world_open
    lines = {}
    golden_file = args.out / "golden.tsv"
    if golden_file.exists():
        for line in golden_file.read_text().splitlines():
            lines.setdefault(line.split("\t")[0], []).append(line)
    for name in args.networks:
        wish = architectures.Wish(small=not args.full)
        made = write(name, wish, args.out, prepare=round_weights)
        for part in made.parts:
            path = args.out / f"{name}{part.suffix}.onnx"
            if not args.full:
                onnx.save(halve(onnx.load(path)), path)
        card = args.out / f"{name}.toml"
        if card.exists():
            kept = [line for line in card.read_text().splitlines() if "sha256" not in line]
            if name != "sed":
                kept += ["[thresholds]", "score = 0.0", "nms_iou = 1.0"]
            card.write_text("\n".join(kept) + "\n")
        with torch.no_grad():
            rows = list(golden(name, made, wish))
        lines[name] = ["\t".join(f"{x:.6g}" if isinstance(x, float) else str(x) for x in row) for row in rows]
        print(name, len(rows), "lines")
    golden_file.write_text("\n".join(line for name in sorted(lines) for line in lines[name]) + "\n")


if __name__ == "__main__":
    main()
