# SPDX-License-Identifier: MIT
"""The second network: from a claim's box and the first network's masks to the mask of the object, by its depth and colour.

It looks at a window of 96 x 96 around the box, computes on 48 x 48 and answers pixel by pixel. The first network stays
as it was trained; `train_masks.py` trains this one alone.
"""

import torch
import torch.nn.functional as F
from model import Plain, conv
from torch import nn

SIZE = 96  # of a window
SIDE = 2  # pixels of a window that share one computation
MARGIN = 0.06  # chosen: margin of the window beyond each edge, as a share of the box
NEAREST_M = 0.05  # chosen: nearer readings count as this near
SPREAD = 0.2  # chosen: of the logarithm of range within one object
LEAST_SHARE = 0.5  # chosen: minimum share of the goal in a cell or its neighbours
OUTPUTS = ["mask", "window"]


def sampler(box, size):
    """Takes planes that cover the picture [n, c, h, w] to the window of each box [n, c, 96, 96]."""
    step = (torch.arange(SIZE, device=box.device) + 0.5) / SIZE
    sides = box[:, 2:] - box[:, :2]
    at = box[:, None, :2] + sides[:, None] * (step[:, None] * (1 + 2 * MARGIN) - MARGIN)  # [n, 96, 2]
    at = at * (2 / size) - 1
    across, down = at[:, None, :, 0].expand(-1, SIZE, -1), at[:, :, None, 1].expand(-1, -1, SIZE)
    grid = torch.stack([across, down], -1)
    return lambda x, mode: F.grid_sample(x, grid, mode=mode, padding_mode="border", align_corners=False)


def window(image, depth, height, share, box):
    """Window around `box` [n, 4] (left, top, right, bottom, input px): [n, 7, 96, 96] of colour, range
    relative to the object's, validity of the range, height, and the first network's share of the goal."""
    take = sampler(box, image.shape[-1])
    image, depth, height = torch.split(take(torch.cat([image, depth, height], 1), "nearest"), [3, 1, 1], 1)
    share = take(share, "bilinear")
    seen, far = (depth > 0).to(depth.dtype), torch.log(depth.clamp(min=NEAREST_M))
    mean = lambda weight: (weight * far).sum((2, 3), keepdim=True) / (weight.sum((2, 3), keepdim=True) + 1e-3)
    first = mean(seen * share * share)
    object_far = mean(seen * share * share * torch.exp(-((far - first) / SPREAD) ** 2))
    return torch.cat([image * 4 - 2, (far - object_far) * seen, seen, height.clamp(-3, 3) * seen, share * 2 - 1], 1)


class Masks(nn.Module):
    def __init__(self, fine=24, coarse=48):
        super().__init__()
        self.fine = nn.Sequential(conv(8 * SIDE**2 + 2, fine), Plain(fine))
        self.middle = nn.Sequential(conv(fine, coarse, 3, 2), Plain(coarse))
        self.deepest = nn.Sequential(conv(coarse, coarse, 3, 2), Plain(coarse), conv(coarse, coarse, 1))
        self.to_fine = conv(coarse, fine, 1, act=False)
        self.out = nn.Sequential(nn.ReLU(), Plain(fine), nn.Conv2d(fine, SIDE**2, 1))

    def forward(self, seen):
        """Logits [n, 1, 96, 96] for the output of `window`."""
        colour, far, rest = torch.split(seen, [3, 1, 3], 1)
        pixels = F.pixel_unshuffle(torch.cat([colour, torch.tanh(far * 4), torch.tanh(far * 20), rest], 1), SIDE)
        line = torch.linspace(-1, 1, SIZE // SIDE, device=seen.device).expand(len(seen), 1, SIZE // SIDE, -1)
        fine = self.fine(torch.cat([pixels, line, line.transpose(2, 3)], 1))
        middle = self.middle(fine)
        middle = middle + F.interpolate(self.deepest(middle), scale_factor=2.0)
        fine = fine + F.interpolate(self.to_fine(middle), scale_factor=2.0)
        return F.pixel_shuffle(self.out(fine), SIDE)


class MaskOfBox(nn.Module):
    """Output of the exported file (docs/networks-training.md)."""

    def __init__(self, masks):
        super().__init__()
        self.masks = masks

    def forward(self, image, depth, height, share, box):
        beyond = (box[:, 2:] - box[:, :2]) * MARGIN
        edges = torch.cat([box[:, :2] - beyond, box[:, 2:] + beyond], 1)
        around = sampler(box, image.shape[-1])(F.max_pool2d(share, 3, 1, 1), "bilinear")
        drawn = torch.sigmoid(self.masks(window(image, depth, height, share, box)))
        return drawn * (around >= LEAST_SHARE).to(drawn.dtype), edges
