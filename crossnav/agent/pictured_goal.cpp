// SPDX-License-Identifier: MIT
#include "crossnav/agent/pictured_goal.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "crossnav/agent/object_notes.h"
#include "crossnav/agent/state.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/perception/goal_picture.h"

namespace crossnav::agent {

using language::Fit;

namespace {

constexpr double kBeside_m = 1.0;       // chosen: as far as a picture of a chair shows beside it
constexpr double kSameLogOdds = 1.5;    // chosen: four to one: worth the walk
constexpr double kOtherLogOdds = -2.5;  // chosen: one to twelve

/// A measure's contribution: slope * (value - even), between both limits.
struct Evidence {
  double even, slope, least, most;
  double Of(const std::optional<double>& value) const {
    return value ? std::clamp(slope * (*value - even), least, most) : 0.0;
  }
};

struct Weights {
  std::string_view encoder;  ///< beginning of its name
  Evidence colours, object, around;
};

constexpr Evidence kNothing{0, 0, 0, 0};
constexpr std::array<Weights, 2> kWeights = {{
    {"ground-truth", {0.8, 10, -4, 2}, {0.4, 12, -4, 4}, {0.4, 4, -1, 1}},
    {"", {0.8, 10, -4, 2}, kNothing, kNothing},
}};

std::vector<std::string> NamesToRead() {
  std::vector<std::string> names;
  for (const std::string_view category : kCategories) names.emplace_back(category);
  return names;
}

}  // namespace

Result<PicturedGoal> PicturedGoalOf(const perception::GoalPicture& picture,
                                    const perception::PerceptionSuite& suite) {
  auto reading = perception::ReadPicture(suite, picture, NamesToRead());
  if (!reading) return tl::unexpected(reading.error());
  PicturedGoal goal;
  goal.name = perception::NameOfPicture(picture);
  goal.category = std::move(reading->category);
  goal.encoder_name = suite.encoder->Name();
  goal.object = perception::PooledFeature(reading->features, reading->mask);
  goal.around = perception::PooledFeature(reading->features, reading->mask, true);
  goal.colours.Add(picture.rgb, reading->mask, {0, 0, picture.rgb.width, picture.rgb.height});
  if (goal.object.empty())
    return Fail(ErrorCode::kInvalid, "shows no object to perception", "goal's picture");
  return goal;
}

Likeness LikenessAt(const World& world, const GoalState& goal,
                    const std::vector<geometry::VoxelKey>& voxels, const Vector3d& p_center_world) {
  const PicturedGoal& pictured = *goal.pictured;
  Likeness likeness;
  const auto record = RecordAt(world, SpacedName(goal.goal), p_center_world);
  if (record)
    likeness.colours =
        OverlapOf(pictured.colours, world.objects.ColoursOf(static_cast<int>(*record)));
  const auto& own = record ? world.objects.records()[*record].voxels : voxels;
  const std::array<std::vector<float>, 2> common = {goal.text, objects::MeanFeature(world.memory)};
  likeness.object =
      objects::OwnCosine(pictured.object, objects::FeatureAt(world.memory, own), common);
  likeness.around =
      objects::OwnCosine(pictured.around, objects::FeatureAround(world.memory, own, kBeside_m),
                         std::span(&common[1], 1));
  return likeness;
}

double LogOdds(const Likeness& likeness, const std::string& encoder_name) {
  const auto weights = std::find_if(kWeights.begin(), kWeights.end(), [&](const Weights& w) {
    return encoder_name.starts_with(w.encoder);
  });
  return weights->colours.Of(likeness.colours) + weights->object.Of(likeness.object) +
         weights->around.Of(likeness.around);
}

void KeepLikenessFresh(const World& world, GoalState* goal) {
  if (!goal->pictured) return;
  for (const policy::LivePoi& poi : goal->live.all()) {
    PicturedGoal::Judged& judged = goal->pictured->judged[poi.id];
    if (judged.frames == poi.frames) continue;
    judged.frames = poi.frames;
    judged.log_odds = LogOdds(LikenessAt(world, *goal, poi.voxels, poi.p_center_world),
                              goal->pictured->encoder_name);
  }
}

Fit FitOfPicture(const GoalState& goal, double log_odds) {
  if (log_odds >= kSameLogOdds) return Fit::kYes;
  if (!goal.instances.takes_guesses) return log_odds <= kOtherLogOdds ? Fit::kNo : Fit::kMaybe;
  for (const policy::LivePoi& poi : goal.live.all()) {
    const bool is_out = poi.is_discarded && !goal.instances.set_aside.contains(poi.id);
    const auto judged = goal.pictured->judged.find(poi.id);
    if (!is_out && judged != goal.pictured->judged.end() && judged->second.log_odds > log_odds)
      return Fit::kNo;
  }
  return Fit::kYes;
}

}  // namespace crossnav::agent
