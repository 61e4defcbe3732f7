// SPDX-License-Identifier: MIT
// Whether two boxes stand to each other as a word says. The measures are those of the graph
// (scenegraph/relations.cpp); what misses them by little is a maybe, because boxes of what was seen
// are coarse. World frame.
#pragma once

#include "crossnav/core/box.h"
#include "crossnav/language/description.h"

namespace crossnav::language {

/// "a `relation` b". Walls between them are not known here.
Fit HoldsFor(Relation relation, const Box3& a, const Box3& b);

}  // namespace crossnav::language
