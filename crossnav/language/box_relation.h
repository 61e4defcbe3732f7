// SPDX-License-Identifier: MIT
// Relation word between two boxes. Measures are those of the graph (scenegraph/box_measures.h); a
// near miss is a maybe, because boxes of seen objects are coarse. World frame.
#pragma once

#include "crossnav/core/box.h"
#include "crossnav/language/description.h"

namespace crossnav::language {

/// "a `relation` b". Walls between them are not known here.
Fit HoldsFor(Relation relation, const Box3& a, const Box3& b);

}  // namespace crossnav::language
