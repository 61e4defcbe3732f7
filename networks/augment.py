# SPDX-License-Identifier: MIT
"""Augmentation of a training sample: camera direction, light and colours, faults of the sensors.

All draws come from the given generator; a sample is changed in place.
"""

import cv2
import numpy as np


def place(sample, size, rng):
    """Part of the picture, stretched a little and sometimes mirrored, at `size` pixels."""
    full = sample.depth.shape[0]
    side = full * (rng.uniform(0.55, 1.0) if rng.random() < 0.5 else 1.0)
    stretch = rng.uniform(0.87, 1.15)
    width, height = min(full, int(side * stretch)), min(full, int(side / stretch))
    left, top = int(rng.integers(full - width + 1)), int(rng.integers(full - height + 1))
    columns = left + (np.arange(size) * width) // size
    rows = top + (np.arange(size) * height) // size
    part = sample.rgb[top : top + height, left : left + width]
    sample.rgb = cv2.resize(part, (size, size), interpolation=cv2.INTER_AREA)
    sample.depth = sample.depth[rows][:, columns]
    sample.instance = sample.instance[rows][:, columns]
    sample.rows = sample.rows[rows]
    if rng.random() < 0.5:
        sample.rgb = np.ascontiguousarray(sample.rgb[:, ::-1])
        sample.depth = np.ascontiguousarray(sample.depth[:, ::-1])
        sample.instance = np.ascontiguousarray(sample.instance[:, ::-1])


def resize(sample, size):
    """The whole picture at `size` pixels, as an evaluation sees it."""
    full = sample.depth.shape[0]
    if full == size:
        return
    index = (np.arange(size) * full) // size
    sample.rgb = cv2.resize(sample.rgb, (size, size), interpolation=cv2.INTER_AREA)
    sample.depth, sample.instance = sample.depth[index][:, index], sample.instance[index][:, index]
    sample.rows = sample.rows[index]


def recolour(image, sample, rng):
    """Other colours for some of the things: the same chair comes in many."""
    size = len(sample.house.goal_of)
    chosen = rng.random(size) < 0.5
    gain = np.where(chosen[:, None], rng.uniform(0.35, 1.5, (size, 3)), 1.0)
    grey = np.where(chosen, rng.random(size) * 0.8, 0.0)[:, None]
    shift = np.where(chosen[:, None], rng.uniform(-40, 60, (size, 1)) + rng.uniform(-25, 25, (size, 3)), 0.0)
    ids = sample.instance
    mean = image.mean(axis=2, keepdims=True)
    image = image + grey.astype(np.float32)[ids] * (mean - image)
    return image * gain.astype(np.float32)[ids] + shift.astype(np.float32)[ids]


def light(image, rng):
    image = image * rng.uniform(0.7, 1.3, 3).astype(np.float32)  # white balance
    mean = image.mean()
    image = (image - mean) * np.float32(rng.uniform(0.6, 1.4)) + mean * np.float32(rng.uniform(0.6, 1.4))
    if rng.random() < 0.3:
        grey = image.mean(axis=2, keepdims=True)
        image = image + np.float32(rng.uniform(0.2, 1.0)) * (grey - image)
    if rng.random() < 0.3:  # brighter towards one side
        size = image.shape[0]
        ramp = np.linspace(*rng.uniform(0.6, 1.4, 2), size, dtype=np.float32)
        image = image * (ramp[:, None, None] if rng.random() < 0.5 else ramp[None, :, None])
    return image


def camera(image, rng):
    """Blur, noise and JPEG, each sometimes."""
    share = rng.random()
    if share < 0.15:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.6))
    elif share < 0.22:  # motion blur
        length = int(rng.integers(3, 8))
        kernel = np.zeros((length, length), np.float32)
        kernel[length // 2] = 1 / length
        image = cv2.filter2D(image, -1, kernel)
    if rng.random() < 0.4:
        image = image + rng.standard_normal(image.shape, np.float32) * np.float32(rng.uniform(1, 12))
    image = np.clip(image, 0, 255).astype(np.uint8)
    if rng.random() < 0.2:
        code = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(30, 95))])[1]
        image = cv2.imdecode(code, cv2.IMREAD_COLOR)
    return image


def depth_sensor(depth, rng):
    """Noise that grows with range, lost edges, holes, a limit of range; now and then nothing at all."""
    if rng.random() < 0.03:
        return np.zeros_like(depth)
    if rng.random() < 0.5:
        depth = depth + rng.standard_normal(depth.shape, np.float32) * np.float32(rng.uniform(0, 0.006)) * depth**2
        depth = np.maximum(depth, 0)
    if rng.random() < 0.3:  # readings at edges are lost
        jump = np.zeros(depth.shape, bool)
        jump[:, 1:] |= np.abs(np.diff(depth, axis=1)) > 0.15
        jump[1:] |= np.abs(np.diff(depth, axis=0)) > 0.15
        jump = cv2.dilate(jump.astype(np.uint8), np.ones((2, 2), np.uint8)) > 0
        depth = np.where(jump & (rng.random(depth.shape, np.float32) < 0.7), 0, depth)
    if rng.random() < 0.3:  # holes in shiny surfaces
        small = rng.random((14, 14)) < rng.uniform(0, 0.15)
        mask = cv2.resize(small.astype(np.float32), depth.shape[::-1], interpolation=cv2.INTER_LINEAR)
        depth = np.where(mask > 0.5, 0, depth)
    if rng.random() < 0.2:
        depth = np.where(depth > rng.uniform(4, 8), 0, depth)
    return depth.astype(np.float32)


def augment(sample, size, rng):
    place(sample, size, rng)
    image = sample.rgb.astype(np.float32)
    if rng.random() < 0.4:
        image = recolour(image, sample, rng)
    if rng.random() < 0.6:
        image = light(image, rng)
    sample.rgb = camera(image, rng)
    sample.depth = depth_sensor(sample.depth, rng)
    sample.camera_height_m += rng.normal(0, 0.02)  # error of odometry
    sample.pitch_rad += np.radians(rng.normal(0, 0.7))
