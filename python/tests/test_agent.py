# SPDX-License-Identifier: MIT
"""The agent driven from Python equals the C++ runner, at negligible cost."""

import gc
import json
import statistics
import threading
import time
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import crossnav


def short(budget: int) -> crossnav.Config:
    return crossnav.Config({**SMALL, "eval": {"action_budget": budget}})


def fresh(scene: crossnav.Scene, config: crossnav.Settings
          ) -> tuple[crossnav.Agent, crossnav.Simulator]:
    simulator = crossnav.Simulator(scene, config)
    return crossnav.Agent(simulator.ground_truth(), config), simulator


def test_python_and_the_runner_give_the_same_record(scene: crossnav.Scene,
                                                    episode: crossnav.Episode) -> None:
    config = short(150)
    expected, _ = crossnav.run_episode(scene, episode, config)
    record = crossnav.play(*fresh(scene, config), episode)
    assert record["actions"] == expected["actions"] > 20
    assert len(record["stages"]) == len(expected["stages"])
    for ours, theirs in zip(record["stages"], expected["stages"], strict=True):
        for key in ours:
            assert ours[key] == theirs[key], key


def test_python_and_the_runner_give_the_same_traces(scene: crossnav.Scene,
                                                    episode: crossnav.Episode) -> None:
    config = short(25)
    _, lines = crossnav.run_episode(scene, episode, config)
    agent, simulator = fresh(scene, config)
    simulator.reset(episode.start)
    goal = None
    for line in lines:
        if goal != json.loads(line)["goal"]:
            goal = json.loads(line)["goal"]
            agent.set_goal(goal)
        result = agent.step(simulator.observe())
        assert result.trace_json == line
        simulator.step(result.action)


def test_a_step_tells_what_happened(agent: crossnav.Agent, simulator: crossnav.Simulator) -> None:
    agent.set_goal("sofa")
    result = agent.step(simulator.observe())
    assert isinstance(result.action, crossnav.Action)
    assert result.trace["goal"] == "sofa"
    assert result.trace["action"] == result.action.name.lower()
    assert not result.all_explored and result.p_claimed_world is None
    keys, states = result.voxel_changes
    assert keys.shape == (len(states), 3) and len(states) > 100
    assert (agent.map.states_at((keys + 0.5) * agent.map.voxel_m) == states).all()
    assert "integrate" in result.timing_ms


def test_a_goal_may_be_a_picture(agent: crossnav.Agent, simulator: crossnav.Simulator) -> None:
    sofa = next(o["id"] for o in simulator.scene.objects if o["category"] == "sofa")
    picture = simulator.take_picture(sofa, seed=2)
    assert picture.shape == (256, 256, 3) and picture.dtype == np.uint8
    agent.set_goal(picture)
    result = agent.step(simulator.observe())
    assert result.trace["goal"] == "sofa"
    assert any("picture" in event for event in result.trace["events"])
    with pytest.raises(crossnav.Error, match="the simulator took"):
        agent.set_goal(np.ascontiguousarray(picture[::-1]))
    with pytest.raises(crossnav.Error, match="box"):
        agent.set_goal(picture, box=(0, 0, 300, 10))
    with pytest.raises(crossnav.Error, match="no instance"):
        simulator.take_picture(10**6)


def test_the_map_can_be_read_but_not_written(agent: crossnav.Agent,
                                             simulator: crossnav.Simulator) -> None:
    agent.set_goal("sofa")
    view = simulator.observe()
    agent.step(view)
    assert len(agent.map) > 0 and len(agent.memory) > 0
    with pytest.raises(crossnav.Error, match="belongs to an agent"):
        agent.map.integrate(view.depth_m, view.camera, view.T_world_camera)
    voxel_map, memory = agent.map, agent.memory
    del agent
    gc.collect()
    assert len(voxel_map) > 0 and len(memory) > 0  # they keep it alive


def test_observations_are_views_and_survive_the_simulator(scene: crossnav.Scene,
                                                          episode: crossnav.Episode) -> None:
    simulator = crossnav.Simulator(scene)
    simulator.reset(episode.start)
    view = simulator.observe()
    depth_m = view.depth_m
    assert np.shares_memory(depth_m, view.depth_m)
    before = depth_m.copy()
    del view, simulator
    gc.collect()
    assert (depth_m == before).all() and depth_m.dtype == np.float32


def test_a_made_observation_equals_the_simulators(agent: crossnav.Agent,
                                                  simulator: crossnav.Simulator) -> None:
    view = simulator.observe()
    made = crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, view.rgb)
    assert (made.rgb == view.rgb).all() and (made.depth_m == view.depth_m).all()
    assert (made.T_world_camera == view.T_world_camera).all()
    agent.set_goal("sofa")
    assert agent.step(made).trace["detections"] >= 0


def mounted(view: crossnav.Observation, **more: Any) -> crossnav.Observation:
    return crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, view.rgb, **more)


def test_the_foot_is_that_of_the_mounting(agent: crossnav.Agent,
                                          simulator: crossnav.Simulator) -> None:
    view = simulator.observe()
    assert view.T_base_camera is None and view.rgb_camera is None
    T_base_camera = crossnav.AgentPose((0.2, 0.1, 0), 0.5).camera_pose(0.6)
    obs = mounted(view, T_base_camera=T_base_camera)
    assert obs.T_base_camera is not None
    np.testing.assert_array_equal(obs.T_base_camera, T_base_camera)
    T_world_base = view.T_world_camera @ np.linalg.inv(T_base_camera)
    agent.set_goal("sofa")
    foot = agent.step(obs).trace["agent"]
    np.testing.assert_allclose(foot["p_world"], T_world_base[:3, 3], atol=1e-6)
    np.testing.assert_allclose(foot["yaw_rad"], np.arctan2(T_world_base[1, 0], T_world_base[0, 0]),
                               atol=1e-6)
    with pytest.raises(crossnav.Error, match="T_base_camera"):
        mounted(view, T_base_camera=2 * np.eye(4))
    with pytest.raises(crossnav.Error, match="T_base_camera.*point up"):
        agent.step(mounted(view, T_base_camera=np.linalg.inv(T_base_camera) + [
            [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 2], [0, 0, 0, 0]]))


def test_colour_of_another_camera_is_brought_onto_the_grid_of_depth(
        agent: crossnav.Agent, simulator: crossnav.Simulator) -> None:
    view = simulator.observe()
    rows, cols = view.depth_m.shape
    camera = crossnav.CameraIntrinsics.from_hfov(48, 36, 70)
    T_camera_rgb = crossnav.AgentPose((0, 0, 0), 0.1).camera_pose(0) @ np.linalg.inv(
        crossnav.AgentPose((0, 0, 0), 0).camera_pose(0))
    T_camera_rgb[0, 3] = 0.05
    rgb = np.random.default_rng(2).integers(1, 256, (36, 48, 3)).astype(np.uint8)
    obs = crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, rgb,
                               rgb_camera=camera, T_camera_rgb=T_camera_rgb)
    assert obs.rgb.shape == (36, 48, 3) and obs.rgb_camera is not None
    assert obs.rgb_camera.fx == camera.fx
    np.testing.assert_array_equal(obs.T_camera_rgb, T_camera_rgb)

    v, u = np.mgrid[:rows, :cols]
    k = view.camera
    d = np.where(view.depth_m > 0, view.depth_m, 10).astype(float)
    points = np.stack([(u - k.cx) / k.fx * d, (v - k.cy) / k.fy * d, d, np.ones_like(d)])
    x, y, z, _ = np.einsum("ij,jvu->ivu", np.linalg.inv(T_camera_rgb), points)
    at_u = np.rint(camera.fx * x / z + camera.cx).astype(int)
    at_v = np.rint(camera.fy * y / z + camera.cy).astype(int)
    inside = (z > 0) & (at_u >= 0) & (at_u < 48) & (at_v >= 0) & (at_v < 36)
    expected = np.where(inside[..., None], rgb[at_v.clip(0, 35), at_u.clip(0, 47)], 0)
    seen = obs.registered()
    assert 0.1 < inside.mean() < 0.9
    assert (seen.rgb == expected).all(axis=-1).mean() > 0.999  # but for pixels at an edge
    assert seen.rgb_camera is None and (seen.depth_m == view.depth_m).all()
    assert (view.registered().rgb == view.rgb).all()
    agent.set_goal("sofa")
    assert agent.step(obs).trace["detections"] >= 0

    with pytest.raises(crossnav.Error, match="rgb_camera"):
        crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, view.rgb,
                             T_camera_rgb=T_camera_rgb)
    with pytest.raises(crossnav.Error, match="observation.rgb"):
        crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, rgb[:-1],
                             rgb_camera=camera)
    with pytest.raises(crossnav.Error, match="T_camera_rgb"):
        crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, rgb,
                             rgb_camera=camera, T_camera_rgb=np.zeros((4, 4)))


def test_perception_sees_registered_colour(scene: crossnav.Scene,
                                           simulator: crossnav.Simulator) -> None:
    shapes = []

    class Detector(crossnav.Detector):
        def detect(self, observation: crossnav.Observation, goal: str
                   ) -> list[crossnav.Detection]:
            shapes.append(observation.rgb.shape)
            return []

    truth = simulator.ground_truth()
    detector = Detector()
    agent = crossnav.Agent(crossnav.Perception(detector, truth.segmenter, truth.stairs,
                                               truth.encoder), scene.config)
    agent.set_goal("sofa")
    view = simulator.observe()
    obs = crossnav.Observation(view.depth_m, view.camera, view.T_world_camera,
                               np.ones((36, 48, 3), np.uint8),
                               rgb_camera=crossnav.CameraIntrinsics.from_hfov(48, 36, 70))
    agent.step(obs)
    detector.detect(obs, "sofa")  # Python's own method: as it is given
    # The agent asks for the goal, then for things met in passing.
    assert set(shapes[:-1]) == {(*view.depth_m.shape, 3)}
    assert shapes[-1] == (36, 48, 3)


def test_steps_without_a_goal_or_place_are_exceptions(agent: crossnav.Agent,
                                                      simulator: crossnav.Simulator,
                                                      scene: crossnav.Scene) -> None:
    with pytest.raises(crossnav.Error, match="set_goal"):
        agent.step(simulator.observe())
    with pytest.raises(crossnav.Error, match="reset"):
        crossnav.Simulator(scene).observe()


def test_another_thread_runs_during_a_step(agent: crossnav.Agent,
                                           simulator: crossnav.Simulator) -> None:
    agent.set_goal("sofa")
    view = simulator.observe()
    refused = []

    def step_too() -> None:
        try:
            agent.step(view)
        except crossnav.Error as error:
            refused.append(str(error))

    threads = [threading.Thread(target=step_too) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all("one thread at a time" in text for text in refused)
    agent.step(view)  # and it goes on


def test_python_adds_under_a_millisecond_to_a_step(agent: crossnav.Agent,
                                                   simulator: crossnav.Simulator) -> None:
    agent.set_goal("sofa")
    overheads_ms = []
    for _ in range(30):
        view = simulator.observe(with_colour=False)
        begun = time.thread_time()
        result = agent.step(view)
        action = result.action
        spent_ms = (time.thread_time() - begun) * 1e3
        overheads_ms.append(spent_ms - sum(result.timing_ms.values()))
        simulator.step(action)
    print(f"Python's overhead: {statistics.median(overheads_ms):.3f} ms a step")
    assert statistics.median(overheads_ms) < 1.0
