#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How well a COCO detector knows the objects in pictures written by `crossnav scene views`.

    scripts/detector_recall.py --model MODEL.onnx... VIEWS...

VIEWS are folders with a views.json (docs/formats/views.md). A model is an ONNX file with the inputs
`images` f32 [1, 3, S, S] (RGB, 0 to 1, plain resize) and `orig_target_sizes` i64 [1, 2] (width,
height), and the outputs `labels` (COCO's 80 classes from 0), `boxes` (x0 y0 x1 y1, picture pixels)
and `scores`. Needs onnxruntime, numpy and Pillow (docs/reproduce.md).

A view counts as recognised if a detection of the right class with enough confidence overlaps the
box of the object's visible pixels by IoU >= 0.5; "centre" asks only that the object's box holds the
detection's centre. False alarms are the detections of the six classes whose box overlaps no
visible object of that class by 0.5 and whose centre lies in none.
"""
import argparse
import collections
import json
import pathlib
import sys

try:
    import numpy as np
    import onnxruntime
    from PIL import Image, ImageDraw
except ImportError as error:
    np, MISSING = None, error.name  # the scoring below works without it
else:
    MISSING = None

# Our category -> COCO's class, counted from 0.
COCO = {"chair": 56, "sofa": 57, "plant": 58, "bed": 59, "toilet": 61, "tv_monitor": 62}
CATEGORY = {label: category for category, label in COCO.items()}
MIN_IOU = 0.5
NMS_IOU = 0.7


def open_model(path):
    """(session, side of its input in pixels)."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(str(path), options,
                                           providers=["CPUExecutionProvider"])
    return session, session.get_inputs()[0].shape[2]


def iou(a, b):
    """Intersection over union of two boxes."""
    width = min(a[2], b[2]) - max(a[0], b[0])
    height = min(a[3], b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0.0
    both = width * height
    return both / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both)


def suppress(detections):
    """Non-maximum suppression per class; best first."""
    kept = []
    for category, score, box in sorted(detections, key=lambda d: -d[1]):
        if all(category != other or iou(box, better) < NMS_IOU for other, _, better in kept):
            kept.append((category, score, box))
    return kept


def detect(model, picture, confidence):
    """[(category, score, box)] of our six classes, best first, after non-maximum suppression."""
    session, side = model
    small = picture.resize((side, side), Image.Resampling.BILINEAR)
    pixels = np.asarray(small, dtype=np.float32).transpose(2, 0, 1)[None] / 255
    size = np.array([[picture.width, picture.height]], dtype=np.int64)
    labels, boxes, scores = session.run(
        ["labels", "boxes", "scores"], {"images": pixels, "orig_target_sizes": size})
    return suppress([(CATEGORY[int(label)], float(score), [float(x) for x in box])
                     for label, box, score in zip(labels[0], boxes[0], scores[0])
                     if score >= confidence and int(label) in CATEGORY])


def holds_centre(outer, box):
    """Whether the centre of `box` lies in `outer`."""
    x, y = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    return outer[0] <= x <= outer[2] and outer[1] <= y <= outer[3]


def judge(view, detections):
    """(recognised, recognised by centre, best wrong class on the object or None)."""
    right = [box for category, _, box in detections if category == view["category"]]
    wrong = [category for category, _, box in detections
             if category != view["category"] and iou(box, view["box"]) >= MIN_IOU]
    return (any(iou(box, view["box"]) >= MIN_IOU for box in right),
            any(holds_centre(view["box"], box) for box in right), wrong[0] if wrong else None)


def false_alarms(view, detections):
    """[(category, raw name of the object in the box)]."""
    alarms = []
    for category, _, box in detections:
        truths = [o["box"] for o in view["objects"] if o["category"] == category]
        if any(iou(box, t) >= MIN_IOU or holds_centre(t, box) for t in truths):
            continue
        best = max(view["objects"], key=lambda o: iou(box, o["box"]), default=None)
        on_it = best is not None and iou(box, best["box"]) > 0
        alarms.append((category, best["name"] if on_it else "nothing"))
    return alarms


def draw(picture, view, detections, path):
    """Saves the picture with the object's box (green) and the detections (red)."""
    sketch = ImageDraw.Draw(picture)
    sketch.rectangle(view["box"], outline=(0, 255, 0))
    for category, score, box in detections:
        sketch.rectangle(box, outline=(255, 0, 0))
        sketch.text((box[0] + 3, box[1] + 2), f"{category} {score:.2f}", fill=(255, 0, 0))
    picture.save(path)


def measure(model, folders, confidence, drawings):
    """Counters per category, and of the false alarms."""
    counts = {category: collections.Counter() for category in COCO}
    alarms = collections.Counter()
    for folder in folders:
        document = json.loads((folder / "views.json").read_text(encoding="utf-8"))
        for view in document["views"]:
            picture = Image.open(folder / view["file"]).convert("RGB")
            detections = detect(model, picture, confidence)
            by_box, by_centre, wrong = judge(view, detections)
            count = counts[view["category"]]
            count.update(views=1, box=by_box, centre=by_centre)
            count.update({("views", view["name"]): 1, ("box", view["name"]): int(by_box)})
            if wrong and not by_box:
                count["taken", wrong] += 1
            alarms.update(false_alarms(view, detections))
            if drawings:
                verdict = "found" if by_box else "missed"
                draw(picture, view, detections,
                     drawings / f"{verdict}_{document['scene']}_{view['file']}")
    return counts, alarms


def share(part, whole):
    return f"{part / whole:.2f}" if whole else "-"


def table(counts, alarms):
    """Markdown rows."""
    per_class = collections.Counter()
    for (category, _), n in alarms.items():
        per_class[category] += n
    views = sum(count["views"] for count in counts.values())
    lines = ["| category | views | recognised | recall | recall (centre) | false alarms a picture |",
             "|---|---|---|---|---|---|"]
    total = collections.Counter()
    for category, count in counts.items():
        total.update(box=count["box"], centre=count["centre"])
        lines.append(f"| {category} | {count['views']} | {count['box']} | "
                     f"{share(count['box'], count['views'])} | "
                     f"{share(count['centre'], count['views'])} | "
                     f"{share(per_class[category], views)} |")
    lines.append(f"| **all** | {views} | {total['box']} | {share(total['box'], views)} | "
                 f"{share(total['centre'], views)} | {share(sum(per_class.values()), views)} |")
    return lines


def details(counts, alarms):
    """Lines on the objects' raw names, and on the confusions of misses and false alarms."""
    for category, count in counts.items():
        names = sorted(key[1] for key in count if key[0] == "views")
        yield f"{category}: " + ", ".join(
            f"{name} {count['box', name]} of {count['views', name]}" for name in names)
    for category, count in counts.items():
        taken = [f"{key[1]} {n}" for key, n in count.most_common() if key[0] == "taken"]
        if taken:
            yield f"missed {category} taken for: {', '.join(taken)}"
    for category in COCO:
        where = [f"{name} {n}" for (c, name), n in alarms.most_common() if c == category][:6]
        if where:
            yield f"false {category} on: {', '.join(where)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("views", nargs="+", type=pathlib.Path, help="folders with views.json")
    parser.add_argument("--model", action="append", required=True, type=pathlib.Path)
    parser.add_argument("--confidence", type=float, default=0.3)
    parser.add_argument("--draw", type=pathlib.Path, help="folder for pictures with the boxes")
    options = parser.parse_args()
    if MISSING:
        print(f"detector_recall: no Python module {MISSING}; see docs/reproduce.md",
              file=sys.stderr)
        return 1
    missing = [f for f in [*options.model, *(v / "views.json" for v in options.views)]
               if not f.is_file()]
    if missing:
        print(f"detector_recall: no such file: {missing[0]}; `crossnav scene views` writes views",
              file=sys.stderr)
        return 1
    for path in options.model:
        drawings = options.draw / path.stem if options.draw else None
        if drawings:
            drawings.mkdir(parents=True, exist_ok=True)
        counts, alarms = measure(open_model(path), options.views, options.confidence, drawings)
        print(f"\n{path.name}, confidence >= {options.confidence}, {len(options.views)} scenes\n")
        print("\n".join(table(counts, alarms)))
        print("\n" + "\n".join(details(counts, alarms)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
