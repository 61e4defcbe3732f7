// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/generation/goal_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/evaluation/episodes/picture_view.h"
#include "crossnav/sim/sensing/object_views.h"

namespace crossnav::evaluation {
namespace {

constexpr double kLeastHfov_deg = 60, kMostHfov_deg = 90;    // chosen: telephones and robots
constexpr double kLeastHeight_m = 0.9, kMostHeight_m = 1.5;  // chosen: of hands and of eyes
constexpr double kTwinOverlap = 0.85;  // chosen: two photographs of one chair have 0.85 to 1
constexpr int kLooks = 6;              // chosen: sides from which an object's colours are taken
constexpr int kLook_px = 96;           // chosen: enough pixels for its colours

const Target* TargetOf(const SceneContext& context, const std::string& category, int instance) {
  const auto& targets = context.TargetsOf(category);
  const auto found = std::find_if(targets.begin(), targets.end(), [&](const Target& target) {
    return target.instance == instance && target.is_confirmable && !target.viewpoints_world.empty();
  });
  return found == targets.end() ? nullptr : &*found;
}

}  // namespace

std::optional<StagePicture> PictureTaker::TakeOf(const sim::SceneInstance& instance,
                                                 Rng& rng) const {
  StagePicture taken;
  taken.object_id = instance.id;
  // Whole tenths, so that a file holds the same camera.
  taken.hfov_deg = std::round(rng.Uniform(kLeastHfov_deg, kMostHfov_deg) * 10) / 10;
  taken.camera_height_m = std::round(rng.Uniform(kLeastHeight_m, kMostHeight_m) * 10) / 10;
  sim::ViewRules rules;
  rules.sensor = {kGoalPictureSide_px, kGoalPictureSide_px, taken.hfov_deg, taken.camera_height_m};
  const auto views =
      sim::GoodViews(context_.scene(), context_.navmesh(), context_.caster(), instance, rules);
  if (views.empty()) return std::nullopt;
  taken.taken_from = views[rng.Below(static_cast<std::uint32_t>(views.size()))].pose;
  taken.picture.rgb =
      context_.caster().Render(rules.sensor.Intrinsics(), ViewOf(taken).T_world_camera).rgb;
  return taken;
}

const objects::ColourHistogram& PictureTaker::ColoursOf(const sim::SceneInstance& instance) {
  const auto [entry, is_new] = colours_.emplace(instance.id, objects::ColourHistogram());
  if (!is_new) return entry->second;
  const Target* target = TargetOf(context_, instance.category, instance.id);
  if (target == nullptr) return entry->second;
  const auto& places = target->viewpoints_world;
  const std::size_t step = std::max<std::size_t>(1, places.size() / kLooks);
  const SensorConfig sensor{kLook_px, kLook_px, kMostHfov_deg, kLeastHeight_m};
  for (std::size_t i = 0; i < places.size(); i += step) {
    const Vector3d d = instance.box.Center() - places[i];
    const AgentPose pose{places[i], std::atan2(d.y(), d.x()), 0};
    const sim::Frame frame =
        context_.caster().Render(sensor.Intrinsics(), CameraPose(pose, sensor.camera_height_m));
    MaskImage mask(kLook_px, kLook_px);
    for (std::size_t k = 0; k < mask.data.size(); ++k)
      mask.data[k] = frame.instance.data[k] == instance.id ? 1 : 0;
    entry->second.Add(frame.rgb, mask, {0, 0, kLook_px, kLook_px});
  }
  return entry->second;
}

bool PictureTaker::HasTwin(const sim::SceneInstance& instance) {
  for (const sim::SceneInstance& other : context_.scene().instances) {
    if (other.id == instance.id || other.category != instance.category ||
        other.region != instance.region)
      continue;
    const auto overlap = OverlapOf(ColoursOf(instance), ColoursOf(other));
    if (!overlap || *overlap >= kTwinOverlap) return true;
  }
  return false;
}

std::optional<std::pair<StagePicture, GoalObject>> PictureTaker::Take(const std::string& category,
                                                                      Rng& rng) {
  std::vector<const Target*> targets;
  for (const Target& target : context_.TargetsOf(category))
    if (const Target* usable = TargetOf(context_, category, target.instance))
      targets.push_back(usable);
  rng.Shuffle(targets);
  for (const Target* target : targets) {
    const sim::SceneInstance* instance = context_.scene().FindInstance(target->instance);
    if (instance == nullptr || HasTwin(*instance)) continue;
    auto taken = TakeOf(*instance, rng);
    if (!taken) continue;
    GoalObject object{target->instance,         target->name, category, target->box.Center(),
                      target->viewpoints_world, true};
    return std::pair(std::move(*taken), std::move(object));
  }
  return std::nullopt;
}

}  // namespace crossnav::evaluation
