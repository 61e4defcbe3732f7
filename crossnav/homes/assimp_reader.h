// SPDX-License-Identifier: MIT
// Models in formats other than OBJ and glTF, through Assimp if the program is built with it.
#pragma once

#include <string>

#include "crossnav/core/result.h"
#include "crossnav/world/models/obj_reader.h"

namespace crossnav::homes {

/// `extension` ("3ds", "dae") gives the format. kUnsupported without Assimp.
Result<world::NamedObj> ParseWithAssimp(const std::string& bytes, const std::string& extension,
                                        const world::FileLookup& lookup, const std::string& where);

}  // namespace crossnav::homes
