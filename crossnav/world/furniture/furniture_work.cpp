// SPDX-License-Identifier: MIT
// Tables, desks and the kitchen.
#include <array>

#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {
namespace {

void AddTable(ModelBuilder& b, double w, double d, double h, double leg) {
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.035}, {w / 2, d / 2, h});
  for (double x : {-w / 2 + leg + 0.02, w / 2 - leg - 0.02}) {
    for (double y : {-d / 2 + leg + 0.02, d / 2 - leg - 0.02}) {
      b.mesh.AddBox({x - leg, y - leg, 0}, {x + leg, y + leg, h - 0.035});
    }
  }
  b.SetTop(h);
}

/// Looks of a kitchen: fronts and worktop.
constexpr std::array<Rgb8, 5> kFronts = {
    Rgb8{232, 230, 226}, {176, 132, 88}, {92, 104, 110}, {120, 140, 124}, {206, 190, 164}};
constexpr std::array<Rgb8, 3> kWorktops = {Rgb8{70, 68, 66}, {176, 132, 88}, {210, 208, 204}};

}  // namespace

ObjectModel MakeDiningTable(Rng& rng) {
  ModelBuilder b("dining table");
  b.Colour(Pick(kWoods, rng));
  if (rng.Chance(0.25)) {
    const double r = rng.Uniform(0.5, 0.62), h = 0.75;
    b.mesh.AddCylinder({0, 0, h - 0.035}, r, 0.035, 28);
    b.mesh.AddFrustum({0, 0, 0.03}, 0.1, 0.06, h - 0.065, 14);
    b.mesh.AddCylinder({0, 0, 0}, 0.3, 0.03, 20);
    b.SetTop(h);
    return b.Finish();
  }
  const double h = rng.Uniform(0.73, 0.77), d = rng.Uniform(0.8, 0.95), w = rng.Uniform(1.2, 1.8);
  AddTable(b, w, d, h, 0.035);
  return b.Finish();
}

ObjectModel MakeDesk(Rng& rng) {
  ModelBuilder b("desk");
  const Rgb8 wood = Pick(kWoods, rng);
  const double w = rng.Uniform(1.1, 1.5), d = rng.Uniform(0.6, 0.72), h = rng.Uniform(0.72, 0.76);
  b.Colour(wood);
  AddTable(b, w, d, h, 0.025);
  if (rng.Chance(0.6)) {
    b.Colour(Shade(wood, 0.92));
    b.mesh.AddBox({w / 2 - 0.45, -d / 2 + 0.03, 0.08}, {w / 2 - 0.08, d / 2 - 0.04, h - 0.04});
    b.Colour({120, 120, 124});
    for (double z : {0.2, 0.4, 0.6}) {
      b.mesh.AddBox({w / 2 - 0.32, d / 2 - 0.04, z}, {w / 2 - 0.2, d / 2 - 0.02, z + 0.015});
    }
  }
  return b.Finish();
}

ObjectModel MakeMonitor(Rng& rng) {
  ModelBuilder b("computer monitor");
  const double w = rng.Uniform(0.5, 0.62), h = w * 0.58, foot = 0.1;
  b.Colour({30, 30, 34});
  b.mesh.AddBox({-w / 2, -0.02, foot}, {w / 2, 0.01, foot + h});
  b.mesh.AddBox({-0.03, -0.03, 0}, {0.03, -0.01, foot + 0.1});
  b.mesh.AddBox({-0.12, -0.1, 0}, {0.12, 0.08, 0.012});
  b.Colour(rng.Chance(0.5) ? kScreenBlack : Rgb8{70, 110, 160});
  b.mesh.AddBox({-w / 2 + 0.01, 0.01, foot + 0.01}, {w / 2 - 0.01, 0.012, foot + h - 0.01});
  return b.Finish();
}

ObjectModel MakeLaptop(Rng& rng) {
  ModelBuilder b("laptop");
  b.Colour(Pick(kMetals, rng));
  b.mesh.AddBox({-0.17, -0.1, 0}, {0.17, 0.13, 0.018});
  b.mesh.AddOrientedBox({0, -0.14, 0.12}, {0.34, 0.012, 0.23},
                        Eigen::AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix());
  b.Colour(kScreenBlack);
  b.mesh.AddOrientedBox({0, -0.133, 0.122}, {0.31, 0.006, 0.2},
                        Eigen::AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix());
  return b.Finish();
}

ObjectModel MakeKitchenUnit(Rng& rng) {
  ModelBuilder b("kitchen cabinet");
  const double w = 0.6, d = 0.6, h = 0.9;
  const Rgb8 front = Pick(kFronts, rng);
  b.Colour({60, 60, 62});
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2 - 0.06, 0.1});
  b.Colour(Shade(front, 0.9));
  b.mesh.AddBox({-w / 2, -d / 2, 0.1}, {w / 2, d / 2 - 0.02, h - 0.04});
  b.Colour(front);
  const bool has_drawers = rng.Chance(0.4);
  for (int i = 0; i < (has_drawers ? 3 : 1); ++i) {
    const double n = has_drawers ? 3 : 1, z0 = 0.11 + (h - 0.16) * i / n,
                 z1 = 0.11 + (h - 0.16) * (i + 1) / n;
    b.Colour(front);
    b.mesh.AddBox({-w / 2 + 0.004, d / 2 - 0.02, z0}, {w / 2 - 0.004, d / 2, z1 - 0.006});
    b.Colour({140, 140, 144});
    b.mesh.AddBox({-0.08, d / 2, z1 - 0.06}, {0.08, d / 2 + 0.02, z1 - 0.045});
  }
  b.Colour(Pick(kWorktops, rng));
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.04}, {w / 2, d / 2 + 0.02, h});
  b.SetTop(h);
  return b.Finish();
}

ObjectModel MakeUpperCabinet(Rng& rng) {
  ModelBuilder b("kitchen upper cabinet");
  const double w = 0.6, d = 0.34, h = 0.7;
  const Rgb8 front = Pick(kFronts, rng);
  b.Colour(Shade(front, 0.9));
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2 - 0.02, h});
  b.Colour(front);
  b.mesh.AddBox({-w / 2 + 0.004, d / 2 - 0.02, 0.004}, {w / 2 - 0.004, d / 2, h - 0.004});
  b.Colour({140, 140, 144});
  b.mesh.AddBox({w / 2 - 0.07, d / 2, 0.05}, {w / 2 - 0.055, d / 2 + 0.02, 0.2});
  return b.Finish();
}

ObjectModel MakeRefrigerator(Rng& rng) {
  ModelBuilder b("refrigerator");
  const double w = rng.Uniform(0.6, 0.75), d = 0.64, h = rng.Uniform(1.7, 1.95);
  const Rgb8 body = rng.Chance(0.5) ? Rgb8{238, 238, 236} : Pick(kMetals, rng);
  b.Colour(body);
  b.mesh.AddBox({-w / 2, -d / 2, 0.03}, {w / 2, d / 2 - 0.04, h});
  b.Colour(Shade(body, 1.04));
  b.mesh.AddBox({-w / 2, d / 2 - 0.035, 0.05}, {w / 2, d / 2, 0.62});
  b.mesh.AddBox({-w / 2, d / 2 - 0.035, 0.63}, {w / 2, d / 2, h});
  b.Colour({110, 112, 116});
  b.mesh.AddBox({-w / 2 + 0.04, d / 2, 0.7}, {-w / 2 + 0.06, d / 2 + 0.03, 1.2});
  b.mesh.AddBox({-w / 2 + 0.04, d / 2, 0.35}, {-w / 2 + 0.06, d / 2 + 0.03, 0.58});
  return b.Finish();
}

ObjectModel MakeCooker(Rng& rng) {
  ModelBuilder b("stove");
  const double w = 0.6, d = 0.6, h = 0.9;
  const Rgb8 body = rng.Chance(0.5) ? Rgb8{238, 238, 236} : Rgb8{150, 152, 155};
  b.Colour(body);
  b.mesh.AddBox({-w / 2, -d / 2, 0.02}, {w / 2, d / 2, h - 0.01});
  b.Colour({26, 26, 28});
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.01}, {w / 2, d / 2, h});
  b.mesh.AddBox({-0.22, d / 2, 0.25}, {0.22, d / 2 + 0.01, 0.6});
  b.Colour({90, 90, 92});
  for (double x : {-0.14, 0.14}) {
    for (double y : {-0.14, 0.13}) b.mesh.AddCylinder({x, y, h}, 0.09, 0.006, 16);
  }
  for (int i = 0; i < 4; ++i) {
    b.mesh.AddBox({-0.24 + i * 0.13, d / 2, 0.76}, {-0.2 + i * 0.13, d / 2 + 0.03, 0.8});
  }
  b.mesh.AddBar({-0.22, d / 2 + 0.035, 0.66}, {0.22, d / 2 + 0.035, 0.66}, 0.01, 6);
  return b.Finish();
}

ObjectModel MakeSink(Rng& rng) {
  ModelBuilder b("sink");
  const double w = 0.8, d = 0.6, h = 0.9;
  const Rgb8 front = Pick(kFronts, rng);
  b.Colour(front);
  b.mesh.AddBox({-w / 2, -d / 2, 0.1}, {w / 2, d / 2, h - 0.18});
  b.mesh.AddBox({-w / 2, d / 2 - 0.02, h - 0.18}, {w / 2, d / 2, h - 0.02});
  b.Colour({60, 60, 62});
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2 - 0.06, 0.1});
  b.Colour({186, 190, 194});
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.18}, {w / 2, -d / 2 + 0.1, h});
  b.mesh.AddBox({-w / 2, d / 2 - 0.1, h - 0.18}, {w / 2, d / 2 - 0.02, h});
  b.mesh.AddBox({-w / 2, -d / 2 + 0.1, h - 0.18}, {-w / 2 + 0.08, d / 2 - 0.1, h});
  b.mesh.AddBox({0.08, -d / 2 + 0.1, h - 0.18}, {w / 2, d / 2 - 0.1, h});
  b.mesh.AddCylinder({0, -d / 2 + 0.05, h}, 0.02, 0.28, 8);
  b.mesh.AddBar({0, -d / 2 + 0.05, h + 0.27}, {-0.1, -d / 2 + 0.2, h + 0.2}, 0.014, 6);
  return b.Finish();
}

}  // namespace crossnav::world
