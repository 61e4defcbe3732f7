# SPDX-License-Identifier: MIT
"""The agent driven from Python does what the C++ runner does, at no cost worth naming."""

import gc
import json
import statistics
import threading
import time

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
