// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/graph_trials.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "crossnav/evaluation/running/survey.h"
#include "crossnav/evaluation/trials/true_home.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/world/house/house_gate.h"
#include "crossnav/world/house/house_generator.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::evaluation {
namespace {

using Cells = std::set<std::pair<int, int>>;

constexpr double kSameHeight_m = 0.3;  // chosen: three voxels
constexpr double kLeastIou = 0.5;      // docs/lifelong.md

struct TrueStorey {
  std::vector<int> levels;
};

std::vector<TrueStorey> StoreysOf(const world::HousePlan& plan) {
  std::vector<TrueStorey> storeys;
  double base_m = 0;
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    if (storeys.empty() || plan.levels[i].floor_m - base_m >= kStorey_m) {
      storeys.emplace_back();
      base_m = plan.levels[i].floor_m;
    }
    storeys.back().levels.push_back(static_cast<int>(i));
  }
  return storeys;
}

void AddRect(const world::Rect& rect, double cell_m, Cells& cells) {
  for (int x = static_cast<int>(std::floor(rect.x0 / cell_m)); (x + 0.5) * cell_m < rect.x1; ++x)
    for (int y = static_cast<int>(std::floor(rect.y0 / cell_m)); (y + 0.5) * cell_m < rect.y1; ++y)
      if (rect.Contains({(x + 0.5) * cell_m, (y + 0.5) * cell_m})) cells.emplace(x, y);
}

/// True rooms of one level; rooms of an open group count as one.
std::vector<Cells> RoomsOf(const world::HousePlan& plan, int level, double cell_m) {
  std::map<int, Cells> by_group;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const world::Room& room = plan.rooms[i];
    if (room.level != level || room.type == world::RoomType::kVoid) continue;
    const int group = room.open_group >= 0 ? -1 - room.open_group : static_cast<int>(i);
    for (const world::Rect& rect : room.rects)
      for (const world::Rect& piece : world::Subtract(rect, plan.VoidsOf(level)))
        AddRect(piece, cell_m, by_group[group]);
  }
  std::vector<Cells> rooms;
  for (auto& [group, cells] : by_group)
    if (!cells.empty()) rooms.push_back(std::move(cells));
  return rooms;
}

std::map<int, Cells> FoundRooms(const scenegraph::PlanGrid<int>& plan) {
  std::map<int, Cells> rooms;
  for (std::size_t i = 0; i < plan.cells.size(); ++i)
    if (plan.cells[i] >= 0) rooms[plan.cells[i]].emplace(plan.frame.XOf(i), plan.frame.YOf(i));
  return rooms;
}

double IouOf(const Cells& a, const Cells& b) {
  std::size_t shared = 0;
  for (const auto& cell : a) shared += b.count(cell);
  const auto all = static_cast<double>(a.size() + b.size() - shared);
  return all > 0 ? static_cast<double>(shared) / all : 0;
}

/// The graph's floor at the height of one of the storey's levels, or -1.
int FloorOf(const scenegraph::SceneGraph& graph, const world::HousePlan& plan,
            const TrueStorey& storey) {
  for (const auto& floor : graph.floors)
    for (const int level : storey.levels)
      if (std::abs(floor.height_m - plan.levels[level].floor_m) <= kSameHeight_m) return floor.id;
  return -1;
}

void ScoreRooms(const std::vector<Cells>& truth, std::map<int, Cells> found, GraphScore& score) {
  for (const Cells& room : truth) {
    ++score.rooms;
    const auto hit = std::find_if(found.begin(), found.end(), [&](const auto& entry) {
      return IouOf(entry.second, room) >= kLeastIou;
    });
    if (hit == found.end()) continue;
    ++score.rooms_found;
    found.erase(hit);
  }
  score.rooms_wrong += static_cast<int>(found.size());
}

}  // namespace

GraphScore& GraphScore::operator+=(const GraphScore& other) {
  floors += other.floors, floors_found += other.floors_found, floors_wrong += other.floors_wrong;
  rooms += other.rooms, rooms_found += other.rooms_found, rooms_wrong += other.rooms_wrong;
  return *this;
}

GraphScore ScoreGraph(const scenegraph::SceneGraph& graph, const world::HousePlan& plan) {
  GraphScore score;
  std::set<int> used;
  for (const TrueStorey& storey : StoreysOf(plan)) {
    ++score.floors;
    std::vector<Cells> truth;
    for (const int level : storey.levels)
      for (Cells& room : RoomsOf(plan, level, graph.voxel_m)) truth.push_back(std::move(room));
    const int floor = FloorOf(graph, plan, storey);
    const bool is_found = floor >= 0 && used.insert(floor).second;
    if (is_found) ++score.floors_found;
    ScoreRooms(truth, is_found ? FoundRooms(graph.plans[floor]) : std::map<int, Cells>(), score);
  }
  score.floors_wrong = static_cast<int>(graph.floors.size() - used.size());
  for (const auto& room : graph.rooms) score.rooms_wrong += used.count(room.floor) == 0 ? 1 : 0;
  return score;
}

Result<world::HousePlan> PassedPlan(const world::HouseParams& params, const RunConfig& config,
                                    std::unique_ptr<SceneContext>& context) {
  for (int attempt = 0; attempt < world::AttemptsFor(params); ++attempt) {
    auto plan = world::DrawFurnishedPlan(params, attempt);
    if (!plan) continue;
    auto made = SceneContext::Of(world::BuildHouse(*plan), config);
    if (!made) return tl::unexpected(made.error());
    if (!world::CheckHouse(*plan, (*made)->scene(), (*made)->navmesh())) continue;
    context = std::move(*made);
    return plan;
  }
  return Fail(ErrorCode::kInvalid, "no plan passed the gate; try another seed",
              world::SceneIdOf(params));
}

Result<GraphTrial> TryGraph(std::uint64_t seed, int edition, const RunConfig& config,
                            perception::PerceptionSuite* suite) {
  world::HouseParams params;
  params.seed = seed;
  params.edition = edition;
  params.has_textures = suite != nullptr;
  std::unique_ptr<SceneContext> context;
  const auto plan = PassedPlan(params, config, context);
  if (!plan) return tl::unexpected(plan.error());
  ObjectSurvey objects(*context, config, suite);
  Result<void> looked;
  const auto survey =
      SurveyScene(*context, config, Known::kMap, [&](const Observation& obs, const auto& sim) {
        if (looked) looked = objects.Look(obs, sim);
      });
  if (!survey) return tl::unexpected(survey.error());
  if (!looked) return tl::unexpected(looked.error());
  GraphTrial trial;
  trial.house = plan->id;
  const auto start = std::chrono::steady_clock::now();
  trial.graph = scenegraph::BuildGraph(survey->map, survey->memory, survey->flights);
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  trial.score = ScoreGraph(trial.graph, *plan);
  trial.record_ms = 1e3 * objects.seconds() / std::max(1, objects.views());
  const auto relate = std::chrono::steady_clock::now();
  AddRecords(trial.graph, objects.book().Confirmed());
  RelateObjects(trial.graph);
  trial.relate_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - relate).count();
  trial.objects = ScoreObjects(trial.graph, objects, context->scene(), *plan);
  return trial;
}

}  // namespace crossnav::evaluation
