// SPDX-License-Identifier: MIT
#include "crossnav/agent/described_goal.h"

#include <algorithm>

#include "crossnav/agent/decision.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/language/parse_description.h"
#include "crossnav/language/question.h"
#include "crossnav/language/resolve.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/scenegraph/find_objects.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using language::Fit;

namespace {

constexpr int kRefresh_steps = 40;     // chosen: a room is looked at in as many
constexpr double kSameObject_m = 0.5;  // chosen: of a record and a POI that show one thing

Box3 BoxOf(const std::vector<VoxelKey>& voxels, double voxel_m) {
  Box3 box;
  for (const VoxelKey& key : voxels) {
    const Vector3d p = CenterOf(key, voxel_m);
    box.Add(p.array() - 0.5 * voxel_m);
    box.Add(p.array() + 0.5 * voxel_m);
  }
  return box;
}

/// The record of what stands at a point.
const objects::ObjectRecord* RecordAt(const World& world, const std::string& category,
                                      const Vector3d& p_world) {
  const objects::ObjectRecord* nearest = nullptr;
  double least_m = kSameObject_m;
  for (const objects::ObjectRecord& record : world.objects.records()) {
    const double away_m = (record.centre_world_m - p_world).norm();
    if (record.category != category || away_m > least_m) continue;
    least_m = away_m;
    nearest = &record;
  }
  return nearest;
}

language::Thing ThingAt(const World& world, const GoalState& goal,
                        const std::vector<VoxelKey>& voxels, const Vector3d& p_center_world) {
  const DescribedGoal& described = *goal.described;
  language::Thing thing;
  thing.category = described.description.noun;
  thing.p_center_world = p_center_world;
  thing.box = BoxOf(voxels, world.map.config().voxel_m);
  if (const auto* record = RecordAt(world, thing.category, p_center_world)) {
    if (record->colour)
      thing.colour = language::SurfaceColourOf(
          {(*record->colour)[0], (*record->colour)[1], (*record->colour)[2]});
    thing.box = {record->box_world_m.min(), record->box_world_m.max()};
  }
  thing.floor = FloorOf(described.home, p_center_world);
  if (thing.floor && described.graph)
    thing.room = scenegraph::RoomAt(*described.graph, *thing.floor, p_center_world);
  return thing;
}

/// Order and size say something of all that are known: maybe, until everything was seen.
Fit FitOf(const GoalState& goal, const language::Thing& thing) {
  const DescribedGoal& described = *goal.described;
  const language::Description& d = described.description;
  const Fit fit = language::FitOf(d, described.home, thing);
  if (fit == Fit::kNo || (d.order == 0 && !d.size)) return fit;
  if (!described.takes_guesses) return std::min(fit, Fit::kMaybe);
  for (const int i : Resolve(d, described.home).things)
    if ((described.home.things[i].p_center_world - thing.p_center_world).norm() <= kSameObject_m)
      return fit;
  return Fit::kNo;
}

}  // namespace

Result<std::optional<DescribedGoal>> DescribedGoalOf(const std::string& text,
                                                     perception::DenseEncoder& encoder) {
  if (!language::IsDescription(text)) return std::optional<DescribedGoal>();
  auto description = language::ParseDescription(text);
  if (!description) return tl::unexpected(description.error());
  DescribedGoal goal;
  goal.encoder_name = encoder.Name();
  for (const std::string& name : NamesFor(*description)) {
    const bool is_subject = language::IsKindOf(name, description->noun);
    const bool is_needed = description->room || !description->relations.empty();
    if (!is_subject && !is_needed) continue;
    if (auto vector = encoder.EncodeText(name)) goal.names.push_back({name, std::move(*vector)});
  }
  goal.category = description->noun;
  for (const std::string_view category : kCategories)
    if (SpacedName(category) == description->noun) goal.category = category;
  goal.description = std::move(*description);
  return std::optional<DescribedGoal>(std::move(goal));
}

void LookAtHome(const World& world, const Config& config, GoalState* goal) {
  if (!goal->described) return;
  DescribedGoal& described = *goal->described;
  auto graph = scenegraph::BuildGraph(world.map, world.memory, world.flights);
  for (const policy::NamedText& name : described.names)
    scenegraph::FindObjects(graph, world.memory, {name.name, name.vector, goal->background},
                            config.query, memory::PresentFrom(described.encoder_name));
  described.home = language::HomeOf(graph, world.objects.Confirmed());
  described.home.p_robot_world = described.p_start_world;
  described.home.may_have_more_floors |= described.home.floors.size() < 2;
  described.home.may_have_more_floors &= !described.takes_guesses;
  described.home_step = world.step;
  described.graph = std::make_shared<const scenegraph::SceneGraph>(std::move(graph));
}

std::vector<HistoryPoi> FittingPlaces(std::vector<HistoryPoi> places, const World& world,
                                      const GoalState& goal) {
  const auto fit_of = [&](const HistoryPoi& place) {
    return FitOf(goal, ThingAt(world, goal, place.voxels, place.p_center_world));
  };
  std::erase_if(places, [&](const HistoryPoi& place) { return fit_of(place) == Fit::kNo; });
  std::stable_sort(places.begin(), places.end(),
                   [&](const HistoryPoi& a, const HistoryPoi& b) { return fit_of(a) > fit_of(b); });
  return places;
}

void JudgeInstances(StepState& now) {
  GoalState& goal = now.goal;
  if (!goal.described) return;
  DescribedGoal& described = *goal.described;
  if (!described.p_start_world) described.p_start_world = now.agent.p_world;
  if (goal.live.all().empty()) return;
  if (described.home_step < 0 || now.world.step - described.home_step >= kRefresh_steps)
    LookAtHome(now.world, now.config, &goal);
  for (const policy::LivePoi& poi : std::vector<policy::LivePoi>(goal.live.all())) {
    const Fit fit = FitOf(goal, ThingAt(now.world, goal, poi.voxels, poi.p_center_world));
    const bool fits = fit == Fit::kYes || (fit == Fit::kMaybe && described.takes_guesses);
    if (fits && described.set_aside.erase(poi.id) > 0) {
      goal.live.Forgive(poi.id);
      goal.events.push_back("an object set aside fits the description now");
    } else if (!fits && !poi.is_discarded && described.set_aside.insert(poi.id).second) {
      goal.live.Discard(poi.id);
      goal.events.push_back(fit == Fit::kNo ? "not the one that was described"
                                            : "perhaps the one that was described: later");
    }
  }
}

bool TakeGuesses(StepState& now) {
  if (!now.goal.described || now.goal.described->takes_guesses) return false;
  now.goal.described->takes_guesses = true;
  LookAtHome(now.world, now.config, &now.goal);
  now.goal.events.push_back("nothing left: what may fit the description will do");
  return true;
}

}  // namespace crossnav::agent
