// SPDX-License-Identifier: MIT
// Stairs that turn: U with a half landing, L with a quarter landing or winders, spiral.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/world/stairs/stair_walls.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

constexpr double kExitZone_m = 1.0;  // chosen

std::vector<Vector2d> Quad(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Stair Empty(const StairParams& params) {
  Stair stair;
  stair.kind = params.kind;
  stair.body = params.body;
  stair.riser_m = params.rise_m / params.risers;
  return stair;
}

}  // namespace

StairBlock MakeUStair(const StairParams& params) {
  StairBlock block;
  Stair& stair = block.stair = Empty(params);
  const double w = params.width_m, t = params.tread_m, r = stair.riser_m;
  const int first = (params.risers + 1) / 2, second = params.risers - first;  // risers per flight
  const double x1 = kWall_m + w, x2 = x1 + kGap_m, x3 = x2 + w;
  const double y0 = params.approach_m, y_landing = y0 + (first - 1) * t;
  const double y_exit = y_landing - (second - 1) * t,
               y_end = y_landing + (params.landing_m > 0 ? params.landing_m : std::max(w, 0.9));
  for (int i = 0; i + 1 < first; ++i) {
    stair.treads.push_back({Quad(kIntoWall_m, y0 + i * t, x1, y0 + (i + 1) * t), (i + 1) * r});
  }
  stair.treads.push_back(
      {Quad(kIntoWall_m, y_landing, x3 + kIntoWall_m, y_end + kIntoWall_m), first * r});
  for (int i = 0; i + 1 < second; ++i) {
    stair.treads.push_back({Quad(x2, y_landing - (i + 1) * t, x3 + kIntoWall_m, y_landing - i * t),
                            (first + i + 1) * r});
  }
  const double y_open = y0 + std::min(TreadsUnderCeiling(params), first - 1) * t;
  const double split_x = x2 - 0.03;
  stair.voids = {{kWall_m - 0.005, y_open, split_x, y_end + 0.005},
                 {split_x, y_exit, x3 + 0.005, y_end + 0.005}};
  stair.arrivals = {{{split_x, y_exit}, {x3 + 0.005, y_exit}}};
  stair.departures = {{{0, y0}, {x1, y0}}};
  stair.footprint = {{kWall_m, y0, x1, y_end}, {x1, y_exit, x3, y_end}};
  stair.p_bottom = {0.5 * (kWall_m + x1), y0 - 0.5, 0};
  stair.p_top = {0.5 * (x2 + x3), y_exit - 0.5, params.rise_m};
  stair.railings = {
      {{x1 - 0.03, y0 + 0.08, r}, {x1 - 0.03, y_landing, first * r}, 0.9, params.rail_style},
      {{x2 + 0.03, y_landing, (first + 1) * r},
       {x2 + 0.03, y_exit, params.rise_m},
       0.9,
       params.rail_style}};
  block.width_m = x3 + kWall_m;
  block.depth_m = y_end + kWall_m;
  block.entry_x0 = 0;
  block.entry_x1 = x1;
  block.exit_x0 = x2;
  block.exit_x1 = block.width_m;
  return block;
}

StairBlock MakeLStair(const StairParams& params) {
  StairBlock block;
  Stair& stair = block.stair = Empty(params);
  const bool has_winders = params.kind == StairKind::kWinder;
  const double w = params.width_m, t = params.tread_m, r = stair.riser_m;
  const int corner = has_winders ? 3 : 1;
  const int first = std::max(2, (params.risers - corner) / 3);  // treads of the short flight
  const int second = params.risers - 1 - first - corner;
  const double x1 = kWall_m + w, y0 = params.approach_m, y1 = y0 + first * t, y2 = y1 + w;
  const double x_end = x1 + second * t;
  for (int i = 0; i < first; ++i) {
    stair.treads.push_back({Quad(kIntoWall_m, y0 + i * t, x1, y0 + (i + 1) * t), (i + 1) * r});
  }
  if (has_winders) {
    const double reach = (w + kWall_m - kIntoWall_m), s = reach * std::tan(std::numbers::pi / 6);
    const Vector2d c(x1, y1);
    const double xl = x1 - reach, yt = y1 + reach;
    stair.treads.push_back({{c, {xl, y1 + s}, {xl, y1}}, (first + 1) * r});
    stair.treads.push_back({{c, {x1 - s, yt}, {xl, yt}, {xl, y1 + s}}, (first + 2) * r});
    stair.treads.push_back({{c, {x1, yt}, {x1 - s, yt}}, (first + 3) * r});
  } else {
    stair.treads.push_back({Quad(kIntoWall_m, y1, x1, y2 + kIntoWall_m), (first + 1) * r});
  }
  for (int i = 0; i < second; ++i) {
    stair.treads.push_back(
        {Quad(x1 + i * t, y1, x1 + (i + 1) * t, y2 + kIntoWall_m), (first + corner + i + 1) * r});
  }
  const double y_open = y0 + std::min(TreadsUnderCeiling(params), first) * t;
  stair.voids = {{kWall_m - 0.005, y_open, x1 + 0.03, y2 + 0.005},
                 {x1 + 0.03, y1 - 0.03, x_end, y2 + 0.005}};
  stair.arrivals = {{{x_end, y1 - 0.03}, {x_end, y2 + 0.005}}};
  stair.departures = {{{0, y0}, {x1, y0}}};
  stair.footprint = {{kWall_m, y0, x1, y2}, {x1, y1, x_end, y2}};
  stair.p_bottom = {0.5 * (kWall_m + x1), y0 - 0.5, 0};
  stair.p_top = {x_end + 0.5, 0.5 * (y1 + y2), params.rise_m};
  stair.railings = {
      {{x1 - 0.03, y0 + 0.08, r}, {x1 - 0.03, y1 - 0.05, first * r}, 0.9, params.rail_style},
      {{x1 + 0.1, y1 + 0.03, (first + corner + 1) * r},
       {x_end, y1 + 0.03, params.rise_m},
       0.9,
       params.rail_style}};
  block.width_m = x_end + kExitZone_m + kWall_m;
  block.depth_m = y2 + kWall_m;
  block.entry_x0 = 0;
  block.entry_x1 = x1;
  block.exit_x0 = x_end;
  block.exit_x1 = block.width_m;
  return block;
}

StairBlock MakeSpiralStair(const StairParams& params) {
  StairBlock block;
  Stair& stair = block.stair = Empty(params);
  stair.body = StairBody::kOpenRisers;
  constexpr double kPole_m = 0.08;
  // Counter-clockwise from just right of the corridor side to just left of it; the sector between
  // is the landing above and the entry below.
  constexpr double kSector = std::numbers::pi / 3;
  const double radius = params.width_m + kPole_m, first = -std::numbers::pi / 2 + kSector / 2;
  const int treads = params.risers - 1;
  const double step = (2 * std::numbers::pi - kSector) / treads;
  const Vector2d c(radius + kWall_m + 0.03, radius + params.approach_m);
  const auto at = [&](double radius_m, double angle) -> Vector2d {
    return c + radius_m * Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < treads; ++i) {
    const double a = first + i * step, b = a + step;
    stair.treads.push_back(
        {{at(kPole_m, a), at(radius, a), at(radius, 0.5 * (a + b)), at(radius, b), at(kPole_m, b)},
         (i + 1) * stair.riser_m});
    stair.railings.push_back(
        {Vector3d(at(radius - 0.03, a).x(), at(radius - 0.03, a).y(), (i + 0.5) * stair.riser_m),
         Vector3d(at(radius - 0.03, b).x(), at(radius - 0.03, b).y(), (i + 1.5) * stair.riser_m),
         0.9, params.rail_style});
  }
  // The landing: the open sector at the height of the upper floor, out to the edge of the void.
  const double y_edge = c.y() - radius - 0.03;
  const double reach = (c.y() - y_edge) * std::tan(kSector / 2);
  stair.treads.push_back({{c, {c.x() - reach, y_edge}, {c.x() + reach, y_edge}}, params.rise_m});
  Tread pole;
  for (int k = 0; k < 8; ++k) pole.polygon.push_back(at(kPole_m, k * std::numbers::pi / 4));
  pole.top_m = params.rise_m + 0.95;
  stair.column = pole;
  stair.voids = {{c.x() - radius - 0.03, y_edge, c.x() + radius + 0.03, c.y() + radius + 0.03}};
  stair.arrivals = {{{c.x() - reach, y_edge}, {c.x() + reach, y_edge}}};
  stair.departures = stair.arrivals;
  if (!params.is_continued) {  // beside the landing there would be a drop onto the first treads
    stair.railings.push_back({Vector3d(c.x() + reach, y_edge + 0.02, params.rise_m),
                              Vector3d(c.x() + kPole_m, c.y() - kPole_m, params.rise_m), 0.95,
                              params.rail_style});
  }
  stair.footprint = {stair.voids[0]};
  stair.p_bottom = {c.x(), y_edge - 0.5, 0};
  stair.p_top = {c.x(), y_edge - 0.5, params.rise_m};
  block.width_m = 2 * c.x();
  block.depth_m = c.y() + radius + 0.03 + kWall_m;
  block.entry_x0 = block.exit_x0 = 0;
  block.entry_x1 = block.exit_x1 = block.width_m;
  return block;
}

}  // namespace crossnav::world
