// SPDX-License-Identifier: MIT
// Saved maps and the texts that are looked for in them, in the space of their features.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/perception/perception.h"
#include "crossnav/scenegraph/scene_graph.h"
#include "crossnav/store/map_file.h"

namespace crossnav::app {

/// The map with its own voxel size and clearing; damage that was skipped goes to the log.
Result<store::LoadedMemory> LoadMap(const std::string& file, bool skip_damaged,
                                    const evaluation::RunConfig& config, Console& console);

/// Query vectors in the space of the map's features.
struct TextVectors {
  std::vector<float> text;
  std::vector<std::vector<float>> background;  ///< for query.relevancy = contrastive
};

/// The encoder of the map's features, by the settings; kMismatch where it is another.
Result<std::unique_ptr<perception::DenseEncoder>> EncoderFor(const std::string& file,
                                                             const store::MapHeader& header,
                                                             const evaluation::RunConfig& config);

Result<TextVectors> EncodeText(const std::string& file, const std::string& text,
                               const store::MapHeader& header, const evaluation::RunConfig& config);

/// A picture (PNG) as a query: the vector of the object that it shows, and its category.
struct PictureQuery {
  TextVectors vectors;
  std::string category;
};
/// Error kUnsupported: ground truth, which reads no pictures of files.
Result<PictureQuery> EncodePicture(const std::string& file, const std::string& picture,
                                   const std::vector<int>& box, const store::MapHeader& header,
                                   const evaluation::RunConfig& config);

/// From which match on a text is present in a map with features of `encoder`.
std::optional<memory::MatchThresholds> ThresholdsOf(const std::string& encoder,
                                                    const evaluation::RunConfig& config);

/// Queries the map's memory for each of `categories` and adds the found objects to the graph.
Result<void> FindObjects(const std::string& file, const std::vector<std::string>& categories,
                         const store::LoadedMemory& loaded, const evaluation::RunConfig& config,
                         scenegraph::SceneGraph& graph);

}  // namespace crossnav::app
