// SPDX-License-Identifier: MIT
#include "crossnav/language/map_home.h"

#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/scenegraph/find_objects.h"

namespace crossnav::language {

Result<KnownHome> HomeOf(const MapParts& parts, std::span<const std::string> names,
                         const EncodeText& encode, const memory::QueryConfig& query) {
  auto graph = scenegraph::BuildGraph(parts.map, parts.memory, parts.flights);
  if (parts.memory.Size() == 0) return HomeOf(graph, parts.records);
  std::vector<std::vector<float>> background;
  if (query.relevancy == "contrastive")
    for (const char* prompt : memory::kBackgroundPrompts) {
      auto vector = encode(prompt);
      if (vector) background.push_back(std::move(*vector));
    }
  for (const std::string& name : names) {
    const auto vector = encode(name);
    if (!vector) return tl::unexpected(vector.error());
    scenegraph::FindObjects(graph, parts.memory, {name, *vector, background}, query,
                            parts.thresholds);
  }
  return HomeOf(graph, parts.records);
}

}  // namespace crossnav::language
