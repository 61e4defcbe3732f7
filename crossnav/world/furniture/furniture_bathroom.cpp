// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {

ObjectModel MakeToilet(Rng& rng) {
  ModelBuilder b("toilet");
  const Rgb8 white = Pick(kPorcelains, rng);
  const double seat_m = rng.Uniform(0.39, 0.43), tank_m = rng.Uniform(0.76, 0.84);
  b.Colour(white);
  b.mesh.AddFrustum({0, 0.02, 0}, 0.13, 0.11, 0.18, 20);
  b.mesh.AddFrustum({0, 0.04, 0.18}, 0.12, 0.19, seat_m - 0.18 - 0.03, 20);
  b.mesh.AddBox({-0.12, -0.28, 0}, {0.12, 0.0, seat_m - 0.03});
  b.mesh.AddBox({-0.19, -0.2, seat_m - 0.1}, {0.19, 0.08, seat_m - 0.03});
  b.mesh.AddCushion({-0.2, -0.36, seat_m - 0.06}, {0.2, -0.18, tank_m}, 0.02);  // cistern
  b.mesh.AddCushion({-0.21, -0.37, tank_m}, {0.21, -0.17, tank_m + 0.035}, 0.012);
  b.Colour(rng.Chance(0.8) ? Shade(white, 0.95) : Pick(kWoods, rng));
  b.mesh.AddCylinder({0, 0.06, seat_m - 0.03}, 0.2, 0.03, 24);  // seat
  b.mesh.AddBox({-0.19, -0.18, seat_m - 0.03}, {0.19, 0.06, seat_m});
  if (rng.Chance(0.5)) {  // lid up, leaning on the cistern, the bowl's water shows
    b.mesh.AddCushion({-0.18, -0.175, seat_m}, {0.18, -0.15, seat_m + 0.4}, 0.01);
    b.Colour({120, 140, 150});
    b.mesh.AddCylinder({0, 0.06, seat_m}, 0.12, 0.002, 20);
  } else {
    b.mesh.AddCylinder({0, 0.06, seat_m}, 0.195, 0.018, 24);
    b.mesh.AddBox({-0.185, -0.175, seat_m}, {0.185, 0.06, seat_m + 0.018});
  }
  b.Colour({200, 202, 205});
  b.mesh.AddCylinder({0, -0.27, tank_m + 0.035}, 0.025, 0.012, 12);  // flush button
  return b.Finish();
}

ObjectModel MakeWashbasin(Rng& rng) {
  ModelBuilder b("washbasin");
  const double w = rng.Uniform(0.55, 0.8), d = 0.46, h = rng.Uniform(0.82, 0.88);
  const Rgb8 white = Pick(kPorcelains, rng);
  if (rng.Chance(0.6)) {
    b.Colour(Pick(kWoods, rng));
    b.mesh.AddBox({-w / 2 + 0.02, -d / 2, 0.12}, {w / 2 - 0.02, d / 2 - 0.03, h - 0.12});
    b.Colour({120, 120, 124});
    b.mesh.AddBox({-0.05, d / 2 - 0.03, h - 0.3}, {0.05, d / 2 - 0.01, h - 0.28});
  } else {
    b.Colour(white);
    b.mesh.AddFrustum({0, -0.08, 0}, 0.12, 0.09, h - 0.14, 16);
  }
  b.Colour(white);
  const double rim = 0.05;
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.14}, {w / 2, d / 2, h - 0.1});
  b.mesh.AddBox({-w / 2, -d / 2, h - 0.1}, {w / 2, -d / 2 + 0.12, h});
  b.mesh.AddBox({-w / 2, d / 2 - rim, h - 0.1}, {w / 2, d / 2, h});
  b.mesh.AddBox({-w / 2, -d / 2 + 0.12, h - 0.1}, {-w / 2 + rim, d / 2 - rim, h});
  b.mesh.AddBox({w / 2 - rim, -d / 2 + 0.12, h - 0.1}, {w / 2, d / 2 - rim, h});
  b.Colour({198, 200, 204});
  b.mesh.AddCylinder({0, -d / 2 + 0.06, h}, 0.02, 0.14, 10);
  b.mesh.AddBar({0, -d / 2 + 0.06, h + 0.13}, {0, -d / 2 + 0.2, h + 0.1}, 0.015, 8);
  return b.Finish();
}

ObjectModel MakeBathtub(Rng& rng) {
  ModelBuilder b("bathtub");
  const double w = rng.Uniform(1.55, 1.75), d = rng.Uniform(0.7, 0.8), h = rng.Uniform(0.52, 0.6);
  const double rim = 0.07;
  b.Colour(Pick(kPorcelains, rng));
  b.mesh.AddBox({-w / 2, -d / 2, 0}, {w / 2, d / 2, 0.14});
  b.mesh.AddBox({-w / 2, -d / 2, 0.14}, {w / 2, -d / 2 + rim, h});
  b.mesh.AddBox({-w / 2, d / 2 - rim, 0.14}, {w / 2, d / 2, h});
  b.mesh.AddBox({-w / 2, -d / 2 + rim, 0.14}, {-w / 2 + rim, d / 2 - rim, h});
  b.mesh.AddBox({w / 2 - rim, -d / 2 + rim, 0.14}, {w / 2, d / 2 - rim, h});
  b.Colour({198, 200, 204});
  b.mesh.AddBar({w / 2 - 0.04, 0, h}, {w / 2 - 0.04, 0, h + 0.12}, 0.018, 8);
  b.mesh.AddBar({w / 2 - 0.04, 0, h + 0.11}, {w / 2 - 0.18, 0, h + 0.09}, 0.015, 8);
  return b.Finish();
}

ObjectModel MakeShower(Rng& rng) {
  ModelBuilder b("shower");
  const double s = rng.Uniform(0.8, 0.95);
  b.Colour(Pick(kPorcelains, rng));
  b.mesh.AddBox({-s / 2, -s / 2, 0}, {s / 2, s / 2, 0.08});
  b.Colour({190, 210, 216});
  b.mesh.AddBox({-s / 2, s / 2 - 0.01, 0.08}, {s / 2, s / 2, 1.95});
  b.mesh.AddBox({s / 2 - 0.01, -s / 2, 0.08}, {s / 2, s / 2 - 0.01, 1.95});
  b.Colour(Pick(kMetals, rng));
  for (double x : {-s / 2, s / 2 - 0.03}) {
    b.mesh.AddBox({x, s / 2 - 0.03, 0.08}, {x + 0.03, s / 2 + 0.005, 2.0});
  }
  b.mesh.AddBar({0, -s / 2 + 0.03, 0.9}, {0, -s / 2 + 0.03, 2.05}, 0.012, 6);
  b.mesh.AddCylinder({0, -s / 2 + 0.12, 2.02}, 0.09, 0.02, 14);
  return b.Finish();
}

ObjectModel MakeMirror(Rng& rng) {
  ModelBuilder b("mirror");
  const double w = rng.Uniform(0.45, 0.7), h = rng.Uniform(0.6, 0.9);
  b.Colour(rng.Chance(0.5) ? Pick(kMetals, rng) : Pick(kWoods, rng));
  b.mesh.AddBox({-w / 2, -0.01, 0}, {w / 2, 0.01, h});
  b.Colour({196, 206, 212});
  b.mesh.AddBox({-w / 2 + 0.03, 0.01, 0.03}, {w / 2 - 0.03, 0.014, h - 0.03});
  return b.Finish();
}

}  // namespace crossnav::world
