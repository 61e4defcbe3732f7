# SPDX-License-Identifier: MIT
"""A Gymnasium environment over the simulator: ``crossnav/CrossFloorNav-v0``.

    import gymnasium, crossnav.gym
    env = gymnasium.make("crossnav/CrossFloorNav-v0", goals=2)
"""

import functools
import tempfile
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

import crossnav

ENV_ID = "crossnav/CrossFloorNav-v0"
_TRIES = 50  # chosen: draws of a start with all goals reachable

Obs = dict[str, Any]


@functools.cache
def _embedded_scenes() -> "tempfile.TemporaryDirectory[str]":
    """A folder with the house of the demo, for as long as the process lives."""
    folder = tempfile.TemporaryDirectory(prefix="crossnav-")
    crossnav.write_embedded_house(folder.name)
    return folder


class CrossFloorNavEnv(gymnasium.Env[Obs, np.int64]):
    """Find goals in order, with six actions; STOP claims the current one.

    Observation: ``rgb`` H x W x 3 uint8; ``depth`` H x W float32, planar [m], 0 invalid; ``pose``
    (5,) float32: x, y, z of the foot [m], yaw and pitch [rad], world frame; ``goal``: index into
    crossnav.CATEGORIES. Reward: 1 for each STOP at its goal. Terminated by a STOP elsewhere or by
    the last goal, truncated by the action budget (`eval.action_budget`).
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012

    def __init__(self, scenes_dir: str | None = None, scene_id: str | None = None,
                 goals: int = 3, config: crossnav.Settings = None,
                 episodes: Sequence[crossnav.Episode] = (),
                 render_mode: str | None = None) -> None:
        """Without `scenes_dir` the house of the demo. Given `episodes` are played in turn."""
        self.render_mode = render_mode
        self.scene = crossnav.Scene(scenes_dir or _embedded_scenes().name, scene_id, config)
        self.simulator = crossnav.Simulator(self.scene)
        settings = self.scene.config.to_dict()
        self._budget = int(settings["eval"]["action_budget"])
        height, width = settings["sensor"]["height_px"], settings["sensor"]["width_px"]
        self._goal_count = goals
        self._episodes = list(episodes)
        self._next_episode = 0
        self._goals: list[str] = []
        self._stage = self._actions = 0
        self._length_m = 0.0
        self.observation_space = spaces.Dict({
            "rgb": spaces.Box(0, 255, (height, width, 3), np.uint8),
            "depth": spaces.Box(0, np.inf, (height, width), np.float32),
            "pose": spaces.Box(-np.inf, np.inf, (5,), np.float32),
            "goal": spaces.Discrete(len(crossnav.CATEGORIES)),
        })
        self.action_space = spaces.Discrete(len(crossnav.Action))

    def reset(self, *, seed: int | None = None,
              options: dict[str, Any] | None = None) -> tuple[Obs, dict[str, Any]]:
        """Starts an episode: options["episode"], the next given one, or one drawn by the seed."""
        super().reset(seed=seed)
        episode = (options or {}).get("episode") or self._take_episode()
        unknown = set(episode.goals) - set(crossnav.CATEGORIES)
        if unknown:
            raise crossnav.Error(f"are no category: {', '.join(sorted(unknown))}", "goals")
        self.simulator.reset(episode.start)
        self._goals = list(episode.goals)
        self._stage = self._actions = 0
        self._length_m = 0.0
        return self._observe(), self._info(False)

    def step(self, action: np.int64) -> tuple[Obs, float, bool, bool, dict[str, Any]]:
        """Executes an action; see the class for the reward."""
        chosen = crossnav.Action(int(action))
        self._actions += 1
        reached = terminated = False
        if chosen == crossnav.Action.STOP:
            reached = self.simulator.is_reached(self._goals[self._stage])
            terminated = not reached or self._stage + 1 == len(self._goals)
            if not terminated:
                self._stage += 1
        else:
            self._length_m += self.simulator.step(chosen)
        truncated = not terminated and self._actions >= self._budget
        return self._observe(), float(reached), terminated, truncated, self._info(reached)

    def render(self) -> NDArray[np.uint8] | None:
        """The camera's picture, H x W x 3 uint8."""
        if self.render_mode != "rgb_array":
            return None
        return self.simulator.observe().rgb.copy()

    def _take_episode(self) -> crossnav.Episode:
        if self._episodes:
            episode = self._episodes[self._next_episode % len(self._episodes)]
            self._next_episode += 1
            return episode
        return self._draw_episode()

    def _draw_episode(self) -> crossnav.Episode:
        """Different goals, each reachable from a start anywhere on the navmesh."""
        there = {o["category"] for o in self.scene.objects}
        known = [c for c in crossnav.CATEGORIES if c in there]
        for _ in range(_TRIES):
            p_world = self.scene.random_point(int(self.np_random.integers(1 << 62)))
            yaw_rad = float(self.np_random.uniform(-np.pi, np.pi))
            order = [known[i] for i in self.np_random.permutation(len(known))]
            goals = [g for g in order if self.scene.distance_to_goal(p_world, g) is not None]
            if len(goals) >= self._goal_count:
                start = crossnav.AgentPose(p_world, yaw_rad)
                return crossnav.Episode(self.scene.id, start, goals[:self._goal_count])
        raise crossnav.Error(f"has no start from which {self._goal_count} goals can be reached",
                             self.scene.id)

    def _observe(self) -> Obs:
        view = self.simulator.observe()
        pose = self.simulator.pose
        return {
            "rgb": view.rgb,
            "depth": view.depth_m,
            "pose": np.array([*pose.p_world, pose.yaw_rad, pose.pitch_rad], np.float32),
            "goal": np.int64(crossnav.CATEGORIES.index(self._goals[self._stage])),
        }

    def _info(self, reached: bool) -> dict[str, Any]:
        return {"goal": self._goals[self._stage], "stage": self._stage, "reached": reached,
                "goals": list(self._goals), "actions": self._actions, "length_m": self._length_m}


if ENV_ID not in gymnasium.registry:
    gymnasium.register(id=ENV_ID, entry_point="crossnav.gym:CrossFloorNavEnv")
