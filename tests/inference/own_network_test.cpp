// SPDX-License-Identifier: MIT
// Our networks give the same masks as the Python pipeline (make_golden.py), which its evaluation
// measures.
#include <fstream>
#include <sstream>

#include "crossnav/core/camera.h"
#include "crossnav/inference/parts.h"
#include "inference/model_files.h"
#include "support/places.h"

namespace crossnav::inference::test {
namespace {

constexpr int kSize = 256;
constexpr double kCameraHeight_m = 0.88;
constexpr double kClose = 1e-3;

/// The same picture as in make_golden.py.
Observation Picture() {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(kSize, kSize, DegToRad(90));
  obs.T_world_camera = CameraPose({}, kCameraHeight_m);
  obs.rgb = RgbImage(kSize, kSize);
  obs.depth_m = DepthImage(kSize, kSize);
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u) {
      const auto within = [&](int u0, int u1, int v0, int v1) {
        return u >= u0 && u < u1 && v >= v0 && v < v1;
      };
      double range_m =
          std::min(3.5, kCameraHeight_m * obs.camera.fy / std::max(v - obs.camera.cy, 1.0));
      Rgb8 colour{static_cast<std::uint8_t>(150 + u / 8), static_cast<std::uint8_t>(150 + v / 8),
                  140};
      const bool is_back = within(72, 182, 129, 155), is_seat = within(55, 199, 155, 163),
                 is_front = within(55, 199, 163, 198);
      if (is_back) range_m = 2.1;
      if (is_seat) range_m = 1.85;
      if (is_front) range_m = 1.6;
      if (is_back || is_front) colour = {160, 40, 40};
      if (is_seat) colour = {185, 65, 65};
      if (within(183, 234, 34, 91)) colour = {30, 60, 160};
      obs.depth_m.At(u, v) = static_cast<float>(range_m);
      obs.rgb.At(u, v) = colour;
    }
  return obs;
}

MaskImage MaskOf(std::istream& runs) {
  MaskImage mask(kSize, kSize);
  std::size_t at = 0, length = 0;
  for (std::uint8_t value = 0; runs >> length; value = value == 0 ? 1 : 0)
    for (; length > 0 && at < mask.data.size(); --length) mask.data[at++] = value;
  return mask;
}

/// Every pixel twice across and twice down.
Observation Doubled(const Observation& obs) {
  Observation out = obs;
  out.camera = IntrinsicsFromHfov(2 * kSize, 2 * kSize, DegToRad(90));
  out.rgb = RgbImage(2 * kSize, 2 * kSize);
  out.depth_m = DepthImage(2 * kSize, 2 * kSize);
  for (int v = 0; v < 2 * kSize; ++v)
    for (int u = 0; u < 2 * kSize; ++u) {
      out.rgb.At(u, v) = obs.rgb.At(u / 2, v / 2);
      out.depth_m.At(u, v) = obs.depth_m.At(u / 2, v / 2);
    }
  return out;
}

class OwnNetwork : public EachBackend {
 protected:
  void SetUp() override {
    WithBackend::SetUp();
    if (IsSkipped()) return;
    const auto root = std::filesystem::path(crossnav::test::SourcePath(""));
    const auto card = ReadModelCard(root / "networks/crossnav_small.toml");
    ASSERT_TRUE(card) << card.error().Message();
    const auto model = Open(*card, ModelsOptions());
    ASSERT_TRUE(model) << model.error().Message();
    segmenter_ = (*model)->MakeSegmenter();
  }
  std::unique_ptr<perception::Segmenter> segmenter_;
};
CROSSNAV_FOR_EACH_BACKEND(OwnNetwork);

TEST_P(OwnNetwork, MasksOfBoxesEqualThePythonPipelines) {
  const Observation obs = Picture();
  std::ifstream file(DataFile("crossnav_small.tsv"));
  int boxes = 0;
  for (std::string line; std::getline(file, line); ++boxes) {
    std::istringstream columns(line);
    perception::Detection detection;
    auto& box = detection.box;
    std::string goal;
    double quality = 0;
    columns >> box.u0 >> box.v0 >> box.u1 >> box.v1 >> goal >> quality;
    const MaskImage wanted = MaskOf(columns);
    const auto ok = segmenter_->Segment(obs, detection);
    ASSERT_TRUE(ok) << ok.error().Message();
    EXPECT_NEAR(detection.mask_quality, quality, kClose) << line.substr(0, 40);
    double both = 0, either = 0;
    for (std::size_t i = 0; i < wanted.data.size(); ++i) {
      both += detection.mask.data[i] & wanted.data[i];
      either += detection.mask.data[i] | wanted.data[i];
    }
    EXPECT_GE(both + kClose * either, either) << line.substr(0, 40);
  }
  EXPECT_EQ(boxes, 4);
}

TEST_P(OwnNetwork, MasksFollowTheFramesSize) {
  const Observation small = Picture(), large = Doubled(small);
  perception::Detection one, two;
  one.box = {60, 66, 150, 200};
  two.box = {120, 132, 300, 400};
  ASSERT_TRUE(segmenter_->Segment(small, one));
  ASSERT_TRUE(segmenter_->Segment(large, two));
  int wrong = 0, filled = 0;
  for (int v = 0; v < 2 * kSize; ++v)
    for (int u = 0; u < 2 * kSize; ++u) {
      filled += two.mask.At(u, v);
      wrong += two.mask.At(u, v) != one.mask.At(u / 2, v / 2);
    }
  EXPECT_GT(filled, 5000);
  EXPECT_LT(wrong, filled / 4);  // the network's edges follow the sampling of another grid
}

TEST_P(OwnNetwork, TheSameFrameGivesTheSameBits) {
  std::vector<float> first;
  for (int again = 0; again < 2; ++again) {
    const auto card = ReadModelCard(crossnav::test::SourcePath("networks/crossnav_small.toml"));
    ASSERT_TRUE(card);
    const auto model = Open(*card, ModelsOptions());
    ASSERT_TRUE(model);
    const auto grid = (*model)->MakeEncoder()->EncodeImage(Picture());
    ASSERT_TRUE(grid) << grid.error().Message();
    EXPECT_GT(grid->data.size(), 1000U);
    if (again == 0) first = grid->data;
    EXPECT_EQ(grid->data, first);
  }
}

}  // namespace
}  // namespace crossnav::inference::test
