// SPDX-License-Identifier: MIT
// Clutter: small objects that are no goals, on tops and on the floor.
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {

ObjectModel MakeVase(Rng& rng) {
  ModelBuilder b("vase");
  const double h = rng.Uniform(0.16, 0.3), r = rng.Uniform(0.045, 0.07);
  b.Colour(Pick(kPots, rng));
  b.mesh.AddFrustum({0, 0, 0}, 0.6 * r, r, 0.45 * h, 14);
  b.mesh.AddFrustum({0, 0, 0.45 * h}, r, 0.45 * r, 0.4 * h, 14);
  b.mesh.AddFrustum({0, 0, 0.85 * h}, 0.45 * r, 0.65 * r, 0.15 * h, 14);
  return b.Finish();
}

ObjectModel MakeBowl(Rng& rng) {
  ModelBuilder b("bowl");
  const double r = rng.Uniform(0.09, 0.15);
  b.Colour(Pick(kPots, rng));
  b.mesh.AddFrustum({0, 0, 0}, 0.5 * r, r, 0.07, 16);
  b.Colour({196, 120, 50});
  for (int i = 0; i < 4; ++i) {
    b.mesh.AddEllipsoid({0.04 * (i % 2 ? 1 : -1), 0.04 * (i / 2 ? 1 : -1), 0.08},
                        {0.04, 0.04, 0.04}, 8);
  }
  return b.Finish();
}

ObjectModel MakeBooks(Rng& rng) {
  ModelBuilder b("book");
  double z = 0;
  for (int i = rng.Int(1, 4); i > 0; --i) {
    b.Colour(Pick(kFabrics, rng));
    const double w = rng.Uniform(0.07, 0.1), d = rng.Uniform(0.1, 0.14),
                 h = rng.Uniform(0.02, 0.04);
    b.mesh.AddBox({-w, -d, z}, {w, d, z + h});
    z += h;
  }
  return b.Finish();
}

ObjectModel MakeTableLamp(Rng& rng) {
  ModelBuilder b("table lamp");
  const double h = rng.Uniform(0.32, 0.5);
  b.Colour(rng.Chance(0.5) ? Pick(kPots, rng) : Pick(kMetals, rng));
  b.mesh.AddFrustum({0, 0, 0}, 0.07, 0.05, 0.03, 14);
  b.mesh.AddFrustum({0, 0, 0.03}, 0.03, 0.02, h - 0.2, 10);
  b.Colour({242, 232, 206});
  b.mesh.AddFrustum({0, 0, h - 0.18}, 0.13, 0.08, 0.18, 16);
  return b.Finish();
}

ObjectModel MakeCardboardBox(Rng& rng) {
  ModelBuilder b("box");
  const double w = rng.Uniform(0.15, 0.3), d = rng.Uniform(0.15, 0.25), h = rng.Uniform(0.2, 0.45);
  b.Colour(Shade({176, 138, 96}, rng.Uniform(0.85, 1.1)));
  b.mesh.AddBox({-w, -d, 0}, {w, d, h});
  b.Colour({150, 112, 74});
  b.mesh.AddBox({-w, -0.03, h}, {w, 0.03, h + 0.002});
  b.SetTop(h);
  return b.Finish();
}

ObjectModel MakeBin(Rng& rng) {
  ModelBuilder b("trash can");
  b.Colour(rng.Chance(0.5) ? Pick(kMetals, rng) : Pick(kFabrics, rng));
  b.mesh.AddFrustum({0, 0, 0}, 0.1, 0.13, rng.Uniform(0.28, 0.4), 16);
  return b.Finish();
}

ObjectModel MakeBasket(Rng& rng) {
  ModelBuilder b("basket");
  b.Colour(Shade({168, 130, 84}, rng.Uniform(0.8, 1.15)));
  b.mesh.AddFrustum({0, 0, 0}, 0.17, 0.22, rng.Uniform(0.3, 0.5), 16);
  return b.Finish();
}

ObjectModel MakeOttoman(Rng& rng) {
  ModelBuilder b("ottoman");
  const double r = rng.Uniform(0.24, 0.34);
  b.Colour(Pick(kFabrics, rng));
  b.mesh.AddCushion({-r, -r, 0.03}, {r, r, rng.Uniform(0.36, 0.44)}, 0.06);
  return b.Finish();
}

ObjectModel MakeCeilingLamp(Rng& rng) {
  ModelBuilder b("ceiling lamp");  // origin at the ceiling, hangs down
  const double drop = rng.Uniform(0.1, 0.4), r = rng.Uniform(0.12, 0.22);
  b.Colour(Pick(kMetals, rng));
  b.mesh.AddCylinder({0, 0, -drop}, 0.01, drop, 6);
  b.Colour({246, 240, 220});
  b.mesh.AddFrustum({0, 0, -drop - 0.14}, r, 0.5 * r, 0.14, 18);
  return b.Finish();
}

ObjectModel MakeCurtain(Rng& rng) {
  ModelBuilder b("curtain");
  const Rgb8 fabric = rng.Chance(0.5) ? Pick(kLinens, rng) : Pick(kFabrics, rng);
  const double h = 2.0;
  for (int i = 0; i < 6; ++i) {
    b.Colour(Shade(fabric, i % 2 == 0 ? 1.0 : 0.88));
    b.mesh.AddBox({-0.18 + 0.06 * i, -0.03, 0}, {-0.12 + 0.06 * i, i % 2 == 0 ? 0.03 : 0.01, h});
  }
  return b.Finish();
}

}  // namespace crossnav::world
