# SPDX-License-Identifier: MIT
"""Ground truth from Habitat's semantic sensor, on arrays and a stand-in for its semantic scene."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from conftest import SMALL
from test_habitat import OUR_ACTION, Recorder

import crossnav
from crossnav import habitat
from crossnav.habitat_truth import SemanticTruth, instance_names

SIDE_PX = 40
CAMERA = crossnav.CameraIntrinsics.from_hfov(SIDE_PX, SIDE_PX, 90)


class Category:
    """As habitat-sim binds it: name(mapping="")."""

    def __init__(self, name: str) -> None:
        self._name = name

    def name(self, mapping: str = "") -> str:
        return self._name


def semantic_scene(names: dict[int, str]) -> SimpleNamespace:
    return SimpleNamespace(objects=[
        SimpleNamespace(id=f"{name}_{i}", semantic_id=i, category=Category(name))
        for i, name in {0: "Unknown", **names}.items()])


NAMES = {1: "wall", 2: "Armchair", 3: "tv", 4: "stairs", 5: "armchair", 6: "lamp"}


def view(ids: np.ndarray, depth_m: float = 2.0) -> tuple[dict[str, Any], crossnav.Observation]:
    """Observations as Habitat-Lab gives them, and as the agent passes them to perception."""
    rgb = np.zeros((SIDE_PX, SIDE_PX, 3), np.uint8)
    rgb[..., 0] = ids
    depth = np.full((SIDE_PX, SIDE_PX), depth_m, np.float32)
    pose = crossnav.AgentPose((0, 0, 0)).camera_pose(0.88)
    return ({"rgb": rgb, "semantic": ids[..., None].astype(np.int32)},
            crossnav.Observation(depth, CAMERA, pose, rgb))


@pytest.fixture
def ids() -> np.ndarray:
    """A wall with an armchair, a television of few pixels, and stairs below."""
    ids = np.full((SIDE_PX, SIDE_PX), 1, np.uint32)  # habitat-sim's type
    ids[10:20, 5:15] = 2
    ids[2:4, 30:34] = 3
    ids[30:, :] = 4
    return ids


@pytest.fixture
def truth() -> SemanticTruth:
    return SemanticTruth(instance_names(semantic_scene(NAMES)), config=SMALL)


def test_names_come_from_the_semantic_scene() -> None:
    scene = semantic_scene(NAMES)
    scene.objects.append(None)
    scene.objects.append(SimpleNamespace(id="x", semantic_id=9, category=None))
    assert instance_names(scene) == NAMES
    with pytest.raises(crossnav.Error, match="semantic_scene"):
        instance_names(semantic_scene({}))


def test_a_goal_is_detected_where_it_is(truth: SemanticTruth, ids: np.ndarray) -> None:
    seen, observation = view(ids)
    assert truth.look(seen) is seen
    detector = truth.perception.detector
    (chair,) = detector.detect(observation, "chair")
    assert chair.box == (5, 10, 15, 20) and 0.5 < chair.confidence < 1
    assert detector.detect(observation, "tv_monitor") == []  # 8 pixels, of 20
    assert detector.detect(observation, "bed") == []
    (wall,) = detector.detect(observation, "wall")  # a raw name
    assert wall.box == (0, 0, SIDE_PX, 30)


def test_what_is_too_far_away_is_not_detected(truth: SemanticTruth, ids: np.ndarray) -> None:
    for depth_m, count in ((7.9, 1), (8.1, 0), (0.0, 0)):
        seen, observation = view(ids, depth_m)
        truth.look(seen)
        assert len(truth.perception.detector.detect(observation, "chair")) == count


def test_instances_of_one_name_are_apart(truth: SemanticTruth, ids: np.ndarray) -> None:
    ids[10:30, 20:38] = 5
    seen, observation = view(ids)
    truth.look(seen)
    boxes = [d.box for d in truth.perception.detector.detect(observation, "chair")]
    assert boxes == [(20, 10, 38, 30), (5, 10, 15, 20)]  # the larger is surer


def test_a_mask_has_the_pixels_of_the_object_in_the_box(truth: SemanticTruth,
                                                        ids: np.ndarray) -> None:
    ids[12:14, 7:9] = 1  # the wall shows through
    seen, observation = view(ids)
    truth.look(seen)
    mask, quality = truth.perception.segmenter.segment(observation, (4, 9, 16, 21))
    assert quality == 1 and np.array_equal(mask != 0, ids == 2)
    ids[:] = 0
    seen, observation = view(ids)
    truth.look(seen)
    assert truth.perception.segmenter.segment(observation, (4, 9, 16, 21))[1] == 0


def test_stairs_are_found_by_name(truth: SemanticTruth, ids: np.ndarray) -> None:
    seen, observation = view(ids)
    truth.look(seen)
    found = truth.perception.stairs.segment_stairs(observation)
    assert np.array_equal(found > 0.5, ids == 4)


def test_features_resemble_the_words_of_what_they_show(truth: SemanticTruth,
                                                       ids: np.ndarray) -> None:
    ids[:, 20:] = 6
    seen, observation = view(ids)
    truth.look(seen)
    encoder = truth.perception.encoder
    grid = encoder.encode_image(observation)
    rows, cols, dim = grid.shape
    assert dim == encoder.dim()
    lamp, chair = encoder.encode_text("lamp"), encoder.encode_text("chair")
    assert np.linalg.norm(lamp) == pytest.approx(1, abs=1e-5)
    assert grid[rows // 4, cols - 2] @ lamp == pytest.approx(1, abs=1e-5)
    assert grid[rows // 4, cols - 2] @ chair < 0.8
    assert grid[15 * rows // SIDE_PX, 9 * cols // SIDE_PX] @ chair == pytest.approx(1, abs=1e-5)
    assert np.allclose(encoder.encode_text("couch"), encoder.encode_text("sofa"))


def test_another_observation_than_the_last_is_refused(truth: SemanticTruth,
                                                      ids: np.ndarray) -> None:
    seen, observation = view(ids)
    with pytest.raises(crossnav.Error, match="truth.look"):
        truth.perception.detector.detect(observation, "chair")
    truth.look(seen)
    other = view(np.full_like(ids, 5))[1]
    with pytest.raises(crossnav.Error, match="truth.look"):
        truth.perception.detector.detect(other, "chair")
    with pytest.raises(crossnav.Error, match="observations.semantic: is missing"):
        truth.look({"rgb": seen["rgb"]})
    with pytest.raises(crossnav.Error, match="integers"):
        truth.look({**seen, "semantic": seen["semantic"].astype(np.float32)})


def test_the_agent_finds_a_goal_by_the_semantic_image(simulator: crossnav.Simulator) -> None:
    """The whole loop, with our simulator's instances in place of Habitat's sensor."""
    recorder = Recorder(simulator)
    names = {o["id"]: o["name"] for o in simulator.scene.objects}
    truth = SemanticTruth(instance_names(semantic_scene(names)), config=SMALL)
    agent = habitat.HabitatAgent(truth.perception, SMALL)
    for _ in range(200):
        observations = recorder.record("sofa")
        observations["semantic"] = simulator.instances[..., None].astype(np.int32)
        number = agent.act(truth.look(observations))
        if number == 0:
            break
        simulator.step(OUR_ACTION[number])
    assert number == 0 and simulator.is_reached("sofa")
