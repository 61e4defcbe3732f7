// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_source.h"

#include <span>
#include <string>

#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/surface/pictures.h"

namespace crossnav::world {
namespace {

/// Synonyms in use for an object; the category table has all of them.
void VaryName(ObjectModel& model, Rng& rng) {
  static constexpr const char* kNames[][3] = {{"couch", "sofa", "couch"},
                                              {"potted plant", "plant", "houseplant"},
                                              {"tv", "television", "tv"},
                                              {"dining chair", "chair", "dining chair"},
                                              {"computer monitor", "monitor", "computer monitor"}};
  for (const auto& row : kNames) {
    if (model.name == row[0]) {
      model.name = row[rng.Below(3)];
      return;
    }
  }
}

/// Most screens are on.
void ShowPicture(std::string_view kind, ObjectModel& model, Rng& rng) {
  const bool is_screen = kind == "tv" || kind == "computer monitor";
  if (kind == "picture" || (is_screen && rng.Chance(0.75))) AddPicture(model, is_screen, rng);
}

}  // namespace

std::optional<ObjectModel> FurnitureSource::Make(std::string_view kind, Rng& rng) const {
  std::optional<ObjectModel> model;
  if (pack && rng.Chance(pack_share)) model = pack->Draw(kind, rng);
  if (!model) model = MakeFurniture(kind, rng);
  if (model && has_pictures) ShowPicture(kind, *model, rng);
  if (model) VaryName(*model, rng);
  return model;
}

}  // namespace crossnav::world
