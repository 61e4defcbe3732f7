// SPDX-License-Identifier: MIT
#include "crossnav/agent/described_goal.h"

#include <algorithm>

#include "crossnav/agent/object_notes.h"
#include "crossnav/agent/state.h"
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

constexpr int kRefresh_steps = 40;  // chosen: a room is looked at in as many

Box3 BoxOf(const std::vector<VoxelKey>& voxels, double voxel_m) {
  Box3 box;
  for (const VoxelKey& key : voxels) {
    const Vector3d p = CenterOf(key, voxel_m);
    box.Add(p.array() - 0.5 * voxel_m);
    box.Add(p.array() + 0.5 * voxel_m);
  }
  return box;
}

language::Thing ThingAt(const World& world, const GoalState& goal,
                        const std::vector<VoxelKey>& voxels, const Vector3d& p_center_world) {
  const DescribedGoal& described = *goal.described;
  language::Thing thing;
  thing.category = described.description.noun;
  thing.p_center_world = p_center_world;
  thing.box = BoxOf(voxels, world.map.config().voxel_m);
  if (const auto index = RecordAt(world, thing.category, p_center_world)) {
    const objects::ObjectRecord& record = world.objects.records()[*index];
    if (record.colour)
      thing.colour = language::SurfaceColourOf(
          {(*record.colour)[0], (*record.colour)[1], (*record.colour)[2]});
    thing.box = {record.box_world_m.min(), record.box_world_m.max()};
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
  if (!goal.instances.takes_guesses) return std::min(fit, Fit::kMaybe);
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
                            config.query, memory::ThresholdsOf(described.encoder_name));
  described.home = language::HomeOf(graph, world.objects.Confirmed());
  described.home.p_robot_world = described.p_start_world;
  described.home.may_have_more_floors |= described.home.floors.size() < 2;
  described.home.may_have_more_floors &= !goal->instances.takes_guesses;
  described.home_step = world.step;
  described.graph = std::make_shared<const scenegraph::SceneGraph>(std::move(graph));
}

void KeepHomeFresh(const World& world, const Config& config, const AgentPose& agent,
                   GoalState* goal) {
  if (!goal->described) return;
  DescribedGoal& described = *goal->described;
  if (!described.p_start_world) described.p_start_world = agent.p_world;
  if (goal->live.all().empty()) return;
  if (described.home_step < 0 || world.step - described.home_step >= kRefresh_steps)
    LookAtHome(world, config, goal);
}

Fit FitOfDescription(const World& world, const GoalState& goal, const std::vector<VoxelKey>& voxels,
                     const Vector3d& p_center_world) {
  return FitOf(goal, ThingAt(world, goal, voxels, p_center_world));
}

}  // namespace crossnav::agent
