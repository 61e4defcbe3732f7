# SPDX-License-Identifier: MIT
"""Messages of ROS 2 to observations and commands to messages (docs/live.md). Needs no ROS.

Messages are read by their fields, so that the classes of rclpy and of the package rosbags are both accepted.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crossnav._core import CameraIntrinsics, Observation
from crossnav._errors import Error
from crossnav.live import Command

_COLOUR_CHANNELS = {"rgb8": (0, 1, 2), "bgr8": (2, 1, 0), "rgba8": (0, 1, 2), "bgra8": (2, 1, 0),
                    "mono8": (0, 0, 0)}
_BYTES_PER_PIXEL = {"rgb8": 3, "bgr8": 3, "rgba8": 4, "bgra8": 4, "mono8": 1, "16UC1": 2,
                    "mono16": 2, "32FC1": 4}


def _rows(image: Any) -> NDArray[np.uint8]:
    """H x (bytes of a row) of a sensor_msgs/Image; padding behind the rows is cut off."""
    if image.encoding not in _BYTES_PER_PIXEL:
        raise Error(f'has encoding "{image.encoding}"; there are {", ".join(_BYTES_PER_PIXEL)}',
                    "image")
    data = np.frombuffer(bytes(image.data), np.uint8)
    used = image.width * _BYTES_PER_PIXEL[image.encoding]
    if image.step < used or data.size != image.height * image.step:
        raise Error(f"has {data.size} bytes; {image.height} rows of {image.step} were said",
                    "image.data")
    return data.reshape(image.height, image.step)[:, :used]


def rgb_of(image: Any) -> NDArray[np.uint8]:
    """H x W x 3 of a sensor_msgs/Image in colour."""
    if image.encoding not in _COLOUR_CHANNELS:
        raise Error(f'encoding "{image.encoding}" is no colour; there are '
                    f'{", ".join(_COLOUR_CHANNELS)}', "image")
    pixels = _rows(image).reshape(image.height, image.width, -1)
    return np.ascontiguousarray(pixels[..., _COLOUR_CHANNELS[image.encoding]])


def depth_m_of(image: Any) -> NDArray[np.float32]:
    """H x W [m] of a sensor_msgs/Image in 16UC1 or mono16 (millimetres) or 32FC1 (metres)."""
    order = ">" if image.is_bigendian else "<"
    if image.encoding in ("16UC1", "mono16"):
        millimetres = np.ascontiguousarray(_rows(image)).view(f"{order}u2")
        return (millimetres / np.float32(1000)).astype(np.float32)
    if image.encoding == "32FC1":
        return np.ascontiguousarray(_rows(image)).view(f"{order}f4").astype(np.float32)
    raise Error(f'encoding "{image.encoding}" is no depth; there are 16UC1, mono16, 32FC1', "image")


def camera_of(info: Any) -> CameraIntrinsics:
    """Of a sensor_msgs/CameraInfo; the images must be rectified, as P says of them.

    Without a P (all zero), K holds for images without distortion.
    """
    k, p = np.asarray(info.k, float), np.asarray(info.p, float)
    if p.any():
        fx, cx, fy, cy = p[0], p[2], p[5], p[6]
    elif not np.any(np.asarray(info.d, float)):
        fx, cx, fy, cy = k[0], k[2], k[4], k[5]
    else:
        raise Error("has distortion and no P: rectify the images first", "camera_info")
    return CameraIntrinsics(info.width, info.height, fx=fx, fy=fy, cx=cx, cy=cy)


def matrix_of(translation: Any, rotation: Any) -> NDArray[np.float64]:
    """4 x 4 of fields x, y, z [m] and x, y, z, w."""
    q = np.array([rotation.x, rotation.y, rotation.z, rotation.w], float)
    norm = np.linalg.norm(q)
    if not abs(norm - 1) < 0.01:
        raise Error(f"is no unit quaternion: its norm is {norm:.3g}", "rotation")
    x, y, z, w = q / norm
    T = np.eye(4)
    T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    T[:3, 3] = translation.x, translation.y, translation.z
    return T


def pose_of(message: Any) -> NDArray[np.float64]:
    """4 x 4 of a nav_msgs/Odometry, geometry_msgs/PoseStamped or geometry_msgs/TransformStamped."""
    if hasattr(message, "transform"):
        return matrix_of(message.transform.translation, message.transform.rotation)
    pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
    return matrix_of(pose.position, pose.orientation)


def mounting(camera_height_m: float, forward_m: float = 0.0,
             pitch_rad: float = 0.0) -> NDArray[np.float64]:
    """T_base_camera of a camera that looks ahead: base x ahead, z up; optical frame z ahead, y down."""
    c, s = np.cos(pitch_rad), np.sin(pitch_rad)
    T = np.eye(4)
    T[:3, :3] = np.array([[0, s, c], [-1, 0, 0], [0, -c, s]])
    T[:3, 3] = forward_m, 0.0, camera_height_m
    return T


def time_ns_of(header: Any) -> int:
    """Of a std_msgs/Header."""
    return int(header.stamp.sec) * 10**9 + int(header.stamp.nanosec)


def observation_of(colour: Any, depth: Any, camera: CameraIntrinsics,
                   T_world_base: ArrayLike, T_base_camera: ArrayLike,
                   colour_camera: CameraIntrinsics | None = None,
                   T_camera_rgb: ArrayLike | None = None) -> Observation:
    """One observation of two sensor_msgs/Image of the same moment.

    `camera` is depth's, and `T_base_camera` how it is mounted: `pose_of` the transform from the frame
    that the depth image names to the base, or `mounting`. Both images are of that camera unless
    `colour_camera` says which colour's is and `T_camera_rgb` where it sits in the depth camera's frame.
    """
    T_mounting = np.asarray(T_base_camera, float)
    T_colour = None if T_camera_rgb is None else np.asarray(T_camera_rgb, float)
    obs = Observation(depth_m_of(depth), camera, np.asarray(T_world_base, float) @ T_mounting,
                      rgb_of(colour), rgb_camera=colour_camera, T_camera_rgb=T_colour,
                      T_base_camera=T_mounting)
    obs.time_ns = time_ns_of(depth.header)
    return obs


def fill_twist(command: Command, twist: Any) -> Any:
    """Writes a command into a geometry_msgs/Twist, which is returned; the pitch is another joint's."""
    twist.linear.x, twist.linear.y, twist.linear.z = float(command.v_mps), 0.0, 0.0
    twist.angular.x, twist.angular.y, twist.angular.z = 0.0, 0.0, float(command.w_radps)
    return twist


_MARKER = {"cube": 1, "line_list": 5, "text": 9}  # visualization_msgs/Marker
_GRAPH_COLOURS = {"rooms": (0.11, 0.49, 0.84, 0.15), "objects": (0.84, 0.20, 0.42, 0.4),
                  "names": (1.0, 1.0, 1.0, 1.0), "passages": (0.18, 0.62, 0.27, 1.0),
                  "relations": (0.96, 0.62, 0.0, 1.0)}


def _marker(make: Any, frame_id: str, space: str, number: int, kind: str) -> Any:
    marker = make()
    marker.header.frame_id, marker.ns, marker.id = frame_id, space, number
    marker.type, marker.action = _MARKER[kind], 0
    marker.pose.orientation.w = 1.0
    colour = marker.color
    colour.r, colour.g, colour.b, colour.a = _GRAPH_COLOURS[space]
    return marker


def _place(point: Any, values: ArrayLike) -> Any:
    point.x, point.y, point.z = (float(value) for value in np.asarray(values, float))
    return point


def _box(marker: Any, low: ArrayLike, high: ArrayLike) -> Any:
    least, most = np.asarray(low, float), np.asarray(high, float)
    _place(marker.pose.position, (least + most) / 2)
    _place(marker.scale, most - least)
    return marker


def markers_of(graph: dict[str, Any], make_marker: Any, make_point: Any,
               frame_id: str = "map") -> list[Any]:
    """A map's graph (JSON of `crossnav map graph`) as visualization_msgs/Marker: fill MarkerArray.

    `make_marker` and `make_point` are the classes Marker and geometry_msgs/Point. Rooms lie as their
    ground, objects as boxes with their names; passages and relations are lines.
    """
    markers = []
    for room in graph["rooms"]:
        marker = _marker(make_marker, frame_id, "rooms", room["id"], "cube")
        low = room["box_min"]
        markers.append(_box(marker, low, [*room["box_max"][:2], low[2] + 0.05]))
    for one in graph["objects"]:
        markers.append(_box(_marker(make_marker, frame_id, "objects", one["id"], "cube"),
                            one["box_min"], one["box_max"]))
        name = _marker(make_marker, frame_id, "names", one["id"], "text")
        middle = (np.array(one["box_min"]) + np.array(one["box_max"])) / 2
        _place(name.pose.position, [middle[0], middle[1], one["box_max"][2] + 0.1])
        name.scale.z, name.text = 0.15, one["category"]
        markers.append(name)
    rooms = {room["id"]: room["center"] for room in graph["rooms"]}
    middles = {one["id"]: (np.array(one["box_min"]) + np.array(one["box_max"])) / 2
               for one in graph["objects"]}
    ways = [(rooms[room], passage["position"]) for passage in graph["passages"]
            for room in passage["rooms"]]
    links = [(middles[link["from"]], middles[link["to"]]) for link in graph["relations"]]
    for space, pairs in (("passages", ways), ("relations", links)):
        lines = _marker(make_marker, frame_id, space, 0, "line_list")
        lines.scale.x = 0.03
        lines.points = [_place(make_point(), end) for pair in pairs for end in pair]
        markers.append(lines)
    return markers
