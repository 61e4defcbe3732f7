# SPDX-License-Identifier: MIT
"""Draws the network's output beside the truth, and finds the pictures with the largest errors."""

import augment
import common
import cv2
import frames
import metrics
import numpy as np

COLOURS = np.array([[230, 60, 60], [60, 120, 240], [60, 200, 60], [240, 220, 60], [200, 60, 220], [60, 220, 220]])


def tinted(rgb, mask, colour, strength=0.5):
    out = rgb.astype(np.float32)
    out[mask] = out[mask] * (1 - strength) + np.asarray(colour, np.float32) * strength
    return out.astype(np.uint8)


def write(image, text, at):
    cv2.putText(image, text, at, cv2.FONT_HERSHEY_SIMPLEX, 0.35, (0, 0, 0), 2, cv2.LINE_AA)
    cv2.putText(image, text, at, cv2.FONT_HERSHEY_SIMPLEX, 0.35, (255, 255, 255), 1, cv2.LINE_AA)


LOWEST = 0.2  # chosen: lower scores are not drawn


def claims_picture(rgb, answer, lowest=LOWEST):
    size = rgb.shape[0]
    claims = [claim for claim in metrics.decode(answer["heat"], answer["box"], size)[::-1] if claim[1] >= lowest]
    image = rgb
    for goal, _, box in claims:
        image = tinted(image, metrics.claim_mask(answer, goal, box, size), COLOURS[goal])
    image = np.ascontiguousarray(image)
    for goal, score, box in claims:
        left, top, right, bottom = (int(v) for v in box)
        cv2.rectangle(image, (left, top), (right - 1, bottom - 1), COLOURS[goal].tolist(), 1)
        write(image, f"{common.GOALS[goal]} {score:.2f}", (left + 2, min(size - 3, top + 10)))
    return image


def stairs_picture(rgb, answer):
    share = metrics.upsample(answer["stairs"], rgb.shape[0])[0]
    return tinted(rgb, share > 0.5, (255, 160, 0), 0.6)


def truth_picture(sample):
    goal = sample.house.goal_of[sample.instance]
    image = sample.rgb
    for one in range(len(common.GOALS)):
        image = tinted(image, goal == one, COLOURS[one])
    return tinted(image, sample.house.is_stairs[sample.instance], (255, 160, 0), 0.6)


def names_picture(rgb, answer, table):
    """The names that most cells have, each in the middle of its cells."""
    size = rgb.shape[0]
    said = (answer["dense"] @ table.T).argmax(-1)
    image = np.ascontiguousarray((rgb * 0.6).astype(np.uint8))
    for one in np.unique(said):
        count, labels, stats, centres = cv2.connectedComponentsWithStats((said == one).astype(np.uint8))
        for part in range(1, count):
            if stats[part, cv2.CC_STAT_AREA] >= 6:
                x, y = (centres[part] + 0.5) * size / said.shape[0]
                write(image, common.CLASS_NAMES[one], (int(max(x - 25, 0)), int(y)))
    return image


def panel(sample, answer):
    return np.hstack([truth_picture(sample), claims_picture(sample.rgb, answer), stairs_picture(sample.rgb, answer)])


def draw_worst(tally, houses, network, out, count=12):
    """Missed objects, false claims, wrong masks, wrong stairs: the worst of each kind, truth on the left."""
    out.mkdir(parents=True, exist_ok=True)
    by_name = {house.name: house for house in houses}
    missed = sorted(tally.asked, key=lambda row: (row["score"], -(row["box"][2] - row["box"][0]) * (
        row["box"][3] - row["box"][1])))
    false = sorted(tally.false, key=lambda row: -row["score"])
    stairs = sorted(tally.cases, key=lambda row: -row["stair_error"])
    masks = sorted((row for row in tally.asked if row["score"] >= LOWEST), key=lambda row: row["mask_iou"])
    for name, rows in (("missed", missed), ("false", false), ("masks", masks), ("stairs", stairs)):
        seen, images = set(), []
        for row in rows:
            key = (row["house"], row["index"])
            if key in seen or len(images) == count:
                continue
            seen.add(key)
            sample = frames.Sample(by_name[key[0]], key[1])
            augment.resize(sample, network.size)
            image = panel(sample, network(**sample.inputs()))
            goal = f" {common.GOALS[row['goal']]} {row['score']:.2f}" if "goal" in row else ""
            goal += f", mask {row['mask_iou']:.2f}" if name == "masks" else ""
            write(image, f"{key[0]}/{key[1]}{goal}", (3, 218))
            images.append(image)
        pairs = [np.hstack(images[i : i + 2]) for i in range(0, len(images) - 1, 2)]
        cv2.imwrite(str(out / f"{name}.png"), np.vstack(pairs)[:, :, ::-1])
        print(f"{out / name}.png")
