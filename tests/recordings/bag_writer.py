# SPDX-License-Identifier: MIT
"""Writes ROS 2 bags (MCAP) of a camera with the package `rosbags`: for the fixtures of the tests
(make_bags.py) and for python/tests/test_recordings.py."""
import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)


def _type(name):
    return STORE.types[name]


class BagWriter:
    """A bag while it is written; use as a context manager. Times are seconds or nanoseconds (int)."""

    def __init__(self, path, is_compressed=False):
        self._writer = Writer(path, version=9, storage_plugin=StoragePlugin.MCAP)
        if is_compressed:
            self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        self._connections = {}

    def __enter__(self):
        self._writer.open()
        return self

    def __exit__(self, *error):
        self._writer.close()

    def _write(self, topic, message, time_ns):
        kind = message.__msgtype__
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(topic, kind, typestore=STORE)
        self._writer.write(self._connections[topic], time_ns, STORE.serialize_cdr(message, kind))

    @staticmethod
    def _header(time_ns, frame):
        stamp = _type("builtin_interfaces/msg/Time")(sec=time_ns // 10**9, nanosec=time_ns % 10**9)
        return _type("std_msgs/msg/Header")(stamp=stamp, frame_id=frame)

    def image(self, topic, time_ns, frame, pixels, encoding):
        """`pixels`: H x W or H x W x C array of the encoding's numbers."""
        pixels = np.ascontiguousarray(pixels)
        self._write(topic, _type("sensor_msgs/msg/Image")(
            header=self._header(time_ns, frame), height=pixels.shape[0], width=pixels.shape[1],
            encoding=encoding, is_bigendian=0, step=pixels[0].nbytes,
            data=pixels.reshape(-1).view(np.uint8)), time_ns)

    def compressed_image(self, topic, time_ns, frame, data, form):
        self._write(topic, _type("sensor_msgs/msg/CompressedImage")(
            header=self._header(time_ns, frame), format=form,
            data=np.frombuffer(data, np.uint8)), time_ns)

    def camera_info(self, topic, time_ns, frame, size, pinhole):
        """`size`: width, height; `pinhole`: fx, fy, cx, cy."""
        fx, fy, cx, cy = pinhole
        region = _type("sensor_msgs/msg/RegionOfInterest")(
            x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
        self._write(topic, _type("sensor_msgs/msg/CameraInfo")(
            header=self._header(time_ns, frame), height=size[1], width=size[0],
            distortion_model="plumb_bob", d=np.zeros(5),
            k=np.array([fx, 0, cx, 0, fy, cy, 0, 0, 1.0]), r=np.eye(3).reshape(-1),
            p=np.array([fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1.0, 0]), binning_x=0, binning_y=0,
            roi=region), time_ns)

    def odometry(self, topic, time_ns, frame, child, p, q):
        """`q`: x, y, z, w."""
        vector = _type("geometry_msgs/msg/Vector3")
        pose = _type("geometry_msgs/msg/Pose")(
            position=_type("geometry_msgs/msg/Point")(*map(float, p)),
            orientation=_type("geometry_msgs/msg/Quaternion")(*map(float, q)))
        twist = _type("geometry_msgs/msg/Twist")(linear=vector(0.0, 0.0, 0.0),
                                                 angular=vector(0.0, 0.0, 0.0))
        self._write(topic, _type("nav_msgs/msg/Odometry")(
            header=self._header(time_ns, frame), child_frame_id=child,
            pose=_type("geometry_msgs/msg/PoseWithCovariance")(pose=pose, covariance=np.zeros(36)),
            twist=_type("geometry_msgs/msg/TwistWithCovariance")(twist=twist,
                                                                 covariance=np.zeros(36))), time_ns)

    def transforms(self, topic, time_ns, transforms):
        """`transforms`: (parent, child, p, q) each."""
        messages = [_type("geometry_msgs/msg/TransformStamped")(
            header=self._header(time_ns, parent), child_frame_id=child,
            transform=_type("geometry_msgs/msg/Transform")(
                translation=_type("geometry_msgs/msg/Vector3")(*map(float, p)),
                rotation=_type("geometry_msgs/msg/Quaternion")(*map(float, q))))
            for parent, child, p, q in transforms]
        self._write(topic, _type("tf2_msgs/msg/TFMessage")(transforms=messages), time_ns)
