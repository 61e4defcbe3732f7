// SPDX-License-Identifier: MIT
// Relation word between two boxes. Measures: scenegraph/box_measures.h. A near miss is kMaybe,
// because boxes of seen objects are coarse. World frame.
#pragma once

#include "crossnav/core/box.h"
#include "crossnav/language/description.h"

namespace crossnav::language {

/// Fit of "a `relation` b". Ignores walls between the boxes.
Fit HoldsFor(Relation relation, const Box3& a, const Box3& b);

}  // namespace crossnav::language
