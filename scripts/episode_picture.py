#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A moving picture of an episode over two floors: camera, and the seen part of both floors from above.

    scripts/episode_picture.py [OUT.webp]      default: docs/images/episode.webp

Needs the Python package (docs/python.md) and Pillow, which build/python-venv has after `make test`.
The house is the one that comes with crossnav; the same seed gives the same episode.
"""
import pathlib
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import crossnav

GOALS = ("tv", "bed")  # one below, one above
CONFIG = {"sensor.width_px": 320, "sensor.height_px": 320}
CELL_M = 0.05
PANEL_PX = 300
GAP_PX = 8
MAX_BYTES = 3_000_000


def points_of(seen):
    """Points [m, world] and colours of every second pixel with depth."""
    depth = np.asarray(seen.depth_m)[::2, ::2]
    rgb = np.asarray(seen.rgb)[::2, ::2]
    v, u = np.indices(depth.shape) * 2
    camera = seen.camera
    x = (u - camera.cx) / camera.fx * depth
    y = (v - camera.cy) / camera.fy * depth
    is_valid = (depth > 0.1) & (depth < 6)
    p_camera = np.stack([x, y, depth], axis=-1)[is_valid]
    T = np.asarray(seen.T_world_camera)
    return p_camera @ T[:3, :3].T + T[:3, 3], rgb[is_valid]


def play(folder):
    """One record per step: picture, points, foot, goal, activity."""
    crossnav.write_embedded_house(folder)
    scene = crossnav.Scene(folder, config=CONFIG)
    simulator = crossnav.Simulator(scene)
    agent = crossnav.Agent(simulator.ground_truth(), scene.config)
    start = next(p for p in map(scene.random_point, range(1, 100)) if p[2] < 0.5)
    simulator.reset(crossnav.AgentPose(start))
    steps = []
    for goal in GOALS:
        agent.set_goal(goal)
        for _ in range(400):
            seen = simulator.observe()
            result = agent.step(seen)
            is_over = result.all_explored or result.action == crossnav.Action.STOP
            steps.append({"rgb": np.array(seen.rgb), "points": points_of(seen), "goal": goal,
                          "foot": np.array(simulator.pose.p_world), "is_found": is_over,
                          "activity": result.trace.get("activity", ""),
                          "claim": result.p_claimed_world})
            if is_over:
                break
            simulator.step(result.action)
    return steps


class Plan:
    """A floor from above: the colour of the highest point below head height."""

    def __init__(self, height_m, low, high):
        self.height_m, self.low = height_m, low
        columns, rows = np.ceil((high - low) / CELL_M).astype(int) + 1
        self.top_m = np.full((rows, columns), -np.inf)
        self.colours = np.full((rows, columns, 3), 28, np.uint8)
        self.trail = []

    def cells(self, p_world):
        return np.floor((np.asarray(p_world)[..., :2] - self.low) / CELL_M).astype(int)

    def add(self, p_world, rgb):
        z = p_world[:, 2] - self.height_m
        column, row = self.cells(p_world).T
        is_here = ((z > -0.3) & (z < 1.7) & (column >= 0) & (row >= 0) &
                   (column < self.top_m.shape[1]) & (row < self.top_m.shape[0]))
        order = np.flatnonzero(is_here)[np.argsort(z[is_here], kind="stable")]
        order = order[z[order] >= self.top_m[row[order], column[order]] - 0.02]
        self.top_m[row[order], column[order]] = z[order]
        self.colours[row[order], column[order]] = rgb[order]

    def picture(self, foot, claims):
        image = Image.fromarray(self.colours[::-1])
        scale = PANEL_PX / max(image.size)
        image = image.resize([round(side * scale) for side in image.size], Image.BILINEAR)
        draw = ImageDraw.Draw(image)

        def pixel(p_world):
            column, row = self.cells(p_world)
            return column * scale, (self.top_m.shape[0] - 1 - row) * scale

        for run in self.trail:
            draw.line([pixel(p) for p in run], fill=(70, 200, 255), width=3)
        for p in claims:
            if -0.3 < p[2] - self.height_m < 1.7:
                x, y = pixel(p)
                draw.ellipse((x - 9, y - 9, x + 9, y + 9), outline=(90, 255, 90), width=3)
        if foot is not None:
            x, y = pixel(foot)
            draw.ellipse((x - 5, y - 5, x + 5, y + 5), fill=(255, 80, 60))
        panel = Image.new("RGB", (PANEL_PX, PANEL_PX), (28, 28, 28))
        panel.paste(image, ((PANEL_PX - image.width) // 2, (PANEL_PX - image.height) // 2))
        return panel


def follow(plans, foot, previous):
    """Adds a place to the trail of its floor; a floor that is entered anew begins a new line."""
    plan = min(plans, key=lambda p: abs(p.height_m - foot[2]))
    if plan is not previous:
        plan.trail.append([])
    plan.trail[-1].append(foot)
    return plan


def frame_of(step, plans, here, claims):
    width = 3 * PANEL_PX + 4 * GAP_PX
    image = Image.new("RGB", (width, PANEL_PX + 44), (255, 255, 255))
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(18)
    image.paste(Image.fromarray(step["rgb"]).resize((PANEL_PX, PANEL_PX)), (GAP_PX, 36))
    for i, (name, plan) in enumerate(zip(("lower floor", "upper floor"), plans)):
        left = GAP_PX + (i + 1) * (PANEL_PX + GAP_PX)
        image.paste(plan.picture(step["foot"] if plan is here else None, claims), (left, 36))
        draw.text((left, 8), name, fill=(90, 90, 90), font=font)
    said = "found" if step["is_found"] else str(step["activity"]).replace("_", " ")
    draw.text((GAP_PX, 8), f"{step['goal']}: {said}", fill=(0, 0, 0), font=font)
    return image


def frames_of(steps):
    feet = np.array([step["foot"] for step in steps])
    seen = np.concatenate([step["points"][0] for step in steps])
    low, high = np.percentile(seen[:, :2], [0.2, 99.8], axis=0)
    plans = [Plan(height, low, high) for height in (feet[:, 2].min(), feet[:, 2].max())]
    here, claims, frames = None, [], []
    for i, step in enumerate(steps):
        for plan in plans:
            plan.add(*step["points"])
        here = follow(plans, step["foot"], here)
        if step["is_found"] and step["claim"] is not None:
            claims.append(np.asarray(step["claim"]))
        if i % 2 == 0 or step["is_found"]:
            frames += [frame_of(step, plans, here, claims)] * (8 if step["is_found"] else 1)
    return frames


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "docs/images/episode.webp")
    with tempfile.TemporaryDirectory() as folder:
        steps = play(folder)
    frames = frames_of(steps)
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=120, loop=0, quality=55,
                   method=4)
    size = out.stat().st_size
    found = [step["goal"] for step in steps if step["is_found"] and step["claim"] is not None]
    print(f"{out}: {len(steps)} steps, {len(frames)} frames, {size} bytes; found {', '.join(found)}")
    return 0 if size <= MAX_BYTES and len(found) == len(GOALS) else 1


if __name__ == "__main__":
    sys.exit(main())
