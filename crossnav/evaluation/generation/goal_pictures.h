// SPDX-License-Identifier: MIT
// Pictures of goal objects, as somebody takes them with a telephone: from a place to stand nearby,
// with the object in the middle. Objects whose twin stands in the same room have no picture that
// means them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/objects/appearance.h"

namespace crossnav::evaluation {

inline constexpr int kGoalPictureSide_px = 256;  // chosen: some 60 kB as PNG

class PictureTaker {
 public:
  /// `context` must outlive it.
  explicit PictureTaker(const SceneContext& context) : context_(context) {}

  /// A picture of one of the category's objects that can be confirmed and has no twin, and the
  /// object; empty where there is none.
  std::optional<std::pair<StagePicture, GoalObject>> Take(const std::string& category, Rng& rng);

  /// A picture of the instance with a camera that `rng` draws; empty without a good view.
  std::optional<StagePicture> TakeOf(const sim::SceneInstance& instance, Rng& rng) const;

  /// Whether another object of its category in its room has its colours.
  bool HasTwin(const sim::SceneInstance& instance);

 private:
  const objects::ColourHistogram& ColoursOf(const sim::SceneInstance& instance);

  const SceneContext& context_;
  std::map<int, objects::ColourHistogram> colours_;  // by instance
};

}  // namespace crossnav::evaluation
