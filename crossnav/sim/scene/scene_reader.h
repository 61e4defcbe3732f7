// SPDX-License-Identifier: MIT
// The parts of LoadScene that can be used and tested alone.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/sim/scene/gltf_reader.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// One line of a semantic text.
struct SemanticLine {
  int id = 0;
  std::uint32_t colour = 0;  ///< 0xRRGGBB
  std::string name;
  int region = 0;
};

/// Parses a semantic text; errors name `where` and the line. An id or a colour that is used twice,
/// as in some scenes of HM3D, is a note.
Result<std::vector<SemanticLine>> ParseSemanticText(std::string_view text, const std::string& where,
                                                    std::vector<std::string>* notes = nullptr);

/// "raw name<TAB>category" lines. Errors name `where` and the line.
Result<CategoryTable> ParseCategoryTable(std::string_view text, const std::string& where);

/// Instance of each triangle of a semantic mesh, by its colour; 0 for unnamed colours.
std::vector<std::int32_t> InstancesByColour(const GltfModel& semantic,
                                            std::span<const SemanticLine> lines);

/// Instance of each triangle of `target` from `source` (same frame): identical triangles first,
/// then the nearest surface within `max_m` of the triangle's centre; 0 where there is none.
std::vector<std::int32_t> TransferInstances(const TriangleMesh& source, const TriangleMesh& target,
                                            double max_m);

}  // namespace crossnav::sim
