# SPDX-License-Identifier: MIT
"""Perception written in Python, inside an agent."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import crossnav


class Detector(crossnav.Detector):
    """Forwards to ground truth, and records the queries."""

    def __init__(self, inner: crossnav.Detector) -> None:
        super().__init__()
        self.inner = inner
        self.asked: list[tuple[str, tuple[int, ...]]] = []

    def detect(self, observation: crossnav.Observation, goal: str) -> list[crossnav.Detection]:
        self.asked.append((goal, observation.rgb.shape))
        return [crossnav.Detection(d.box, d.confidence)
                for d in self.inner.detect(observation, goal)]


class Segmenter(crossnav.Segmenter):
    def __init__(self, inner: crossnav.Segmenter) -> None:
        super().__init__()
        self.inner = inner

    def segment(self, observation: crossnav.Observation, box: tuple[int, int, int, int]
                ) -> tuple[Any, float]:
        mask, quality = self.inner.segment(observation, box)
        return mask.astype(bool), quality


class Stairs(crossnav.StairSegmenter):
    def __init__(self, inner: crossnav.StairSegmenter) -> None:
        super().__init__()
        self.inner = inner

    def segment_stairs(self, observation: crossnav.Observation) -> Any:
        return self.inner.segment_stairs(observation).astype(np.float64)


class Encoder(crossnav.DenseEncoder):
    def __init__(self, inner: crossnav.DenseEncoder) -> None:
        super().__init__()
        self.inner = inner

    def dim(self) -> int:
        return self.inner.dim()

    def name(self) -> str:
        return self.inner.name()

    def encode_image(self, observation: crossnav.Observation) -> Any:
        return self.inner.encode_image(observation)

    def encode_text(self, text: str) -> Any:
        return self.inner.encode_text(text)


def in_python(truth: crossnav.Perception) -> crossnav.Perception:
    return crossnav.Perception(Detector(truth.detector), Segmenter(truth.segmenter),
                               Stairs(truth.stairs), Encoder(truth.encoder))


def walk(agent: crossnav.Agent, simulator: crossnav.Simulator, episode: crossnav.Episode,
         steps: int) -> list[str]:
    simulator.reset(episode.start)
    agent.set_goal("sofa")
    lines = []
    for _ in range(steps):
        result = agent.step(simulator.observe())
        lines.append(result.trace_json)
        simulator.step(result.action)
    return lines


def test_perception_in_python_acts_as_the_one_it_wraps(simulator: crossnav.Simulator,
                                                       episode: crossnav.Episode) -> None:
    truth = simulator.ground_truth()
    wrapped = in_python(truth)
    expected = walk(crossnav.Agent(truth, SMALL), simulator, episode, 15)
    assert walk(crossnav.Agent(wrapped, SMALL), simulator, episode, 15) == expected
    assert isinstance(wrapped.detector, Detector)
    assert wrapped.detector.asked[0] == ("sofa", (160, 160, 3))


def test_parts_are_kept_by_the_agent(simulator: crossnav.Simulator,
                                     episode: crossnav.Episode) -> None:
    agent = crossnav.Agent(in_python(simulator.ground_truth()), SMALL)
    assert len(walk(agent, simulator, episode, 2)) == 2
    assert isinstance(agent.perception.encoder, Encoder)


def test_an_exception_in_python_comes_out_of_the_step(simulator: crossnav.Simulator) -> None:
    class Broken(crossnav.Detector):
        def detect(self, observation: crossnav.Observation, goal: str
                   ) -> list[crossnav.Detection]:
            raise ZeroDivisionError("the network is on holiday")

    truth = simulator.ground_truth()
    agent = crossnav.Agent(
        crossnav.Perception(Broken(), truth.segmenter, truth.stairs, truth.encoder), SMALL)
    agent.set_goal("sofa")
    with pytest.raises(ZeroDivisionError, match="on holiday"):
        agent.step(simulator.observe())


class Boxes(crossnav.Detector):
    def __init__(self, boxes: Sequence[tuple[int, int, int, int]]) -> None:
        super().__init__()
        self.boxes = boxes

    def detect(self, observation: crossnav.Observation, goal: str) -> list[crossnav.Detection]:
        return [crossnav.Detection(box, 0.9) for box in self.boxes]


@pytest.mark.parametrize("box", [(-1, 0, 5, 5), (0, 0, 161, 5), (5, 5, 5, 9)])
def test_boxes_outside_the_image_are_exceptions(simulator: crossnav.Simulator,
                                                box: tuple[int, int, int, int]) -> None:
    truth = simulator.ground_truth()
    agent = crossnav.Agent(
        crossnav.Perception(Boxes([box]), truth.segmenter, truth.stairs, truth.encoder), SMALL)
    agent.set_goal("sofa")
    with pytest.raises(crossnav.Error, match=r"Detector\.detect: a box"):
        agent.step(simulator.observe())


def test_arrays_of_the_wrong_shape_are_exceptions(simulator: crossnav.Simulator) -> None:
    class FlatStairs(crossnav.StairSegmenter):
        def segment_stairs(self, observation: crossnav.Observation) -> Any:
            return np.zeros((4, 4))

    class OtherEncoder(Encoder):
        def encode_image(self, observation: crossnav.Observation) -> Any:
            return np.zeros((2, 2, 3), np.float32)

    truth = simulator.ground_truth()
    for part, stairs, encoder in (("StairSegmenter", FlatStairs(), truth.encoder),
                                  ("DenseEncoder", truth.stairs, OtherEncoder(truth.encoder))):
        agent = crossnav.Agent(
            crossnav.Perception(truth.detector, truth.segmenter, stairs, encoder), SMALL)
        agent.set_goal("sofa")
        with pytest.raises(crossnav.Error, match=part):
            agent.step(simulator.observe())


def test_a_method_that_was_not_written_is_named(simulator: crossnav.Simulator) -> None:
    class Empty(crossnav.Detector):
        pass

    with pytest.raises(RuntimeError, match="detect"):
        Empty().detect(simulator.observe(), "sofa")
