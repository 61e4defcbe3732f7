#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plots the output of `crossnav bench noise --out SWEEP.json`.

    scripts/plot_noise.py SWEEP.json --out PLOT.png      (or .svg, .pdf)

One row a kind of noise: the share of goals that were reached, and the map's error, against the value of
its setting; the grey line is the perfect sensor with `map.clearing = evidence`. Needs matplotlib.
"""
import argparse
import json
import pathlib
import sys

UNITS = {"depth": "sigma at 1 m [m]", "edges": "shift [px]", "flying": "share of edge pixels", "holes": "share lost", "range": "m",
         "drift": "m a move", "height": "m a move", "yaw": "degrees a step", "turns": "degrees",
         "moves": "share of a move", "slip": "probability", "drops": "probability"}


def read_sweep(path):
    """(rows of the control, {kind: rows}) of a sweep."""
    try:
        rows = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["rows"]
        control = next(row for row in rows if row["kind"] == "clearing")
        kinds = {}
        for row in rows:
            if row["kind"] not in ("none", "clearing"):
                kinds.setdefault(row["kind"], []).append(row)
    except (OSError, ValueError, KeyError, TypeError, StopIteration) as error:
        sys.exit(f"{path}: is no sweep of `crossnav bench noise --out` ({error!r})")
    return control, kinds


def reached(row):
    """Share of the goals that were reached [%]."""
    return 100 * row["goals_reached"] / max(1, row["goals"])


def plot(control, kinds, out):
    """Writes the picture."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(len(kinds), 2, figsize=(8, 1.7 * len(kinds)), squeeze=False,
                                   constrained_layout=True)
    most_cm = 105 * max(row["map_error_m"] for rows in kinds.values() for row in [control, *rows])
    for (left, right), (kind, rows) in zip(axes, kinds.items()):
        labels = [row["value"] for row in rows]
        for axis, values, level, name, top in (
                (left, [reached(row) for row in rows], reached(control), "goals reached [%]", 105),
                (right, [100 * row["map_error_m"] for row in rows],
                 100 * control["map_error_m"], "map error [cm]", most_cm)):
            axis.axhline(level, color="0.6", linewidth=1)
            axis.plot(labels, values, "k.-")
            axis.set_ylim(0, top)
            axis.set_ylabel(name, fontsize=8)
            axis.set_xlabel(f"{kind}: {UNITS.get(kind, 'profile')}", fontsize=8)
            axis.tick_params(labelsize=8)
    figure.suptitle(f"{control['episodes']} episodes and {control['goals']} goals a point; "
                    "grey: perfect sensors", fontsize=9)
    figure.savefig(out, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sweep")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    plot(*read_sweep(arguments.sweep), arguments.out)


if __name__ == "__main__":
    main()
