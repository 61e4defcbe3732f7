# SPDX-License-Identifier: MIT
"""The network: one encoder over colour, depth and height, a decoder to a quarter of the input, five heads.

Plain convolutions throughout: on the matrix units that train it (bfloat16) and on the core that runs it
they are faster than depthwise convolutions with as many parameters.
"""

import common
import torch
import torch.nn.functional as F
from torch import nn

GRID = 24  # of the dense head
GOALS = len(common.GOALS)


def conv(inputs, outputs, kernel=3, stride=1, groups=1, act=True):
    layers = [nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, groups=groups, bias=False),
              nn.BatchNorm2d(outputs)]
    return nn.Sequential(*layers, nn.ReLU(inplace=True)) if act else nn.Sequential(*layers)


class Plain(nn.Module):
    """Two convolutions around which the input is added."""

    def __init__(self, width):
        super().__init__()
        self.body = nn.Sequential(conv(width, width), conv(width, width, act=False))

    def forward(self, x):
        return F.relu(x + self.body(x))


class Narrow(nn.Module):
    """Narrow, look around, widen; the input is added."""

    def __init__(self, width, inside):
        super().__init__()
        self.body = nn.Sequential(conv(width, inside, 1), conv(inside, inside), conv(inside, width, 1, act=False))

    def forward(self, x):
        return F.relu(x + self.body(x))


class Context(nn.Module):
    """Adds a summary of the whole picture to every place."""

    def __init__(self, width):
        super().__init__()
        self.mix = nn.Sequential(nn.Linear(width, width), nn.ReLU(inplace=True), nn.Linear(width, width))

    def forward(self, x):
        return x + self.mix(x.mean((2, 3)))[:, :, None, None]


def up(x, size):
    return F.interpolate(x, size=(size, size), mode="bilinear", align_corners=False)


def planes(image, depth, height):
    """Seven planes of about unit size: colour, range near and far, height, whether depth was read."""
    seen = (depth > 0).to(depth.dtype)
    depth = depth.clamp(0, 12)
    return torch.cat([image * 4 - 2, depth * 0.4 - 1, seen / (depth + 0.4), height.clamp(-3, 3) * seen, seen], 1)


class Network(nn.Module):
    def __init__(self, widths=(24, 48, 80, 128, 192), text=None):
        super().__init__()
        a, b, c, d, e = widths
        self.stem = nn.Sequential(conv(7, a, 3, 2), conv(a, b, 3, 2), Plain(b))  # 1/4
        self.eighth = nn.Sequential(conv(b, c, 3, 2), Plain(c), Plain(c))
        self.eighth_more = nn.Sequential(*[Narrow(c, 48) for _ in range(4)])
        self.sixteenth = nn.Sequential(conv(c, d, 3, 2), *[Narrow(d, 80) for _ in range(8)])
        self.deepest = nn.Sequential(conv(d, e, 3, 2), Narrow(e, 96), Narrow(e, 96), Context(e))
        self.deepest_more = nn.Sequential(*[Narrow(e, 96) for _ in range(3)])
        self.from_deepest, self.at_sixteenth = conv(e, 96, 1, act=False), conv(d, 96, 1, act=False)
        self.mix_sixteenth = nn.Sequential(nn.ReLU(inplace=True), conv(96, 96))
        self.to_eighth, self.at_eighth = conv(96, 80, 1, act=False), conv(c, 80, 1, act=False)
        self.mix_eighth = nn.Sequential(nn.ReLU(inplace=True), Plain(80), Narrow(80, 48), Narrow(80, 48))
        self.to_quarter, self.at_quarter = conv(80, 64, 1, act=False), conv(b, 64, 1, act=False)
        self.mix_quarter = nn.Sequential(nn.ReLU(inplace=True), conv(64, 64), Narrow(64, 32))
        self.detect = nn.Sequential(conv(64, 64), nn.Conv2d(64, GOALS + 4, 1))
        self.label = nn.Sequential(conv(64, 64), nn.Conv2d(64, GOALS + 2, 1))
        self.name = nn.Sequential(conv(80, 96), nn.Conv2d(96, len(common.CLASS_NAMES), 1))
        with torch.no_grad():
            self.detect[-1].bias[:GOALS] = -4.0
        text = torch.zeros(len(common.CLASS_NAMES), 512) if text is None else text
        self.register_buffer("text", text, persistent=False)

    def raw(self, image, depth, height):
        """Logits of heat, mask, stairs and names; logarithms of the box edges [input px]."""
        quarter = self.stem(planes(image, depth, height))
        eighth = self.eighth_more(self.eighth(quarter))
        sixteenth = self.sixteenth(eighth)
        deepest = self.deepest_more(self.deepest(sixteenth))
        x = up(self.from_deepest(deepest), sixteenth.shape[-1]) + self.at_sixteenth(sixteenth)
        x = self.mix_sixteenth(x)
        x = self.mix_eighth(up(self.to_eighth(x), eighth.shape[-1]) + self.at_eighth(eighth))
        names = self.name(up(x, GRID))
        x = self.mix_quarter(up(self.to_quarter(x), quarter.shape[-1]) + self.at_quarter(quarter))
        found, labels = self.detect(x), self.label(x)
        return {"heat": found[:, :GOALS], "box": found[:, GOALS:] + 3.0, "mask": labels[:, : GOALS + 1],
                "stairs": labels[:, GOALS + 1 :], "dense": names}

    def forward(self, image, depth, height):
        """Output of the exported file; see docs/networks-training.md."""
        raw = self.raw(image, depth, height)
        share = torch.softmax(raw["dense"], 1)
        dense = share.permute(0, 2, 3, 1) @ self.text
        dense = dense / dense.square().sum(-1, keepdim=True).sqrt().clamp(min=1e-6)
        return (torch.sigmoid(raw["heat"]), torch.exp(raw["box"].clamp(-3, 7)),
                torch.softmax(raw["mask"], 1), torch.sigmoid(raw["stairs"]), dense)


OUTPUTS = ["heat", "box", "mask", "stairs", "dense"]
