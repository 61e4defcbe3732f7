# SPDX-License-Identifier: MIT
"""Episodes in the Rerun viewer: live, or of a replay.

`python -m crossnav.rerun REPLAY.mcap --to r.rrd`; needs `pip install "crossnav[rerun]"`. World
frame, z up, metres. Timelines: `step`, and `sim_time`, 0.1 s a step. docs/python.md lists the
entities.
"""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from crossnav._errors import Error

if TYPE_CHECKING:
    import rerun as rr

    from crossnav import Agent, Observation, StepResult
    from crossnav.rerun.replay import Frame, Replay

PathLike = Union[str, "os.PathLike[str]"]
MAP_EVERY = 10
"""Steps between two drawings of the whole map."""


def _needed() -> None:
    """Raises crossnav.Error where the packages of the extra are not installed."""
    try:
        import google.protobuf  # type: ignore[import-untyped]  # noqa: F401
        import mcap  # noqa: F401
        import mcap_protobuf  # noqa: F401
        import PIL  # noqa: F401
        import rerun  # noqa: F401
    except ImportError as error:
        raise Error(f'needs {error.name}: pip install "crossnav[rerun]"', "crossnav.rerun",
                    "not_found") from None


def _recording(given: "rr.RecordingStream | None") -> "rr.RecordingStream":
    import rerun as rr
    found = given if given is not None else rr.get_data_recording()
    if found is None:
        raise Error('no recording: call rerun.init("crossnav") first, or give one',
                    "crossnav.rerun")
    return found


def log(result: "StepResult", observation: "Observation | None" = None,
        agent: "Agent | None" = None, recording: "rr.RecordingStream | None" = None,
        map_every: int = MAP_EVERY) -> None:
    """Draws a step that an agent just made.

    `observation` adds image and depth, `agent` its map: whole every `map_every` steps and where
    the goal changes, and in every step the voxels that changed. `recording` is rerun's current one
    where left out. Raises crossnav.Error without one, and where rerun is not installed.
    """
    _needed()
    from crossnav.rerun import draw
    from crossnav.rerun.replay import Camera
    stream = _recording(recording)
    record = result.trace
    draw.set_time(stream, record["step"])
    if record["step"] == 0:
        draw.statics(stream)
    draw.step_record(stream, record)
    if observation is not None:
        if observation.rgb_camera is not None:  # boxes are on the grid of depth
            observation = observation.registered()
        k = observation.camera
        camera = Camera(k.width_px, k.height_px,
                        np.array([[k.fx, 0, k.cx], [0, k.fy, k.cy], [0, 0, 1]]))
        draw.image(stream, observation.rgb, camera)
        draw.depth(stream, observation.depth_m, 1.0, camera)
    if agent is not None:
        draw.changes(stream, *result.voxel_changes, agent.map.voxel_m)
        if record["step"] % max(1, map_every) == 0 or record["action"] == "stop":
            keys, states, _ = agent.map.voxels()
            draw.voxels(stream, keys, states, agent.map.voxel_m)


class _Drawing:
    """State carried from frame to frame of a replay."""

    def __init__(self, replay: "Replay", stream: "rr.RecordingStream", map_every: int) -> None:
        self.stream, self.map_every = stream, max(1, map_every)
        self.voxel_m = float(replay.info["voxel_m"])
        self.goals = len(replay.info["goals"])
        self.states: dict[tuple[int, int, int], int] = {}
        self.stale: set[int] = set()
        self.feet: list[list[float]] = []
        self.steps = 0

    def frame(self, frame: "Frame") -> None:
        from crossnav.rerun import draw
        draw.set_time(self.stream, round(frame.time_s / draw.STEP_S))
        if frame.changes is not None:
            self._changes(*frame.changes)
        if frame.step is not None:
            if self.steps % self.map_every == 0 or frame.step["action"] == "stop":
                self.map()
            self.steps += 1
            draw.step_record(self.stream, {**frame.step, "events": []}, self.goals)
            self.feet.append(frame.step["agent"]["p_world"])
            draw.trail(self.stream, self.feet)
        self._pictures(frame)
        for level, text in frame.logs:
            draw.message(self.stream, level, text)
        for stage in frame.stages:
            draw.stage(self.stream, stage)

    def _changes(self, keys: Any, values: Any) -> None:
        from crossnav.rerun import draw
        from crossnav.rerun.replay import INFLATED
        states = values % INFLATED
        draw.changes(self.stream, keys, states, self.voxel_m)
        for key, state in zip(map(tuple, keys.tolist()), states.tolist(), strict=True):
            before = self.states.pop(key, 0)
            if state:
                self.states[key] = state
            if state != before:
                self.stale |= {state, before} - {0}

    def map(self) -> None:
        """Draws the states that changed since they were drawn last."""
        from crossnav.rerun import draw
        keys = np.array(list(self.states), np.int32).reshape(-1, 3)
        states = np.fromiter(self.states.values(), np.uint8, len(self.states))
        draw.voxels(self.stream, keys, states, self.voxel_m, sorted(self.stale))
        self.stale.clear()

    def _pictures(self, frame: "Frame") -> None:
        from crossnav.rerun import draw
        if frame.camera is None:
            return
        if frame.jpeg is not None:
            draw.image(self.stream, frame.jpeg, frame.camera)
        if frame.depth_mm is not None:
            draw.depth(self.stream, frame.depth_mm, 1000.0, frame.camera)
        if frame.sight is not None:
            draw.boxes(self.stream, frame.sight, frame.camera)
        if frame.maps_png is not None:
            draw.maps(self.stream, frame.maps_png, frame.sight, frame.camera)


def _draw(replay: "Replay", stream: "rr.RecordingStream", map_every: int) -> int:
    from crossnav.rerun import draw
    drawing = _Drawing(replay, stream, map_every)
    draw.statics(stream, replay.info)
    for frame in replay.frames():
        try:
            drawing.frame(frame)
        except (KeyError, TypeError, ValueError, IndexError, OSError) as error:
            raise Error(f"damaged at {frame.time_s:.1f} s: {type(error).__name__}: {error}",
                        str(replay.path), "malformed") from None
    drawing.map()
    return drawing.steps


def log_replay(path: PathLike, recording: "rr.RecordingStream | None" = None,
               map_every: int = MAP_EVERY) -> int:
    """Draws all of a replay (docs/formats/replay.md); returns the number of steps.

    `recording` is rerun's current one where left out. The whole map is drawn every `map_every`
    steps, at the end of a goal and at the end; `world/changes` has every step's changes. Raises
    crossnav.Error: no recording, no rerun, or a file that is missing, cut off or damaged.
    """
    _needed()
    from crossnav.rerun.replay import Replay
    stream = _recording(recording)
    with Replay(Path(path)) as replay:
        return _draw(replay, stream, map_every)


def write_recording(replay: PathLike, out: PathLike, map_every: int = MAP_EVERY) -> int:
    """Writes a replay as a Rerun recording with its layout; returns the number of steps.

    The file is whole or not there. Raises crossnav.Error as `log_replay`, and where `out` cannot
    be written or does not end in .rrd.
    """
    target = Path(out)
    if target.suffix != ".rrd":
        raise Error("must end in .rrd", f"--to {target}")
    _needed()
    import rerun as rr

    from crossnav.rerun.layout import blueprint
    from crossnav.rerun.replay import Replay
    part = target.with_name(target.name + ".part")
    with Replay(Path(replay)) as opened:
        try:
            part.touch()
        except OSError as error:
            raise Error(f"cannot be written: {error.strerror}", f"--to {target}", "io") from None
        stream = rr.RecordingStream("crossnav", recording_id=str(opened.info["episode_id"]))
        try:
            stream.save(part, default_blueprint=blueprint())
            steps = _draw(opened, stream, map_every)
            stream.flush()
            stream.disconnect()
            part.replace(target)
        except OSError as error:
            raise Error(f"cannot be written: {error.strerror}", f"--to {target}", "io") from None
        finally:
            stream.disconnect()
            part.unlink(missing_ok=True)
    return steps


def write_graph(graph: PathLike, out: PathLike) -> int:
    """Writes a map's graph (JSON of `crossnav map graph`) as a recording; the number of its objects.

    The file is whole or not there. Raises crossnav.Error where the graph cannot be read, and where
    `out` cannot be written or does not end in .rrd.
    """
    target = Path(out)
    if target.suffix != ".rrd":
        raise Error("must end in .rrd", f"--to {target}")
    _needed()
    import rerun as rr

    from crossnav.rerun.graph import draw_graph, read_graph
    found = read_graph(graph)
    part = target.with_name(target.name + ".part")
    stream = rr.RecordingStream("crossnav", recording_id="graph")
    try:
        part.touch()
        stream.save(part)
        draw_graph(stream, found)
        stream.flush()
        stream.disconnect()
        part.replace(target)
    except OSError as error:
        raise Error(f"cannot be written: {error.strerror}", f"--to {target}", "io") from None
    finally:
        stream.disconnect()
        part.unlink(missing_ok=True)
    return len(found["objects"])
