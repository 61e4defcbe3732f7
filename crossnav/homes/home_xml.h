// SPDX-License-Identifier: MIT
// Home.xml of Sweet Home 3D -> HomePlan. Any bytes are safe to pass; errors name the element and
// its attribute.
#pragma once

#include <string>

#include "crossnav/core/result.h"
#include "crossnav/homes/home_plan.h"

namespace crossnav::homes {

/// `where` (file and entry) prefixes errors.
Result<HomePlan> ParseHomeXml(const std::string& xml, const std::string& where);

}  // namespace crossnav::homes
