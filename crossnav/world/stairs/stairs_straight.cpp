// SPDX-License-Identifier: MIT
// Straight flights: single, with a landing, two side by side, and the few steps of a split level.
#include "crossnav/world/stairs/stair_walls.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

constexpr double kLanding_m = 0.95;  // chosen: a landing about as long as the flight is wide
constexpr double kZone_m = 1.1;      // chosen: free ground before and after a flight

std::vector<Vector2d> Strip(double x0, double x1, double half) {
  return {{x0, -half}, {x1, -half}, {x1, half}, {x0, half}};
}

}  // namespace

Stair MakeStraightStair(const StairParams& params, int landing_after) {
  Stair stair;
  stair.kind = params.kind;
  stair.body = params.body;
  stair.riser_m = params.rise_m / params.risers;
  const int treads = params.risers - 1;  // the upper floor is the last step
  const double half = 0.5 * params.width_m;
  const int under_ceiling = TreadsUnderCeiling(params);
  const double landing_m = params.landing_m > 0 ? params.landing_m : kLanding_m;
  double x = 0, void_x0 = 0;
  for (int i = 0; i < treads; ++i) {
    if (i == under_ceiling) void_x0 = x;
    const double run_m = i + 1 == landing_after ? landing_m : params.tread_m;
    stair.treads.push_back({Strip(x, x + run_m, half), (i + 1) * stair.riser_m});
    x += run_m;
  }
  const double left = half + (params.has_left_rail ? 0.03 : 0.005);
  const double right = -half - (params.has_right_rail ? 0.03 : 0.005);
  stair.voids = {{void_x0, right, x, left}};
  stair.footprint = {{0, -half, x, half}};
  stair.p_bottom = {-0.5, 0, 0};
  stair.p_top = {x + 0.5, 0, params.rise_m};
  stair.departures = {{{0, -half}, {0, half}}};
  stair.arrivals = {{{x, right}, {x, left}}};
  const auto rail = [&](double y) {  // one piece per slope, so that it follows a landing
    double z = stair.riser_m, x0 = 0.08;
    for (int i = 0; i < treads; ++i) {
      const bool is_landing = i + 1 == landing_after, is_last = i + 1 == treads;
      if (!is_landing && !is_last && i + 2 != landing_after) continue;
      const double x1 = stair.treads[static_cast<std::size_t>(i)].polygon[1].x();
      const double z1 = is_last ? params.rise_m : stair.treads[static_cast<std::size_t>(i)].top_m;
      stair.railings.push_back({{x0, y, is_landing ? z1 : z}, {x1, y, z1}, 0.9, params.rail_style});
      x0 = x1;
      z = z1;
    }
  };
  if (params.has_left_rail) rail(half - 0.03);
  if (params.has_right_rail) rail(-half + 0.03);
  return stair;
}

Stair MakeSteps(double rise_m, int risers, double tread_m, double width_m) {
  StairParams params;
  params.kind = StairKind::kSplitLevel;
  params.rise_m = rise_m;
  params.risers = risers;
  params.tread_m = tread_m;
  params.width_m = width_m;
  params.has_right_rail = false;
  Stair stair = MakeStraightStair(params);
  stair.voids.clear();
  return stair;
}

namespace {

/// The flight runs along the corridor; its right side (seen when climbing) faces the corridor.
StairBlock AlongCorridor(const StairParams& params, int landing_after) {
  StairBlock block;
  Stair one = MakeStraightStair(params, landing_after);
  const double run_m = one.footprint[0].x1;
  const double edge_m = params.has_right_rail ? 0.06 : kWall_m;  // room for the railing
  block.stair = Moved(std::move(one), {kZone_m, edge_m + 0.5 * params.width_m, 0}, 0);
  block.width_m = run_m + 2 * kZone_m;
  block.depth_m = edge_m + params.width_m + kWall_m;
  block.entry_x0 = 0;
  block.entry_x1 = kZone_m;
  block.exit_x0 = kZone_m + run_m;
  block.exit_x1 = block.width_m;
  return block;
}

StairBlock TwoFlights(const StairParams& params) {
  StairBlock block = AlongCorridor(params, 0);
  StairParams second = params;
  second.has_left_rail = false;
  second.has_right_rail = true;
  const double y = block.depth_m + 0.5 * params.width_m + 0.02;
  const Stair other = Moved(MakeStraightStair(second), {kZone_m, y, 0}, 0);
  Stair& all = block.stair;
  all.treads.insert(all.treads.end(), other.treads.begin(), other.treads.end());
  all.railings.insert(all.railings.end(), other.railings.begin(), other.railings.end());
  all.footprint.insert(all.footprint.end(), other.footprint.begin(), other.footprint.end());
  all.arrivals.insert(all.arrivals.end(), other.arrivals.begin(), other.arrivals.end());
  all.departures.insert(all.departures.end(), other.departures.begin(), other.departures.end());
  // One opening over both: a strip between them would be a walkable ledge.
  all.voids = {{all.voids[0].x0, all.voids[0].y0, all.voids[0].x1, other.voids[0].y1}};
  all.arrivals = {{{all.voids[0].x1, all.voids[0].y0}, {all.voids[0].x1, all.voids[0].y1}}};
  all.departures = {{{kZone_m, all.voids[0].y0}, {kZone_m, all.voids[0].y1}}};
  block.depth_m = y + 0.5 * params.width_m + kWall_m;
  return block;
}

}  // namespace

StairBlock MakeStairBlock(const StairParams& params) {
  switch (params.kind) {
    case StairKind::kStraightLanding:
      return AlongCorridor(params, params.risers / 2);
    case StairKind::kL:
    case StairKind::kWinder:
      return MakeLStair(params);
    case StairKind::kU:
      return MakeUStair(params);
    case StairKind::kHalfWinder:
      return MakeHalfWinderStair(params);
    case StairKind::kSpiral:
      return MakeSpiralStair(params);
    case StairKind::kDouble:
      return TwoFlights(params);
    default:
      return AlongCorridor(params, 0);
  }
}

}  // namespace crossnav::world
