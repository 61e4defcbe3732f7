# SPDX-License-Identifier: MIT
"""How the viewer is arranged when a recording is opened for the first time."""

import rerun.blueprint as rrb


def blueprint() -> rrb.Blueprint:
    """The map beside the camera's pictures, the scores below, on the timeline `step`."""
    space = rrb.Spatial3DView(
        name="map", origin="/world",
        contents=["/world/**", "- /world/changes", "- /world/camera/depth/**"])
    pictures = rrb.Vertical(
        rrb.Spatial2DView(name="image, boxes, masks", origin="/world/camera/image"),
        rrb.Spatial2DView(name="depth", origin="/world/camera/depth"),
        rrb.Spatial2DView(name="similarity", origin="/similarity"))
    below = rrb.Horizontal(
        rrb.TextDocumentView(name="status", origin="/status"),
        rrb.TimeSeriesView(name="scores", origin="/", contents=["/scores/**", "/claim/**"]),
        rrb.TextLogView(name="log", origin="/log"), column_shares=[1, 2, 2])
    return rrb.Blueprint(
        rrb.Vertical(rrb.Horizontal(space, pictures, column_shares=[3, 1]), below,
                     row_shares=[3, 1]),
        rrb.TimePanel(timeline="step", state="collapsed"), collapse_panels=True)
