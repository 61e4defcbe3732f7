# SPDX-License-Identifier: MIT
"""Output of the network for five real frames of a depth camera: a panel to look at, not a figure.

Of each frame the left and the right square. The floor is found as a plane, because the poses do not give
it is; heights are distances to it.
"""

import argparse
import pathlib

import common
import cv2
import metrics
import numpy as np
import panels
from export import FILE
from runtime import Runtime

FX, FY, CX, CY = 518.0, 519.0, 325.5, 253.5  # of the frames (../shared/README.md)


def points_of(depth):
    rows, columns = np.indices(depth.shape)
    return np.stack([(columns - CX) * depth / FX, (rows - CY) * depth / FY, depth], -1)


def floor_plane(points, rng, tries=400):
    """(normal, distance) of the plane under the camera with most points, normal up (y is down)."""
    low = points[points.shape[0] // 2 :]
    low = low[(low[..., 2] > 0.3) & (low[..., 2] < 5)]
    best, count = None, -1
    for _ in range(tries):
        a, b, c = low[rng.integers(len(low), size=3)]
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal)
        if length < 1e-6:
            continue
        normal *= (-1 if normal[1] > 0 else 1) / length
        distance = -normal @ a
        if normal[1] > -0.85 or not 0.5 < distance < 2.0:
            continue
        fitting = int((np.abs(low @ normal + distance) < 0.03).sum())
        if fitting > count:
            best, count = (normal, distance), fitting
    return best


def squares(rgb, depth, height):
    side = rgb.shape[0]
    for left in (0, rgb.shape[1] - side):
        part = slice(left, left + side)
        yield rgb[:, part], depth[:, part], height[:, part]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=pathlib.Path, default=common.SHARED / "data/rgbd")
    parser.add_argument("--network", type=pathlib.Path, default=FILE)
    parser.add_argument("--out", type=pathlib.Path, default=common.DATA / "real.png")
    args = parser.parse_args()
    network = Runtime(args.network)
    size = network.size
    table = np.load(common.REPO / "networks/text_vectors.npy").astype(np.float32)
    rng, rows = np.random.default_rng(1), []
    for file in sorted((args.frames / "color").glob("*.png")):
        rgb = cv2.imread(str(file))[:, :, ::-1]
        raw = cv2.imread(str(args.frames / "depth" / f"{file.stem}.pgm"), cv2.IMREAD_UNCHANGED)
        depth = raw.astype(np.float32) / 1000
        points = points_of(depth)
        normal, distance = floor_plane(points, rng)
        height = np.where(depth > 0, points @ normal + distance, 0).astype(np.float32)
        row = []
        for part in squares(rgb, depth, height):
            small = cv2.resize(part[0], (size, size), interpolation=cv2.INTER_AREA)
            depth_s, height_s = (cv2.resize(p, (size, size), interpolation=cv2.INTER_NEAREST) for p in part[1:])
            answer = network(small.transpose(2, 0, 1), depth_s[None], height_s[None])
            claims = [f"{common.GOALS[goal]} {score:.2f}" for goal, score, _ in
                      metrics.decode(answer["heat"], answer["box"], size) if score > 0.2]
            stairs = float((answer["stairs"] > 0.5).mean())
            print(f"{file.name}: camera {distance:.2f} m high; {', '.join(claims) or 'no claims'}; stairs {stairs:.3f}")
            row += [panels.claims_picture(small, answer), panels.stairs_picture(small, answer),
                    panels.names_picture(small, answer, table)]
        rows.append(np.hstack(row))
    args.out.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(args.out), np.vstack(rows)[:, :, ::-1])
    print(args.out)


if __name__ == "__main__":
    main()
