// SPDX-License-Identifier: MIT
#include "crossnav/localization/awakening.h"

#include <utility>

namespace crossnav::localization {

Result<Awakening> Awakening::In(const geometry::VoxelMap& map, const Body& body,
                                const LocalizeConfig& config) {
  auto placed = PlaceMap(map, config);
  if (!placed) return tl::unexpected(placed.error());
  Awakening awakening;
  awakening.map_ = std::make_unique<const PlacedMap>(std::move(*placed));
  awakening.localizer_ = std::make_unique<Localizer>(*awakening.map_, body, config);
  return awakening;
}

const LocalizeStep& Awakening::Step(const Observation& obs) {
  last_ = localizer_->Step(obs);
  return last_;
}

}  // namespace crossnav::localization
