// SPDX-License-Identifier: MIT
// A scene graph as text (docs/lifelong.md, "The map as a graph").
#pragma once

#include <string>

#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::app {

std::string GraphJson(const scenegraph::SceneGraph& graph);
/// GraphML 1.0: nodes with `kind`, edges with `relation`.
std::string GraphXml(const scenegraph::SceneGraph& graph);
/// Summary text: floors, their rooms, objects by category.
std::string GraphSummary(const scenegraph::SceneGraph& graph);

}  // namespace crossnav::app
