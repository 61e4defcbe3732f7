# SPDX-License-Identifier: MIT
"""The plots of a report, each as SVG for the page and as PNG and PDF.

Readable in grey: runs differ in lightness, hatch and marker, the paper's values are diamonds.
"""

import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crossnav.report.data import OUTCOMES, Report

COLOURS = ("#20476b", "#d98c2b", "#7fb0a5", "#b9b3d9", "#5d5d5d", "#e3cf7a")
MARKERS = "osv^Dx"
HATCHES = ("", "//", "..", "xx", "\\\\", "--")
GREYS = ("#f2f2f2", "#2b2b2b", "#6a6a6a", "#9a9a9a", "#c4c4c4", "#e0e0e0")  # by outcome
STYLE = {"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
         "grid.color": "#dddddd", "axes.axisbelow": True, "svg.fonttype": "path",
         "pdf.fonttype": 42, "legend.frameon": False, "hatch.linewidth": 0.5}
DISTANCES_M = (0.0, 2.0, 5.0, 10.0, 20.0, float("inf"))  # chosen: a room, a floor, two floors


@dataclass
class Plot:
    name: str
    title: str
    note: str  # content, and how to read it
    svg: str
    png: bytes
    pdf: bytes


def _render(name: str, title: str, note: str, figure: Figure) -> Plot:
    def bytes_of(kind: str, **options: Any) -> bytes:
        buffer = io.BytesIO()
        dated = {"CreationDate": None} if kind == "pdf" else {"Date": None}
        figure.savefig(buffer, format=kind, bbox_inches="tight",
                       metadata=None if kind == "png" else dated, **options)
        return buffer.getvalue()

    with matplotlib.rc_context({"svg.hashsalt": name}):
        svg = bytes_of("svg").decode()
    return Plot(name, title, note, svg, bytes_of("png", dpi=150), bytes_of("pdf"))


def _figure(width: float, height: float, columns: int = 1) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots(1, columns, squeeze=False)[0]
    return figure, list(axes)


def _legend(figure: Figure, axes: Axes, columns: int = 4) -> None:
    """Above the plot, where it covers nothing."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=columns, fontsize=8)


def _bars(axes: Axes, report: Report, cells: list[tuple[str, str, str]]) -> None:
    """A group of bars per cell (label, group, metric), a bar per run, per cent with intervals."""
    width = 0.8 / len(report.runs)
    for r, run in enumerate(report.runs):
        for i, (_, group, metric) in enumerate(cells):
            row = report.figure(run["name"], group, metric)
            if np.isnan(row["value"]):
                continue
            x = i - 0.4 + (r + 0.5) * width
            value = 100 * row["value"]
            axes.bar(x, value, 0.9 * width, color=COLOURS[r % len(COLOURS)], edgecolor="black",
                     linewidth=0.6, hatch=HATCHES[r % len(HATCHES)],
                     label=run["name"] if i == 0 else "_")
            if not np.isnan(row["low"]):
                axes.errorbar(x, value, [[max(0, value - 100 * row["low"])],
                                         [max(0, 100 * row["high"] - value)]],
                              color="black", capsize=3, linewidth=1)
            if not np.isnan(row["paper"]):
                axes.plot(x, 100 * row["paper"], "D", color="white", markeredgecolor="black",
                          markersize=6, label="the paper" if i == 0 and r == 0 else "_")
    axes.set_xticks(range(len(cells)), [label for label, _, _ in cells])
    axes.set_xlim(-0.5, len(cells) - 0.5)
    axes.set_ylim(0, 105)
    axes.grid(visible=False, axis="x")


def _n(report: Report, group: str) -> str:
    """Episodes of a group, one number per run."""
    return " / ".join(str(report.figure(run["name"], group, "SR")["episodes"])
                      for run in report.runs)


def _reached(report: Report, k: int) -> str:
    counts = [str(int((report.stages[report.stages.run == run["name"]].number == k).sum()))
              for run in report.runs]
    return f"goal {k}\nn = " + " / ".join(counts)


def by_goal(report: Report, kind: str, title: str, note: str) -> Plot:
    figure, axes = _figure(9, 3.6, 2)
    for panel, metric in zip(axes, ("SR", "SPL"), strict=True):
        cells = []
        for k in range(1, report.goals + 1):
            label = _reached(report, k) if kind == "cond" else f"goal {k}\nn = {_n(report, 'all')}"
            cells.append((label, "all", f"{metric}_{kind}_{k}"))
        _bars(panel, report, cells)
        panel.set_ylabel(f"{metric} [%]")
        panel.set_xlabel("number of the goal in the sequence")
    _legend(figure, axes[0])
    return _render(f"{'conditional' if kind == 'cond' else 'global'}_by_goal", title, note, figure)


def conditional(report: Report) -> Plot:
    return by_goal(report, "cond", "Conditional success and efficiency by goal number",
                   "Of the episodes that reached a goal; n is their number, one per run. Bars have "
                   "bootstrap 95 % intervals; diamonds are the paper's values.")


def overall(report: Report) -> Plot:
    return by_goal(report, "global", "Global success and efficiency by goal number",
                   "Of all episodes. The paper's values follow from its conditional ones.")


def floor_change(report: Report) -> Plot:
    figure, axes = _figure(9, 3.6, 4)
    groups = {"all": "all", "same_floor": "none\nneeded", "cfr": "needed"}
    for panel, metric in zip(axes, ("SR", "SPL", "PR", "PPL"), strict=True):
        _bars(panel, report, [(label, group, metric) for group, label in groups.items()])
        panel.set_ylabel(f"{metric} [%]")
        panel.set_xlabel("floor change")
        panel.tick_params(axis="x", labelsize=8)
    _legend(figure, axes[0])
    note = (f"n = {_n(report, 'all')} episodes; {_n(report, 'same_floor')} need no floor change, "
            f"{_n(report, 'cfr')} do. Diamonds are the paper's values.")
    return _render("floor_change", "All episodes against those that require a floor change", note,
                   figure)


def _heat(axes: Axes, counts: pd.DataFrame, row_label: str, unit: str) -> None:
    """Counts, with the share of their row as shade."""
    share = counts.div(counts.sum(axis=1).clip(lower=1), axis=0)
    axes.imshow(share, cmap="Greys", vmin=0, vmax=1.25, aspect="auto")
    for (i, j), count in np.ndenumerate(counts.to_numpy()):
        if count:
            axes.text(j, i, str(count), ha="center", va="center", fontsize=8,
                      color="white" if share.iat[i, j] > 0.6 else "black")
    axes.set_xticks(range(len(counts.columns)), [str(c).replace("_", " ") for c in counts.columns],
                    rotation=30, ha="right")
    axes.set_yticks(range(len(counts)),
                    [f"{name} (n = {n})" for name, n in counts.sum(axis=1).items()], fontsize=8)
    axes.set_ylabel(row_label)
    axes.set_xlabel(f"outcome [{unit}]")
    axes.grid(visible=False)
    axes.set_xticks(np.arange(len(counts.columns) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(counts) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="#bbbbbb", linewidth=0.6)
    axes.tick_params(which="minor", length=0)


def _heat_plot(report: Report, table: pd.DataFrame, row: str, columns: list[str],
               words: tuple[str, str, str, str]) -> Plot:
    name, title, row_label, unit = words
    rows = sorted(table[row].unique())
    figure, axes = _figure(4.6 * len(report.runs) + 0.6, 1.5 + 0.24 * max(4, len(rows)),
                           len(report.runs))
    for panel, run in zip(axes, report.runs, strict=True):
        part = table[table.run == run["name"]]
        counts = pd.crosstab(part[row], part["outcome"]).reindex(
            index=rows, columns=columns, fill_value=0)
        _heat(panel, counts, row_label, unit)
        panel.set_title(run["name"], fontsize=9)
    return _render(name, title, "The number is a count, the shade its share of the row.", figure)


def category_outcomes(report: Report) -> Plot:
    return _heat_plot(report, report.stages, "goal", OUTCOMES,
                      ("category_outcomes", "Outcomes by goal category", "category of the goal",
                       "number of goals that were searched"))


def scene_outcomes(report: Report) -> Plot:
    columns = OUTCOMES + (["failed"] if (report.episodes.outcome == "failed").any() else [])
    return _heat_plot(report, report.episodes, "scene", columns,
                      ("scene_outcomes", "Outcomes by scene", "scene", "number of episodes"))


def budget(report: Report) -> Plot:
    figure, (axes,) = _figure(8, 3.8)
    for r, run in enumerate(report.runs):
        part = report.episodes[report.episodes.run == run["name"]]
        for style, value, label in (("-", "not required", "no floor change"),
                                    ("--", "required", "floor change")):
            group = part[part.floor_change == value]
            if group.empty:
                continue
            done = np.sort(group[group.outcome == "success"].actions.to_numpy())
            x = np.concatenate([[0], done, [max(part.actions.max(), 1)]])
            y = np.arange(len(done) + 1) * 100 / len(group)
            axes.step(x, np.append(y, y[-1]), style, where="post", color=COLOURS[r % len(COLOURS)],
                      linewidth=1.6, marker=MARKERS[r % len(MARKERS)], markersize=4,
                      markevery=max(1, len(x) // 8),
                      label=f"{run['name']}, {label}, n = {len(group)}")
    axes.set_xlabel("budget [actions of an episode]")
    axes.set_ylabel("episodes completed [%]")
    axes.set_ylim(0, 105)
    axes.set_xlim(left=0)
    _legend(figure, axes, 2)
    return _render("budget", "Success against budget",
                   "Share of episodes that were complete within so many actions.", figure)


def distance(report: Report) -> Plot:
    figure, (axes,) = _figure(8, 3.8)
    stages = report.stages.assign(
        bin=pd.cut(report.stages.shortest_m, DISTANCES_M, right=False, labels=False))
    width = 0.7 / len(report.runs)
    counts: list[list[str]] = [[] for _ in DISTANCES_M[1:]]
    for r, run in enumerate(report.runs):
        part = stages[stages.run == run["name"]]
        for b in range(len(DISTANCES_M) - 1):
            values = 100 * part[part.bin == b].spl.to_numpy()
            counts[b].append(str(len(values)))
            if not len(values):
                continue
            x = b - 0.35 + (r + 0.5) * width
            spread = np.linspace(-0.3, 0.3, len(values)) * width
            axes.plot(x + spread, values, MARKERS[r % len(MARKERS)],
                      color=COLOURS[r % len(COLOURS)], alpha=0.35, markersize=3,
                      markeredgewidth=0)
            axes.plot([x - 0.45 * width, x + 0.45 * width], [values.mean()] * 2, color="black",
                      linewidth=2)
            axes.plot(x, values.mean(), MARKERS[r % len(MARKERS)], color=COLOURS[r % len(COLOURS)],
                      markeredgecolor="black", markersize=7,
                      label=run["name"] if b == 0 else "_")
    labels = [f"{low:g} to {high:g}" if high < float("inf") else f"over {low:g}"
              for low, high in zip(DISTANCES_M, DISTANCES_M[1:], strict=False)]
    axes.set_xticks(range(len(labels)), [f"{label}\nn = {' / '.join(n)}"
                                         for label, n in zip(labels, counts, strict=True)])
    axes.set_xlabel("shortest path to the goal when it was set [m]; n: goals searched")
    axes.set_ylabel("SPL of a goal [%]")
    axes.set_ylim(-3, 105)
    _legend(figure, axes)
    return _render("distance", "SPL against distance",
                   "Small marks are goals, large ones the mean of their distance.", figure)


def causes(report: Report) -> Plot:
    table = report.causes
    rows = table.groupby("cause").stages.sum().sort_values().index if len(table) else []
    figure, axes = _figure(4.4 * len(report.runs) + 1.6, 1.3 + 0.28 * max(2, len(rows)),
                           len(report.runs))
    for panel, run in zip(axes, report.runs, strict=True):
        part = table[table.run == run["name"]]
        counts = part.pivot_table(index="cause", columns="outcome", values="stages",
                                  aggfunc="sum", fill_value=0).reindex(rows, fill_value=0)
        left = np.zeros(len(counts))
        for i, outcome in enumerate(OUTCOMES):
            if outcome not in counts:
                continue
            panel.barh(range(len(counts)), counts[outcome], left=left, color=GREYS[i],
                       edgecolor="black", linewidth=0.6, hatch=HATCHES[i],
                       label=outcome.replace("_", " "))
            left += counts[outcome].to_numpy()
        panel.set_yticks(range(len(rows)), list(rows), fontsize=8)
        panel.set_ylim(-0.5, max(1, len(rows)) - 0.5)
        panel.set_xlabel(f"failed goals [number], n = {int(part.stages.sum())}")
        panel.set_title(run["name"], fontsize=9)
        panel.grid(visible=False, axis="y")
        panel.xaxis.get_major_locator().set_params(integer=True)
        if len(part):
            panel.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
        else:
            panel.text(0.5, 0.5, "no goal failed", ha="center", transform=panel.transAxes)
    return _render("causes", "Causes of failure",
                   "What a goal that was not found was doing at its end, as crossnav report counts "
                   "it; shades are outcomes.", figure)


def timing(report: Report) -> Plot:
    table = report.timing
    order = table.groupby("stage").p50_ms.max().sort_values().index
    figure, (axes,) = _figure(8, 1.4 + 0.3 * max(3, len(order)) * max(1, len(report.runs) / 2))
    height = 0.8 / len(report.runs)
    for r, run in enumerate(report.runs):
        part = table[table.run == run["name"]].set_index("stage").reindex(order)
        y = np.arange(len(order)) + 0.4 - (r + 0.5) * height
        n = int(part.episodes.max()) if part.episodes.notna().any() else 0
        axes.barh(y, part.p50_ms, 0.9 * height, color=COLOURS[r % len(COLOURS)], edgecolor="black",
                  linewidth=0.6, hatch=HATCHES[r % len(HATCHES)],
                  label=f"{run['name']}, n = {n} episodes")
        axes.plot(part.p95_ms, y, "|", color="black", markersize=9,
                  label="95th percentile" if r == 0 else "_")
    axes.set_yticks(range(len(order)), list(order))
    axes.set_ylabel("stage of a step")
    axes.set_xlabel("CPU time of a step [ms], median over episodes")
    axes.grid(visible=False, axis="y")
    _legend(figure, axes)
    return _render("timing", "Where the time of a step goes",
                   "Bars are medians, ticks 95th percentiles; \"step\" is everything together.",
                   figure)


PLOTS: tuple[Callable[[Report], Plot], ...] = (
    conditional, overall, floor_change, budget, distance, category_outcomes, scene_outcomes, causes,
    timing)


def draw_all(report: Report) -> list[Plot]:
    with matplotlib.rc_context(STYLE):
        return [plot(report) for plot in PLOTS]
