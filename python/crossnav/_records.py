# SPDX-License-Identifier: MIT
"""Playing an episode from Python, and the metrics of records."""

import json
import os
import tempfile
from collections import deque
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

from crossnav import _core
from crossnav._errors import Error

Record = dict[str, Any]
"""A result record as docs/formats/results.md lists it."""


def play_stage(agent: _core.Agent, simulator: _core.Simulator, goal: str, budget: int,
               recent_m: deque[float]) -> Record:
    """Searches one goal with at most `budget` actions and judges how it ended.

    `recent_m` holds the displacements of the last steps [m]; it continues across stages.
    """
    agent.set_goal(goal)
    start = simulator.pose.p_world
    length_m, actions = 0.0, 0
    stopped = reached = claim_near = all_explored = False
    while actions < budget and not (stopped or all_explored):
        result = agent.step(simulator.observe(with_colour=False))
        all_explored = result.all_explored
        if all_explored:
            break
        actions += 1
        stopped = result.action == _core.Action.STOP
        if stopped:
            reached = simulator.is_reached(goal)
            claimed = result.p_claimed_world
            claim_near = claimed is not None and simulator.is_claim_near(goal, claimed)
        else:
            recent_m.append(simulator.step(result.action))
            length_m += recent_m[-1]
    outcome = _core.judge_stage(stopped, reached, claim_near, all_explored, sum(recent_m),
                                simulator.config)
    return {"goal": goal, "outcome": outcome, "success": outcome == "success",
            "start": start.tolist(), "end": simulator.pose.p_world.tolist(),
            "shortest_m": simulator.scene.distance_to_goal(start, goal),
            "length_m": length_m, "actions": actions}


def play(agent: _core.Agent, simulator: _core.Simulator, episode: _core.Episode) -> Record:
    """Drives `agent` through an episode, step by step, as the C++ runner does.

    The agent has to be new. Colours are not rendered. Returns a record that `metrics` reads.
    """
    settings = simulator.config.to_dict()["eval"]
    budget, per_goal = settings["action_budget"], settings["budget_scope"] == "goal"
    recent_m: deque[float] = deque(maxlen=settings["stuck_steps"])
    simulator.reset(episode.start)
    stages: list[Record] = []
    actions = 0
    for goal in episode.goals:
        left = budget if per_goal else budget - actions
        if left <= 0:
            break
        stages.append(play_stage(agent, simulator, goal, left, recent_m))
        actions += stages[-1]["actions"]
        if not stages[-1]["success"]:
            break
    return {"kind": "episode", "episode_id": episode.episode_id, "scene_id": episode.scene_id,
            "cross_floor_required": episode.cross_floor_required,
            "first_transition_stage": episode.first_transition_stage,
            "goals": list(episode.goals), "actions": actions, "stages": stages}


def metrics(records: Union[str, "os.PathLike[str]", Iterable[Mapping[str, Any]]]) -> Record:
    """The figures of `crossnav metrics --json`: of a result file, or of records in memory.

    A record needs goals, and per stage goal, outcome, success, shortest_m and length_m.
    """
    if isinstance(records, (str, os.PathLike)):
        return _core.metrics_of_files([records])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "records.jsonl"
        path.write_text("".join(json.dumps(dict(r)) + "\n" for r in records), encoding="utf-8")
        try:
            return _core.metrics_of_files([path])
        except Error as error:
            raise Error(error.what, error.where.replace(str(path), "records"),
                        error.code) from None
