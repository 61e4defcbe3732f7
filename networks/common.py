# SPDX-License-Identifier: MIT
"""Constants common to the pipeline: folders, sets of houses, goals, classes."""

import os
import pathlib

REPO = pathlib.Path(__file__).resolve().parent.parent
DATA = REPO / "build/networks"  # ignored by git
SHARED = REPO.parent / "shared"

INPUT_PX = 256  # chosen: the largest size with all heads and some masks below 15 ms on one core
STORED_PX = 320  # of rendered frames
HFOV_DEG = 90.0
FOCAL_PX = INPUT_PX / 2  # of the network's own pictures, HFOV_DEG wide: their depth is in metres, see Sample.inputs

# In the order of kCategories (crossnav/core/categories.h).
GOALS = ["chair", "bed", "plant", "toilet", "tv_monitor", "sofa"]

# Seeds of generated houses, the generator's edition, other options and their part of the furniture. Held-out seeds begin at
# 5001; held-out furniture appears in sets with `test` in their name only.
VARIED = ["--varied", "--area", 70]  # small rooms, furniture of uncommon sizes in uncommon places
SETS = {
    "train": {"seeds": range(2001, 2105), "furniture": "train", "frames": 120},
    "train-2": {"seeds": range(3001, 3105), "furniture": "train", "frames": 120, "edition": 2},
    "train-3": {"seeds": range(3201, 3361), "furniture": "program", "frames": 120, "edition": 2},
    "train-4": {"seeds": range(3401, 3561), "furniture": "program", "frames": 120, "edition": 2, "options": VARIED},
    "train-5": {"seeds": range(3601, 3761), "furniture": "train", "frames": 120, "edition": 2, "options": VARIED},
    "dev": {"seeds": range(2901, 2907), "furniture": "train", "frames": 60},
    "dev-2": {"seeds": range(3901, 3907), "furniture": "train", "frames": 60, "edition": 2},
    "test": {"seeds": range(5101, 5111), "furniture": "held", "frames": 60},
    "test-2": {"seeds": range(6101, 6111), "furniture": "held", "frames": 60, "edition": 2},
}
TRAIN_SETS, DEV_SETS, TEST_SETS = ["train", "train-2", "train-3", "train-4", "train-5"], ["dev", "dev-2"], ["test", "test-2"]

# The archive of the package `sweethome3d`: nine homes that people drew, and the catalogue of furniture that they
# are furnished from. Two homes are trained on, as is the catalogue (`program` furniture). The other homes, and a
# building of an architect with held-out furniture, are evaluation only.
HOMES_JAR = pathlib.Path(os.environ.get("SWEETHOME3D_JAR", "/usr/share/sweethome3d/sweethome3d.jar"))
LOOKED_AT = ["3BedroomHouseWithMezzanine", "4BedroomHouse"]  # their pictures were seen in development
HOMES = ["1BedroomApartmentWithRoundWall", "2BedroomApartment", "2BedroomApartmentWithBowWindow",
         "2BedroomHouseWithBasement", "3BedroomApartment", "3BedroomHouseWithAttic", "Studio"]
STYLES = {
    "train-drawn": {"input": HOMES_JAR, "homes": LOOKED_AT, "frames": 1600},
    "drawn": {"input": HOMES_JAR, "homes": HOMES, "frames": 120},
    "building": {"input": SHARED / "data/ifc/Duplex.ifc", "furnish": [1, 2, 3], "frames": 100},
}
TRAIN_STYLES = ["train-drawn"]

# Seats that look like another goal but for their size; frames that show them are drawn more often.
LOOKALIKES = {"armchair", "ottoman", "stool", "bench"}
STAIR_NAMES = {"stairs", "staircase", "stair"}

# Classes of the dense head: their name (goals in the benchmark's spelling), the name with their
# CLIP text vector (None: no word of the lists fits, the vector is synthetic), the raw names that
# mean them.
CLASSES = [
    ("chair", "chair", ["chair", "dining chair", "office chair", "armchair"]),
    ("bed", "bed", ["bed", "single bed", "double bed", "bunk bed", "loft bed"]),
    ("plant", "houseplant", ["plant", "potted plant", "houseplant", "flowers"]),
    ("toilet", "toilet", ["toilet"]),
    ("tv_monitor", "television", ["tv", "television", "computer monitor", "monitor"]),
    ("sofa", "couch", ["couch", "sofa", "corner sofa"]),
    ("stairs", "stairs", ["stairs", "staircase", "stair"]),
    ("stool", "stool", ["stool", "ottoman"]),
    ("bench", "bench", ["bench"]),
    ("table", "table", ["dining table", "table"]),
    ("desk", "desk", ["desk"]),
    ("coffee table", "coffee table", ["coffee table"]),
    ("bookcase", "bookcase", ["bookcase", "bookshelf"]),
    ("wardrobe", "wardrobe", ["wardrobe"]),
    ("chest of drawers", "chest of drawers", ["chest of drawers", "dresser"]),
    ("bedside table", "nightstand", ["bedside table", "nightstand"]),
    ("cabinet", "cabinetry", ["kitchen cabinet", "kitchen upper cabinet", "kitchen lower cabinet",
                                 "bathroom cabinet", "cabinet", "tv stand"]),
    ("refrigerator", "refrigerator", ["refrigerator"]),
    ("stove", "gas stove", ["stove", "oven"]),
    ("sink", "sink", ["sink", "washbasin"]),
    ("bathtub", "bathtub", ["bathtub"]),
    ("shower", "shower", ["shower"]),
    ("mirror", "mirror", ["mirror"]),
    ("picture", "picture frame", ["picture"]),
    ("window", "window", ["window"]),
    ("curtain", "curtain", ["curtain"]),
    ("door", "door", ["door", "door frame"]),
    ("lamp", "lamp", ["floor lamp", "table lamp", "ceiling lamp", "wall lamp"]),
    ("box", "box", ["box", "basket"]),
    ("trash can", "waste container", ["trash can"]),
    ("vase", "vase", ["vase", "bowl"]),
    ("book", "book", ["book"]),
    ("laptop", "laptop", ["laptop"]),
    ("rug", "runner (carpet)", ["rug"]),
    ("wall", None, ["wall"]),
    ("floor", None, ["floor"]),
    ("ceiling", None, ["ceiling"]),
    ("railing", None, ["railing"]),
]
CLASS_NAMES = [name for name, _, _ in CLASSES]
CLASS_OF = {raw: index for index, (_, _, raws) in enumerate(CLASSES) for raw in raws}
