# SPDX-License-Identifier: MIT
"""`crossnav map build`: a bag that the package rosbags writes, against the same frames given directly."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossnav

ROOT = Path(os.environ.get("CROSSNAV_ROOT", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("CROSSNAV_PROGRAM", ROOT / "build/release/apps/crossnav/crossnav"))
FRAMES = 200
STEP_NS = 250 * 10**6  # a step of 0.25 m or a turn of 30 degrees in a quarter of a second

needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")


def quaternion_of(R: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """x, y, z, w of a rotation matrix."""
    values, vectors = np.linalg.eigh(np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
        [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
        [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], np.trace(R)]]))
    q = vectors[:, np.argmax(values)]
    return q / np.linalg.norm(q)


def pose_of(p: np.ndarray[Any, Any], q: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """4 x 4, rounded as Eigen's toRotationMatrix rounds."""
    x, y, z, w = (float(n) for n in q)
    tx, ty, tz = 2 * x, 2 * y, 2 * z
    T = np.eye(4)
    T[:3, :3] = [[1 - (ty * y + tz * z), ty * x - tz * w, tz * x + ty * w],
                 [ty * x + tz * w, 1 - (tx * x + tz * z), tz * y - tx * w],
                 [tz * x - ty * w, tz * y + tx * w, 1 - (tx * x + ty * y)]]
    T[:3, 3] = p
    return T


def walk(tmp_path: Path) -> list[tuple[crossnav.Observation, Any, Any]]:
    """Frames of a generated house with position and quaternion of the camera."""
    crossnav.generate_house(tmp_path / "scenes", seed=5, floors=1)
    scene = crossnav.Scene(tmp_path / "scenes",
                           config={"sensor": {"width_px": 96, "height_px": 72, "hfov_deg": 80}})
    simulator = crossnav.Simulator(scene)
    simulator.reset(crossnav.AgentPose(scene.random_point(2), 0.5))
    rng = np.random.default_rng(1)
    actions = [crossnav.Action.MOVE_FORWARD] * 6 + [crossnav.Action.TURN_LEFT,
                                               crossnav.Action.TURN_RIGHT,
                                               crossnav.Action.LOOK_UP, crossnav.Action.LOOK_DOWN]
    frames = []
    while len(frames) < FRAMES:
        obs = simulator.observe()
        T = obs.T_world_camera
        frames.append((obs, T[:3, 3].copy(), quaternion_of(T[:3, :3])))
        simulator.step(actions[rng.integers(len(actions))])
    return frames


@needs_program
def test_the_map_of_a_bag_is_that_of_its_frames(tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    sys.path.insert(0, str(ROOT / "tests/recordings"))
    from bag_writer import BagWriter  # type: ignore[import-not-found]

    frames = walk(tmp_path)
    K = frames[0][0].camera
    direct = crossnav.VoxelMap()
    with BagWriter(tmp_path / "bag", is_compressed=True) as bag:
        bag.camera_info("/camera/camera_info", 0, "camera", (K.width_px, K.height_px),
                        (K.fx, K.fy, K.cx, K.cy))
        bag.camera_info("/depth/camera_info", 0, "camera", (K.width_px, K.height_px),
                        (K.fx, K.fy, K.cx, K.cy))
        for i, (obs, p, q) in enumerate(frames):
            time_ns = 10**9 + i * STEP_NS
            bag.odometry("/odom", time_ns, "map", "camera", p, q)
            bag.image("/camera/image", time_ns, "camera", obs.rgb, "rgb8")
            bag.image("/depth/image", time_ns, "camera", obs.depth_m, "32FC1")
            direct.integrate(obs.depth_m, K, pose_of(p, q))

    done = subprocess.run([PROGRAM, "map", "build", "--json", "--quiet", "--from", tmp_path / "bag",
                           "--out", tmp_path / "bag.map"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["recording"]["frames"] == FRAMES
    loaded = crossnav.load_map(tmp_path / "bag.map")[0]

    def sorted_voxels(voxel_map: crossnav.VoxelMap) -> np.ndarray[Any, Any]:
        keys, states, inflated = voxel_map.voxels()
        rows = np.column_stack([keys, states, inflated])
        return rows[np.lexsort(rows.T[::-1])]

    expected, got = sorted_voxels(direct), sorted_voxels(loaded)
    assert len(expected) > 10000
    np.testing.assert_array_equal(got, expected)
