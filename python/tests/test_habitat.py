# SPDX-License-Identifier: MIT
"""The Habitat agent on dictionaries that are recorded here, in Habitat's frames, from our simulator.

The recording follows Habitat's definitions with quaternion-free rotations about its y axis; nothing
of crossnav.habitat is used for it.
"""

import math
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import crossnav
from crossnav import habitat

MAX_DEPTH_M = 10.0
OUR_ACTION = {number: action for action, number in habitat.ACTION_IDS.items()}


def about_y(p: np.ndarray, angle_rad: float) -> np.ndarray:
    """Turns a point of Habitat's frame counter-clockwise about y."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]])


class Recorder:
    """Habitat's sensors over our simulator, from where it stands now."""

    def __init__(self, simulator: crossnav.Simulator) -> None:
        self.simulator = simulator
        self.start = simulator.pose

    @staticmethod
    def position(pose: crossnav.AgentPose) -> np.ndarray:
        x, y, z = pose.p_world
        return np.array([-y, z, -x])

    def record(self, goal: str) -> dict[str, Any]:
        view, pose = self.simulator.observe(), self.simulator.pose
        moved = self.position(pose) - self.position(self.start)
        # Habitat's yaw 0 looks along -z, which is our +x, so the yaws are equal.
        forward = about_y(np.array([0.0, 0.0, -1.0]), self.start.yaw_rad - pose.yaw_rad)
        depth = np.clip(view.depth_m, 0, MAX_DEPTH_M) / MAX_DEPTH_M
        return {
            "rgb": view.rgb.copy(),
            "depth": depth[..., None].astype(np.float32),
            "gps": about_y(moved, -self.start.yaw_rad).astype(np.float32),
            "compass": np.array([math.atan2(forward[0], -forward[2])], np.float32),
            "objectgoal": np.array([crossnav.CATEGORIES.index(goal)], np.int64),
        }


def true_pose(recorder: Recorder, height_m: float) -> np.ndarray:
    """T_episode_camera from the simulator's own poses."""
    T_world_start = recorder.start.camera_pose(0.0)
    level = crossnav.AgentPose((0, 0, 0), 0.0).camera_pose(0.0)  # episode world <- its camera
    T_episode_world = level @ np.linalg.inv(T_world_start)
    return T_episode_world @ recorder.simulator.pose.camera_pose(height_m)


def test_the_frames_are_those_of_the_conventions() -> None:
    assert habitat.world_from_habitat([0, 0, -1]).tolist() == [1, 0, 0]  # forward
    assert habitat.world_from_habitat([0, 1, 0]).tolist() == [0, 0, 1]  # up
    assert habitat.world_from_habitat([1, 0, 0]).tolist() == [0, -1, 0]  # right
    points = np.random.default_rng(1).normal(size=(20, 3))
    assert np.allclose(habitat.habitat_from_world(habitat.world_from_habitat(points)), points)


def test_poses_of_a_walk_come_back(simulator: crossnav.Simulator) -> None:
    recorder = Recorder(simulator)
    agent = habitat.HabitatAgent(simulator.ground_truth(), SMALL)
    tilt = 0.0
    for number in [1, 1, 2, 1, 4, 3, 1, 5, 5, 1, 2, 2, 1]:
        action = OUR_ACTION[number]
        simulator.step(action)
        agent._note_look(action)
        made = agent.observation_of(recorder.record("sofa"))
        assert np.allclose(made.T_world_camera, true_pose(recorder, 0.88), atol=1e-5)
        tilt = max(tilt, abs(simulator.pose.pitch_rad))
    assert tilt > 0.4


def test_heights_of_another_floor_come_back(scene: crossnav.Scene,
                                            episode: crossnav.Episode) -> None:
    simulator = crossnav.Simulator(scene)
    simulator.reset(episode.start)
    recorder = Recorder(simulator)
    floors = [f["height_m"] for f in scene.floors]
    for seed in range(1, 40):
        p_world = scene.random_point(seed)
        simulator.reset(crossnav.AgentPose(p_world, 1.0))
        gps = recorder.record("bed")["gps"]
        foot = habitat.foot_from_gps(gps)
        assert foot[2] == pytest.approx(p_world[2] - recorder.start.p_world[2], abs=0.31)
        if abs(p_world[2] - floors[-1]) < 0.2:
            assert foot[2] > 2.0
            return
    pytest.fail("no point upstairs")


def test_depth_is_scaled_and_its_ends_are_no_surface() -> None:
    scale = habitat.DepthScale(0.5, 5.0)
    metres = scale.metres(np.array([[[0.0], [0.5], [1.0]]], np.float32))
    assert metres.shape == (1, 3)
    assert metres[0, 0] == 0 and metres[0, 1] == pytest.approx(2.75) and metres[0, 2] > 5
    raw = habitat.DepthScale(0.5, 5.0, is_normalized=False)
    assert raw.metres(np.array([[0.5, 2.0, 5.0]]))[0].tolist() == [0.0, 2.0, 10.0]


def test_the_agent_finds_a_goal_through_the_dictionaries(simulator: crossnav.Simulator) -> None:
    recorder = Recorder(simulator)
    agent = habitat.HabitatAgent(simulator.ground_truth(), SMALL)
    for _ in range(200):
        number = agent.act(recorder.record("sofa"))
        if number == 0:
            break
        simulator.step(OUR_ACTION[number])
    assert number == 0 and simulator.is_reached("sofa")
    claimed = agent.last_result.p_claimed_world if agent.last_result else None
    assert claimed is not None
    # The next goal goes on with the same memory; a reset forgets it.
    rows = len(agent.agent.memory)
    agent.act(recorder.record("toilet"))
    assert agent.last_result is not None and agent.last_result.trace["goal"] == "toilet"
    assert len(agent.agent.memory) >= rows
    agent.reset()
    assert len(agent.agent.memory) == 0


def test_what_is_missing_is_named(simulator: crossnav.Simulator) -> None:
    agent = habitat.HabitatAgent(simulator.ground_truth(), SMALL)
    whole = Recorder(simulator).record("sofa")
    for key in ("rgb", "depth", "gps", "compass", "objectgoal"):
        with pytest.raises(crossnav.Error, match=f"observations.{key}: is missing"):
            agent.act({k: v for k, v in whole.items() if k != key})
    with pytest.raises(crossnav.Error, match="dimensionality"):
        agent.act({**whole, "gps": whole["gps"][:2]})
    with pytest.raises(crossnav.Error, match="goal names"):
        agent.act({**whole, "objectgoal": np.array([17])})


def test_two_gps_numbers_do_on_one_floor(simulator: crossnav.Simulator) -> None:
    assert habitat.foot_from_gps([2.0, 1.0], flat_world=True).tolist() == [2.0, -1.0, 0.0]
