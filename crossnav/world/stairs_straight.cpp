// SPDX-License-Identifier: MIT
// One straight flight.
#include "crossnav/world/stairs.h"

namespace crossnav::world {
namespace {

constexpr double kHeadroom_m = 2.0;  // chosen: the building codes' usual clear height over stairs

}  // namespace

Stair MakeStraightStair(const StairParams& params) {
  Stair stair;
  stair.kind = params.kind;
  stair.body = params.body;
  stair.riser_m = params.rise_m / params.risers;
  const int treads = params.risers - 1;  // the upper floor is the last step
  const double run_m = treads * params.tread_m, half = 0.5 * params.width_m;
  for (int i = 0; i < treads; ++i) {
    const double x0 = i * params.tread_m, x1 = x0 + params.tread_m;
    stair.treads.push_back(
        {{{x0, -half}, {x1, -half}, {x1, half}, {x0, half}}, (i + 1) * stair.riser_m});
  }
  // The opening starts where the treads leave less than the headroom below the ceiling.
  const double ceiling_m = params.rise_m - params.slab_m;
  int first_open = 0;
  while (first_open < treads && ceiling_m - (first_open + 1) * stair.riser_m >= kHeadroom_m) {
    ++first_open;
  }
  const double void_x0 = first_open * params.tread_m;
  const double left = half + (params.rail_left ? 0.03 : 0.005);
  const double right = -half - (params.rail_right ? 0.03 : 0.005);
  stair.voids = {{void_x0, right, run_m, left}};
  stair.footprint = {{0, -half, run_m, half}};
  stair.p_bottom = {-0.5, 0, 0};
  stair.p_top = {run_m + 0.5, 0, params.rise_m};
  const auto flight = [&](double y) {
    stair.railings.push_back(
        {{0.1, y, stair.riser_m}, {run_m, y, params.rise_m}, 0.9, params.rail_style});
  };
  const auto around = [&](double xa, double ya, double xb, double yb) {
    stair.railings.push_back(
        {{xa, ya, params.rise_m}, {xb, yb, params.rise_m}, 0.95, params.rail_style});
  };
  if (params.rail_left) {
    flight(half - 0.03);
    around(run_m, left + 0.03, void_x0 - 0.03, left + 0.03);
  }
  if (params.rail_right) {
    flight(-half + 0.03);
    around(run_m, right - 0.03, void_x0 - 0.03, right - 0.03);
  }
  around(void_x0 - 0.03, right - 0.03, void_x0 - 0.03, left + 0.03);
  return stair;
}

}  // namespace crossnav::world
