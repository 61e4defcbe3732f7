// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/world/embedded_house.h"

namespace crossnav::app {

Result<void> WorldGenerate(const WorldOptions& options, const CommonOptions& /*common*/,
                           Console& console) {
  if (!options.embedded) {
    return Fail(ErrorCode::kUnsupported,
                "this version writes only the embedded house; add --embedded", "world generate");
  }
  const auto folder = world::WriteEmbeddedHouse(options.out);
  if (!folder) return tl::unexpected(folder.error());
  console.Print(folder->string() + "\n");
  console.Document(nlohmann::ordered_json({{"scenes", {folder->string()}}}).dump());
  return {};
}

}  // namespace crossnav::app
