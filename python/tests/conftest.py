# SPDX-License-Identifier: MIT
"""The embedded house with small pictures, made once."""

import math
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import crossnav

SMALL = {
    "sensor": {"width_px": 160, "height_px": 160},
    "ground_truth": {"min_visible_px": 20, "feature_dim": 64},
}


@pytest.fixture(scope="session")
def scenes_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scenes")
    crossnav.write_embedded_house(folder)
    return folder


@pytest.fixture(scope="session")
def scene(scenes_dir: Path) -> crossnav.Scene:
    return crossnav.Scene(scenes_dir, config=SMALL)


@pytest.fixture(scope="session")
def episode(scene: crossnav.Scene) -> crossnav.Episode:
    return crossnav.make_episode(scene, ["sofa", "toilet", "bed"], start_floor=0, seed=1)


@pytest.fixture(scope="session")
def replay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The replay of 30 steps that the program itself wrote; trace.jsonl beside it."""
    program = os.environ.get("CROSSNAV_PROGRAM", "")
    if not program:
        pytest.skip("scripts/test_python.sh names the program, where it is built")
    out = tmp_path_factory.mktemp("demo")
    # Exit status 1: so few steps find no goal.
    done = subprocess.run(
        [program, "demo", "2", "--quiet", "--out", str(out), "--set", "eval.action_budget=30",
         "--set", "sensor.width_px=160", "--set", "sensor.height_px=160"],
        capture_output=True, text=True, check=False)
    written = out / "2" / "replay.mcap"
    assert written.is_file(), done.stderr
    return written


@pytest.fixture
def simulator(scene: crossnav.Scene, episode: crossnav.Episode) -> crossnav.Simulator:
    simulator = crossnav.Simulator(scene)
    simulator.reset(episode.start)
    return simulator


@pytest.fixture
def agent(simulator: crossnav.Simulator) -> crossnav.Agent:
    return crossnav.Agent(simulator.ground_truth(), SMALL)


class Wall:
    """A wall 2 m before a camera 1 m above the ground that looks along world +x."""

    camera = crossnav.CameraIntrinsics.from_hfov(32, 24, 90)
    T_world_camera = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1], [0, 0, 0, 1]])
    depth_m = np.full((24, 32), 2.0, np.float32)
    p_hit_world = (2.05, 0.05, 1.05)
    half_width_m = 2.0 * math.tan(math.radians(45))


@pytest.fixture
def wall() -> type[Wall]:
    return Wall
