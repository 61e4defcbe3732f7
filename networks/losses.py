# SPDX-License-Identifier: MIT
"""One number for how far the network's answers are from the targets, and its parts by name."""

import torch
import torch.nn.functional as F

WEIGHTS = {"heat": 1.0, "box": 1.0, "mask": 1.0, "stairs": 1.0, "dense": 0.5}


def heat_loss(logits, target, asked):
    """Focal loss that forgives cells near a centre, per centre."""
    at_centre = target.eq(1).float()
    log_yes, log_no = F.logsigmoid(logits), F.logsigmoid(-logits)
    share = torch.sigmoid(logits)
    yes = at_centre * (1 - share) ** 2 * log_yes
    no = (1 - target) ** 4 * share**2 * log_no * (1 - at_centre) * asked
    return -(yes + no).sum() / at_centre.sum().clamp(min=1)


def box_loss(log_edges, target, weight):
    """1 - IoU plus the error of the logarithms, per instance."""
    edges = torch.exp(log_edges.clamp(-3, 7))
    area = lambda e: (e[:, 0] + e[:, 2]) * (e[:, 1] + e[:, 3])
    target = target.clamp(min=0.5)
    both = area(torch.minimum(edges, target))
    iou = both / (area(edges) + area(target) - both).clamp(min=1)
    error = (log_edges - target.log()).abs().mean(1)
    return ((1 - iou + 0.5 * error) * weight).sum() / weight.sum().clamp(min=1)


def dice_loss(share, target):
    """1 - overlap, over the whole batch, per channel that occurs."""
    both = (share * target).sum((0, 2, 3))
    size = share.sum((0, 2, 3)) + target.sum((0, 2, 3))
    occurs = target.sum((0, 2, 3)) > 0
    return (((size + 1 - 2 * both) / (size + 1)) * occurs).sum() / occurs.sum().clamp(min=1)


def mask_loss(logits, target):
    share = torch.softmax(logits, 1)
    one_hot = F.one_hot(target, logits.shape[1]).permute(0, 3, 1, 2).float()
    return F.cross_entropy(logits, target) + dice_loss(share[:, :-1], one_hot[:, :-1])


def stairs_loss(logits, target):
    target = target[:, None]
    return F.binary_cross_entropy_with_logits(logits, target) + dice_loss(torch.sigmoid(logits), target)


def window(logits, own):
    """Cross entropy and 1 - IoU of the object in each window [n,h,w]."""
    share = torch.sigmoid(logits)
    both = (share * own).sum((1, 2))
    parts = {"pixels": F.binary_cross_entropy_with_logits(logits, own),
             "overlap": (1 - both / (share.sum((1, 2)) + own.sum((1, 2)) - both)).mean()}
    return sum(parts.values()), parts


def dense_loss(logits, target, class_weight):
    return F.cross_entropy(logits, target, weight=class_weight, ignore_index=-1, label_smoothing=0.02)


def total(raw, target, class_weight):
    raw = {name: value.float() for name, value in raw.items()}
    parts = {"heat": heat_loss(raw["heat"], target["heat"], target["asked"]),
             "box": box_loss(raw["box"], target["box"], target["weight"]),
             "mask": mask_loss(raw["mask"], target["mask"]),
             "stairs": stairs_loss(raw["stairs"], target["stairs"]),
             "dense": dense_loss(raw["dense"], target["dense"], class_weight)}
    return sum(WEIGHTS[name] * value for name, value in parts.items()), parts
