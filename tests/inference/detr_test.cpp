// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/inference/parts.h"
#include "crossnav/sim/scene/image_codec.h"
#include "inference/model_files.h"
#include "support/places.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSmall = R"(family = "detr"
labels = ["chair", "couch", "tv"]
[input]
size = 8
[thresholds]
score = 0.2
)";

class DetrFamily : public WithBackend {};

TEST_F(DetrFamily, GivesTheGoalsBoxesInTheFrameOncePerObject) {
  const crossnav::test::TempFolder folder;
  crossnav::test::WriteText(folder.path() / "detr.toml", kSmall);
  fs::copy_file(DataFile("detr.onnx"), folder.path() / "detr.onnx");
  const auto card = ReadModelCard(folder.path() / "detr.toml");
  ASSERT_TRUE(card);
  const auto model = Open(*card, {});
  ASSERT_TRUE(model) << model.error().Message();
  const auto detector = (*model)->MakeDetector();
  Observation obs;
  obs.rgb = RgbImage(200, 100, Rgb8{255, 255, 255});
  const auto sofas = detector->Detect(obs, "sofa");
  ASSERT_TRUE(sofas) << sofas.error().Message();
  ASSERT_EQ(sofas->size(), 1U);  // the second box is the same object
  EXPECT_EQ((*sofas)[0].box.u0, 20);
  EXPECT_EQ((*sofas)[0].box.u1, 100);
  EXPECT_EQ((*sofas)[0].box.v1, 50);
  EXPECT_FLOAT_EQ((*sofas)[0].confidence, 0.9F);
  EXPECT_EQ((*detector->Detect(obs, "tv_monitor"))[0].box.v1, 100);  // clipped to the frame
  EXPECT_EQ(detector->Detect(obs, "chair")->size(), 1U);
  EXPECT_FALSE(detector->Detect(obs, "bed"));
  EXPECT_EQ((*model)->MakeEncoder(), nullptr);
}

/// Result of the Python reference (Pillow, ONNX Runtime) for a goal in docs/images/home.png.
struct DetrGolden {
  const char *network, *goal;
  double score, left, top, right, bottom;
};

class SharedDetector : public WithBackend, public ::testing::WithParamInterface<DetrGolden> {};

TEST_P(SharedDetector, GivesTheBoxesOfThePythonReference) {
  const DetrGolden golden = GetParam();
  const fs::path root = crossnav::test::SourcePath("");
  auto card = ReadModelCard(root / "networks" / (std::string(golden.network) + ".toml"));
  ASSERT_TRUE(card) << card.error().Message();
  card->file = fs::path(crossnav::test::SharedPath("data/models")) / card->file.filename();
  if (!fs::exists(card->file)) GTEST_SKIP() << card->file << " is not here";
  const auto bytes = *ReadFile(root / "docs/images/home.png");
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto picture = sim::DecodeImage({data, bytes.size()}, "home.png");
  ASSERT_TRUE(picture);
  Observation obs;
  obs.rgb = picture->rgb;
  for (const std::string& backend : BuiltBackends()) {
    ModelOptions options;
    options.session.backend = backend;
    const auto model = Open(*card, options);
    ASSERT_TRUE(model) << model.error().Message();
    const auto found = (*model)->MakeDetector()->Detect(obs, golden.goal);
    ASSERT_TRUE(found) << found.error().Message();
    ASSERT_GE(found->size(), 1U);
    const auto& best = found->front();
    EXPECT_NEAR(best.confidence, golden.score, 0.01) << backend;  // Pillow rounds to bytes between
    EXPECT_NEAR(best.box.u0, golden.left, 1) << backend;
    EXPECT_NEAR(best.box.v0, golden.top, 1) << backend;
    EXPECT_NEAR(best.box.u1, golden.right, 1) << backend;
    EXPECT_NEAR(best.box.v1, golden.bottom, 1) << backend;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Deim, SharedDetector,
    ::testing::Values(DetrGolden{"deimv2_atto_coco", "plant", 0.690, 276.7, 295.6, 325.1, 375.4},
                      DetrGolden{"deimv2_atto_coco", "sofa", 0.504, 373.8, 321.4, 541.3, 392.9},
                      DetrGolden{"deimv2_femto_coco", "sofa", 0.758, 373.2, 319.1, 542.6, 394.3},
                      DetrGolden{"deimv2_femto_coco", "plant", 0.604, 279.4, 297.2, 324.7, 375.8}));

}  // namespace
}  // namespace crossnav::inference::test
