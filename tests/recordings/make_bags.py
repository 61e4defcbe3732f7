#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the bags under data/ that bag_test.cpp reads (packages: rosbags 0.11, numpy, pillow).

    tests/recordings/make_bags.py

A camera drives along +x towards a wall at x = 3 m, 1 m above the ground. `raw`: odometry of the
robot, static transforms to two cameras of different sizes side by side, raw images, zstd chunks; one
depth image before the first pose, one without colour, one in a jump of the pose. `packed`: transforms
alone, JPEG colour and compressedDepth of one camera.
"""
import io
import pathlib
import shutil
import struct

import numpy as np
from bag_writer import BagWriter
from PIL import Image

DATA = pathlib.Path(__file__).parent / "data"
WALL_M, SPEED_MPS, HEIGHT_M = 3.0, 0.5, 1.0
OPTICAL = (-0.5, 0.5, -0.5, 0.5)  # x forward, y left, z up -> x right, y down, z forward
LEVEL = (0.0, 0.0, 0.0, 1.0)
START_NS = 100 * 10**9
STEP_NS = 10**8


def depth_mm(time_ns, size):
    """Distance seen by a camera that faces the wall."""
    x = SPEED_MPS * 1e-9 * (time_ns - START_NS)
    return np.full((size[1], size[0]), round(1000 * (WALL_M - x)), np.uint16)


def colour(size):
    """Red grows to the right, green downwards."""
    v, u = np.mgrid[0:size[1], 0:size[0]]
    return np.stack([5 * u, 5 * v, np.full_like(u, 90)], axis=-1).astype(np.uint8)


def make_raw():
    shutil.rmtree(DATA / "raw", ignore_errors=True)
    colour_size, depth_size = (48, 36), (24, 18)
    with BagWriter(DATA / "raw", is_compressed=True) as bag:
        bag.transforms("/tf_static", START_NS, [
            ("base_link", "camera_link", (0.0, 0.0, HEIGHT_M), LEVEL),
            ("camera_link", "depth_optical", (0.0, 0.0, 0.0), OPTICAL),
            ("camera_link", "color_optical", (0.0, -0.06, 0.0), OPTICAL)])
        bag.camera_info("/camera/color/camera_info", START_NS, "color_optical", colour_size,
                        (40.0, 40.0, 23.5, 17.5))
        bag.camera_info("/camera/depth/camera_info", START_NS, "depth_optical", depth_size,
                        (16.0, 16.0, 11.5, 8.5))
        for i in range(21):
            time_ns = START_NS + i * STEP_NS
            y = 2.0 if i >= 16 else 0.0
            image_ns = time_ns - STEP_NS // 2
            bag.image("/camera/depth/image_rect_raw", image_ns, "depth_optical",
                      depth_mm(image_ns, depth_size), "16UC1")
            if i != 8:
                bag.image("/camera/color/image_raw", image_ns + 4 * 10**6, "color_optical",
                          colour(colour_size), "rgb8")
            bag.odometry("/odom", time_ns, "odom", "base_link",
                         (SPEED_MPS * 1e-9 * (time_ns - START_NS), y, 0.0), LEVEL)


def make_packed():
    shutil.rmtree(DATA / "packed", ignore_errors=True)
    size = (24, 18)
    with BagWriter(DATA / "packed") as bag:
        bag.transforms("/tf_static", START_NS, [
            ("base_link", "color_optical", (0.0, 0.0, HEIGHT_M), OPTICAL)])
        bag.camera_info("/camera/color/camera_info", START_NS, "color_optical", size,
                        (16.0, 16.0, 11.5, 8.5))
        bag.camera_info("/camera/aligned_depth_to_color/camera_info", START_NS, "color_optical", size,
                        (16.0, 16.0, 11.5, 8.5))
        for i in range(5):
            time_ns = START_NS + i * STEP_NS
            bag.transforms("/tf", time_ns, [
                ("map", "odom", (0.0, 0.0, 0.0), LEVEL),
                ("odom", "base_link", (SPEED_MPS * 0.1 * i, 0.0, 0.0), LEVEL)])
            jpeg, png = io.BytesIO(), io.BytesIO()
            Image.fromarray(colour(size)).save(jpeg, "JPEG", quality=95)
            Image.fromarray(depth_mm(time_ns, size)).save(png, "PNG")
            bag.compressed_image("/camera/color/image_raw/compressed", time_ns, "color_optical",
                                 jpeg.getvalue(), "rgb8; jpeg compressed bgr8")
            bag.compressed_image(
                "/camera/aligned_depth_to_color/image_raw/compressedDepth", time_ns,
                "color_optical", struct.pack("<iff", 0, 0.0, 0.0) + png.getvalue(),
                "16UC1; compressedDepth png")


if __name__ == "__main__":
    make_raw()
    make_packed()
