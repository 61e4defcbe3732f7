// SPDX-License-Identifier: MIT
// Trials of localisation: the robot wakes up anywhere in a house whose map it has, and does not
// know where. The map is the survey of the perfect house (evaluation/running/survey.h); sensors,
// odometry and steps are as imperfect as `noise` says. The same seed gives the same trial.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/localization/localizer.h"
#include "crossnav/world/house/twin_floors.h"

namespace crossnav::evaluation {

/// A right answer is this near.
inline constexpr double kRight_m = 0.25, kRight_deg = 5;

struct LostTrial {
  std::string house;
  AgentPose start;  ///< true
  int floor = 0;
  localization::LocalizeStep answer;
  double off_m = 0, off_deg = 0;  ///< of a known pose
  int actions = 0;
  double cpu_s = 0;  ///< of the localizer; rendering is not counted

  bool IsKnown() const { return answer.status == localization::Status::kKnown; }
  bool IsRight() const { return IsKnown() && off_m <= kRight_m && off_deg <= kRight_deg; }
  bool IsWrong() const { return IsKnown() && !IsRight(); }
};

/// A random pose on floor `number` modulo their count, and the localizer's answer there.
Result<LostTrial> TryLost(const SceneContext& context, const localization::PlacedMap& map,
                          const RunConfig& config, std::uint64_t seed, int number);

/// The survey of the house as a map to be lost in.
Result<localization::PlacedMap> SurveyedMap(const SceneContext& context, const RunConfig& config);

/// House `seed` of edition 1 with its upper floor made like the lower one. Error: a house of which
/// no twin can be made, or whose floors do not come out connected; try another seed.
Result<std::unique_ptr<SceneContext>> TwinHouse(std::uint64_t seed, world::TwinFurniture furniture,
                                                const RunConfig& config);

}  // namespace crossnav::evaluation
