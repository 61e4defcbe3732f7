// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {
namespace {

/// A carcass with `rows` x `columns` drawer or door fronts and handles, front at +y.
void AddFronts(ModelBuilder& b, const Rect& plan, double z0, double z1, int rows, int columns) {
  const Rgb8 metal{120, 120, 124};
  const double w = plan.Width() / columns, h = (z1 - z0) / rows;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double x0 = plan.x0 + c * w + 0.006, x1 = plan.x0 + (c + 1) * w - 0.006;
      const double a = z0 + r * h + 0.006, e = z0 + (r + 1) * h - 0.006;
      b.mesh.AddBox({x0, plan.y1, a}, {x1, plan.y1 + 0.016, e});
      const int before = b.mesh.material;
      b.Colour(metal);
      const double xm = 0.5 * (x0 + x1), zm = 0.5 * (a + e);
      if (h < 0.45) {
        b.mesh.AddBox({xm - 0.05, plan.y1 + 0.016, zm - 0.008},
                      {xm + 0.05, plan.y1 + 0.04, zm + 0.008});
      } else {
        const double x = c % 2 == 0 ? x1 - 0.05 : x0 + 0.05;
        b.mesh.AddBox({x - 0.008, plan.y1 + 0.016, zm - 0.08},
                      {x + 0.008, plan.y1 + 0.04, zm + 0.08});
      }
      b.mesh.material = before;
    }
  }
}

}  // namespace

ObjectModel MakeBed(Rng& rng) {
  ModelBuilder b("bed");
  const bool is_double = rng.Chance(0.65);
  const double w = is_double ? rng.Uniform(1.45, 1.8) : rng.Uniform(0.92, 1.1);
  const double length = rng.Uniform(2.0, 2.1), y0 = -length / 2, y1 = length / 2;
  const double base = rng.Uniform(0.26, 0.34), mattress = base + rng.Uniform(0.18, 0.24);
  const Rgb8 wood = rng.Chance(0.7) ? Pick(kWoods, rng) : Pick(kFabrics, rng);
  const Rgb8 sheet = Pick(kLinens, rng),
             duvet = rng.Chance(0.5) ? Pick(kLinens, rng) : Pick(kFabrics, rng);
  b.Colour(wood);
  b.mesh.AddBox({-w / 2, y0, 0}, {w / 2, y0 + 0.07, rng.Uniform(0.9, 1.15)});  // headboard
  b.mesh.AddBox({-w / 2, y0 + 0.07, 0.1}, {w / 2, y1, base});
  for (double s : {-1.0, 1.0}) {
    b.mesh.AddBox({s * (w / 2 - 0.06) - 0.03, y1 - 0.1, 0},
                  {s * (w / 2 - 0.06) + 0.03, y1 - 0.04, 0.1});
  }
  b.Colour(sheet);
  b.mesh.AddCushion({-w / 2 + 0.03, y0 + 0.08, base}, {w / 2 - 0.03, y1 - 0.03, mattress}, 0.05);
  b.Colour(duvet);
  b.mesh.AddCushion({-w / 2 - 0.02, y0 + 0.72, base + 0.06},
                    {w / 2 + 0.02, y1 - 0.01, mattress + 0.07}, 0.06);
  b.Colour(Shade(sheet, 0.94));
  b.mesh.AddCushion({-w / 2 - 0.021, y0 + 0.66, base + 0.08},
                    {w / 2 + 0.021, y0 + 0.9, mattress + 0.085}, 0.05);
  b.Colour(rng.Chance(0.6) ? Rgb8{242, 240, 236} : Pick(kLinens, rng));
  const int pillows = is_double ? 2 : 1;
  for (int i = 0; i < pillows; ++i) {
    const double x = pillows == 1 ? 0 : (i == 0 ? -w / 4 : w / 4);
    b.mesh.AddCushion({x - 0.3, y0 + 0.12, mattress}, {x + 0.3, y0 + 0.54, mattress + 0.14}, 0.06);
  }
  return b.Finish();
}

ObjectModel MakeBedsideTable(Rng& rng) {
  ModelBuilder b("bedside table");
  const double w = rng.Uniform(0.4, 0.5), d = 0.38, h = rng.Uniform(0.45, 0.6);
  const Rgb8 wood = Pick(kWoods, rng);
  b.Colour(wood);
  b.mesh.AddBox({-w / 2, -d / 2, 0.06}, {w / 2, d / 2, h});
  b.mesh.AddBox({-w / 2 + 0.03, -d / 2 + 0.03, 0}, {w / 2 - 0.03, d / 2 - 0.03, 0.06});
  b.Colour(Shade(wood, 1.1));
  AddFronts(b, {-w / 2, -d / 2, w / 2, d / 2}, 0.07, h - 0.02, 2, 1);
  b.SetTop(h);
  return b.Finish();
}

ObjectModel MakeWardrobe(Rng& rng) {
  ModelBuilder b("wardrobe");
  const int doors = rng.Int(2, 4);
  const double w = 0.5 * doors, d = rng.Uniform(0.55, 0.62), h = rng.Uniform(1.95, 2.2);
  const Rgb8 wood = rng.Chance(0.3) ? Rgb8{232, 230, 226} : Pick(kWoods, rng);
  b.Colour(wood);
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2, h});
  b.Colour(Shade(wood, rng.Chance(0.5) ? 1.08 : 0.92));
  AddFronts(b, {-w / 2, -d / 2, w / 2, d / 2}, 0.08, h - 0.03, 1, doors);
  return b.Finish();
}

ObjectModel MakeChest(Rng& rng) {
  ModelBuilder b("chest of drawers");
  const double w = rng.Uniform(0.75, 1.2), d = rng.Uniform(0.4, 0.5), h = rng.Uniform(0.75, 1.05);
  const Rgb8 wood = Pick(kWoods, rng);
  b.Colour(wood);
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2, h});
  b.Colour(Shade(wood, 1.1));
  AddFronts(b, {-w / 2, -d / 2, w / 2, d / 2}, 0.06, h - 0.03, rng.Int(3, 4), w > 1.0 ? 2 : 1);
  b.SetTop(h);
  return b.Finish();
}

}  // namespace crossnav::world
