# SPDX-License-Identifier: MIT
"""Augmentation of whole batches on the training device.

The rules are those of augment.py, from another generator of random numbers.
"""

import math

import common
import frames
import torch
import torch.nn.functional as F
from augment import ENLARGED
from batches import Batch, at_pixels


class Random:
    """Draws on a device."""

    def __init__(self, device, seed):
        self.device, self.generator = device, torch.Generator(device).manual_seed(seed)

    def uniform(self, low, high, *shape):
        return low + (high - low) * torch.rand(shape, generator=self.generator, device=self.device)

    def normal(self, deviation, *shape):
        return deviation * torch.randn(shape, generator=self.generator, device=self.device)

    def below(self, share, *shape):
        return self.uniform(0, 1, *shape) < share

    def integer(self, last):
        """0 to `last`, each inclusive."""
        return torch.minimum((self.uniform(0, 1, *last.shape) * (last + 1)).long(), last.long())

    def beta(self, a, b, *shape):
        """Of whole numbers a and b: the a-th smallest of a + b - 1 uniform numbers."""
        return self.uniform(0, 1, *shape, a + b - 1).sort(-1).values[..., a - 1]


def place(store, chosen, size, rng):
    """The batch of frames `chosen`, each a part, stretched a little and sometimes mirrored (augment.place)."""
    count, full, device = len(chosen), store.size, store.device
    enlarged = torch.where(rng.below(ENLARGED, count), rng.uniform(1, 1.8, count), 1.0)
    side = full * min(1.0, size / common.INPUT_PX) / enlarged
    stretch = rng.uniform(0.87, 1.15, count)
    width, height = (side * stretch).long().clamp(max=full), (side / stretch).long().clamp(max=full)
    left, top = rng.integer(full - width), rng.integer(full - height)
    mirrored = rng.below(0.5, count)[:, None]
    step = torch.arange(size, device=device)[None]
    column = lambda add: left[:, None] + ((step + add) * width[:, None] / size).long()
    turned = lambda at: torch.where(mirrored, at.flip(1), at)
    row = lambda add: top[:, None] + ((step + add) * height[:, None] / size).long()
    take = lambda planes, v, u: planes[chosen[:, None, None], v[:, :, None], u[:, None, :]]
    parts = [take(store.rgb, row(v), turned(column(u))).float() for v in (0.25, 0.75) for u in (0.25, 0.75)]
    rows, columns = row(0), turned(column(0))
    centre = (full - 1) / 2
    focal, _ = frames.intrinsics(full)
    sign = torch.where(mirrored, -1.0, 1.0)
    return Batch(store, store.house[chosen], sum(parts) / 4, take(store.depth_mm, rows, columns).float() / 1000,
                 take(store.instance, rows, columns).long(), rows - centre, (columns - centre) * sign, focal,
                 store.pose[chosen, 0], store.pose[chosen, 1])


def grey_of(image):
    return image.mean(-1, keepdim=True)


def things(batch):
    return batch.store.tables["goal"].shape[1]


def recolour(batch, rng):
    """augment.recolour"""
    count, size = len(batch), things(batch)
    changed = rng.below(0.5, count, size)
    gain = torch.where(changed[..., None], rng.uniform(0.35, 1.5, count, size, 3), 1.0)
    grey = torch.where(changed, rng.uniform(0, 0.8, count, size), 0.0)[..., None]
    shift = rng.uniform(-40, 60, count, size, 1) + rng.uniform(-25, 25, count, size, 3)
    shift = torch.where(changed[..., None], shift, 0.0)
    image = batch.image + at_pixels(grey, batch.ids) * (grey_of(batch.image) - batch.image)
    return image * at_pixels(gain, batch.ids) + at_pixels(shift, batch.ids)


def points(batch):
    """augment.points, [B,S,S,3]"""
    down = batch.depth * (batch.rows / batch.focal)[:, :, None]
    right = batch.depth * (batch.columns / batch.focal)[:, None, :]
    sine, cosine = batch.pitch.sin()[:, None, None], batch.pitch.cos()[:, None, None]
    return torch.stack([right, batch.depth * cosine + down * sine, batch.depth * sine - down * cosine], -1)


def pattern(batch, at, rng):
    """augment.pattern, [B,S,S]"""
    shape = (len(batch), things(batch))
    direction = rng.normal(1, *shape, 3) * rng.below(0.6, *shape, 3)
    wave = direction * (2 * math.pi / rng.uniform(0.05, 0.8, *shape, 1))
    bend = rng.normal(6, *shape, 3)
    phase = (at * at_pixels(wave, batch.ids)).sum(-1)
    phase = phase + ((at * at_pixels(bend, batch.ids)).sum(-1)).sin() * at_pixels(rng.uniform(0, 2.5, *shape), batch.ids)
    value = phase.sin()
    value = torch.where(at_pixels(rng.below(0.4, *shape), batch.ids), value.sign(), value)
    strength = torch.where(rng.below(0.5, *shape), rng.uniform(0.05, 0.5, *shape), 0.0)
    return 1 + value * at_pixels(strength, batch.ids)


def slopes(plane):
    """Differences across and down, the edge repeated: [B,S,S,3] each."""
    wide = F.pad(plane.permute(0, 3, 1, 2), (1, 1, 1, 1), mode="replicate")
    across, down = wide[:, :, :, 2:] - wide[:, :, :, :-2], wide[:, :, 2:] - wide[:, :, :-2]
    smooth = lambda x, axis: (x.narrow(axis, 0, x.shape[axis] - 2) + 2 * x.narrow(axis, 1, x.shape[axis] - 2)
                              + x.narrow(axis, 2, x.shape[axis] - 2))
    return smooth(across, 2).permute(0, 2, 3, 1), smooth(down, 3).permute(0, 2, 3, 1)


def shading(at, rng):
    """augment.shading, [B,S,S]"""
    across, down = slopes(at)
    normal = F.normalize(torch.linalg.cross(across, down), dim=-1)
    lamp = F.normalize(rng.normal(1, len(at), 3) + torch.tensor([0.0, 0.0, 1.0], device=at.device), dim=-1)
    ambient = rng.uniform(0.3, 1.0, len(at), 1, 1)
    return ambient + (1 - ambient) * (normal * lamp[:, None, None]).sum(-1).abs()


def paints(shape, rng):
    """augment.paints, [...,3]"""
    hue = rng.uniform(0, 6, *shape)
    saturation = torch.where(rng.below(0.25, *shape), rng.beta(3, 1, *shape), rng.beta(2, 5, *shape))
    value = torch.where(rng.below(0.15, *shape), rng.uniform(0.01, 0.2, *shape), rng.beta(2, 1, *shape))
    wheel = (hue[..., None] + torch.tensor([0.0, 4.0, 2.0], device=hue.device)) % 6
    pure = ((wheel - 3).abs() - 1).clamp(0, 1)
    return 255 * value[..., None] * (1 - saturation[..., None] * (1 - pure))


def restyle(batch, rng):
    """augment.restyle"""
    count, size, image = len(batch), things(batch), batch.image
    share = torch.tensor([0.3, 0.7, 1.0], device=image.device)[rng.integer(torch.full((count,), 2, device=image.device))]
    changed = rng.uniform(0, 1, count, size) < share[:, None]
    colour = paints((count, size), rng)
    tables = batch.store.tables
    seats = (tables["goal"][batch.house] >= 0) | (tables["alike"][batch.house] > 0)
    series = rng.below(0.4, count, 1) & seats
    colour = torch.where(series[..., None], paints((count, 1), rng), colour)
    at = points(batch)
    grey = grey_of(image)[..., 0]
    flat, ids = grey[:, ::2, ::2].flatten(1), batch.ids[:, ::2, ::2].flatten(1)
    seen = torch.zeros(count, size, device=image.device).scatter_add_(1, ids, torch.ones_like(flat)).clamp(min=1)
    mean = torch.zeros(count, size, device=image.device).scatter_add_(1, ids, flat) / seen
    of_picture = (grey / at_pixels(mean, batch.ids).clamp(min=8)).clamp(0.2, 2.5)
    each = lambda share: rng.below(share, count)[:, None, None]
    bright = torch.where(each(0.6), of_picture, shading(at, rng))
    bright = torch.where(each(0.5), bright * pattern(batch, at, rng), bright)
    made = at_pixels(colour, batch.ids) * bright[..., None]
    return torch.where(at_pixels(changed, batch.ids)[..., None], made, image)


def light(image, rng):
    """augment.light"""
    count, size = len(image), image.shape[1]
    each = lambda low, high, *shape: rng.uniform(low, high, count, 1, 1, *(shape or (1,)))
    image = image * each(0.7, 1.3, 3)
    mean = image.mean((1, 2, 3), keepdim=True)
    image = (image - mean) * each(0.6, 1.4) + mean * each(0.6, 1.4)
    pale = torch.where(rng.below(0.3, count, 1, 1, 1), each(0.2, 1.0), 0.0)
    image = image + pale * (grey_of(image) - image)
    step = torch.linspace(0, 1, size, device=image.device)
    first, last = each(0.6, 1.4), each(0.6, 1.4)
    ramp = torch.where(rng.below(0.5, count, 1, 1, 1), first + (last - first) * step[None, :, None, None],
                       first + (last - first) * step[None, None, :, None])
    return torch.where(rng.below(0.3, count, 1, 1, 1), image * ramp, image)


def exposure(image, depth, rng):
    """augment.exposure"""
    count = len(image)
    each = lambda low, high: rng.uniform(low, high, count, 1, 1, 1)
    share = rng.uniform(0, 1, count, 1, 1, 1)
    lamp = each(0.8, 1.5) / (1 + (depth[..., None] / each(1.5, 5)) ** 2)
    gain = torch.where(share < 0.2, each(0.15, 0.6), torch.where(share < 0.3, each(1.4, 2.2),
                                                               torch.where(share < 0.5, lamp, 1.0)))
    image = image * gain
    curve = torch.where(rng.below(0.5, count, 1, 1, 1), each(-0.5, 0.6).exp(), 1.0)
    return torch.where(curve == 1, image, 255 * (image / 255).clamp(0, 1) ** curve)


def kernels(count, device, rng):
    """Of blurs out of focus (two thirds) and of motion: [count,1,9,9]"""
    at = torch.arange(-4, 5, device=device).float()
    sigma = rng.uniform(0.4, 1.6, count, 1)
    out_of_focus = torch.exp(-0.5 * (at / sigma) ** 2)
    out_of_focus = out_of_focus[:, :, None] * out_of_focus[:, None, :]
    moved = (at.abs() <= rng.uniform(1, 4, count, 1)).float()
    moved = moved[:, None, :] * (at == 0)[None, :, None]
    made = torch.where(rng.below(2 / 3, count)[:, None, None], out_of_focus, moved)
    return (made / made.sum((1, 2), keepdim=True))[:, None]


def blur(image, rng):
    """Each picture with a kernel of its own."""
    count, size = len(image), image.shape[1]
    planes = F.pad(image.permute(0, 3, 1, 2), (4, 4, 4, 4), mode="replicate").reshape(1, count * 3, size + 8, size + 8)
    made = F.conv2d(planes, kernels(count, image.device, rng).repeat_interleave(3, 0), groups=count * 3)
    return made.reshape(count, 3, size, size).permute(0, 2, 3, 1)


def cosines(device):
    """Matrix of the discrete cosine transform of 8 values."""
    k = torch.arange(8, device=device).float()
    made = torch.cos(math.pi * (2 * k[None] + 1) * k[:, None] / 16) / 2
    made[0] /= math.sqrt(2)
    return made


def jpeg(image, rng):
    """Losses of a JPEG file of quality 30 to 95: blocks of 8 x 8 cosines in steps that grow with the frequency
    (about those of the standard's table for brightness), brightness and colour alike."""
    count, size = len(image), image.shape[1]
    basis, k = cosines(image.device), torch.arange(8, device=image.device).float()
    quality = rng.uniform(30, 95, count, 1, 1, 1, 1, 1)
    scale = torch.where(quality < 50, 50 / quality, 2 - quality / 50)
    steps = ((10 + 9 * (k[:, None] + k[None])) * scale).clamp(min=1)
    blocks = (image.clamp(0, 255) - 128).reshape(count, size // 8, 8, size // 8, 8, 3).permute(0, 1, 3, 5, 2, 4)
    waves = basis @ blocks @ basis.T
    blocks = basis.T @ ((waves / steps).round() * steps) @ basis
    return blocks.permute(0, 1, 4, 2, 5, 3).reshape(image.shape) + 128


def camera(image, rng):
    """augment.camera"""
    count = len(image)
    image = change_some(image, rng.below(0.22, count), lambda index: blur(image[index], rng))
    noise = torch.where(rng.below(0.4, count, 1, 1, 1), rng.uniform(1, 12, count, 1, 1, 1), 0.0)
    image = image + rng.normal(1, *image.shape) * noise
    image = change_some(image, rng.below(0.2, count), lambda index: jpeg(image[index], rng))
    return image.clamp(0, 255)


def change_some(image, chosen, change):
    """Replaces the chosen pictures by `change` of their index."""
    index = chosen.nonzero()[:, 0]
    return image.index_copy(0, index, change(index)) if len(index) else image


def depth_sensor(depth, rng):
    """augment.depth_sensor"""
    count, size = len(depth), depth.shape[1]
    some = lambda share: rng.below(share, count, 1, 1)
    noise = torch.where(some(0.5), rng.uniform(0, 0.006, count, 1, 1), 0.0)
    depth = (depth + rng.normal(1, *depth.shape) * noise * depth**2).clamp(min=0)
    jump = torch.zeros_like(depth)
    jump[:, :, 1:] = ((depth[:, :, 1:] - depth[:, :, :-1]).abs() > 0.15).float()
    jump[:, 1:] = torch.maximum(jump[:, 1:], ((depth[:, 1:] - depth[:, :-1]).abs() > 0.15).float())
    jump = F.max_pool2d(F.pad(jump[:, None], (1, 0, 1, 0)), 2, 1)[:, 0] > 0
    lost = jump & rng.below(0.7, *depth.shape) & some(0.3)
    small = (rng.uniform(0, 1, count, 1, 14, 14) < rng.uniform(0, 0.15, count, 1, 1, 1)).float()
    holes = F.interpolate(small, (size, size), mode="bilinear")[:, 0] > 0.5
    limit = torch.where(some(0.2), rng.uniform(4, 8, count, 1, 1), math.inf)
    return torch.where(lost | (holes & some(0.3)) | (depth > limit) | some(0.03), 0.0, depth)


def augmented(store, chosen, size, rng):
    """augment.augment of the chosen frames."""
    batch = place(store, chosen, size, rng)
    count = len(batch)
    share = rng.uniform(0, 1, count)
    image = change_some(batch.image, share < 0.3, lambda index: recolour(batch.part(index), rng))
    batch.image = change_some(image, (share >= 0.3) & (share < 0.6), lambda index: restyle(batch.part(index), rng))
    batch.image = torch.where(rng.below(0.6, count, 1, 1, 1), light(batch.image, rng), batch.image)
    batch.image = torch.where(rng.below(0.35, count, 1, 1, 1), exposure(batch.image, batch.depth, rng), batch.image)
    batch.image = camera(batch.image, rng)
    batch.depth = depth_sensor(batch.depth, rng)
    batch.camera_height = batch.camera_height + rng.normal(0.02, count)  # error of odometry
    batch.pitch = batch.pitch + rng.normal(math.radians(0.7), count)
    return batch
