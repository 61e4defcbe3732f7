# SPDX-License-Identifier: MIT
"""The layers of YOLOv7, in the form that its package builds a model of: rows of [from, times, module, arguments]."""


class Rows:
    """Rows of a YOLO description: [from, times, module, arguments]."""

    def __init__(self, divide):
        self.rows, self.divide = [], divide

    def add(self, source, module, arguments):
        self.rows.append([source, 1, module, arguments])
        return len(self.rows) - 1

    def conv(self, channels, side=1, stride=1, source=-1):
        return self.add(source, "Conv", [channels // self.divide, side, stride])

    def elan(self, narrow, inner, out, taps):
        """Two branches, four convolutions in a row, and the joined `taps` of them (Wang et al., 2022, E-ELAN's basic block)."""
        self.conv(narrow)
        self.conv(narrow, source=-2)
        for _ in range(4):
            self.conv(inner, 3)
        self.add(taps, "Concat", [1])
        return self.conv(out)

    def down(self, channels, also=()):
        """Half the size by pooling and by a stride, joined with the rows `also`."""
        self.add(-1, "MP", [])
        self.conv(channels)
        self.conv(channels, source=-3)
        self.conv(channels, 3, 2)
        return self.add([-1, -3, *also], "Concat", [1])

    def up(self, channels, route):
        self.conv(channels)
        self.add(-1, "nn.Upsample", [None, 2, "nearest"])
        self.conv(channels, source=route)
        return self.add([-1, -2], "Concat", [1])


def yolov7_description(classes, divide=1):
    """The layers of YOLOv7 (Wang et al., CVPR 2023) as its checkpoints for use have them, re-parameterised: 36.9 million parameters for 80 classes.
    Channels are divided by `divide`."""
    net = Rows(divide)
    backbone_taps, head_taps = [-1, -3, -5, -6], [-1, -2, -3, -4, -5, -6]
    for channels, stride in ((32, 1), (64, 2), (64, 1), (128, 2)):
        net.conv(channels, 3, stride)
    net.elan(64, 64, 256, backbone_taps)
    net.down(128)
    third = net.elan(128, 128, 512, backbone_taps)
    net.down(256)
    fourth = net.elan(256, 256, 1024, backbone_taps)
    net.down(512)
    net.elan(256, 256, 1024, backbone_taps)
    backbone = len(net.rows)
    fifth = net.add(-1, "SPPCSPC", [512 // divide])
    net.up(256, fourth)
    middle = net.elan(256, 128, 256, head_taps)
    net.up(128, third)
    small = net.elan(128, 64, 128, head_taps)
    net.down(128, [middle])
    medium = net.elan(256, 128, 256, head_taps)
    net.down(256, [fifth])
    large = net.elan(512, 256, 512, head_taps)
    ends = [net.conv(c, 3, 1, source) for c, source in ((256, small), (512, medium), (1024, large))]
    net.add(ends, "Detect", ["nc", "anchors"])
    anchors = [[12, 16, 19, 36, 40, 28], [36, 75, 76, 55, 72, 146], [142, 110, 192, 243, 459, 401]]
    return {"nc": classes, "depth_multiple": 1.0, "width_multiple": 1.0, "anchors": anchors, "backbone": net.rows[:backbone],
            "head": net.rows[backbone:]}
