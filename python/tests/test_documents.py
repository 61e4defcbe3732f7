# SPDX-License-Identifier: MIT
"""Python in the documents: every name of ours that it uses is there, and blocks run on a small house."""

import ast
import importlib
import os
import re
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import crossnav

ROOT = Path(os.environ.get("CROSSNAV_ROOT", Path(__file__).parents[2]))
BLOCKS = [
    (f"{page.name}-{number}", text)
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    for number, text in enumerate(re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.S))
]
# Blocks not run here: a bag, a network of torch, a robot (test_live.py), a window (test_rerun.py).
NAMES_ONLY = {"read_recording(", "semantic_annotations(", "torch.from_numpy", "live.Client(", "rerun.init("}


def modules_of(tree: ast.AST) -> dict[str, Any]:
    """Modules and names of ours that a block imports; `crossnav` is there anyway."""
    found: dict[str, Any] = {"crossnav": crossnav}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("crossnav"):
            module = importlib.import_module(node.module or "")
            for alias in node.names:
                try:
                    found[alias.name] = getattr(module, alias.name)
                except AttributeError:
                    found[alias.name] = importlib.import_module(f"{node.module}.{alias.name}")
        elif isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.startswith("crossnav."):
                    importlib.import_module(alias.name)
    return found


@pytest.mark.parametrize("text", [text for _, text in BLOCKS], ids=[name for name, _ in BLOCKS])
def test_names_of_ours_are_there(text: str) -> None:
    tree = ast.parse(text)
    modules = modules_of(tree)
    for node in ast.walk(tree):
        chain = []
        while isinstance(node, ast.Attribute):
            chain.insert(0, node.attr)
            node = node.value
        if chain and isinstance(node, ast.Name) and node.id in modules:
            value = modules[node.id]
            for name in chain:
                assert hasattr(value, name), f"{node.id}.{'.'.join(chain)}"
                value = getattr(value, name)


class NoDetector(crossnav.Detector):
    def detect(self, observation: crossnav.Observation, goal: str) -> list[crossnav.Detection]:
        return []


class NoMasks(crossnav.Segmenter):
    def segment(self, observation: crossnav.Observation, box: tuple[int, int, int, int]) -> tuple[Any, float]:
        return np.zeros(observation.depth_m.shape, np.float32), 0.0


class NoStairs(crossnav.StairSegmenter):
    def segment_stairs(self, observation: crossnav.Observation) -> Any:
        return np.zeros(observation.depth_m.shape, np.float32)


class OneFeature(crossnav.DenseEncoder):
    def dim(self) -> int:
        return 4

    def name(self) -> str:
        return "one"

    def encode_text(self, text: str) -> Any:
        return np.array([1, 0, 0, 0], np.float32)

    def encode_image(self, observation: crossnav.Observation) -> Any:
        return np.tile(self.encode_text(""), (6, 8, 1))


class OneStepEnvironment:
    """Of Habitat, as far as the page goes."""

    episode_over = False

    def __init__(self, observations: dict[str, Any]) -> None:
        self.observations = observations

    def step(self, action: Any) -> dict[str, Any]:
        self.episode_over = True
        assert action is not None
        return self.observations


def prepared(scene: crossnav.Scene, wall: Any) -> dict[str, Any]:
    """Names that the blocks take from the text around them."""
    simulator = crossnav.Simulator(scene)
    simulator.reset(crossnav.AgentPose(scene.random_point(seed=1)))
    observations = {
        "rgb": np.zeros((480, 640, 3), np.uint8), "depth": np.full((480, 640, 1), 0.5, np.float32),
        "gps": np.zeros(3, np.float32), "compass": np.zeros(1, np.float32),
        "objectgoal": np.zeros(1, np.int64),
    }
    vga = np.full((480, 640), 2.0, np.float32)
    return {
        "crossnav": crossnav, "np": np, "scene": scene, "simulator": simulator,
        "perception": crossnav.Perception(NoDetector(), NoMasks(), NoStairs(), OneFeature()), "env": OneStepEnvironment(observations),
        "observations": observations, "depth_m": vga, "T_world_camera": wall.T_world_camera,
        "rgb": np.zeros((480, 640, 3), np.uint8), "T": np.eye(4), "mounting": np.eye(4),
        "camera": crossnav.CameraIntrinsics(640, 480, fx=525.0, fy=525.0, cx=319.5, cy=239.5),
        "colour_camera": crossnav.CameraIntrinsics(640, 480, fx=525.0, fy=525.0, cx=319.5, cy=239.5),
        "features": np.ones((24, 24, 8), np.float32), "text_vector": np.ones(8, np.float32),
    }


RUN = [(name, text) for name, text in BLOCKS if not any(word in text for word in NAMES_ONLY)]


@pytest.mark.parametrize("text", [text for _, text in RUN], ids=[name for name, _ in RUN])
def test_blocks_run(text: str, scene: crossnav.Scene, wall: Any, tmp_path: Path,
                    monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    if "gymnasium" in text:
        pytest.importorskip("gymnasium")
    for folder in ("houses", "scenes"):
        crossnav.write_embedded_house(folder)
    small = f'**{SMALL!r}, "eval": {{"action_budget": 500}}'
    text = text.replace('"eval.action_budget": 500', small)  # the same loop with small pictures
    module = types.ModuleType("document")
    monkeypatch.setitem(sys.modules, "document", module)
    exec(text, {**prepared(scene, wall), "__name__": "document"})  # noqa: S102: our own pages
