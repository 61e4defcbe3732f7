# SPDX-License-Identifier: MIT
"""Tables of a report: one row per figure, episode, stage, time and cause."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

import pandas as pd

from crossnav import _core

OUTCOMES = ["success", "not_reached", "misdetection", "all_explored", "stuck", "out_of_time"]
"""Of a stage, in the order of docs/formats/results.md."""


@dataclass
class Report:
    """Tables of all runs; `run` is the name of a run's folder."""

    runs: list[dict[str, Any]]  # name, variant, perception, hashes, number of episodes
    figures: pd.DataFrame  # run, group, metric, episodes, value, low, high, paper
    episodes: pd.DataFrame
    stages: pd.DataFrame
    timing: pd.DataFrame  # run, stage, p50_ms and p95_ms: medians over episodes, episodes
    causes: pd.DataFrame  # run, cause, outcome, stages
    differences: pd.DataFrame  # before, after, metric, difference, low, high, episodes, scenes
    flips: pd.DataFrame  # before, after, episode, goals, outcome_.., goals_.., cause, replay
    notes: list[str]  # compared runs, and reasons against fairness

    def tables(self) -> dict[str, pd.DataFrame]:
        return {"figures": self.figures, "episodes": self.episodes, "stages": self.stages,
                "timing": self.timing, "causes": self.causes, "differences": self.differences,
                "flips": self.flips}

    def figure(self, run: str, group: str, metric: str) -> dict[str, Any]:
        """value, low, high, paper and episodes of a figure; NaN if there is none."""
        rows = self.figures
        found = rows[(rows.run == run) & (rows.group == group) & (rows.metric == metric)]
        empty = {"value": float("nan"), "low": float("nan"), "high": float("nan"),
                 "paper": float("nan"), "episodes": 0}
        return found.iloc[0].to_dict() if len(found) else empty

    @property
    def goals(self) -> int:
        return int(self.episodes["goals"].str.count(" > ").max()) + 1


def _episode_row(run: str, record: dict[str, Any]) -> dict[str, Any]:
    stages = record["stages"]
    causes = [cause for cause in record["causes"] if cause]
    failed = record.get("failed")
    return {"run": run, "episode": record["episode_id"],
            "scene": record["scene_id"].split("/")[0],
            "floor_change": "required" if record["cross_floor_required"] else "not required",
            "goals": " > ".join(record["goals"]), "outcome": record["outcome"],
            "completed": record["completed"], "spl": record["spl"], "ppl": record["ppl"],
            "actions": record["actions"], "length_m": sum(s["length_m"] for s in stages),
            "shortest_m": sum(s["shortest_m"] for s in stages),
            "floor_changes": sum(s.get("transitions", 0) for s in stages),
            "cause": failed["message"] if failed else "; ".join(causes),
            "wall_s": record.get("wall_s"), "replay": ""}


def _stage_rows(run: str, record: dict[str, Any]) -> list[dict[str, Any]]:
    return [{"run": run, "episode": record["episode_id"], "scene": record["scene_id"].split("/")[0],
             "number": k + 1, "goal": stage["goal"], "outcome": stage["outcome"],
             "success": stage["success"], "spl": spl, "shortest_m": stage["shortest_m"],
             "length_m": stage["length_m"], "actions": stage.get("actions"),
             "floor_changes": stage.get("transitions"), "cause": cause}
            for k, (stage, spl, cause) in enumerate(
                zip(record["stages"], record["stage_spl"], record["causes"], strict=True))]


def _timing(run: str, records: list[dict[str, Any]]) -> pd.DataFrame:
    rows = [{"run": run, "stage": stage, "p50_ms": time["p50"], "p95_ms": time["p95"]}
            for record in records for stage, time in record.get("timing_ms", {}).items()]
    table = pd.DataFrame(rows, columns=["run", "stage", "p50_ms", "p95_ms"]).astype(
        {"p50_ms": float, "p95_ms": float})
    grouped = table.groupby(["run", "stage"])
    return grouped.median().assign(episodes=grouped.size()).reset_index()


def _causes(run: str, causes: dict[str, Any]) -> list[dict[str, Any]]:
    return [{"run": run, "cause": cause, "outcome": outcome, "stages": stages}
            for cause, row in causes.items() for outcome, stages in row["outcomes"].items()]


def _notes(comparison: dict[str, Any]) -> list[str]:
    pair = f"{comparison['after']} against {comparison['before']}"
    notes = [f"{pair}: {text}" for text in comparison["compared"]]
    return notes + [f"{pair} is not fair, they differ in {text}" for text in comparison["unfair"]]


def _flip(comparison: dict[str, Any], flip: dict[str, Any]) -> dict[str, Any]:
    """A row; cause and replay are of the run that did not complete the episode."""
    worse = "before" if flip["goals_after"] > flip["goals_before"] else "after"
    return {"before": comparison["before"], "after": comparison["after"],
            "episode": flip["episode_id"], "goals": flip["goals"],
            "outcome_before": flip["before"], "goals_before": flip["goals_before"],
            "outcome_after": flip["after"], "goals_after": flip["goals_after"],
            "worse": comparison[worse], "cause": flip[f"cause_{worse}"], "replay": ""}


def _compared(comparisons: list[dict[str, Any]]) -> tuple[pd.DataFrame, pd.DataFrame]:
    differences = [{"before": c["before"], "after": c["after"], "metric": metric, **difference,
                    "episodes": c["episodes"], "scenes": c["scenes"]}
                   for c in comparisons for metric, difference in c["differences"].items()]
    flips = [_flip(c, flip) for c in comparisons for flip in c["flips"]]
    return (pd.DataFrame(differences, columns=list(_DIFFERENCE_COLUMNS)),
            pd.DataFrame(flips, columns=list(_FLIP_COLUMNS)))


def read(runs: Sequence[Union[str, "os.PathLike[str]"]], partial: bool) -> Report:
    """Reads run folders or result files. Raises crossnav.Error that names the file and line."""
    report = _core.report_of_runs([Path(run) for run in runs], partial)
    episodes: list[dict[str, Any]] = []
    stages: list[dict[str, Any]] = []
    causes: list[dict[str, Any]] = []
    timing = []
    for run in report["runs"]:
        records = run.pop("records")
        for record in records:
            episodes.append(_episode_row(run["name"], record))
            stages += _stage_rows(run["name"], record)
        timing.append(_timing(run["name"], records))
        causes += _causes(run["name"], run.pop("causes"))
    figures = pd.DataFrame(report["figures"], columns=[
        "run", "group", "metric", "episodes", "value", "low", "high", "paper"])
    return Report(report["runs"], figures, pd.DataFrame(episodes),
                  pd.DataFrame(stages, columns=list(_STAGE_COLUMNS)),
                  pd.concat(timing, ignore_index=True),
                  pd.DataFrame(causes, columns=["run", "cause", "outcome", "stages"]),
                  *_compared(report["comparisons"]),
                  [note for c in report["comparisons"] for note in _notes(c)])


_DIFFERENCE_COLUMNS = ("before", "after", "metric", "difference", "low", "high", "episodes",
                       "scenes")
_FLIP_COLUMNS = ("before", "after", "episode", "goals", "outcome_before", "goals_before",
                 "outcome_after", "goals_after", "worse", "cause", "replay")
_STAGE_COLUMNS = ("run", "episode", "scene", "number", "goal", "outcome", "success", "spl",
                  "shortest_m", "length_m", "actions", "floor_changes", "cause")


def _file_name(episode_id: str) -> str:
    """As the program names a replay that it keeps."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", episode_id)


def export_replays(report: Report, runs: Sequence[Union[str, "os.PathLike[str]"]],
                   folder: Path) -> list[Path]:
    """Makes a page of every replay that a run kept, and notes it at its episode."""
    written = []
    for number, (run, path) in enumerate(zip(report.runs, runs, strict=True), 1):
        rows = report.episodes[report.episodes.run == run["name"]]
        for index, episode in rows.episode.items():
            replay = Path(path) / "replays" / f"{_file_name(episode)}.mcap"
            if not replay.is_file():
                continue
            page = folder / str(number) / f"{_file_name(episode)}.html"
            page.parent.mkdir(parents=True, exist_ok=True)
            _core.export_replay_page(replay, page)
            report.episodes.loc[index, "replay"] = page.relative_to(folder.parents[1]).as_posix()
            written.append(page)
    _link_flips(report)
    return written


def _link_flips(report: Report) -> None:
    pages = report.episodes.set_index(["run", "episode"]).replay
    for index, flip in report.flips.iterrows():
        report.flips.loc[index, "replay"] = pages[(flip.worse, flip.episode)]
