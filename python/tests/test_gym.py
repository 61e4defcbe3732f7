# SPDX-License-Identifier: MIT
"""The Gymnasium environment."""

import subprocess
import sys
from typing import Any

import crossnav.gym
import gymnasium
import numpy as np
import pytest
from conftest import SMALL
from gymnasium.utils.env_checker import check_env

import crossnav


def make(**options: Any) -> gymnasium.Env[Any, Any]:
    return gymnasium.make(crossnav.gym.ENV_ID, config=SMALL, **options)


def test_the_environment_passes_gymnasiums_checks() -> None:
    check_env(make(render_mode="rgb_array").unwrapped)


def test_gymnasium_finds_it_without_an_import_of_ours() -> None:
    user = ("import gymnasium; print(gymnasium.make('crossnav.gym:crossnav/CrossFloorNav-v0', "
            "config={'sensor.width_px': 32, 'sensor.height_px': 32}).spec.id)")
    done = subprocess.run([sys.executable, "-c", user], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == crossnav.gym.ENV_ID, done.stderr


def test_a_seed_gives_the_same_episode() -> None:
    runs = []
    for _ in range(2):
        env = make(goals=2)
        first, info = env.reset(seed=5)
        last = [env.step(a)[0]["pose"] for a in (0, 1, 0)][-1]
        runs.append((first["pose"].tolist(), info["goals"], last.tolist()))
    assert runs[0] == runs[1]
    assert len(runs[0][1]) == 2


def test_a_stop_at_the_goal_pays_and_one_elsewhere_ends(episode: crossnav.Episode) -> None:
    env = make()
    env.reset(options={"episode": episode})
    simulator = env.unwrapped.simulator  # type: ignore[attr-defined]
    agent = crossnav.Agent(simulator.ground_truth(), SMALL)
    agent.set_goal(episode.goals[0])
    action, reward, info = None, 0.0, {}
    for _ in range(200):
        action = agent.step(simulator.observe()).action
        _, reward, terminated, truncated, info = env.step(np.int64(action))
        if action == crossnav.Action.STOP:
            break
    assert (reward, terminated, truncated) == (1.0, False, False)
    assert info["reached"] and info["stage"] == 1 and info["goal"] == episode.goals[1]
    _, reward, terminated, _, _ = env.step(np.int64(crossnav.Action.STOP))
    assert (reward, terminated) == (0.0, True)


def test_the_budget_truncates() -> None:
    env = gymnasium.make(crossnav.gym.ENV_ID, config={**SMALL, "eval": {"action_budget": 3}})
    env.reset(seed=1)
    flags = [env.step(np.int64(1))[3] for _ in range(3)]
    assert flags == [False, False, True]


def test_given_episodes_come_in_turn(episode: crossnav.Episode) -> None:
    env = make(episodes=[episode])
    _, info = env.reset()
    assert info["goals"] == episode.goals
    with pytest.raises(crossnav.Error, match="unicorn"):
        env.reset(options={"episode": crossnav.Episode("a/b.glb", episode.start, ["unicorn"])})
