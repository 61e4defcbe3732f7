// SPDX-License-Identifier: MIT
// A U stair with six winders around a newel as half turn, as in narrow town houses.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/core/check.h"
#include "crossnav/world/stairs/stair_walls.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

constexpr int kWinders = 6;  // chosen: 30 degrees each

/// Sizes in plan, in the block's frame.
struct Plan {
  int first, second;  ///< treads of the flights
  double x1, x2, x3;  ///< inner edge of the first flight, both edges of the second
  double y0, y_turn, y_end, y_exit;
  Vector2d newel;
  double reach_m;  ///< newel to the walls around the turn
};

Plan PlanOf(const StairParams& params) {
  const int treads = params.risers - 1 - kWinders;
  CROSSNAV_CHECK(treads >= 0, "a half turn of winders needs seven risers");
  const double w = params.width_m, t = params.tread_m;
  Plan p{};
  p.first = (treads + 1) / 2;
  p.second = treads - p.first;
  p.x1 = kWall_m + w;
  p.x2 = p.x1 + kGap_m;
  p.x3 = p.x2 + w;
  p.y0 = params.approach_m;
  p.y_turn = p.y0 + p.first * t;
  p.y_exit = p.y_turn - p.second * t;
  p.newel = {0.5 * (p.x1 + p.x2), p.y_turn};
  p.reach_m = w + 0.5 * kGap_m;
  p.y_end = p.y_turn + p.reach_m;
  return p;
}

/// Intersection of the direction with the square around the turn.
Vector2d OnWall(const Plan& p, double angle_rad) {
  const Vector2d d(std::cos(angle_rad), std::sin(angle_rad));
  return p.newel + d * ((p.reach_m + kIntoWall_m) / d.lpNorm<Eigen::Infinity>());
}

/// Winder from angle `hi` down to `lo`, with the square's corner if it lies between.
Tread Winder(const Plan& p, double lo, double hi, double top_m) {
  Tread tread{{p.newel, OnWall(p, lo)}, top_m};
  for (const double corner : {0.25 * std::numbers::pi, 0.75 * std::numbers::pi}) {
    if (corner > lo + 1e-6 && corner < hi - 1e-6) tread.polygon.push_back(OnWall(p, corner));
  }
  tread.polygon.push_back(OnWall(p, hi));
  return tread;
}

void AddTreads(const StairParams& params, const Plan& p, Stair& stair) {
  const double t = params.tread_m, r = stair.riser_m;
  const auto add = [&](double x0, double y0, double x1) {
    const double top_m = static_cast<double>(stair.treads.size() + 1) * r;
    stair.treads.push_back({{{x0, y0}, {x1, y0}, {x1, y0 + t}, {x0, y0 + t}}, top_m});
  };
  for (int i = 0; i < p.first; ++i) add(kIntoWall_m, p.y0 + i * t, p.x1);
  for (int i = 0; i < kWinders; ++i) {
    const double hi = std::numbers::pi * (1 - static_cast<double>(i) / kWinders);
    const double top_m = static_cast<double>(stair.treads.size() + 1) * r;
    stair.treads.push_back(Winder(p, hi - std::numbers::pi / kWinders, hi, top_m));
  }
  for (int i = 0; i < p.second; ++i) add(p.x2, p.y_turn - (i + 1) * t, p.x3 + kIntoWall_m);
}

}  // namespace

StairBlock MakeHalfWinderStair(const StairParams& params) {
  const Plan p = PlanOf(params);
  StairBlock block;
  Stair& stair = block.stair;
  stair.kind = params.kind;
  stair.body = params.body;
  const double r = stair.riser_m = params.rise_m / params.risers;
  AddTreads(params, p, stair);
  const double split_x = p.x2 - 0.03;
  const double y_open = p.y0 + std::min(TreadsUnderCeiling(params), p.first) * params.tread_m;
  stair.voids = {{kWall_m - 0.005, y_open, split_x, p.y_end + 0.005},
                 {split_x, p.y_exit, p.x3 + 0.005, p.y_end + 0.005}};
  stair.arrivals = {{{split_x, p.y_exit}, {p.x3 + 0.005, p.y_exit}}};
  stair.departures = {{{0, p.y0}, {p.x1, p.y0}}};
  stair.footprint = {{kWall_m, p.y0, p.x1, p.y_end}, {p.x1, p.y_exit, p.x3, p.y_end}};
  stair.p_bottom = {0.5 * (kWall_m + p.x1), p.y0 - 0.5, 0};
  stair.p_top = {0.5 * (p.x2 + p.x3), p.y_exit - 0.5, params.rise_m};
  const double top_first = p.first * r, foot_second = (p.first + kWinders + 1) * r;
  stair.railings = {{{p.x1 - 0.03, p.y0 + 0.08, r},
                     {p.x1 - 0.03, p.y_turn - 0.02, std::max(r, top_first)},
                     0.9,
                     params.rail_style},
                    {{p.x2 + 0.03, p.y_turn - 0.02, foot_second},
                     {p.x2 + 0.03, p.y_exit, params.rise_m},
                     0.9,
                     params.rail_style}};
  block.width_m = p.x3 + kWall_m;
  block.depth_m = p.y_end + kWall_m;
  block.entry_x0 = 0;
  block.entry_x1 = p.x1;
  block.exit_x0 = p.x2;
  block.exit_x1 = block.width_m;
  return block;
}

}  // namespace crossnav::world
