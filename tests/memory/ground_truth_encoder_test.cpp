// SPDX-License-Identifier: MIT
// The stand-in encoder, with which the memory's queries are tested.
#include "crossnav/sim/sensing/ground_truth_encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "crossnav/core/categories.h"
#include "support/places.h"

namespace crossnav::sim {
namespace {

// A floor of 6 x 6 m with a bed and a couch on it.
Scene MakeRoom() {
  Scene scene;
  scene.id = "room";
  scene.materials.emplace_back();
  const auto box = [&](int id, const char* name, const char* category, Vector3f lo, Vector3f hi) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    Box3 bounds;
    for (int i = 0; i < 8; ++i) {
      const Vector3f p(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
      scene.mesh.vertices.push_back(p);
      bounds.Add(p.cast<double>());
    }
    constexpr std::uint32_t kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                             {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                             {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (const auto& face : kFaces) {
      scene.mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
      scene.mesh.triangle_material.push_back(0);
      scene.mesh.triangle_instance.push_back(id);
    }
    scene.instances.push_back({id, name, category, 0, bounds});
  };
  box(1, "floor", "", {-3, -3, -0.1f}, {3, 3, 0});
  box(2, "bed", "bed", {1.5f, -2, 0}, {2.8f, 0, 0.6f});
  box(3, "couch", "sofa", {1.5f, 0.3f, 0}, {2.5f, 2, 0.6f});
  return scene;
}

class GroundTruthEncoderTest : public ::testing::Test {
 protected:
  GroundTruthEncoderTest()
      : scene_(MakeRoom()),
        navmesh_(*NavMesh::Build(scene_, {})),
        caster_(scene_),
        simulator_(scene_, navmesh_, caster_, SensorConfig{96, 96, 90, 0.88}, {}) {}

  Observation LookAt(double yaw_rad) {
    EXPECT_TRUE(simulator_.Reset({{0.4, 0, 0}, yaw_rad, -0.4}));
    return simulator_.Observe();
  }

  static GroundTruthConfig WithClip(const std::filesystem::path& dir) {
    GroundTruthConfig config;
    config.clip_dir = dir.string();
    return config;
  }
  static double Cosine(const float* a, const std::vector<float>& b) {
    double dot = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      dot += static_cast<double>(a[i]) * b[i];
      aa += static_cast<double>(a[i]) * a[i];
      bb += static_cast<double>(b[i]) * b[i];
    }
    return dot / std::sqrt(aa * bb);
  }
  static double Cosine(perception::DenseEncoder& encoder, const char* a, const char* b) {
    return Cosine(encoder.EncodeText(a)->data(), *encoder.EncodeText(b));
  }

  Scene scene_;
  NavMesh navmesh_;
  RayCaster caster_;
  Simulator simulator_;
};

TEST_F(GroundTruthEncoderTest, TextsAreUnitVectorsThatDependOnTheNameAlone) {
  const auto encoder = *MakeGroundTruthEncoder(simulator_, {}),
             another = *MakeGroundTruthEncoder(simulator_, {});
  EXPECT_EQ(encoder->Dim(), 768);
  for (const char* text : {"chair", "tv_monitor", "xylophone made of glass", ""}) {
    const auto v = encoder->EncodeText(text);
    ASSERT_TRUE(v);
    ASSERT_EQ(v->size(), 768u);
    double squared = 0;
    for (float x : *v) squared += static_cast<double>(x) * x;
    EXPECT_NEAR(squared, 1.0, 1e-5);
    EXPECT_EQ(*v, *another->EncodeText(text));
  }
  EXPECT_EQ(*encoder->EncodeText("couch"), *encoder->EncodeText("sofa"));
  EXPECT_EQ(*encoder->EncodeText("TV_Monitor "), *encoder->EncodeText("tv monitor"));
}

TEST_F(GroundTruthEncoderTest, LookAlikesLieNearerThanStrangers) {
  GroundTruthConfig config;
  const auto encoder = *MakeGroundTruthEncoder(simulator_, config);
  const double stranger = Cosine(*encoder, "bed", "toilet");
  EXPECT_NEAR(stranger, 0.5, 0.06);
  EXPECT_NEAR(Cosine(*encoder, "bed", "sofa"), 0.5 + 0.5 * config.confusion, 0.1);
  EXPECT_NEAR(Cosine(*encoder, "glass vase", "plant"), 0.5 + 0.5 * config.confusion, 0.1);
  EXPECT_NEAR(Cosine(*encoder, "wall", "floor"), 0.5, 0.06);
}

TEST_F(GroundTruthEncoderTest, CellsShowTheVisibleObjectsAndRunsRepeat) {
  const auto encoder = *MakeGroundTruthEncoder(simulator_, {});
  const Observation obs = LookAt(0);
  const auto grid = encoder->EncodeImage(obs);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->data.size(), static_cast<std::size_t>(24) * 24 * 768);
  const InstanceImage& truth = simulator_.last_frame().instance;
  int checked = 0;
  for (int r = 1; r < 23; ++r)
    for (int c = 1; c < 23; ++c) {
      std::set<int> around;
      for (int v = 4 * r - 6; v < 4 * r + 10; ++v)
        for (int u = 4 * c - 6; u < 4 * c + 10; ++u)
          if (truth.Contains(u, v)) around.insert(truth.At(u, v));
      if (around.size() != 1 || *around.begin() < 2) continue;
      const char* name = *around.begin() == 2 ? "bed" : "sofa";
      const float* cell = &grid->data[(static_cast<std::size_t>(r) * 24 + c) * 768];
      for (const char* other : {"bed", "sofa", "toilet", "floor"})
        if (std::string(other) != name) {
          EXPECT_GT(Cosine(cell, *encoder->EncodeText(name)),
                    Cosine(cell, *encoder->EncodeText(other)));
        }
      ++checked;
    }
  EXPECT_GT(checked, 4);
  EXPECT_EQ(grid->data, encoder->EncodeImage(LookAt(0))->data);
  EXPECT_EQ(grid->data, (*MakeGroundTruthEncoder(simulator_, {}))->EncodeImage(obs)->data);
}

TEST_F(GroundTruthEncoderTest, NoiseHasTheNormThatWasAskedForAndChangesWithThePose) {
  GroundTruthConfig noisy, clean;
  noisy.feature_noise = 0.5;
  clean.feature_noise = 0;
  noisy.confusion = clean.confusion = 0;
  const Observation obs = LookAt(3.0);  // floor only
  const auto a = (*MakeGroundTruthEncoder(simulator_, noisy))->EncodeImage(obs);
  const auto floor = *(*MakeGroundTruthEncoder(simulator_, clean))->EncodeText("floor");
  const InstanceImage& truth = simulator_.last_frame().instance;
  ASSERT_EQ(truth.At(48, 90), 1);
  const float* cell = &a->data[(static_cast<std::size_t>(22) * 24 + 12) * 768];
  // Bias of half and frame noise of the whole norm, against a unit vector.
  EXPECT_NEAR(Cosine(cell, floor), 1 / std::sqrt(1 + 0.5 * 0.5 + 0.25 * 0.25), 0.08);
  const auto b = (*MakeGroundTruthEncoder(simulator_, noisy))->EncodeImage(LookAt(3.01));
  EXPECT_NE(a->data, b->data);
}

TEST_F(GroundTruthEncoderTest, ObservationOfAnotherSizeIsRefused) {
  const auto encoder = *MakeGroundTruthEncoder(simulator_, {});
  Observation obs = LookAt(0);
  obs.rgb = RgbImage(10, 10);
  const auto grid = encoder->EncodeImage(obs);
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().code, ErrorCode::kMismatch);
}

TEST_F(GroundTruthEncoderTest, RealClipVectorsMakeSynonymsWork) {
  const std::filesystem::path dir = test::SharedPath("data/clip");
  if (!std::filesystem::exists(dir)) GTEST_SKIP() << "no CLIP vectors beside the project";
  const auto encoder = MakeGroundTruthEncoder(simulator_, WithClip(dir));
  ASSERT_TRUE(encoder) << encoder.error().Message();
  EXPECT_EQ((*encoder)->Dim(), 512);
  for (const char* word : {"couch", "loveseat", "sofa bed", "studio couch"})
    for (std::string_view category : kCategories) {
      const std::string other(category);
      if (other == "sofa") continue;
      EXPECT_GT(Cosine(**encoder, word, "sofa"), Cosine(**encoder, word, other.c_str())) << word;
    }
  EXPECT_NEAR(Cosine(**encoder, "couch", "gizmo that nobody knows"), 0.78, 0.1);
  EXPECT_TRUE((*encoder)->EncodeImage(LookAt(0)));
}

TEST_F(GroundTruthEncoderTest, BrokenVectorFilesAreErrorsWithTheirName) {
  const auto dir = std::filesystem::temp_directory_path() / "crossnav_clip_test";
  std::filesystem::create_directories(dir);
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(dir / name, std::ios::binary | std::ios::trunc) << bytes;
  };
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), }\n";
  std::string file = std::string("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size());
  file += '\0';
  file += header;
  const std::string good = file + std::string(64, '\x3f');
  write("oid_names.txt", "Chair\nBed\n");
  write("oid_clip_a+cname.npy", good);
  EXPECT_TRUE(MakeGroundTruthEncoder(simulator_, WithClip(dir)));
  for (std::size_t size = 0; size < good.size(); ++size) {
    write("oid_clip_a+cname.npy", good.substr(0, size));
    const auto encoder = MakeGroundTruthEncoder(simulator_, WithClip(dir));
    // Cut at a whole number of columns it reads as a narrower array.
    if (encoder) {
      EXPECT_EQ((size - file.size()) % 8, 0u);
      continue;
    }
    EXPECT_NE(encoder.error().where.find("oid_clip"), std::string::npos);
  }
  write("oid_clip_a+cname.npy", file + std::string(64, '\xff'));  // NaN
  EXPECT_FALSE(MakeGroundTruthEncoder(simulator_, WithClip(dir)));
  std::filesystem::remove_all(dir);
  EXPECT_EQ(MakeGroundTruthEncoder(simulator_, WithClip(dir)).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace crossnav::sim
