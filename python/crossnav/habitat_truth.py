# SPDX-License-Identifier: MIT
"""Ground truth for the Habitat-Lab agent: perception that reads Habitat's semantic sensor.

For tests, and for runs that say so: no robot has such a sensor. Needs no Habitat: it reads arrays
and the names of `simulator.semantic_scene`. See docs/habitat.md of the repository.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import crossnav
from crossnav import Error

STAIR_NAMES = frozenset({"stairs", "staircase", "stair"})
_STAIR_PROBABILITY = 0.9  # as our own simulator's ground truth
_CELLS, _DIM = 24, 128    # of the dense features
_COMMON_SHARE = 0.5       # cosine of unrelated names, as our own ground truth


def instance_names(semantic_scene: Any) -> dict[int, str]:
    """Raw name by id of the semantic sensor, from `simulator.semantic_scene` of habitat-sim.

    Id 0 is Habitat's "Unknown", and no instance.
    """
    names = {}
    for thing in semantic_scene.objects:
        if thing is None or thing.category is None or thing.semantic_id <= 0:
            continue
        names[int(thing.semantic_id)] = str(thing.category.name())
    if not names:
        raise Error("has no named objects: has the scene a semantic mesh and text?",
                    "semantic_scene")
    return names


@dataclass
class SeenInstance:
    """An instance in the current image."""

    mask: NDArray[np.bool_]
    box: tuple[int, int, int, int]  # [u0, u1) x [v0, v1) in pixels
    pixels: int
    nearest_m: float                # planar depth


class SemanticTruth:
    """Perception answered from the semantic image of the current observations.

        truth = SemanticTruth(instance_names(simulator.semantic_scene))
        agent = HabitatAgent(truth.perception, ...)
        action = agent.act(truth.look(observations))

    The rules of visibility are those of our own simulator (`ground_truth.*` of the settings):
    `min_visible_px` pixels, within `max_distance_m`.
    """

    def __init__(self, names: Mapping[int, str],
                 category_of: Callable[[str], str] = crossnav.category_of,
                 config: crossnav.Settings = None, key: str = "semantic") -> None:
        """`category_of` maps a raw name to a goal, or to ""; `key`: of the semantic image."""
        self.names = {int(i): name.strip().lower() for i, name in names.items()}
        self.categories = {i: category_of(name) for i, name in self.names.items()}
        self.key = key
        settings = crossnav.Config(config).to_dict()["ground_truth"]
        self.min_visible_px = int(settings["min_visible_px"])
        self.max_distance_m = float(settings["max_distance_m"])
        self._ids: NDArray[np.int64] | None = None
        self._rgb: NDArray[np.uint8] | None = None
        self.perception = crossnav.Perception(
            _TrueDetector(self), _TrueSegmenter(self), _TrueStairs(self), _TrueEncoder(self))

    def look(self, observations: Mapping[str, Any]) -> Mapping[str, Any]:
        """Keeps the semantic image for the step that follows; returns `observations`."""
        for key in (self.key, "rgb"):
            if key not in observations:
                raise Error("is missing: add its sensor to the task", f"observations.{key}")
        ids = np.asarray(observations[self.key])
        ids = ids[..., 0] if ids.ndim == 3 else ids
        if ids.ndim != 2 or not np.issubdtype(ids.dtype, np.integer):
            raise Error(f"must be H x W (x 1) integers, is {ids.dtype} {ids.shape}",
                        f"observations.{self.key}")
        self._ids = ids.astype(np.int64)
        self._rgb = np.array(np.asarray(observations["rgb"])[..., :3], dtype=np.uint8)
        return observations

    def ids_of(self, observation: crossnav.Observation) -> NDArray[np.int64]:
        """H x W ids of the semantic sensor for this observation."""
        if self._ids is None or self._rgb is None or not np.array_equal(self._rgb,
                                                                        observation.rgb):
            raise Error("was asked about other observations than the last ones it looked at: "
                        "agent.act(truth.look(observations))", "SemanticTruth")
        if self._ids.shape != observation.depth_m.shape:
            raise Error(f"is {self._ids.shape}, but depth is {observation.depth_m.shape}",
                        f"observations.{self.key}")
        return self._ids

    def is_wanted(self, instance: int, goal: str) -> bool:
        """Whether the instance is of the category `goal`, or has `goal` as its raw name."""
        if goal in crossnav.CATEGORIES:
            return self.categories.get(instance, "") == goal
        return self.names.get(instance) == goal

    def seen(self, observation: crossnav.Observation, instance: int) -> SeenInstance | None:
        """Where the instance is in the image; None if it is too small or too far away."""
        mask = self.ids_of(observation) == instance
        pixels = int(mask.sum())
        if pixels < max(1, self.min_visible_px):
            return None
        rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        box = (int(cols[0]), int(rows[0]), int(cols[-1]) + 1, int(rows[-1]) + 1)
        depths_m = observation.depth_m[mask]
        measured_m = depths_m[depths_m > 0]
        nearest_m = float(measured_m.min()) if measured_m.size else float("inf")
        if nearest_m > self.max_distance_m:
            return None
        return SeenInstance(mask, box, pixels, nearest_m)


class _TrueDetector(crossnav.Detector):
    """Boxes of the true instances; the confidence grows with size and falls with distance."""

    def __init__(self, truth: SemanticTruth) -> None:
        super().__init__()
        self.truth = truth

    def detect(self, observation: crossnav.Observation, goal: str) -> list[crossnav.Detection]:
        found = []
        for instance in np.unique(self.truth.ids_of(observation)):
            if not self.truth.is_wanted(int(instance), goal):
                continue
            seen = self.truth.seen(observation, int(instance))
            if seen is not None:
                found.append(crossnav.Detection(seen.box, self._confidence(seen)))
        return sorted(found, key=lambda d: -d.confidence)

    def _confidence(self, seen: SeenInstance) -> float:
        """As our own ground truth: 0.5 for something barely seen, up to 0.98."""
        by_size = 0.98 - 0.48 * 2 ** (-seen.pixels / seen.mask.size / 0.02)
        by_distance = 0.2 * min(seen.nearest_m / self.truth.max_distance_m, 1.0)
        return float(np.clip(by_size - by_distance + 0.1, 0.0, 0.98))


class _TrueSegmenter(crossnav.Segmenter):
    """The visible pixels of the instance whose own box fits the asked box best."""

    def __init__(self, truth: SemanticTruth) -> None:
        super().__init__()
        self.truth = truth

    def segment(self, observation: crossnav.Observation, box: tuple[int, int, int, int]
                ) -> tuple[NDArray[Any], float]:
        ids = self.truth.ids_of(observation)
        u0, v0, u1, v1 = box
        inside = np.zeros(ids.shape, dtype=bool)
        inside[v0:v1, u0:u1] = True
        candidates = [int(i) for i in np.unique(ids[v0:v1, u0:u1]) if i != 0]
        if not candidates:
            return np.zeros(ids.shape, dtype=np.uint8), 0.0
        best = max(candidates, key=lambda i: self._score(ids == i, box, i))
        return (inside & (ids == best)).astype(np.uint8), 1.0

    def _score(self, mask: NDArray[np.bool_], box: tuple[int, int, int, int],
               instance: int) -> float:
        """Intersection over union of the boxes; walls often fill more of a box than its object."""
        rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        own = (cols[0], rows[0], cols[-1] + 1, rows[-1] + 1)
        width = min(own[2], box[2]) - max(own[0], box[0])
        height = min(own[3], box[3]) - max(own[1], box[1])
        shared = max(0, width) * max(0, height)
        areas = sum((b[2] - b[0]) * (b[3] - b[1]) for b in (own, box))
        return float(shared / (areas - shared)) + (
            0.5 if self.truth.categories.get(instance) else 0.0)


class _TrueStairs(crossnav.StairSegmenter):
    def __init__(self, truth: SemanticTruth) -> None:
        super().__init__()
        self.truth = truth
        self.stairs = [i for i, name in truth.names.items() if name in STAIR_NAMES]

    def segment_stairs(self, observation: crossnav.Observation) -> NDArray[Any]:
        is_stair = np.isin(self.truth.ids_of(observation), self.stairs)
        return np.where(is_stair, np.float32(_STAIR_PROBABILITY), np.float32(0))


class _TrueEncoder(crossnav.DenseEncoder):
    """A vector for each name. A cell of the image has the mean of what it shows."""

    def __init__(self, truth: SemanticTruth) -> None:
        super().__init__()
        self.truth = truth
        self.vectors: dict[str, NDArray[np.float32]] = {}

    def dim(self) -> int:
        return _DIM

    def name(self) -> str:
        return "habitat-ground-truth"

    def encode_text(self, text: str) -> NDArray[Any]:
        word = text.strip().lower().replace("_", " ")
        return self._vector((crossnav.category_of(word) or word).replace("_", " "))

    def encode_image(self, observation: crossnav.Observation) -> NDArray[Any]:
        ids, where = np.unique(self.truth.ids_of(observation), return_inverse=True)
        where = where.reshape(observation.depth_m.shape)
        looks = np.stack([self._look(int(i)) for i in ids])
        height, width = (int(n) for n in observation.depth_m.shape)
        cells = (np.arange(height) * _CELLS // height)[:, None] * _CELLS + (
            np.arange(width) * _CELLS // width)[None, :]
        counts = np.zeros((_CELLS * _CELLS, ids.size), np.float32)
        np.add.at(counts, (cells, where), 1)
        shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
        return np.asarray(shares @ looks).reshape(_CELLS, _CELLS, _DIM)

    def _look(self, instance: int) -> NDArray[np.float32]:
        raw = self.truth.names.get(instance, "unknown")
        return self._vector((self.truth.categories.get(instance) or raw).replace("_", " "))

    def _vector(self, name: str) -> NDArray[np.float32]:
        """Unit vector of a name: a direction that all share, and one of its own."""
        if name not in self.vectors:
            vector = (np.sqrt(_COMMON_SHARE) * _direction("")
                      + np.sqrt(1 - _COMMON_SHARE) * _direction(name))
            self.vectors[name] = (vector / np.linalg.norm(vector)).astype(np.float32)
        return self.vectors[name]


def _direction(name: str) -> NDArray[np.float64]:
    """Unit vector, the same in every process."""
    seed = [1, *name.encode()]
    vector = np.random.default_rng(seed).normal(size=_DIM)
    return np.asarray(vector / np.linalg.norm(vector))
