# SPDX-License-Identifier: MIT
"""crossnav as an agent of Habitat-Lab. Needs no Habitat: it reads observation dictionaries.

Habitat's frame is y up and -z forward, ours z up and x forward: world = (-z_h, -x_h, y_h). The
world of an episode is its start: the origin at the first foot point, x the first heading.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import crossnav
from crossnav import Action, Error

ACTION_IDS: Mapping[Action, int] = {
    Action.STOP: 0, Action.MOVE_FORWARD: 1, Action.TURN_LEFT: 2, Action.TURN_RIGHT: 3,
    Action.LOOK_UP: 4, Action.LOOK_DOWN: 5,
}
"""Habitat's ids of the six discrete actions, as in its ObjectNav tasks."""


def world_from_habitat(p_habitat: ArrayLike) -> NDArray[np.float64]:
    """(..., 3) metres, y up and -z forward -> z up, x forward, y left."""
    p = np.asarray(p_habitat, dtype=np.float64)
    return np.stack([-p[..., 2], -p[..., 0], p[..., 1]], axis=-1)


def habitat_from_world(p_world: ArrayLike) -> NDArray[np.float64]:
    """Inverse of world_from_habitat."""
    p = np.asarray(p_world, dtype=np.float64)
    return np.stack([-p[..., 1], p[..., 2], -p[..., 0]], axis=-1)


def foot_from_gps(gps: ArrayLike, flat_world: bool = False) -> NDArray[np.float64]:
    """(3,) foot point in the episode's world [m] from Habitat's episodic GPS.

    Three numbers are a point in Habitat's frame. Two are (forward, right) without a height, which
    is enough on one floor only: `flat_world` says that there is but one.
    """
    p = np.asarray(gps, dtype=np.float64).reshape(-1)
    if not np.isfinite(p).all():
        raise Error("is not finite", "observations.gps")
    if p.size == 3:
        return world_from_habitat(p)
    if p.size == 2 and flat_world:
        return np.array([p[0], -p[1], 0.0])
    raise Error("must have 3 numbers (gps_sensor.dimensionality: 3): floors differ in height; on "
                "one floor, ask for flat_world", "observations.gps")


def yaw_from_compass(compass: ArrayLike) -> float:
    """Yaw [rad], counter-clockwise from the first heading: the compass reading."""
    yaw = float(np.asarray(compass, dtype=np.float64).reshape(-1)[0])
    if not np.isfinite(yaw):
        raise Error("is not finite", "observations.compass")
    return yaw


class DepthScale:
    """Habitat's depth sensor: its limits, and whether it scales them to [0, 1]."""

    def __init__(self, min_depth_m: float = 0.0, max_depth_m: float = 10.0,
                 is_normalized: bool = True) -> None:
        if not 0 <= min_depth_m < max_depth_m:
            raise Error("must be 0 <= min_depth_m < max_depth_m", "depth_sensor")
        self.min_depth_m = min_depth_m
        self.max_depth_m = max_depth_m
        self.is_normalized = is_normalized

    def metres(self, depth: ArrayLike) -> NDArray[np.float32]:
        """H x W (x 1) -> H x W planar [m]. Clipped near = 0, unknown; clipped far = beyond it."""
        d = np.asarray(depth, dtype=np.float32)
        d = d[..., 0] if d.ndim == 3 else d
        span_m = self.max_depth_m - self.min_depth_m
        share = d if self.is_normalized else (d - self.min_depth_m) / np.float32(span_m)
        metres = np.float32(self.min_depth_m) + share * np.float32(span_m)
        metres = np.where(share <= 0, 0, metres)
        metres = np.where(share >= 1, 2 * self.max_depth_m, metres)
        return np.ascontiguousarray(metres, dtype=np.float32)


class HabitatAgent:
    """`habitat.Agent` by shape: ``reset()`` and ``act(observations)``.

    Observations: ``rgb`` H x W x 3 uint8, ``depth`` H x W x 1 float32, ``gps`` (3,) and
    ``compass`` (1,) from the episode's start, ``objectgoal`` (1,) int. Another goal, or the call
    after a STOP, starts the next stage with the same memory.
    """

    def __init__(self, perception: crossnav.Perception, config: crossnav.Settings = None,
                 depth: DepthScale | None = None,
                 goal_names: Sequence[str] = crossnav.CATEGORIES,
                 flat_world: bool = False) -> None:
        """`goal_names[objectgoal]` is the goal; the default is HM3D ObjectNav's order."""
        self._perception = perception
        self._depth = depth or DepthScale()
        self._goal_names = tuple(goal_names)
        self._flat_world = flat_world
        settings = crossnav.Config(config).to_dict()
        # Readings at the sensor's limit are no surface.
        settings["map"]["depth_max_m"] = min(settings["map"]["depth_max_m"],
                                             self._depth.max_depth_m)
        self.config = crossnav.Config(settings)
        sensor = settings["sensor"]
        self._camera = crossnav.CameraIntrinsics.from_hfov(
            sensor["width_px"], sensor["height_px"], sensor["hfov_deg"])
        self._camera_height_m = float(sensor["camera_height_m"])
        self._pitch_rad = float(np.deg2rad(settings["action"]["pitch_deg"]))
        self._max_pitch_rad = float(np.deg2rad(settings["action"]["max_pitch_deg"]))
        self.reset()

    def reset(self) -> None:
        """Forgets everything: a new episode."""
        self.agent = crossnav.Agent(self._perception, self.config)
        self.last_result: crossnav.StepResult | None = None
        self._goal: str | None = None
        self._looking_rad = 0.0

    def act(self, observations: Mapping[str, Any]) -> int:
        """The id of the next action (ACTION_IDS); STOP too when nothing is left to explore."""
        goal = self._goal_of(observations)
        if goal != self._goal:
            self.agent.set_goal(goal)
            self._goal = goal
        result = self.agent.step(self.observation_of(observations))
        self.last_result = result
        action = Action.STOP if result.all_explored else result.action
        if action == Action.STOP:
            self._goal = None
        self._note_look(action)
        return ACTION_IDS[action]

    def observation_of(self, observations: Mapping[str, Any]) -> crossnav.Observation:
        """One dictionary of Habitat's as our observation, in the episode's world."""
        p_foot = foot_from_gps(self._read(observations, "gps"), self._flat_world)
        yaw_rad = yaw_from_compass(self._read(observations, "compass"))
        pose = crossnav.AgentPose(p_foot, yaw_rad, self._looking_rad)
        rgb = np.ascontiguousarray(np.asarray(self._read(observations, "rgb"))[..., :3],
                                   dtype=np.uint8)
        return crossnav.Observation(self._depth.metres(self._read(observations, "depth")),
                                    self._camera, pose.camera_pose(self._camera_height_m), rgb)

    def _note_look(self, action: Action) -> None:
        """Habitat gives no pitch: it is the sum of the looks up and down."""
        if action == Action.LOOK_UP:
            self._looking_rad = min(self._looking_rad + self._pitch_rad, self._max_pitch_rad)
        elif action == Action.LOOK_DOWN:
            self._looking_rad = max(self._looking_rad - self._pitch_rad, -self._max_pitch_rad)

    def _goal_of(self, observations: Mapping[str, Any]) -> str:
        index = int(np.asarray(self._read(observations, "objectgoal")).reshape(-1)[0])
        if not 0 <= index < len(self._goal_names):
            raise Error(f"is {index}; there are {len(self._goal_names)} goal names",
                        "observations.objectgoal")
        return self._goal_names[index]

    @staticmethod
    def _read(observations: Mapping[str, Any], key: str) -> Any:
        if key not in observations:
            raise Error("is missing: add its sensor to the task", f"observations.{key}")
        return observations[key]
