// SPDX-License-Identifier: MIT
#include "crossnav/agent/search_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::SearchPatch;

namespace {

constexpr double kUnasked = 0.3;    // chosen: chance that the memory misses a thing that was seen
constexpr double kMargin_m = 0.3;   // chosen: views end that much before the range
constexpr double kEdge_deg = 5;     // chosen: at each side of the picture
constexpr int kViewGrid_shift = 3;  // chosen: one view in 8 x 8 columns

Vector3d EyeAt(const Situation& now, const VoxelKey& place) {
  return FootOf(place, now.config.map.voxel_m) + Vector3d(0, 0, now.config.sensor.camera_height_m);
}

/// The point of a patch that shows the goal.
Vector3d PointOf(const SearchPatch& patch, const ObjectSearch& search) {
  return search.is_tall ? patch.HighPoint() : patch.LowPoint();
}

/// Chance that the goal stands at the patch and was not noticed, given that it stands there.
double UnnoticedAt(const SearchPatch& patch, const ObjectSearch& search) {
  const policy::Looked& looked = search.is_tall ? patch.high : patch.low;
  const double looked_for_m = search.was_noticed ? looked.in_run_m : looked.for_goal_m;
  if (looked_for_m <= search.sure_range_m) return 0;
  if (looked_for_m <= search.notice_range_m) return search.missed;
  return looked.in_run_m <= search.notice_range_m ? kUnasked : 1;
}

std::set<VoxelKey> AllPatches(const Situation& now) {
  std::set<VoxelKey> cells;
  for (const auto& [cell, patch] : now.world.full.field.patches()) cells.insert(cell);
  return cells;
}

/// Removes the patches that `place` shows.
void EraseSeenFrom(const Situation& now, const VoxelKey& place, const ObjectSearch& goal,
                   std::set<VoxelKey>* cells) {
  const double range_m = goal.notice_range_m;
  const Vector3d p_eye = EyeAt(now, place);
  std::erase_if(*cells, [&](const VoxelKey& cell) {
    const Vector3d p_world = PointOf(now.world.full.field.patches().at(cell), goal);
    return (p_world - p_eye).squaredNorm() <= range_m * range_m &&
           now.world.map.HasLineOfSight(p_eye, p_world);
  });
}

}  // namespace

double Unnoticed(const policy::SearchField& field, const VoxelKey& cell, const SearchPatch& patch,
                 const ObjectSearch& search) {
  if (search.settled.contains(cell)) return 0;
  const double here = UnnoticedAt(patch, search);
  if (!search.is_wide || here == 0) return here;
  constexpr std::size_t kBeside = 4;  // chosen: more than one side of the eight around it
  std::vector<double> beside;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const auto it = field.patches().find({cell.x + dx, cell.y + dy, cell.z});
      if ((dx == 0 && dy == 0) || it == field.patches().end()) continue;
      beside.push_back(UnnoticedAt(it->second, search));
    }
  if (beside.size() < kBeside) return here;
  std::nth_element(beside.begin(), beside.begin() + kBeside - 1, beside.end());
  return std::min(here, beside[kBeside - 1]);
}

VoxelKey ViewCellOf(const VoxelKey& place) {
  return {place.x >> kViewGrid_shift, place.y >> kViewGrid_shift, place.z >> kViewGrid_shift};
}

std::set<VoxelKey> PatchesOutOfSight(const Situation& now, const ObjectSearch& goal) {
  std::set<VoxelKey> hidden = AllPatches(now), asked;
  for (const auto& [cell, patch] : now.world.full.field.patches())
    if (const auto place = now.world.ground.StandingAt(patch.p_world))
      if (asked.insert(ViewCellOf(*place)).second) EraseSeenFrom(now, *place, goal, &hidden);
  return hidden;
}

std::set<VoxelKey> PatchesOutOfReach(const Situation& now, const VoxelKey& start,
                                     const ObjectSearch& goal) {
  std::set<VoxelKey> hidden = AllPatches(now), asked;
  planner::GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  while (const auto place = search.Next())
    if (asked.insert(ViewCellOf(*place)).second) EraseSeenFrom(now, *place, goal, &hidden);
  return hidden;
}

SearchViews::SearchViews(const Situation& now) : now_(now) {
  const ObjectSearch& search = *now.goal.full.search;
  for (const auto& [cell, patch] : now.world.full.field.patches()) {
    const auto it = search.shares.find(cell);
    if (it == search.shares.end()) continue;
    const double gain = it->second * Unnoticed(now.world.full.field, cell, patch, search);
    if (gain > 0) open_.push_back({cell, PointOf(patch, search), gain});
  }
  range_m_ = search.notice_range_m - kMargin_m;
  const auto& camera = now.obs.camera;
  half_width_rad_ = DegToRad(now.config.sensor.hfov_deg / 2 - kEdge_deg);
  half_height_rad_ = std::atan(0.5 * camera.height_px / camera.fy) - DegToRad(kEdge_deg);
}

double SearchViews::Bound(const VoxelKey& place) const {
  const Vector3d p_eye = EyeAt(now_, place);
  double gain = 0;
  for (const Open& open : open_) gain += IsInRange(p_eye, open.p_world) ? open.gain : 0;
  return gain;
}

std::optional<SearchView> SearchViews::From(const VoxelKey& place, double path_m,
                                            double arrival_rad) const {
  const std::vector<Seen> seen = SeenFrom(place);
  const auto& action = now_.config.action;
  const double turn_rad = DegToRad(action.turn_deg);
  const double travel_rad = DegToRad(now_.config.policy.motion.travel_pitch_deg);
  const int turns_around = static_cast<int>(std::lround(2 * M_PI / turn_rad));
  const double start_m = now_.config.policy.explore.start_m;
  std::optional<SearchView> best;
  for (const double pitch_rad : {travel_rad, 0.0})
    for (int i = 0; i < turns_around; ++i) {
      SearchView view;
      // The agent turns by whole steps.
      view.heading_rad = WrapAngle(now_.agent.yaw_rad + i * turn_rad);
      view.pitch_rad = pitch_rad;
      // There and back.
      const double pitches = 2 * std::abs(pitch_rad - travel_rad) / DegToRad(action.pitch_deg);
      const double turns = std::abs(WrapAngle(view.heading_rad - arrival_rad)) / turn_rad;
      view.cost_m = path_m + action.forward_m * (turns + pitches);
      for (const Seen& patch : seen)
        if (std::abs(WrapAngle(patch.bearing_rad - view.heading_rad)) <= half_width_rad_ &&
            std::abs(patch.elevation_rad - pitch_rad) <= half_height_rad_) {
          view.gain += patch.open->gain;
          view.cells.push_back(patch.open->cell);
        }
      if (view.gain < kLeastGain) continue;
      if (!best || (view.cost_m + start_m) / view.gain < (best->cost_m + start_m) / best->gain)
        best = std::move(view);
    }
  return best;
}

std::vector<SearchViews::Seen> SearchViews::SeenFrom(const VoxelKey& place) const {
  const Vector3d p_eye = EyeAt(now_, place);
  std::vector<Seen> seen;
  for (const Open& open : open_) {
    if (!IsInRange(p_eye, open.p_world) || !now_.world.map.HasLineOfSight(p_eye, open.p_world))
      continue;
    const Vector3d d = open.p_world - p_eye;
    seen.push_back({&open, std::atan2(d.y(), d.x()), std::atan2(d.z(), d.head<2>().norm())});
  }
  return seen;
}

bool SearchViews::IsInRange(const Vector3d& p_eye, const Vector3d& p_world) const {
  return (p_world - p_eye).squaredNorm() <= range_m_ * range_m_;
}

}  // namespace crossnav::agent
