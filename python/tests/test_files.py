# SPDX-License-Identifier: MIT
"""Saved maps, episodes, records and worlds."""

from pathlib import Path

import numpy as np
import pytest
from conftest import SMALL

import crossnav


def walked(agent: crossnav.Agent, simulator: crossnav.Simulator, steps: int = 12) -> None:
    agent.set_goal("bed")
    for _ in range(steps):
        simulator.step(agent.step(simulator.observe(with_colour=False)).action)


def test_a_saved_map_is_the_same_when_loaded(agent: crossnav.Agent, tmp_path: Path,
                                             simulator: crossnav.Simulator) -> None:
    walked(agent, simulator)
    path = tmp_path / "home.map"
    assert crossnav.save_map(path, agent.map, agent.memory, agent.perception.encoder.name()) == 1
    voxel_map, memory, header, damaged = crossnav.load_map(path, SMALL)
    assert not damaged
    assert header["feature_rows"] == len(memory) == len(agent.memory)
    assert crossnav.map_header(path) == header
    for ours, theirs in zip(voxel_map.voxels(), agent.map.voxels(), strict=True):
        assert (ours == theirs).all()
    text = agent.perception.encoder.encode_text("sofa")
    assert np.allclose(memory.similarity(text), agent.memory.similarity(text), atol=1e-6)


def test_a_saved_map_answers_questions(agent: crossnav.Agent, tmp_path: Path,
                                       simulator: crossnav.Simulator) -> None:
    walked(agent, simulator)
    path = tmp_path / "home.map"
    encoder = agent.perception.encoder
    crossnav.save_map(path, agent.map, agent.memory, encoder.name())
    answer = crossnav.ask(path, "where is the sofa?", SMALL)
    assert answer["kind"] == "where"
    assert all(thing["category"] == "sofa" for thing in answer["things"])
    own = crossnav.ask(path, "where is the sofa?", SMALL, encode=encoder.encode_text)
    assert own["answer"] == answer["answer"]
    with pytest.raises(crossnav.Error, match="not understood"):
        crossnav.ask(path, "why?", SMALL)


def test_an_agent_starts_from_a_saved_map(agent: crossnav.Agent, tmp_path: Path,
                                          simulator: crossnav.Simulator) -> None:
    walked(agent, simulator)
    crossnav.save_map(tmp_path / "home.map", agent.map, agent.memory)
    voxel_map, memory, _, _ = crossnav.load_map(tmp_path / "home.map", SMALL)
    other = crossnav.Agent(simulator.ground_truth(), SMALL)
    other.restore(voxel_map, memory)
    assert len(other.map) == len(voxel_map) > 0 and len(other.memory) == len(memory)
    found = [c.p_center_world for c in other.query("sofa")]
    assert np.allclose(found, [c.p_center_world for c in agent.query("sofa")], atol=1e-6)
    other.set_goal("sofa")
    with pytest.raises(crossnav.Error, match="before the first goal"):
        other.restore(voxel_map, memory)


def test_stairs_are_saved_with_the_map(scene: crossnav.Scene, tmp_path: Path,
                                       episode: crossnav.Episode) -> None:
    simulator = crossnav.Simulator(scene, SMALL)
    agent = crossnav.Agent(simulator.ground_truth(), SMALL)
    crossnav.play(agent, simulator, episode)
    flights = agent.map.flights
    assert flights, "the episode was chosen for its stairs"
    assert flights[0]["p_top_world"][2] - flights[0]["p_foot_world"][2] > 2
    crossnav.save_map(tmp_path / "home.map", agent.map, agent.memory)
    voxel_map, memory, _, _ = crossnav.load_map(tmp_path / "home.map", SMALL)
    other = crossnav.Agent(simulator.ground_truth(), SMALL)
    other.restore(voxel_map, memory)
    for known in (voxel_map.flights, other.map.flights):
        assert len(known) == len(flights)
        assert np.array_equal(known[0]["steps_world"], flights[0]["steps_world"])


def test_a_map_of_another_kind_is_refused(agent: crossnav.Agent, tmp_path: Path,
                                          simulator: crossnav.Simulator) -> None:
    walked(agent, simulator, 1)
    path = tmp_path / "home.map"
    crossnav.save_map(path, agent.map, agent.memory, "mine")
    with pytest.raises(crossnav.Error) as caught:
        crossnav.load_map(path, encoder_name="yours")
    assert caught.value.code == "mismatch" and str(path) in caught.value.where
    (tmp_path / "no.map").write_text("hello", encoding="utf-8")
    with pytest.raises(crossnav.Error):
        crossnav.load_map(tmp_path / "no.map")


def test_metrics_of_records_in_memory_are_those_of_the_file(tmp_path: Path) -> None:
    def stage(success: bool) -> dict[str, object]:
        return {"goal": "bed", "outcome": "success" if success else "stuck", "success": success,
                "shortest_m": 2.0, "length_m": 4.0, "start": [0, 0, 0], "end": [1, 0, 0]}

    records = [{"episode_id": name, "goals": ["bed"], "stages": [stage(success)]}
               for name, success in (("a", True), ("b", False))]
    figures = crossnav.metrics(records)["metrics"]
    assert figures["SR"]["value"] == 0.5
    assert figures["SPL"]["value"] == 0.25
    with pytest.raises(crossnav.Error, match="line 1"):
        crossnav.metrics([{"goals": ["bed"]}])
    with pytest.raises(crossnav.Error):
        crossnav.metrics(tmp_path / "none.jsonl")


def test_a_generated_house_can_be_walked(tmp_path: Path) -> None:
    house = crossnav.generate_house(tmp_path, seed=3, floors=2)
    assert house["floors"] == 2 and sum(house["stairs"].values()) >= 1
    assert len(crossnav.list_scenes(tmp_path)) == 1
    scene = crossnav.Scene(tmp_path, config=SMALL)
    assert len(scene.floors) >= 2
    simulator = crossnav.Simulator(scene)
    simulator.reset(crossnav.AgentPose(scene.random_point(1), 0.5))
    view = simulator.observe()
    assert view.rgb.shape == (160, 160, 3) and (view.depth_m > 0).any()
    assert set(simulator.instances.ravel()) - {0} <= {o["id"] for o in scene.objects}
    with pytest.raises(crossnav.Error, match="floors"):
        crossnav.generate_house(tmp_path, floors=9)


def test_goals_and_distances(scene: crossnav.Scene, simulator: crossnav.Simulator) -> None:
    assert {o["category"] for o in scene.objects} >= {"sofa", "bed"}
    distance_m = simulator.distance_to_goal("sofa")
    assert distance_m is not None and distance_m > 0
    assert scene.distance_to_goal(simulator.pose.p_world, "sofa") == distance_m
    assert scene.distance_to_goal(simulator.pose.p_world, "unicorn") is None
    assert not simulator.is_reached("bed")
