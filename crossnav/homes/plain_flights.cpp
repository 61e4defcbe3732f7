// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/homes/flights.h"
#include "crossnav/homes/piece_model.h"

namespace crossnav::homes {
namespace {

constexpr double kRiser_m = 0.19;     // chosen: a house's usual step
constexpr double kMinTread_m = 0.14;  // chosen: minimum of the navmesh
constexpr double kMinSpiral_m = 1.1;  // chosen: diameter; narrower spirals have no walkable tread
constexpr double kPole_m = 0.06;
// of a spiral: the landing above, the entry below
constexpr double kSector_rad = std::numbers::pi / 3;
constexpr int kOrientations = 8;
constexpr Rgb8 kWood{150, 110, 75};

int RisersFor(double rise_m) {
  return std::max(2, static_cast<int>(std::ceil(rise_m / kRiser_m)));
}

/// The piece's frame seen along the direction of climbing.
struct ClimbFrame {
  Vector2d along, across;  ///< unit vectors
  double run_m = 0, width_m = 0;
};

/// 0 to the back, 1 to the front, 2 to the right, 3 to the left.
ClimbFrame ClimbFrameOf(const HomePiece& piece, int direction) {
  const double sign = direction % 2 == 0 ? 1 : -1;
  if (direction < 2) return {{0, sign}, {-sign, 0}, piece.depth_m, piece.width_m};
  return {{sign, 0}, {0, sign}, piece.width_m, piece.depth_m};
}

std::optional<world::NamedObj> Finished(world::ModelBuilder& builder) {
  world::NamedObj obj;
  obj.model = builder.Finish();
  obj.material_names.assign(obj.model.materials.size(), "");
  obj.is_material_defined.assign(obj.model.materials.size(), true);
  obj.triangle_group.assign(obj.model.mesh.triangles.size(), -1);
  return obj;
}

std::optional<world::NamedObj> Straight(const HomePiece& piece, double rise_m, int direction) {
  const ClimbFrame frame = ClimbFrameOf(piece, direction);
  const int risers = RisersFor(rise_m), treads = risers - 1;
  const double tread_m = frame.run_m / treads;
  if (tread_m < kMinTread_m || frame.width_m < 0.4) return std::nullopt;
  world::ModelBuilder builder("");
  builder.Colour(piece.colour.value_or(kWood));
  for (int i = 0; i < treads; ++i) {
    const Vector2d a = frame.along * (i * tread_m - 0.5 * frame.run_m);
    const Vector2d b = a + frame.along * tread_m, side = frame.across * (0.5 * frame.width_m);
    const Polygon tread = {a - side, b - side, b + side, a + side};
    builder.mesh.AddPrism(tread, 0, (i + 1) * rise_m / risers);
  }
  return Finished(builder);
}

/// Treads around a pole; the sector around `exit_rad` is the entry below and the landing above.
std::optional<world::NamedObj> Spiral(const HomePiece& piece, double rise_m, double exit_rad,
                                      bool is_clockwise) {
  const Vector2d radius(0.5 * piece.width_m, 0.5 * piece.depth_m);
  if (2 * radius.minCoeff() < kMinSpiral_m) return std::nullopt;
  const int risers = RisersFor(rise_m), treads = risers - 1;
  const double step = (2 * std::numbers::pi - kSector_rad) / treads;
  const auto at = [&](double share, double turned) -> Vector2d {
    const double angle = exit_rad + (is_clockwise ? -turned : turned);
    return share * radius.cwiseProduct(Vector2d(std::cos(angle), std::sin(angle)));
  };
  const double pole = kPole_m / radius.minCoeff();
  world::ModelBuilder builder("");
  builder.Colour(piece.colour.value_or(kWood));
  for (int i = 0; i < treads; ++i) {
    const double a = 0.5 * kSector_rad + i * step, b = a + step, top = (i + 1) * rise_m / risers;
    const Polygon tread =
        Cleaned({at(pole, a), at(1, a), at(1, 0.5 * (a + b)), at(1, b), at(pole, b)});
    builder.mesh.AddPrism(tread, std::max(0.0, top - rise_m / risers - 0.03), top);
  }
  // The landing reaches the edge of the box, where the upper floor begins.
  const double half = 0.5 * kSector_rad;
  const Polygon landing = Cleaned({at(pole, -half), at(1.4, -half), at(1.4, half), at(pole, half)});
  const double x = radius.x(), y = radius.y();
  const Polygon box = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  builder.mesh.AddPrism(Shared(box, landing), rise_m - 0.05, rise_m);
  builder.mesh.AddCylinder(Vector3d::Zero(), kPole_m, rise_m + 0.9, 8);
  return Finished(builder);
}

/// Height of the model's far end above its near end, in a direction.
double RiseAlong(const world::NamedObj& model, const HomePiece& piece, int direction,
                 double rise_m) {
  const ClimbFrame frame = ClimbFrameOf(piece, direction);
  double weight[2] = {}, height[2] = {};
  const auto& mesh = model.model.mesh;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    const Vector3d normal = (b - a).cross(c - a), center = (a + b + c) / 3;
    if (std::abs(normal.z()) < 0.8 * normal.norm() || center.z() > rise_m + 0.1) continue;
    const double s = center.head<2>().dot(frame.along) / frame.run_m;
    if (std::abs(s) < 0.15) continue;
    const int end = s > 0 ? 1 : 0;
    weight[end] += normal.norm();
    height[end] += normal.norm() * center.z();
  }
  if (weight[0] <= 0 || weight[1] <= 0) return 0;
  return height[1] / weight[1] - height[0] / weight[0];
}

}  // namespace

std::vector<world::NamedObj> PlainFlights(const HomePiece& piece, double rise_m,
                                          const world::NamedObj* model) {
  std::vector<std::pair<double, int>> directions;
  directions.reserve(4);
  for (int d = 0; d < 4; ++d) {
    directions.emplace_back(model ? -RiseAlong(*model, piece, d, rise_m) : 0.0, d);
  }
  std::stable_sort(directions.begin(), directions.end());
  std::vector<world::NamedObj> flights;
  for (const auto& [rise, direction] : directions) {
    if (auto flight = Straight(piece, rise_m, direction)) flights.push_back(std::move(*flight));
  }
  for (int k = 0; k < kOrientations; ++k) {
    const double exit_rad = 2 * std::numbers::pi * k / kOrientations;
    for (const bool is_clockwise : {false, true}) {
      auto flight = Spiral(piece, rise_m, exit_rad, is_clockwise);
      if (flight) flights.push_back(std::move(*flight));
    }
  }
  return flights;
}

}  // namespace crossnav::homes
