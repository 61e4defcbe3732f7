// SPDX-License-Identifier: MIT
// A scene graph as a file: by its name JSON, GraphML, MCAP (for Foxglove) or a Rerun recording.
#pragma once

#include <string>

#include "crossnav/core/result.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::app {

/// Error kUnsupported for another kind of name.
Result<void> CheckGraphFile(const std::string& path);

/// `.rrd` is written by the Python package (crossnav[rerun]).
Result<void> WriteGraphFile(const scenegraph::SceneGraph& graph, const std::string& path);

}  // namespace crossnav::app
