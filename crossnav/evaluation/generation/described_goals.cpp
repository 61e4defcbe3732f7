// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/generation/described_goals.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "crossnav/core/category_table.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/generation/goal_pictures.h"
#include "crossnav/evaluation/generation/word_drawing.h"
#include "crossnav/language/resolve.h"
#include "crossnav/language/vocabulary.h"
#include "crossnav/perception/goal_picture.h"

namespace crossnav::evaluation {
namespace {

constexpr int kDescriptions = 40;  // chosen: descriptions of a category to choose from

/// A scene as language knows homes: rooms are its regions, of the types that their things tell.
struct SceneHome {
  language::KnownHome home;
  std::vector<int> instances;  ///< id of each thing
};

SceneHome HomeOf(const SceneContext& context) {
  SceneHome scene;
  for (const sim::Floor& floor : context.navmesh().Floors())
    scene.home.floors.push_back({floor.height_m});
  std::map<int, int> rooms;  // by region
  for (const sim::SceneInstance& instance : context.scene().instances) {
    language::Thing thing;
    thing.category = CanonicalName(instance.category.empty() ? instance.name : instance.category);
    if (!language::ThingWords().contains(thing.category) || instance.box.empty()) continue;
    thing.box = instance.box;
    thing.p_center_world = instance.box.Center();
    thing.confidence = 1;
    thing.is_certain = true;
    thing.floor = FloorOf(scene.home, thing.p_center_world);
    const auto [room, is_new] =
        rooms.emplace(instance.region, static_cast<int>(scene.home.rooms.size()));
    if (is_new) {
      scene.home.rooms.emplace_back();
      scene.home.rooms.back().floor = thing.floor.value_or(0);
      scene.home.rooms.back().looked_at = 1;
    }
    thing.room = room->second;
    scene.home.things.push_back(std::move(thing));
    scene.instances.push_back(instance.id);
  }
  TellRooms(scene.home);
  return scene;
}

const Target* TargetWith(const std::vector<Target>& targets, int instance) {
  const auto found = std::find_if(targets.begin(), targets.end(), [&](const Target& target) {
    return target.instance == instance && target.is_confirmable && !target.viewpoints_world.empty();
  });
  return found == targets.end() ? nullptr : &*found;
}

/// A description of one of the category's objects, and the object; empty where none can be drawn.
std::optional<std::pair<std::string, GoalObject>> Describe(const SceneContext& context,
                                                           const SceneHome& scene,
                                                           const std::string& category, Rng& rng) {
  const auto drawn =
      DrawWords(scene.home, WordKind::kClear, kDescriptions, {SpacedName(category)}, rng);
  std::vector<std::pair<std::string, GoalObject>> described;
  for (const DrawnWords& words : drawn) {
    const Target* target = TargetWith(context.TargetsOf(category), scene.instances[words.thing]);
    if (target == nullptr || words.description.order != 0) continue;
    described.emplace_back(TextOf(words.description),
                           GoalObject{target->instance, target->name, category,
                                      target->box.Center(), target->viewpoints_world, true});
  }
  if (described.empty()) return std::nullopt;
  return described[rng.Below(static_cast<std::uint32_t>(described.size()))];
}

}  // namespace

Result<MixedGoals> MixGoals(SceneContext& context, const std::string& scene_id, const GoalMix& mix,
                            std::uint64_t seed, EpisodeFile& file) {
  const std::string prefix = std::filesystem::path(scene_id).filename().string() + "_";
  const SceneHome scene = HomeOf(context);
  PictureTaker taker(context);
  Rng rng(MixSeed(seed, HashString(scene_id)));
  MixedGoals count;
  for (Episode& episode : file.episodes) {
    if (episode.scene_id != scene_id) continue;
    Episode changed = episode;
    std::map<std::string, std::vector<GoalObject>> objects;
    for (std::string& goal : changed.goals) {
      const double kind = rng.Uniform();
      if (kind < mix.descriptions) {
        auto described = Describe(context, scene, goal, rng);
        if (!described) continue;
        goal = described->first;
        objects[prefix + goal] = {std::move(described->second)};
      } else if (kind < mix.descriptions + mix.pictures) {
        auto taken = taker.Take(goal, rng);
        if (!taken) continue;
        goal = perception::NameOfPicture(taken->first.picture);
        objects[prefix + goal] = {std::move(taken->second)};
        changed.pictures[goal] = std::make_shared<const StagePicture>(std::move(taken->first));
      }
    }
    if (objects.empty()) continue;
    context.UseInstanceGoals(objects, scene_id);
    if (!CheckPlayable(context, changed)) continue;
    Certify(context, changed);
    changed.episode_id = ContentId(changed);
    count.pictures += static_cast<int>(changed.pictures.size());
    count.descriptions += static_cast<int>(objects.size() - changed.pictures.size());
    file.goals_by_category.merge(objects);
    episode = std::move(changed);
  }
  return count;
}

}  // namespace crossnav::evaluation
