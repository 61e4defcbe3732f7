// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {
namespace {

/// A picture of coloured blocks on the plane y = `y`, so that a screen is not plain black.
void AddBlocks(ModelBuilder& b, const Rect& xz, double y, Rng& rng) {
  const int columns = rng.Int(3, 6), rows = rng.Int(2, 4);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      b.Colour({static_cast<std::uint8_t>(rng.Int(20, 230)),
                static_cast<std::uint8_t>(rng.Int(20, 230)),
                static_cast<std::uint8_t>(rng.Int(20, 230))});
      const double x0 = xz.x0 + xz.Width() * i / columns,
                   x1 = xz.x0 + xz.Width() * (i + 1) / columns;
      const double z0 = xz.y0 + xz.Depth() * j / rows, z1 = xz.y0 + xz.Depth() * (j + 1) / rows;
      b.mesh.AddQuad({x1, y, z0}, {x0, y, z0}, {x0, y, z1}, {x1, y, z1});
    }
  }
}

/// A curved leaf: three quads from `root`, rising and then bending down.
void AddLeaf(MeshBuilder& mesh, const Vector3d& root, double azimuth, double length, double rise) {
  const Vector3d out(std::cos(azimuth), std::sin(azimuth), 0), side(-out.y(), out.x(), 0);
  const double half = 0.13 * length;
  const double along[] = {0, 0.4, 0.75, 1.0}, width[] = {0.25, 1.0, 0.75, 0.05};
  Vector3d left[4], right[4];
  for (int i = 0; i < 4; ++i) {
    const double t = along[i];
    const Vector3d p = root + out * (length * t) +
                       Vector3d(0, 0, rise * std::sin(t * 2.2) - 0.25 * length * t * t);
    left[i] = p + side * half * width[i];
    right[i] = p - side * half * width[i];
  }
  for (int i = 0; i < 3; ++i) mesh.AddQuad(right[i], left[i], left[i + 1], right[i + 1]);
}

}  // namespace

ObjectModel MakeTv(Rng& rng) {
  ModelBuilder b("tv");
  const double w = rng.Uniform(0.9, 1.35), h = w * 9 / 16 + 0.03, foot = 0.07;
  b.Colour({static_cast<std::uint8_t>(rng.Int(14, 40)), 20, 24});
  b.mesh.AddBox({-w / 2, -0.03, foot}, {w / 2, 0.015, foot + h});
  b.mesh.AddBox({-0.04, -0.03, 0.01}, {0.04, 0.0, foot});
  b.mesh.AddBox({-0.22, -0.12, 0}, {0.22, 0.1, 0.015});
  b.Colour(kScreenBlack);
  const Rect screen{-w / 2 + 0.015, foot + 0.02, w / 2 - 0.015, foot + h - 0.015};
  b.mesh.AddBox({screen.x0, 0.015, screen.y0}, {screen.x1, 0.018, screen.y1});
  if (rng.Chance(0.5)) AddBlocks(b, screen, 0.0185, rng);
  return b.Finish();
}

ObjectModel MakeTvStand(Rng& rng) {
  ModelBuilder b("tv stand");
  const double w = rng.Uniform(1.3, 1.8), d = rng.Uniform(0.38, 0.45), h = rng.Uniform(0.42, 0.55);
  const Rgb8 wood = Pick(kWoods, rng);
  b.Colour(wood);
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.04}, {w / 2, d / 2, h});
  b.mesh.AddBox({-w / 2, -d / 2, 0.06}, {w / 2, d / 2, 0.1});
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {-w / 2 + 0.04, d / 2, h - 0.04});
  b.mesh.AddBox({w / 2 - 0.04, -d / 2, 0}, {w / 2, d / 2, h - 0.04});
  b.mesh.AddBox({-w / 2 + 0.04, -d / 2, 0.1}, {w / 2 - 0.04, -d / 2 + 0.02, h - 0.04});
  b.Colour(Shade(wood, 1.12));
  b.mesh.AddBox({-w / 2 + 0.05, d / 2 - 0.02, 0.1}, {-w / 6, d / 2, h - 0.05});
  b.mesh.AddBox({w / 6, d / 2 - 0.02, 0.1}, {w / 2 - 0.05, d / 2, h - 0.05});
  b.SetTop(h);
  return b.Finish();
}

ObjectModel MakePlant(Rng& rng) {
  ModelBuilder b("potted plant");
  const double pot_r = rng.Uniform(0.13, 0.2), pot_h = rng.Uniform(0.22, 0.38);
  const double height = rng.Uniform(0.8, 1.5);
  b.Colour(Pick(kPots, rng));
  b.mesh.AddFrustum({0, 0, 0}, pot_r * 0.72, pot_r, pot_h, 18);
  b.mesh.AddFrustum({0, 0, pot_h - 0.03}, pot_r * 1.06, pot_r * 1.08, 0.03, 18);
  b.Colour({62, 46, 36});
  b.mesh.AddCylinder({0, 0, pot_h}, pot_r * 0.9, 0.004, 18);
  const Rgb8 leaf = Pick(kLeaves, rng);
  const bool is_tree = rng.Chance(0.4);
  const double crown0 = is_tree ? 0.55 * height : pot_h;
  b.Colour({96, 74, 50});
  b.mesh.AddBar({0, 0, pot_h}, {0.02, -0.01, height * 0.9}, 0.016, 6);
  const int leaves = rng.Int(26, 44);
  for (int i = 0; i < leaves; ++i) {
    const double t = (i + 0.5) / leaves;
    const double z = crown0 + t * (height * 0.92 - crown0);
    b.Colour(Shade(leaf, 0.8 + 0.1 * (i % 5)));
    const double lift = rng.Uniform(0.08, 0.26), length_m = rng.Uniform(0.26, 0.42);
    AddLeaf(b.mesh, {0, 0, z}, i * 2.399963 + rng.Uniform(-0.3, 0.3), length_m * (1.15 - 0.5 * t),
            lift);
  }
  return b.Finish();
}

ObjectModel MakeCoffeeTable(Rng& rng) {
  ModelBuilder b("coffee table");
  const double h = rng.Uniform(0.38, 0.46);
  b.Colour(rng.Chance(0.7) ? Pick(kWoods, rng) : Pick(kMetals, rng));
  if (rng.Chance(0.3)) {
    const double r = rng.Uniform(0.35, 0.45);
    b.mesh.AddCylinder({0, 0, h - 0.03}, r, 0.03, 24);
    for (int i = 0; i < 3; ++i) {
      const double a = 2 * std::numbers::pi * i / 3;
      const Vector3d d(std::cos(a), std::sin(a), 0);
      b.mesh.AddBar(d * (r * 0.8), d * (r * 0.55) + Vector3d(0, 0, h - 0.03), 0.018, 6);
    }
  } else {
    const double w = rng.Uniform(0.8, 1.15), d = rng.Uniform(0.45, 0.6);
    b.mesh.AddBox({-w / 2, -d / 2, h - 0.035}, {w / 2, d / 2, h});
    for (double x : {-w / 2 + 0.03, w / 2 - 0.03}) {
      for (double y : {-d / 2 + 0.03, d / 2 - 0.03}) {
        b.mesh.AddBox({x - 0.022, y - 0.022, 0}, {x + 0.022, y + 0.022, h - 0.035});
      }
    }
    if (rng.Chance(0.5))
      b.mesh.AddBox({-w / 2 + 0.03, -d / 2 + 0.03, 0.12}, {w / 2 - 0.03, d / 2 - 0.03, 0.14});
  }
  b.SetTop(h);
  return b.Finish();
}

ObjectModel MakeBookcase(Rng& rng) {
  ModelBuilder b("bookcase");
  const double w = rng.Uniform(0.7, 1.1), d = rng.Uniform(0.26, 0.34), h = rng.Uniform(1.5, 2.1);
  b.Colour(Pick(kWoods, rng));
  const double t = 0.022;
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {-w / 2 + t, d / 2, h});
  b.mesh.AddBox({w / 2 - t, -d / 2, 0}, {w / 2, d / 2, h});
  b.mesh.AddBox({-w / 2 + t, -d / 2, 0}, {w / 2 - t, -d / 2 + 0.01, h});
  const int shelves = static_cast<int>(h / 0.36);
  const int board = b.mesh.material;
  for (int s = 0; s <= shelves; ++s) {
    const double z = 0.06 + (h - 0.06 - t) * s / shelves;
    b.mesh.material = board;
    b.mesh.AddBox({-w / 2 + t, -d / 2 + 0.01, z}, {w / 2 - t, d / 2, z + t});
    if (s == shelves) break;
    double x = -w / 2 + t + 0.01;
    const double space = (h - 0.06 - t) / shelves - t;
    const double end = w / 2 - t - (rng.Chance(0.5) ? rng.Uniform(0.05, 0.4) : 0.02);
    while (x < end) {
      const double thick = rng.Uniform(0.025, 0.06), tall = space * rng.Uniform(0.6, 0.92);
      if (x + thick > w / 2 - t) break;
      b.Colour(Pick(kFabrics, rng));
      b.mesh.AddBox({x, -d / 2 + 0.02, z + t}, {x + thick - 0.002, d / 2 - 0.05, z + t + tall});
      x += thick;
    }
  }
  return b.Finish();
}

ObjectModel MakePicture(Rng& rng) {
  ModelBuilder b("picture");
  const double w = rng.Uniform(0.35, 0.9), h = rng.Uniform(0.35, 0.7);
  b.Colour(rng.Chance(0.5) ? Pick(kWoods, rng) : Pick(kMetals, rng));
  b.mesh.AddBox({-w / 2, -0.012, 0}, {w / 2, 0.012, h});
  AddBlocks(b, {-w / 2 + 0.03, 0.03, w / 2 - 0.03, h - 0.03}, 0.0125, rng);
  return b.Finish();
}

ObjectModel MakeFloorLamp(Rng& rng) {
  ModelBuilder b("floor lamp");
  const double h = rng.Uniform(1.4, 1.75);
  b.Colour(Pick(kMetals, rng));
  b.mesh.AddCylinder({0, 0, 0}, 0.14, 0.02, 16);
  b.mesh.AddCylinder({0, 0, 0.02}, 0.012, h - 0.2, 8);
  b.Colour({242, 232, 206});
  b.mesh.AddFrustum({0, 0, h - 0.28}, 0.2, 0.13, 0.28, 18);
  return b.Finish();
}

ObjectModel MakeRug(Rng& rng) {
  ModelBuilder b("rug");
  const double w = rng.Uniform(1.4, 2.2), d = rng.Uniform(1.0, 1.5);
  const Rgb8 border = Pick(kFabrics, rng), field = Pick(kFabrics, rng);
  b.Colour(border);
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2, 0.008});
  b.Colour(field);
  b.mesh.AddBox({-w / 2 + 0.12, -d / 2 + 0.12, 0.008}, {w / 2 - 0.12, d / 2 - 0.12, 0.01});
  return b.Finish();
}

}  // namespace crossnav::world
