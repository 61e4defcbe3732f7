// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_source.h"

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/surface/pictures.h"

namespace crossnav::world {
namespace {

/// Synonyms in use for an object; the category table has all of them.
void VaryName(ObjectModel& model, Rng& rng) {
  struct Names {
    const char *kind, *names[3];
  };
  static constexpr Names kNames[] = {
      {"couch", {"couch", "sofa", "couch"}},
      {"potted plant", {"potted plant", "plant", "houseplant"}},
      {"tv", {"tv", "television", "tv"}},
      {"tv unit", {"tv", "television", "tv"}},
      {"dining chair", {"dining chair", "chair", "dining chair"}},
      {"computer monitor", {"computer monitor", "monitor", "computer monitor"}}};
  for (const auto& row : kNames) {
    if (model.name == row.kind) {
      model.name = row.names[rng.Below(3)];
      return;
    }
  }
}

/// Most screens are on.
void ShowPicture(std::string_view kind, ObjectModel& model, Rng& rng) {
  const bool is_screen = kind == "tv" || kind == "computer monitor";
  if (kind == "picture" || (is_screen && rng.Chance(0.75))) AddPicture(model, is_screen, rng);
}

/// Share of its catalogue size that people give a piece of this kind.
std::pair<double, double> SizeRange(std::string_view kind) {
  struct Range {
    std::string_view kind;
    double least, most;
  };
  // chosen: after the sizes in homes that people drew
  static constexpr Range kRanges[] = {
      {"potted plant", 0.25, 1.8},    {"vase", 0.5, 2.0},     {"tv", 0.5, 1.3},
      {"computer monitor", 0.7, 1.3}, {"tv unit", 0.8, 1.2},  {"chair", 0.6, 1.2},
      {"dining chair", 0.6, 1.2},     {"toilet", 0.85, 1.15}, {"desk", 0.9, 1.15},
      {"dining table", 0.9, 1.15},    {"tv stand", 0.8, 1.2}};
  for (const Range& range : kRanges) {
    if (range.kind == kind) return {range.least, range.most};
  }
  return {0.8, 1.3};
}

void GiveOddSize(std::string_view kind, ObjectModel& model, Rng& rng) {
  constexpr double kChance = 0.7, kStretch = 0.15;  // chosen
  if (!rng.Chance(kChance)) return;
  const auto [least, most] = SizeRange(kind);
  const double size = std::exp(rng.Uniform(std::log(least), std::log(most)));
  Vector3d factor;
  for (double& axis : factor) axis = size * std::exp(rng.Uniform(-kStretch, kStretch));
  for (auto& v : model.mesh.vertices) v = v.cwiseProduct(factor.cast<float>());
  if (model.top_m > 0) model.top_m *= factor.z();
}

}  // namespace

std::optional<ObjectModel> FurnitureSource::Make(std::string_view kind, Rng& rng) const {
  std::optional<ObjectModel> model;
  if (pack && rng.Chance(pack_share)) model = pack->Draw(kind, rng);
  if (!model) model = MakeFurniture(kind, rng);
  if (model && has_odd_sizes) GiveOddSize(kind, *model, rng);
  if (model && has_pictures) ShowPicture(kind, *model, rng);
  if (model) VaryName(*model, rng);
  return model;
}

}  // namespace crossnav::world
