# SPDX-License-Identifier: MIT
"""Writes text_vectors.npy: a unit vector for each class of the dense head, in the order of common.CLASSES.

Vectors are CLIP ViT-B/32's of the OpenImages and LVIS names, less their mean: CLIP's vectors of any two words have a
cosine of 0.7 to 0.9, so that a search for "toilet" did not stand out from other furniture. Walls, floors, ceilings and
railings are in neither list: theirs are seeded random directions, at right angles to all others, so that no word
resembles them.
"""

import json

import common
import numpy as np

CLIP = common.SHARED / "data/clip"
TABLE = common.REPO / "networks/text_vectors.npy"


def named_vectors():
    lvis = json.loads((CLIP / "lvis_v1_train_cat_info.json").read_text(encoding="utf-8"))
    oid = (CLIP / "oid_names.txt").read_text(encoding="utf-8").splitlines()
    vectors = {}
    for names, file in (([row["name"] for row in lvis], "lvis_v1_clip_a+cname.npy"),
                        (oid, "oid_clip_a+cname.npy")):
        for name, row in zip(names, np.load(CLIP / file).astype(np.float64), strict=True):
            vectors[name.strip().lower().replace("_", " ")] = row / np.linalg.norm(row)
    return vectors


def centred(vectors):
    """Unit vectors without the part that all of them share."""
    mean = np.mean(list(vectors.values()), axis=0)
    return {name: (row - mean) / np.linalg.norm(row - mean) for name, row in vectors.items()}


def table():
    all_names = named_vectors()
    vectors = centred({source: all_names[source] for _, source, _ in common.CLASSES if source})
    rows = list(vectors.values())
    basis = np.linalg.qr(np.array(rows).T)[0]
    random, out = np.random.default_rng(1), []
    for _, source, _ in common.CLASSES:
        row = vectors[source] if source else random.standard_normal(basis.shape[0])
        if not source:
            row = row - basis @ (basis.T @ row)
            row /= np.linalg.norm(row)
            basis = np.column_stack([basis, row])
        out.append(row)
    return np.array(out)


if __name__ == "__main__":
    vectors = table()
    np.save(TABLE, vectors.astype(np.float16))
    likeness = vectors @ vectors.T - 2 * np.eye(len(vectors))
    row, column = np.unravel_index(likeness.argmax(), likeness.shape)
    print(f"{TABLE.name}: {vectors.shape}, most alike: {common.CLASS_NAMES[row]} and "
          f"{common.CLASS_NAMES[column]}, {likeness.max():.2f}")
