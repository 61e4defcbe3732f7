// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {
namespace {

void AddLegs(MeshBuilder& mesh, const Rect& under, double height_m, double half_m) {
  for (double x : {under.x0 + half_m, under.x1 - half_m}) {
    for (double y : {under.y0 + half_m, under.y1 - half_m}) {
      mesh.AddBox({x - half_m, y - half_m, 0}, {x + half_m, y + half_m, height_m});
    }
  }
}

/// Backrest of a chair: 0 solid panel, 1 vertical slats, 2 horizontal rails, 3 cushion.
void AddBackrest(ModelBuilder& b, const Rect& seat, double z0, double z1, int style) {
  const double y0 = seat.y0, y1 = seat.y0 + 0.03;
  b.mesh.AddBox({seat.x0, y0, z0}, {seat.x0 + 0.035, y1, z1});
  b.mesh.AddBox({seat.x1 - 0.035, y0, z0}, {seat.x1, y1, z1});
  if (style == 0) {
    b.mesh.AddBox({seat.x0 + 0.035, y0 + 0.005, z0 + 0.12}, {seat.x1 - 0.035, y1 - 0.005, z1});
  } else if (style == 1) {
    b.mesh.AddBox({seat.x0, y0, z1 - 0.06}, {seat.x1, y1, z1});
    const int slats = 4;
    for (int i = 0; i < slats; ++i) {
      const double x = seat.x0 + (seat.x1 - seat.x0) * (i + 1.0) / (slats + 1);
      b.mesh.AddBox({x - 0.012, y0 + 0.006, z0}, {x + 0.012, y1 - 0.006, z1 - 0.06});
    }
  } else {
    for (double f : {0.35, 0.62, 0.9}) {
      const double z = z0 + f * (z1 - z0);
      b.mesh.AddBox({seat.x0 + 0.035, y0 + 0.004, z - 0.03}, {seat.x1 - 0.035, y1, z + 0.03});
    }
  }
}

ObjectModel WoodenChair(const char* name, Rng& rng) {
  ModelBuilder b(name);
  const double w = rng.Uniform(0.40, 0.48), d = rng.Uniform(0.40, 0.47);
  const double seat_m = rng.Uniform(0.43, 0.47), back_m = rng.Uniform(0.84, 1.0);
  const Rgb8 frame = rng.Chance(0.75) ? Pick(kWoods, rng) : Pick(kMetals, rng);
  const bool is_cushioned = rng.Chance(0.5);
  const Rgb8 fabric = Pick(kFabrics, rng);
  const Rect seat{-w / 2, -d / 2, w / 2, d / 2};
  b.Colour(frame);
  AddLegs(b.mesh, seat.Grown(-0.005), seat_m - 0.03, rng.Uniform(0.014, 0.022));
  b.mesh.AddBox({seat.x0, seat.y0, seat_m - 0.03}, {seat.x1, seat.y1, seat_m});
  AddBackrest(b, seat, seat_m, back_m, rng.Int(0, 2));
  if (is_cushioned) {
    b.Colour(fabric);
    b.mesh.AddCushion({seat.x0 + 0.02, seat.y0 + 0.04, seat_m},
                      {seat.x1 - 0.02, seat.y1 - 0.01, seat_m + 0.045}, 0.015);
  }
  return b.Finish();
}

}  // namespace

ObjectModel MakeChair(Rng& rng) {
  return WoodenChair("chair", rng);
}
ObjectModel MakeDiningChair(Rng& rng) {
  return WoodenChair("dining chair", rng);
}

ObjectModel MakeOfficeChair(Rng& rng) {
  ModelBuilder b("office chair");
  const Rgb8 fabric = Pick(kFabrics, rng), metal = Pick(kMetals, rng);
  b.Colour(metal);
  for (int i = 0; i < 5; ++i) {
    const double a = 2 * 3.14159265358979 * i / 5;
    const Vector3d tip(0.28 * std::cos(a), 0.28 * std::sin(a), 0.06);
    b.mesh.AddBar({0, 0, 0.09}, tip, 0.018, 6);
    b.mesh.AddEllipsoid({tip.x(), tip.y(), 0.03}, {0.03, 0.03, 0.03}, 8);
  }
  b.mesh.AddCylinder({0, 0, 0.08}, 0.03, 0.36, 10);
  b.Colour(fabric);
  b.mesh.AddCushion({-0.24, -0.22, 0.43}, {0.24, 0.25, 0.51}, 0.03);
  const double back = rng.Uniform(0.95, 1.15);
  b.mesh.AddCushion({-0.22, -0.26, 0.58}, {0.22, -0.19, back}, 0.03);
  b.Colour(Shade(metal, 0.6));
  b.mesh.AddBox({-0.03, -0.25, 0.45}, {0.03, -0.22, 0.62});
  if (rng.Chance(0.7)) {
    for (double s : {-1.0, 1.0}) {
      b.mesh.AddBar({s * 0.25, 0, 0.46}, {s * 0.28, 0, 0.68}, 0.015, 6);
      b.mesh.AddBox({s * 0.28 - 0.03, -0.14, 0.68}, {s * 0.28 + 0.03, 0.14, 0.71});
    }
  }
  return b.Finish();
}

namespace {

/// Sofa and armchair: seats between arms in front of a back, on a plinth or legs.
ObjectModel Upholstered(const char* name, double width_m, int seats, Rng& rng) {
  ModelBuilder b(name);
  const double depth = rng.Uniform(0.82, 0.95), seat_m = rng.Uniform(0.40, 0.46);
  const double back_m = rng.Uniform(0.76, 0.92), arm_m = rng.Uniform(0.54, 0.64);
  const double arm_w = rng.Uniform(0.12, 0.22), foot_m = rng.Uniform(0.05, 0.14);
  const Rgb8 fabric = Pick(kFabrics, rng), cushion = rng.Chance(0.5) ? fabric : Pick(kFabrics, rng);
  const double x0 = -width_m / 2, x1 = width_m / 2, y0 = -depth / 2, y1 = depth / 2;
  b.Colour(Pick(kWoods, rng));
  AddLegs(b.mesh, Rect{x0, y0, x1, y1}.Grown(-0.05), foot_m, 0.025);
  b.Colour(fabric);
  b.mesh.AddBox({x0 + 0.01, y0 + 0.01, foot_m}, {x1 - 0.01, y1 - 0.03, seat_m - 0.12});
  b.mesh.AddCushion({x0, y0, foot_m}, {x1, y0 + 0.22, back_m}, 0.06);
  b.mesh.AddCushion({x0, y0 + 0.05, foot_m}, {x0 + arm_w, y1, arm_m}, 0.05);
  b.mesh.AddCushion({x1 - arm_w, y0 + 0.05, foot_m}, {x1, y1, arm_m}, 0.05);
  const double inner = width_m - 2 * arm_w;
  for (int i = 0; i < seats; ++i) {
    const double a = x0 + arm_w + inner * i / seats, c = x0 + arm_w + inner * (i + 1) / seats;
    b.Colour(Shade(fabric, 1.06));
    b.mesh.AddCushion({a + 0.004, y0 + 0.2, seat_m - 0.12}, {c - 0.004, y1 - 0.01, seat_m}, 0.035);
    b.mesh.AddCushion({a + 0.01, y0 + 0.18, seat_m}, {c - 0.01, y0 + 0.34, back_m - 0.02}, 0.05);
  }
  if (seats > 1) {
    b.Colour(cushion == fabric ? Shade(fabric, 1.35) : cushion);
    for (double s : {-1.0, 1.0}) {
      if (rng.Chance(0.3)) continue;
      b.mesh.AddOrientedBox({s * (inner / 2 - 0.24), y0 + 0.42, seat_m + 0.2}, {0.4, 0.12, 0.38},
                            Eigen::AngleAxisd(0.35, Vector3d::UnitX()).toRotationMatrix());
    }
  }
  return b.Finish();
}

}  // namespace

ObjectModel MakeArmchair(Rng& rng) {
  return Upholstered("armchair", rng.Uniform(0.8, 0.95), 1, rng);
}

ObjectModel MakeSofa(Rng& rng) {
  const int seats = rng.Int(2, 3);
  return Upholstered("couch", seats == 2 ? rng.Uniform(1.55, 1.8) : rng.Uniform(2.0, 2.3), seats,
                     rng);
}

ObjectModel MakeStool(Rng& rng) {
  ModelBuilder b("stool");
  const double h = rng.Uniform(0.42, 0.66), r = rng.Uniform(0.15, 0.2);
  b.Colour(Pick(kMetals, rng));
  for (int i = 0; i < 4; ++i) {
    const double a = 3.14159265358979 * (0.25 + 0.5 * i);
    const Vector3d d(std::cos(a), std::sin(a), 0);
    b.mesh.AddBar(d * (r + 0.03), d * (r * 0.6) + Vector3d(0, 0, h - 0.03), 0.013, 6);
  }
  b.Colour(rng.Chance(0.5) ? Pick(kWoods, rng) : Pick(kFabrics, rng));
  b.mesh.AddCylinder({0, 0, h - 0.04}, r, 0.04, 18);
  return b.Finish();
}

ObjectModel MakeBench(Rng& rng) {
  ModelBuilder b("bench");
  const double w = rng.Uniform(0.9, 1.4), d = 0.36, h = rng.Uniform(0.42, 0.48);
  b.Colour(Pick(kWoods, rng));
  AddLegs(b.mesh, {-w / 2, -d / 2, w / 2, d / 2}, h - 0.04, 0.025);
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.04}, {w / 2, d / 2, h});
  return b.Finish();
}

}  // namespace crossnav::world
