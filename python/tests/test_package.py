# SPDX-License-Identifier: MIT
"""The wheel itself: its content, import from any folder, and its types."""

import json
import os
import re
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path

import pytest

import crossnav

ROOT = os.environ.get("CROSSNAV_ROOT", "")
WHEEL = os.environ.get("CROSSNAV_WHEEL", "")
needs_wheel = pytest.mark.skipif(not WHEEL, reason="scripts/test_python.sh names the wheel")

USER = '''
import numpy as np
from numpy.typing import NDArray
import crossnav


class NoStairs(crossnav.StairSegmenter):
    def segment_stairs(self, observation: crossnav.Observation) -> NDArray[np.float32]:
        return np.zeros(observation.depth_m.shape, np.float32)


def drive(scenes_dir: str, goal: str) -> bool:
    scene = crossnav.Scene(scenes_dir, config={"map.voxel_m": 0.1})
    simulator = crossnav.Simulator(scene)
    simulator.reset(crossnav.AgentPose((1.0, 2.0, 0.0), 0.5))
    truth = simulator.ground_truth()
    perception = crossnav.Perception(truth.detector, truth.segmenter, NoStairs(), truth.encoder)
    agent = crossnav.Agent(perception, scene.config)
    agent.set_goal(goal)
    for _ in range(100):
        result = agent.step(simulator.observe())
        if result.action == crossnav.Action.STOP:
            return simulator.is_reached(goal)
        moved_m: float = simulator.step(result.action)
        print(moved_m, result.trace["mode"], agent.map.stats()["known"])
    for cluster in agent.memory.query(truth.encoder.encode_text(goal)):
        print(cluster.score, float(cluster.p_center_world[0]))
    keys, states, inflated = agent.map.voxels()
    print(keys[states == crossnav.VoxelState.OCCUPIED].shape, inflated.sum())
    try:
        crossnav.save_map("home.map", agent.map, agent.memory)
    except crossnav.Error as error:
        print(error.where, error.what)
    return False
'''


@pytest.mark.parametrize("folder", ["/", ROOT or "/", "tmp"])
def test_it_imports_from_any_folder(folder: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import crossnav; print(crossnav.__version__)"],
        cwd=tmp_path if folder == "tmp" else folder, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == metadata.version("crossnav") == crossnav.__version__, done.stderr


def test_types_of_a_users_file_hold(tmp_path: Path) -> None:
    file = tmp_path / "user.py"
    file.write_text(USER, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    done = subprocess.run([*command, str(file)], cwd=tmp_path, capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    file.write_text(USER.replace("simulator.step(result.action)", "simulator.step('forward')"),
                    encoding="utf-8")
    done = subprocess.run([*command, str(file)], cwd=tmp_path, capture_output=True, text=True,
                          check=False)
    assert done.returncode == 1 and "user.py:24" in done.stdout, done.stdout


@needs_wheel
def test_the_wheel_is_small_and_whole() -> None:
    assert Path(WHEEL).stat().st_size < 30e6
    with zipfile.ZipFile(WHEEL) as wheel:
        names = wheel.namelist()
    for name in ("crossnav/__init__.py", "crossnav/_core.pyi", "crossnav/py.typed",
                 "crossnav/gym.py", "crossnav/habitat.py", "crossnav/data/live.desc"):
        assert name in names
    assert sum("_core" in name and name.endswith(".so") for name in names) == 1
    assert not [name for name in names if name.startswith(("build/", "python/"))]


@needs_wheel
def test_the_wheel_holds_no_path_of_the_machine_that_built_it() -> None:
    with zipfile.ZipFile(WHEEL) as wheel:
        for name in wheel.namelist():
            data = wheel.read(name)
            for path in (ROOT, str(Path.home()) + "/"):
                assert path.encode() not in data, f"{path} in {name}"


@needs_wheel
@pytest.mark.skipif(not os.environ.get("CROSSNAV_PROGRAM"), reason="the program is not built")
def test_the_wheel_brings_the_program_and_its_small_network(tmp_path: Path) -> None:
    program = Path(sys.executable).with_name("crossnav")
    done = subprocess.run([program, "networks", "list", "--json"], cwd=tmp_path,
                          capture_output=True, text=True, check=True)
    listed = json.loads(done.stdout)
    assert Path(listed["dir"]) == Path(crossnav.__file__).parent / "share/crossnav/networks"
    assert {n["name"]: n["found"] for n in listed["networks"]}["crossnav_small"]


@pytest.mark.skipif(not ROOT, reason="scripts/test_python.sh names the checkout")
def test_the_extra_is_the_version_of_openvino_that_is_built_against() -> None:
    pin = re.search(r"^openvino==[\d.]+", (Path(ROOT) / "scripts/openvino.txt").read_text("utf-8"),
                    re.MULTILINE)
    wanted = metadata.requires("crossnav") or []
    assert pin and f"{pin[0]}; extra == 'openvino'" in [w.replace('"', "'") for w in wanted]
