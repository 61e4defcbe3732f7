// SPDX-License-Identifier: MIT
// The scene graph of an agent's map, kept for viewers while it walks (scenegraph/live_graph.h).
#pragma once

#include <optional>

#include "crossnav/agent/agent.h"
#include "crossnav/scenegraph/live_graph.h"
#include "crossnav/trace/graph_note.h"

namespace crossnav::agent {

class GraphWatch {
 public:
  /// After each step, with its record. The graph where it changed.
  std::optional<trace::GraphNote> Update(const Agent& agent, const trace::StepTrace& step);
  const scenegraph::LiveGraph& live() const { return live_; }

 private:
  scenegraph::LiveGraph live_;
};

trace::GraphNote NoteOf(const scenegraph::SceneGraph& graph);

}  // namespace crossnav::agent
