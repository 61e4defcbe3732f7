# SPDX-License-Identifier: MIT
"""Drawing of a step in Rerun: one function a subject. World frame, z up, metres."""

import io
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from PIL import Image

from crossnav.rerun.replay import Camera

STEP_S = 0.1
"""A step's length on the timeline sim_time, as in replays."""

# The colours of crossnav/trace/foxglove.cpp.
STATES = {1: ("occupied", (201, 205, 212)), 2: ("traversable", (120, 190, 140)),
          3: ("traversable_stair", (250, 214, 120)), 4: ("traversable_fake", (200, 220, 240)),
          5: ("stair", (245, 159, 0)), 6: ("stair_expanded", (240, 120, 40)),
          7: ("fake_stair", (190, 75, 150))}
SEEN_THROUGH = (1, 2, 4)  # small points, so that paths and boxes stay visible
KINDS = {"live_poi": (214, 51, 108), "history_poi": (156, 54, 181),
         "traversable_frontier": (28, 126, 214), "descend_frontier": (232, 89, 12),
         "ascent_frontier": (245, 159, 0), "stair_frontier": (245, 159, 0)}
TRAIL_PIECE = 50  # steps
OTHER_KIND = (90, 90, 90)
MASKS = {0: ("", (0, 0, 0, 0)), 1: ("goal", (235, 60, 60)), 2: ("stairs", (60, 200, 90))}
_LEVELS = {"DEBUG": rr.TextLogLevel.DEBUG, "WARNING": rr.TextLogLevel.WARN,
           "ERROR": rr.TextLogLevel.ERROR, "FATAL": rr.TextLogLevel.CRITICAL}
_CENTRE = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])  # in Rerun a pixel's edge is whole


def statics(recording: rr.RecordingStream, info: dict[str, Any] | None = None) -> None:
    """Static content: axes, names of classes, and the replay's true goals."""
    recording.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    classes = [rr.AnnotationInfo(id=number, label=name, color=colour)
               for number, (name, colour) in MASKS.items()]
    recording.log("world/camera/image", rr.AnnotationContext(classes), static=True)
    goals = info["goal_instances"] if info else []
    if goals:
        low = np.array([goal["box_min"] for goal in goals])
        high = np.array([goal["box_max"] for goal in goals])
        recording.log("world/goals", rr.Boxes3D(
            centers=(low + high) / 2, sizes=high - low, labels=[goal["goal"] for goal in goals],
            colors=(214, 51, 108)), static=True)


def set_time(recording: rr.RecordingStream, step: int) -> None:
    recording.set_time("step", sequence=step)
    recording.set_time("sim_time", duration=step * STEP_S)


def voxels(recording: rr.RecordingStream, keys: NDArray[np.int32], states: NDArray[np.uint8],
           voxel_m: float, only: Iterable[int] = tuple(STATES)) -> None:
    """The map: keys (N, 3) and VoxelStates (N,); one entity a state. `only`: the states to log."""
    for state in only:
        name, colour = STATES[state]
        centres = (keys[states == state] + 0.5) * voxel_m
        radius = voxel_m / (10 if state in SEEN_THROUGH else 2)
        recording.log(f"world/map/{name}", rr.Points3D(centres, radii=radius, colors=colour))


def changes(recording: rr.RecordingStream, keys: NDArray[np.int32], states: NDArray[np.uint8],
            voxel_m: float) -> None:
    """Voxels changed by this step; voxels that became unknown are black."""
    table = np.zeros((max(STATES) + 1, 3), np.uint8)
    for state, (_, colour) in STATES.items():
        table[state] = colour
    recording.log("world/changes", rr.Points3D((keys + 0.5) * voxel_m, radii=voxel_m / 2,
                                               colors=table[states]))


def step_record(recording: rr.RecordingStream, record: dict[str, Any],
                goals: int | None = None) -> None:
    """All of a step's record: pose, camera's place, path, candidates, scores, status."""
    agent = record["agent"]
    p, yaw = np.array(agent["p_world"], float), agent["yaw_rad"]
    recording.log("world/agent", rr.Transform3D(
        translation=p, rotation=rr.RotationAxisAngle(axis=(0, 0, 1), radians=yaw)))
    recording.log("world/agent/heading", rr.Arrows3D(
        origins=[[0, 0, 0.1]], vectors=[[0.4, 0, 0]], colors=(20, 120, 220), radii=0.03))
    T = np.array(record["T_world_camera"], float).reshape(3, 4)
    recording.log("world/camera", rr.Transform3D(translation=T[:, 3], mat3x3=T[:, :3]))
    path = record["path_world"]
    recording.log("world/plan/path", rr.LineStrips3D([path] if len(path) > 1 else [],
                                                     colors=(20, 120, 220), radii=0.03))
    _flights(recording, record.get("flights"))
    _candidates(recording, record["candidates"])
    _scores(recording, record)
    number = record["goal_index"] + 1
    of = f" of {goals}" if goals else ""
    lines = [f"# {record['goal']}",
             f"goal {number}{of}, step {record['step']}: **{record['action']}**", "",
             f"{record['mode']}: {record['reason']}", "", f"activity: {record.get('activity', '')}"]
    recording.log("status", rr.TextDocument("\n".join(lines),
                                            media_type=rr.MediaType.MARKDOWN))
    for event in record["events"]:
        recording.log("log", rr.TextLog(event, level=rr.TextLogLevel.INFO))


def trail(recording: rr.RecordingStream, feet: Sequence[Sequence[float]]) -> None:
    """The path so far through `feet`. It is drawn in pieces, an entity each, which
    keep their last drawing: the cost of a step does not grow with the path."""
    if len(feet) < 2:
        return
    piece = (len(feet) - 2) // TRAIL_PIECE
    points = np.array(feet[piece * TRAIL_PIECE:], float)
    recording.log(f"world/trail/{piece}", rr.LineStrips3D([points], colors=(20, 120, 220),
                                                          radii=0.03))


def _finite(value: Any) -> bool:
    return value is not None and math.isfinite(value)


def _flights(recording: rr.RecordingStream, flights: list[dict[str, Any]] | None) -> None:
    """Drawn after a change only; the view keeps the last drawing."""
    if flights is None:
        return
    walked = [flight["walked_up"] + flight["walked_down"] > 0 for flight in flights]
    recording.log("world/flights", rr.LineStrips3D(
        [flight["steps_world"] for flight in flights], colors=(95, 58, 18),
        radii=[0.03 if is_walked else 0.01 for is_walked in walked],
        labels=[f"flight {flight['id']}, {'walked' if is_walked else 'seen'}"
                for flight, is_walked in zip(flights, walked, strict=True)]))


def _candidates(recording: rr.RecordingStream, candidates: list[dict[str, Any]]) -> None:
    shown = [c for c in candidates if all(map(_finite, c["p_nav_world"]))]
    recording.log("world/plan/candidates", rr.Points3D(
        [c["p_nav_world"] for c in shown], radii=0.08,
        colors=[KINDS.get(c["kind"], OTHER_KIND) for c in shown],
        labels=[f"{c['kind']} {c['score']:.2f}" if _finite(c["score"]) else c["kind"]
                for c in shown], show_labels=False))
    target = [c for c in shown if c["is_target"]]
    recording.log("world/plan/target", rr.Points3D(
        [c["p_nav_world"] for c in target], radii=0.16, colors=(214, 51, 108),
        labels=[c["kind"] for c in target]))


def _scores(recording: rr.RecordingStream, record: dict[str, Any]) -> None:
    scores: dict[str, float] = {}
    for candidate in record["candidates"]:
        kind, score = candidate["kind"], candidate["score"]
        if _finite(score):
            path = f"scores/best/{kind}"
            scores[path] = max(score, scores.get(path, score))
            if candidate["is_target"]:
                scores["scores/target"] = score
    scores["counts/candidates"] = len(record["candidates"])
    scores["counts/detections"] = record["detections"]
    claim = record["verification"]
    if claim["is_active"]:
        for key in ("confidence", "mask_quality", "visibility"):
            if _finite(claim[key]):
                scores[f"claim/{key}"] = claim[key]
    for path, score in scores.items():
        recording.log(path, rr.Scalars(score))


def _pinhole(recording: rr.RecordingStream, path: str, camera: Camera) -> None:
    recording.log(path, rr.Pinhole(
        image_from_camera=_CENTRE @ camera.K, width=camera.width_px, height=camera.height_px,
        camera_xyz=rr.ViewCoordinates.RDF, image_plane_distance=0.5))


def image(recording: rr.RecordingStream, picture: bytes | NDArray[np.uint8],
          camera: Camera) -> None:
    """A JPEG, or H x W x 3 pixels, as `camera` sees it."""
    _pinhole(recording, "world/camera/image", camera)
    if isinstance(picture, bytes):
        entity: Any = rr.EncodedImage(contents=picture, media_type="image/jpeg")
    else:
        entity = rr.Image(picture).compress(jpeg_quality=85)
    recording.log("world/camera/image", entity)


def depth(recording: rr.RecordingStream, pixels: NDArray[Any], per_m: float,
          camera: Camera) -> None:
    """H x W planar depth, 0 where invalid; `per_m` units are a metre. Any size of the view."""
    height, width = pixels.shape
    _pinhole(recording, "world/camera/depth", camera.resized(width, height))
    recording.log("world/camera/depth", rr.DepthImage(pixels, meter=per_m))


def boxes(recording: rr.RecordingStream, sight: dict[str, Any], camera: Camera) -> None:
    """The detector's boxes of the goal, in the pixels of the drawn image."""
    found = sight["boxes"]
    scale = np.array([camera.width_px / max(1, sight["width_px"]),
                      camera.height_px / max(1, sight["height_px"])] * 2)
    corners = np.array([[b["u0"], b["v0"], b["u1"], b["v1"]] for b in found], float)
    corners = corners.reshape(-1, 4) * scale
    recording.log("world/camera/image/boxes", rr.Boxes2D(
        mins=corners[:, :2], sizes=corners[:, 2:] - corners[:, :2], colors=(235, 60, 60),
        labels=[f"{b['confidence']:.2f} (mask {b['mask_quality']:.2f})" for b in found]))
    if found:
        recording.log("scores/detector", rr.Scalars(max(b["confidence"] for b in found)))


def maps(recording: rr.RecordingStream, png: bytes, sight: dict[str, Any] | None,
         camera: Camera) -> None:
    """Masks over the image, and the similarity to the goal's text (cosines) beside it."""
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    large = np.asarray(picture.resize((camera.width_px, camera.height_px),
                                      Image.Resampling.NEAREST))
    classes = np.where(large[:, :, 0] > 127, 1, np.where(large[:, :, 1] > 127, 2, 0))
    recording.log("world/camera/image/masks",
                  rr.SegmentationImage(classes.astype(np.uint8), opacity=0.5))
    low, high = (sight or {}).get("similarity_min"), (sight or {}).get("similarity_max")
    if low is not None and high is not None:
        blue = np.asarray(picture)[:, :, 2].astype(np.float32) / 255
        recording.log("similarity", rr.DepthImage(low + (high - low) * blue, meter=1.0,
                                                  colormap="viridis", depth_range=(0, 1)))
        recording.log("scores/similarity_max", rr.Scalars(high))


def stage(recording: rr.RecordingStream, record: dict[str, Any]) -> None:
    """The evaluator's word on a goal."""
    text = (f"{record['goal']}: {record['outcome']}, {record['length_m']:.2f} m "
            f"(shortest {record['shortest_m']:.2f} m)")
    level = rr.TextLogLevel.INFO if record["success"] else rr.TextLogLevel.WARN
    recording.log("log", rr.TextLog(text, level=level))


def message(recording: rr.RecordingStream, level: str, text: str) -> None:
    recording.log("log", rr.TextLog(text, level=_LEVELS.get(level, rr.TextLogLevel.INFO)))
