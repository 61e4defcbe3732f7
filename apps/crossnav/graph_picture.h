// SPDX-License-Identifier: MIT
// A scene graph from above, a picture for each floor: rooms in colours with their ids, passages,
// objects with their names.
#pragma once

#include <filesystem>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::app {

RgbImage DrawGraphFloor(const scenegraph::SceneGraph& graph, int floor, int px_per_cell = 6);

/// floor_0.png, floor_1.png, ... in `folder`, which is created.
Result<void> WriteFloorPictures(const scenegraph::SceneGraph& graph,
                                const std::filesystem::path& folder);

}  // namespace crossnav::app
