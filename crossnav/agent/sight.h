// SPDX-License-Identifier: MIT
// Results of perception for a frame, kept for viewers.
#pragma once

#include <span>

#include "crossnav/perception/perception.h"
#include "crossnav/trace/sight.h"

namespace crossnav::agent {

/// Boxes, masks and stairs of `percept`, and the cosine of each feature cell with `goal_text`.
trace::Sight SightOf(const perception::Percept& percept, std::span<const float> goal_text);

}  // namespace crossnav::agent
