// SPDX-License-Identifier: MIT
// A generated house with .basis textures looks like its twin with PNG textures.
#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/core/observation.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/write_file.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/house/house_generator.h"
#include "support/basis_twin.h"
#include "support/temp_folder.h"

namespace crossnav::world {
namespace {

namespace fs = std::filesystem;

/// Sum of squared differences and number of channels.
void Compare(const RgbImage& a, const RgbImage& b, double& squares, double& channels) {
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    for (const int d :
         {a.data[i].r - b.data[i].r, a.data[i].g - b.data[i].g, a.data[i].b - b.data[i].b}) {
      squares += d * d;
      channels += 1;
    }
  }
}

TEST(BasisHouse, RendersLikeItsTwinWithPngTextures) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 3;
  params.floors = 1;
  params.area_m2 = 60;
  const auto house = GenerateHouse(params, dir.path());
  ASSERT_TRUE(house.has_value()) << house.error().Message();
  const auto png = sim::LoadScene(house->folder);
  ASSERT_TRUE(png.has_value()) << png.error().Message();

  const fs::path plain = house->folder / (house->scene_id.substr(6) + ".glb");
  int images = 0;
  const std::string twin = test::BasisTwin(ReadFile(plain).value(), &images);
  ASSERT_GT(images, 2);
  ASSERT_TRUE(WriteFileAtomically(fs::path(plain).replace_extension(".basis.glb"), twin));
  // The file with pictures that need no transcoder is preferred where both are there.
  EXPECT_EQ(sim::LoadScene(house->folder)->textures.at(0).rgb.data, png->textures.at(0).rgb.data);
  fs::remove(plain);
  const auto basis = sim::LoadScene(house->folder);
  ASSERT_TRUE(basis.has_value()) << basis.error().Message();
  EXPECT_EQ(basis->notes, std::vector<std::string>());
  ASSERT_EQ(basis->textures.size(), png->textures.size());
  EXPECT_EQ(basis->mesh_hash, png->mesh_hash);

  const auto navmesh = sim::NavMesh::Build(*png, {});
  ASSERT_TRUE(navmesh.has_value());
  const sim::RayCaster caster_png(*png), caster_basis(*basis);
  Rng rng(1);
  double squares = 0, channels = 0;
  for (int i = 0; i < 12; ++i) {
    const AgentPose pose{navmesh->RandomPoint(rng).value(), rng.Uniform(0, 6.28), 0};
    const auto camera = IntrinsicsFromHfov(160, 160, DegToRad(90));
    Compare(caster_png.Render(camera, CameraPose(pose, 0.88)).rgb,
            caster_basis.Render(camera, CameraPose(pose, 0.88)).rgb, squares, channels);
  }
  EXPECT_GT(squares, 0);
  const double psnr_db = 10 * std::log10(255 * 255 / (squares / channels));
  RecordProperty("psnr_db", std::to_string(psnr_db));
  EXPECT_GE(psnr_db, 32);
}

}  // namespace
}  // namespace crossnav::world
