# SPDX-License-Identifier: MIT
"""Augmentation of a training sample: camera direction, light and colours, faults of the sensors.

All draws come from the given generator; a sample is changed in place.
"""

import common
import cv2
import numpy as np


ENLARGED = 0.35  # chosen: cameras with a narrower field of view occur


def place(sample, size, rng):
    """Part of the picture, stretched a little and sometimes mirrored, at `size` pixels: things are as large as in
    the whole picture at the network's own size, or sometimes larger."""
    full = sample.depth.shape[0]
    side = full * min(1.0, size / common.INPUT_PX) / (rng.uniform(1, 1.8) if rng.random() < ENLARGED else 1.0)
    stretch = rng.uniform(0.87, 1.15)
    width, height = min(full, int(side * stretch)), min(full, int(side / stretch))
    left, top = int(rng.integers(full - width + 1)), int(rng.integers(full - height + 1))
    columns = left + (np.arange(size) * width) // size
    rows = top + (np.arange(size) * height) // size
    part = sample.rgb[top : top + height, left : left + width]
    sample.rgb = cv2.resize(part, (size, size), interpolation=cv2.INTER_AREA)
    sample.depth = sample.depth[rows][:, columns]
    sample.instance = sample.instance[rows][:, columns]
    sample.rows, sample.columns = sample.rows[rows], sample.columns[columns]
    if rng.random() < 0.5:
        sample.rgb = np.ascontiguousarray(sample.rgb[:, ::-1])
        sample.depth = np.ascontiguousarray(sample.depth[:, ::-1])
        sample.instance = np.ascontiguousarray(sample.instance[:, ::-1])
        sample.columns = -sample.columns[::-1]


def resize(sample, size):
    """The whole picture at `size` pixels, as an evaluation sees it."""
    full = sample.depth.shape[0]
    if full == size:
        return
    index = (np.arange(size) * full) // size
    sample.rgb = cv2.resize(sample.rgb, (size, size), interpolation=cv2.INTER_AREA)
    sample.depth, sample.instance = sample.depth[index][:, index], sample.instance[index][:, index]
    sample.rows, sample.columns = sample.rows[index], sample.columns[index]


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


def points(sample):
    """Of every pixel: right of the camera, ahead of it, above its foot [m], as [H,W,3]."""
    depth = sample.depth.astype(np.float32)
    down = depth * (sample.rows / sample.focal).astype(np.float32)[:, None]
    right = depth * (sample.columns / sample.focal).astype(np.float32)[None, :]
    sine, cosine = np.float32(np.sin(sample.pitch_rad)), np.float32(np.cos(sample.pitch_rad))
    return np.stack([right, depth * cosine + down * sine, depth * sine - down * cosine], axis=-1)


def pattern(at, ids, size, rng):
    """Stripes, waves, grain and tiles in the space of the points, others on every thing; around 1, [H,W]."""
    direction = rng.normal(0, 1, (size, 3)) * (rng.random((size, 3)) < 0.6)
    wave = direction * (2 * np.pi / rng.uniform(0.05, 0.8, (size, 1)))
    bend = rng.normal(0, 6, (size, 3))
    phase = (at * wave.astype(np.float32)[ids]).sum(-1)
    phase += np.sin((at * bend.astype(np.float32)[ids]).sum(-1)) * rng.uniform(0, 2.5, size).astype(np.float32)[ids]
    value = np.sin(phase)
    hard = (rng.random(size) < 0.4)[ids]
    value = np.where(hard, np.sign(value), value)
    strength = np.where(rng.random(size) < 0.5, rng.uniform(0.05, 0.5, size), 0.0)
    return 1 + value * strength.astype(np.float32)[ids]


def shading(at, rng):
    """Of surfaces without texture under one lamp, from their normals: 0 to 1, [H,W]."""
    across = cv2.Sobel(at, cv2.CV_32F, 1, 0, ksize=3)
    down = cv2.Sobel(at, cv2.CV_32F, 0, 1, ksize=3)
    normal = np.cross(across, down)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True) + 1e-9
    lamp = rng.normal(0, 1, 3) + [0, 0, 1]
    lamp = (lamp / np.linalg.norm(lamp)).astype(np.float32)
    ambient = np.float32(rng.uniform(0.3, 1.0))
    return ambient + (1 - ambient) * np.abs(normal @ lamp)


def paints(count, rng):
    """Colours [count,3], 0 to 255: pale and light most often, some vivid as walls that people draw, some near black."""
    hue = rng.uniform(0, 180, count)
    saturation = np.where(rng.random(count) < 0.25, rng.beta(3, 1, count), rng.beta(1, 2.5, count))
    value = np.where(rng.random(count) < 0.15, rng.uniform(0.01, 0.2, count), rng.beta(2.2, 1.3, count))
    hsv = np.stack([hue, 255 * saturation, 255 * value], -1).astype(np.uint8)[None]
    return cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB)[0].astype(np.float32)


def restyle(image, sample, rng):
    """Other materials: some of the things or all get one colour and a pattern, and keep the light of the picture
    or lose it to flat shading. Shapes alone tell what they are then."""
    size, ids = len(sample.house.goal_of), sample.instance
    chosen = rng.random(size) < rng.choice([0.3, 0.7, 1.0])
    colour = paints(size, rng)
    if rng.random() < 0.4:  # furniture of one series: neither colour nor cloth tells an armchair from a sofa
        house = sample.house
        colour[(house.goal_of >= 0) | house.is_lookalike] = paints(1, rng)
    at = points(sample)
    if rng.random() < 0.6:  # the light of the picture
        grey = image.mean(axis=2)
        count = np.bincount(ids.ravel(), minlength=size).clip(1)
        mean = np.bincount(ids.ravel(), weights=grey.ravel(), minlength=size) / count
        bright = np.clip(grey / np.maximum(mean.astype(np.float32)[ids], 8), 0.2, 2.5)
    else:
        bright = shading(at, rng)
    if rng.random() < 0.5:
        bright = bright * pattern(at, ids, size, rng)
    made = colour[ids] * bright[..., None]
    return np.where(chosen[ids][..., None], made, image)


def exposure(image, sample, rng):
    """A dark room, a lamp at the camera, too much light, another curve of the camera."""
    share = rng.random()
    if share < 0.2:
        image = image * np.float32(rng.uniform(0.15, 0.6))
    elif share < 0.3:
        image = image * np.float32(rng.uniform(1.4, 2.2))
    elif share < 0.5:
        image = image * np.float32(rng.uniform(0.8, 1.5)) / (1 + (sample.depth / rng.uniform(1.5, 5))[..., None] ** 2)
    if rng.random() < 0.5:
        image = 255 * np.clip(image / 255, 0, 1) ** np.float32(np.exp(rng.uniform(-0.5, 0.6)))
    return image.astype(np.float32)


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
    share = rng.random()
    if share < 0.3:
        image = recolour(image, sample, rng)
    elif share < 0.6:
        image = restyle(image, sample, rng)
    if rng.random() < 0.6:
        image = light(image, rng)
    if rng.random() < 0.35:
        image = exposure(image, sample, rng)
    sample.rgb = camera(image, rng)
    sample.depth = depth_sensor(sample.depth, rng)
    sample.camera_height_m += rng.normal(0, 0.02)  # error of odometry
    sample.pitch_rad += np.radians(rng.normal(0, 0.7))
