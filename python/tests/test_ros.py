# SPDX-License-Identifier: MIT
"""Conversions of ROS 2 messages, with the types of the package rosbags; and the example node."""

import importlib.util
import math
import os
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossnav
from crossnav import live, ros

typesys = pytest.importorskip("rosbags.typesys")
TYPES = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE).types
ROOT = Path(os.environ.get("CROSSNAV_ROOT", Path(__file__).resolve().parents[2]))


def header(time_ns: int = 5 * 10**9 + 7, frame_id: str = "camera") -> Any:
    stamp = TYPES["builtin_interfaces/msg/Time"](sec=time_ns // 10**9, nanosec=time_ns % 10**9)
    return TYPES["std_msgs/msg/Header"](stamp=stamp, frame_id=frame_id)


def image(pixels: np.ndarray, encoding: str, padding: int = 0, is_bigendian: int = 0,
          frame_id: str = "camera") -> Any:
    rows = np.ascontiguousarray(pixels).reshape(pixels.shape[0], -1).view(np.uint8)
    rows = np.pad(rows, ((0, 0), (0, padding)), constant_values=77)
    return TYPES["sensor_msgs/msg/Image"](
        header=header(frame_id=frame_id), height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
        is_bigendian=is_bigendian, step=rows.shape[1], data=rows.reshape(-1))


def info(k: tuple[float, ...], p: tuple[float, ...], d: tuple[float, ...] = (0, 0, 0, 0, 0),
         size: tuple[int, int] = (64, 48)) -> Any:
    fx, fy, cx, cy = k
    px, py, qx, qy = p
    region = TYPES["sensor_msgs/msg/RegionOfInterest"](
        x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
    return TYPES["sensor_msgs/msg/CameraInfo"](
        header=header(), height=size[1], width=size[0], distortion_model="plumb_bob", d=np.array(d, float),
        k=np.array([fx, 0, cx, 0, fy, cy, 0, 0, 1.0]), r=np.eye(3).reshape(-1),
        p=np.array([px, 0, qx, 0, 0, py, qy, 0, 0, 0, 1.0 if px else 0, 0]), binning_x=0,
        binning_y=0, roi=region)


def transform(p: tuple[float, ...], q: tuple[float, ...]) -> Any:
    return TYPES["geometry_msgs/msg/TransformStamped"](
        header=header(), child_frame_id="base",
        transform=TYPES["geometry_msgs/msg/Transform"](
            translation=TYPES["geometry_msgs/msg/Vector3"](*p),
            rotation=TYPES["geometry_msgs/msg/Quaternion"](*q)))


def odometry(p: tuple[float, ...], q: tuple[float, ...]) -> Any:
    pose = TYPES["geometry_msgs/msg/Pose"](
        position=TYPES["geometry_msgs/msg/Point"](*p),
        orientation=TYPES["geometry_msgs/msg/Quaternion"](*q))
    vector = TYPES["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
    twist = TYPES["geometry_msgs/msg/Twist"](linear=vector, angular=vector)
    return TYPES["nav_msgs/msg/Odometry"](
        header=header(), child_frame_id="base",
        pose=TYPES["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=np.zeros(36)),
        twist=TYPES["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=np.zeros(36)))


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8", "rgba8", "bgra8"])
@pytest.mark.parametrize("padding", [0, 5])
def test_colour_is_rgb_whatever_its_order_and_padding(encoding: str, padding: int) -> None:
    rgb = np.random.default_rng(1).integers(0, 256, (4, 6, 3)).astype(np.uint8)
    pixels = rgb[..., ::-1] if encoding.startswith("bgr") else rgb
    if encoding.endswith("a8"):
        pixels = np.concatenate([pixels, np.full((4, 6, 1), 9, np.uint8)], axis=2)
    np.testing.assert_array_equal(ros.rgb_of(image(pixels, encoding, padding)), rgb)


def test_depth_is_metres_whatever_its_unit_and_byte_order() -> None:
    mm = np.array([[0, 1500, 65535], [800, 2, 3000]], np.uint16)
    expected = (mm / np.float32(1000)).astype(np.float32)
    for encoding in ("16UC1", "mono16"):
        np.testing.assert_array_equal(ros.depth_m_of(image(mm, encoding, 3)), expected)
    big = image(mm.astype(">u2"), "16UC1", is_bigendian=1)
    np.testing.assert_array_equal(ros.depth_m_of(big), expected)
    metres = np.array([[0.5, np.nan], [np.inf, 2]], np.float32)
    for order, is_bigendian in (("<f4", 0), (">f4", 1)):
        got = ros.depth_m_of(image(metres.astype(order), "32FC1", 4, is_bigendian))
        np.testing.assert_array_equal(got, metres)
        assert got.dtype == np.float32 and got.dtype.isnative


def test_images_that_are_no_such_thing_are_errors() -> None:
    mm = np.zeros((2, 3), np.uint16)
    with pytest.raises(crossnav.Error, match="no colour"):
        ros.rgb_of(image(mm, "16UC1"))
    with pytest.raises(crossnav.Error, match="no depth"):
        ros.depth_m_of(image(np.zeros((2, 3, 3), np.uint8), "rgb8"))
    cut = image(mm, "16UC1")
    cut.data = cut.data[:-1]
    with pytest.raises(crossnav.Error, match="11 bytes"):
        ros.depth_m_of(cut)


def test_the_camera_is_p_or_an_undistorted_k() -> None:
    rectified = ros.camera_of(info((50, 51, 32, 24), (60, 61, 30, 20), (0.1, 0, 0, 0, 0)))
    assert (rectified.fx, rectified.fy, rectified.cx, rectified.cy) == (60, 61, 30, 20)
    assert (rectified.width_px, rectified.height_px) == (64, 48)
    plain = ros.camera_of(info((50, 51, 32, 24), (0, 0, 0, 0)))
    assert (plain.fx, plain.fy, plain.cx, plain.cy) == (50, 51, 32, 24)
    with pytest.raises(crossnav.Error, match="rectify"):
        ros.camera_of(info((50, 51, 32, 24), (0, 0, 0, 0), (0.1, 0, 0, 0, 0)))


def test_poses_are_matrices() -> None:
    q = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))  # a quarter turn to the left
    T = ros.pose_of(odometry((1.0, 2.0, 3.0), q))
    np.testing.assert_allclose(T @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-12)
    np.testing.assert_array_equal(ros.pose_of(transform((1.0, 2.0, 3.0), q)), T)
    with pytest.raises(crossnav.Error, match="unit quaternion"):
        ros.pose_of(odometry((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)))


@pytest.mark.parametrize("pitch_rad", [0.0, -0.5])
def test_a_mounted_camera_is_where_an_agents_is(pitch_rad: float) -> None:
    q = (0.0, 0.0, math.sin(0.35), math.cos(0.35))
    T_world_base = ros.pose_of(odometry((1.0, 2.0, 3.0), q))
    expected = crossnav.AgentPose((1, 2, 3), 0.7, pitch_rad).camera_pose(0.6)
    np.testing.assert_allclose(T_world_base @ ros.mounting(0.6, pitch_rad=pitch_rad), expected,
                               atol=1e-12)


def test_messages_make_an_observation_with_the_depths_time() -> None:
    camera = crossnav.CameraIntrinsics.from_hfov(6, 4, 90)
    rgb = np.full((4, 6, 3), 7, np.uint8)
    depth = image(np.full((4, 6), 1500, np.uint16), "16UC1")
    obs = ros.observation_of(image(rgb, "rgb8"), depth, camera, np.eye(4), ros.mounting(0.6))
    assert obs.time_ns == 5 * 10**9 + 7
    assert (obs.depth_m == 1.5).all() and (obs.rgb == 7).all()
    assert obs.T_world_camera[2, 3] == 0.6
    np.testing.assert_array_equal(obs.T_base_camera, ros.mounting(0.6))
    assert obs.rgb_camera is None


# TF's optical frame of a camera that looks ahead: z ahead, x right, y down.
OPTICAL = (-0.5, 0.5, -0.5, 0.5)


def test_the_mounting_comes_from_tf_and_colour_may_have_a_camera_of_its_own() -> None:
    camera = ros.camera_of(info((32, 32, 31.5, 23.5), (0, 0, 0, 0)))
    colour_camera = ros.camera_of(info((80, 81, 40, 30), (0, 0, 0, 0), size=(80, 60)))
    T_base_camera = ros.pose_of(transform((0.2, 0.1, 0.6), OPTICAL))
    np.testing.assert_allclose(T_base_camera[:3, :3], ros.mounting(0.6)[:3, :3], atol=1e-15)
    T_camera_rgb = ros.pose_of(transform((0.05, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
    q = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
    obs = ros.observation_of(
        image(np.full((60, 80, 3), 7, np.uint8), "rgb8", frame_id="colour"),
        image(np.full((48, 64), 2000, np.uint16), "16UC1"), camera,
        ros.pose_of(odometry((1.0, 2.0, 3.0), q)), T_base_camera, colour_camera, T_camera_rgb)
    # A quarter turn to the left: 0.2 m ahead is +y, 0.1 m to the left is -x.
    np.testing.assert_allclose(obs.T_world_camera[:3, 3], [0.9, 2.2, 3.6], atol=1e-12)
    np.testing.assert_array_equal(obs.T_base_camera, T_base_camera)
    np.testing.assert_array_equal(obs.T_camera_rgb, T_camera_rgb)
    assert obs.rgb_camera is not None
    assert (obs.rgb_camera.width_px, obs.rgb_camera.fy, obs.rgb.shape) == (80, 81, (60, 80, 3))
    assert obs.registered().rgb.shape == (48, 64, 3)
    with pytest.raises(crossnav.Error, match="rgb_camera"):
        ros.observation_of(image(np.zeros((48, 64, 3), np.uint8), "rgb8"),
                           image(np.ones((48, 64), np.uint16), "16UC1"), camera, np.eye(4),
                           T_base_camera, colour_camera, T_camera_rgb)


def test_a_command_becomes_a_twist() -> None:
    vector = TYPES["geometry_msgs/msg/Vector3"]
    twist = TYPES["geometry_msgs/msg/Twist"](linear=vector(9.0, 9.0, 9.0),
                                             angular=vector(9.0, 9.0, 9.0))
    assert ros.fill_twist(live.Command(0.25, -0.5, 0.1, 1.0), twist) is twist
    assert (twist.linear.x, twist.linear.y, twist.linear.z) == (0.25, 0, 0)
    assert (twist.angular.x, twist.angular.y, twist.angular.z) == (0, 0, -0.5)


class StubTwist(types.SimpleNamespace):
    def __init__(self) -> None:
        super().__init__(linear=types.SimpleNamespace(x=0.0, y=0.0, z=0.0),
                         angular=types.SimpleNamespace(x=0.0, y=0.0, z=0.0))


class StubClock:
    """Nanoseconds that the test sets."""

    nanoseconds = 0

    def now(self) -> "StubTime":
        return StubTime(self.nanoseconds)


class StubTime(int):
    @property
    def nanoseconds(self) -> int:
        return int(self)

    def __add__(self, other: int) -> "StubTime":
        return StubTime(int(self) + int(other))


class StubNode:
    """The subset of rclpy's Node that the example uses."""

    def __init__(self, name: str) -> None:
        self.sent: list[Any] = []
        self.clock = StubClock()
        self.logs: list[str] = []

    def declare_parameter(self, name: str, default: Any) -> Any:
        return types.SimpleNamespace(value=PARAMETERS.get(name, default))

    def create_publisher(self, *_: Any) -> Any:
        return types.SimpleNamespace(publish=self.sent.append)

    def create_timer(self, *_: Any) -> None:
        pass

    def get_clock(self) -> StubClock:
        return self.clock

    def get_logger(self) -> Any:
        def log(text: str, **_: Any) -> None:
            self.logs.append(text)
        return types.SimpleNamespace(info=log, warning=log, error=log)


PARAMETERS: dict[str, Any] = {}
TRANSFORMS: dict[tuple[str, str], Any] = {}


class StubTransformError(Exception):
    pass


class StubBuffer:
    """The transforms of tf2: TRANSFORMS."""

    def lookup_transform(self, target: str, source: str, time: Any) -> Any:
        if (target, source) not in TRANSFORMS:
            raise StubTransformError(f"no transform from {source} to {target}")
        return TRANSFORMS[target, source]


def example_node(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module python/examples/ros2_node.py over stand-ins for ROS."""
    synchronizer = types.SimpleNamespace(registerCallback=lambda callback: None)
    modules = {
        "rclpy": {}, "rclpy.node": {"Node": StubNode},
        "rclpy.duration": {"Duration": lambda seconds: round(seconds * 1e9)},
        "rclpy.time": {"Time": lambda: 0},
        "tf2_ros": {"Buffer": StubBuffer, "TransformException": StubTransformError,
                    "TransformListener": lambda *_: None},
        "geometry_msgs": {}, "geometry_msgs.msg": {"Twist": StubTwist},
        "nav_msgs": {}, "nav_msgs.msg": {"Odometry": object},
        "sensor_msgs": {}, "sensor_msgs.msg": {"CameraInfo": object, "Image": object},
        "message_filters": {"ApproximateTimeSynchronizer": lambda *_, **__: synchronizer,
                            "Subscriber": lambda *_: None},
    }
    for name, members in modules.items():
        module = types.ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)
    spec = importlib.util.spec_from_file_location("ros2_node",
                                                  ROOT / "python/examples/ros2_node.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_example_node_moves_ends_its_moves_and_stands_when_the_server_dies(
        monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from test_live import PROGRAM, Server
    if not PROGRAM.is_file():
        pytest.skip("the program is not built")
    server = Server(tmp_path, "--perception", "none", "--set", "action.max_pitch_deg=0")
    try:
        PARAMETERS.update(socket=server.socket, goal="bed")
        node = example_node(monkeypatch).CrossnavNode()
        frame = (image(np.zeros((60, 80, 3), np.uint8), "rgb8", frame_id="colour"),
                 info((80, 81, 40, 30), (0, 0, 0, 0), size=(80, 60)),
                 image(np.full((48, 64), 3000, np.uint16), "16UC1"),
                 info((32, 32, 31.5, 23.5), (32, 32, 31.5, 23.5)),
                 odometry((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
        node.look(*frame)  # TF has not come yet
        assert not node.is_moving and "no transform" in node.logs[-1] and not node.sent
        TRANSFORMS["base_footprint", "camera"] = transform((0.2, 0.0, 0.6), OPTICAL)
        TRANSFORMS["base", "base_footprint"] = transform((0.0, 0.0, -0.1), (0.0, 0.0, 0.0, 1.0))
        TRANSFORMS["camera", "colour"] = transform((0.05, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        seen = node.observation_of(*frame)
        assert seen.T_world_camera[0, 3] == seen.T_base_camera[0, 3] == 0.2
        assert seen.T_base_camera[2, 3] == 0.6 and seen.T_world_camera[2, 3] == 0.5
        assert seen.rgb_camera.width_px == 80 and seen.T_camera_rgb[0, 3] == 0.05
        registered = (image(np.zeros((48, 64, 3), np.uint8), "rgb8"), frame[3], *frame[2:])
        assert node.observation_of(*registered).rgb_camera is None
        node.look(*frame)
        assert node.is_moving and len(node.sent) == 1, node.logs
        twist = node.sent[0]
        assert twist.linear.x > 0 or twist.angular.z != 0
        node.look(*frame)  # while it moves, pictures are of no use
        assert len(node.sent) == 1
        node.clock.nanoseconds = 2 * 10**9
        node.watch()
        assert not node.is_moving and vars(node.sent[-1].linear)["x"] == 0.0
        server.process.kill()
        server.process.wait()
        node.look(*frame)
        assert node.client is None and not node.is_moving
        assert "connect again" in node.logs[-1]
    finally:
        server.process.kill()
        server.process.communicate()
        PARAMETERS.clear()
        TRANSFORMS.clear()


class StubMarker(types.SimpleNamespace):
    def __init__(self) -> None:
        space = types.SimpleNamespace
        super().__init__(header=space(frame_id=""), ns="", id=0, type=0, action=-1,
                         pose=space(position=space(x=0.0, y=0.0, z=0.0), orientation=space(w=0.0)),
                         scale=space(x=0.0, y=0.0, z=0.0), color=space(r=0.0, g=0.0, b=0.0, a=0.0),
                         points=[], text="")


def test_a_graph_becomes_markers() -> None:
    graph = {"rooms": [{"id": 0, "center": [1, 1, 0], "box_min": [0, 0, 0], "box_max": [2, 2, 2.5]},
                       {"id": 1, "center": [3, 1, 0], "box_min": [2, 0, 0], "box_max": [4, 2, 2.5]}],
             "passages": [{"rooms": [0, 1], "position": [2, 1, 0], "width_m": 0.9}],
             "objects": [{"id": 0, "category": "table", "box_min": [0, 0, 0], "box_max": [1, 1, 0.8]},
                         {"id": 1, "category": "plant", "box_min": [0.2, 0.2, 0.8],
                          "box_max": [0.4, 0.4, 1.2]}],
             "relations": [{"relation": "on", "from": 1, "to": 0}]}
    markers = ros.markers_of(graph, StubMarker, types.SimpleNamespace, "world")
    kinds = [(marker.ns, marker.type) for marker in markers]
    assert kinds == [("rooms", 1)] * 2 + [("objects", 1), ("names", 9)] * 2 + [("passages", 5),
                                                                              ("relations", 5)]
    assert all(marker.header.frame_id == "world" for marker in markers)
    plant, name = markers[4], markers[5]
    assert (plant.pose.position.x, plant.pose.position.z) == (pytest.approx(0.3), pytest.approx(1.0))
    assert plant.scale.z == pytest.approx(0.4)
    assert name.text == "plant" and name.pose.position.z == pytest.approx(1.3)
    assert len(markers[-2].points) == 4 and len(markers[-1].points) == 2
