# SPDX-License-Identifier: MIT
"""A map's graph in Rerun: rooms as their ground, objects as boxes, links as lines."""

import json
import os
from pathlib import Path
from typing import Any, Union

import numpy as np
import rerun as rr

from crossnav._errors import Error

PathLike = Union[str, "os.PathLike[str]"]
ROOM, OBJECT, PASSAGE, RELATION = (28, 126, 214), (214, 51, 108), (47, 158, 68), (245, 159, 0)
FLAT_M = 0.05  # a room is drawn as its ground


def _boxes(found: list[dict[str, Any]], labels: list[str], colour: tuple[int, int, int],
           flat_m: float = 0.0) -> rr.Boxes3D:
    low = np.array([one["box_min"] for one in found], float).reshape(-1, 3)
    high = np.array([one["box_max"] for one in found], float).reshape(-1, 3)
    if flat_m:
        high[:, 2] = low[:, 2] + flat_m
    return rr.Boxes3D(centers=(low + high) / 2, sizes=high - low, labels=labels, colors=colour)


def read_graph(path: PathLike) -> dict[str, Any]:
    """The graph that `crossnav map graph MAP --to FILE.json` wrote. Raises crossnav.Error."""
    try:
        graph = json.loads(Path(path).read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise Error(f"cannot read a graph: {error}", str(path)) from None
    if not isinstance(graph, dict) or not {"rooms", "objects", "relations"} <= graph.keys():
        raise Error("not a graph; `crossnav map graph MAP --to FILE.json` writes one", str(path))
    return graph


def draw_graph(recording: rr.RecordingStream, graph: dict[str, Any]) -> None:
    """Draws the graph, for all times."""
    rooms, objects = graph["rooms"], graph["objects"]
    names = [f"room {room['id']}" for room in rooms]
    recording.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    recording.log("world/graph/rooms", _boxes(rooms, names, ROOM, FLAT_M), static=True)
    recording.log("world/graph/objects",
                  _boxes(objects, [one["category"] for one in objects], OBJECT), static=True)
    ways = [[rooms[passage["rooms"][0]]["center"], passage["position"],
             rooms[passage["rooms"][1]]["center"]] for passage in graph["passages"]]
    recording.log("world/graph/passages", rr.LineStrips3D(ways, colors=PASSAGE), static=True)
    centres = [(np.array(one["box_min"]) + np.array(one["box_max"])) / 2 for one in objects]
    links = [[centres[link["from"]], centres[link["to"]]] for link in graph["relations"]]
    recording.log("world/graph/relations",
                  rr.LineStrips3D(links, colors=RELATION,
                                  labels=[link["relation"] for link in graph["relations"]],
                                  show_labels=False), static=True)
