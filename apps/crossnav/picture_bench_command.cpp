// SPDX-License-Identifier: MIT
// `bench pictures`: pictures of objects of generated houses against their maps.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ask_command.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/evaluation/trials/picture_trials.h"
#include "json_parts.h"
#include "perception_source.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::PictureTrial;

struct PictureCounts {
  int pictures = 0, read_right = 0, in_map = 0, right = 0;

  void Add(const PictureTrial& trial) {
    ++pictures;
    read_right += trial.category == trial.read_as ? 1 : 0;
    if (!trial.has_record || trial.rivals == 0) return;
    ++in_map;
    right += trial.is_right ? 1 : 0;
  }
};

std::string PictureShare(const char* what, int hits, int trials) {
  const auto interval = evaluation::WilsonInterval(hits, trials);
  return fmt::format("{:<42}{:>4} of {:>4}, {:5.1f} % [{:.1f}, {:.1f}]\n", what, hits, trials,
                     trials > 0 ? 100.0 * hits / trials : 0.0, 100 * interval.low,
                     100 * interval.high);
}

Json PictureTrialJson(const std::string& house, const PictureTrial& trial) {
  Json pairs = Json::array();
  for (const auto& pair : trial.pairs)
    pairs.push_back({{"same", pair.is_same},
                     {"colours", OrNull(pair.likeness.colours)},
                     {"object", OrNull(pair.likeness.object)},
                     {"around", OrNull(pair.likeness.around)},
                     {"log_odds", pair.log_odds}});
  return {{"house", house},
          {"category", trial.category},
          {"read_as", trial.read_as},
          {"right", trial.is_right},
          {"pairs", std::move(pairs)}};
}

}  // namespace

Result<void> BenchPictures(const PictureBenchOptions& options, const CommonOptions& common,
                           Console& console) {
  Protocol protocol;
  protocol.perception = options.perception;
  const auto config = LoadRunConfig(common, protocol);
  if (!config) return tl::unexpected(config.error());
  const auto source = PerceptionSource::Read(*config);
  if (!source) return tl::unexpected(source.error());
  PictureCounts counts;
  Json list = Json::array();
  for (int i = 0; i < options.count; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, options.count));
    const auto house = evaluation::TryPictures(options.seed + static_cast<std::uint64_t>(i),
                                               options.each, *config, source->Maker());
    if (!house) return tl::unexpected(house.error());
    for (const PictureTrial& trial : house->trials) {
      counts.Add(trial);
      list.push_back(PictureTrialJson(house->house, trial));
    }
  }
  console.EndProgress();
  console.Print(PictureShare("category read right", counts.read_right, counts.pictures) +
                PictureShare("right instance of those in the map", counts.right, counts.in_map));
  console.Document(Json({{"seed", options.seed},
                         {"count", options.count},
                         {"pictures", counts.pictures},
                         {"read_right", counts.read_right},
                         {"in_map", counts.in_map},
                         {"right", counts.right},
                         {"list", std::move(list)}}));
  return {};
}

}  // namespace crossnav::app
