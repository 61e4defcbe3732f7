// SPDX-License-Identifier: MIT
// The adapter of our network, on a small network that sees goals as colours (make_models.py).
#include "crossnav/core/camera.h"
#include "crossnav/inference/suite.h"
#include "inference/small_network.h"

namespace crossnav::inference::test {
namespace {

using crossnav::test::TempFolder;
using crossnav::test::WriteText;

class CrossnavFamily : public WithBackend {
 protected:
  void SetUp() override {
    WithBackend::SetUp();
    config_ = WriteSmallNetwork(folder_.path());
    obs_.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
    obs_.rgb = RgbImage(64, 64);
    obs_.depth_m = DepthImage(64, 64, 1.0F);
    obs_.T_world_camera = CameraPose({}, 0.88);
  }
  void Write(const std::string& card) { WriteText(folder_.path() / "small.toml", card); }
  std::string ErrorOf() {
    auto set = NetworkSet::Read(config_, folder_.path());
    if (!set) return set.error().Message();
    const auto suite = set->MakeSuite(0.88);
    return suite ? "no error" : suite.error().Message();
  }
  void Paint(int u0, int v0, int u1, int v1, Rgb8 colour) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) obs_.rgb.At(u, v) = colour;
  }
  TempFolder folder_;
  NetworksConfig config_;
  Observation obs_;
};

TEST_F(CrossnavFamily, FindsBoxAndMaskOfTheGoalOnly) {
  auto set = NetworkSet::Read(config_, folder_.path());
  ASSERT_TRUE(set) << set.error().Message();
  auto suite = set->MakeSuite(0.88);
  ASSERT_TRUE(suite) << suite.error().Message();
  Paint(16, 16, 24, 24, {255, 0, 0});  // one cell of chair: input px 8..12
  Paint(40, 40, 48, 48, {0, 0, 255});
  const auto seen = suite->Look(obs_, "chair");
  ASSERT_TRUE(seen) << seen.error().Message();
  ASSERT_EQ(seen->detections.size(), 1U);
  const auto& chair = seen->detections[0];
  // centre 10 in the input, 6 to either side, twice as large in the frame
  EXPECT_EQ(chair.box.u0, 8);
  EXPECT_EQ(chair.box.v1, 32);
  EXPECT_NEAR(chair.confidence, 1, 0.05);
  EXPECT_EQ(chair.mask.At(19, 19), 1);
  EXPECT_EQ(chair.mask.At(10, 10), 0);
  EXPECT_GT(chair.mask_quality, 0.5F);
  const auto plants = suite->Look(obs_, "plant");  // through the table of names
  ASSERT_EQ(plants->detections.size(), 1U);
  EXPECT_EQ(plants->detections[0].mask.At(43, 43), 1);
  EXPECT_TRUE(suite->Look(obs_, "bed")->detections.empty());
}

TEST_F(CrossnavFamily, GivesStairsAndFeaturesInTheSpaceOfItsTable) {
  auto set = NetworkSet::Read(config_, folder_.path());
  auto suite = set->MakeSuite(0.5);
  ASSERT_TRUE(suite) << suite.error().Message();
  Paint(0, 0, 16, 16, {0, 255, 0});
  const auto seen = suite->Look(obs_, "chair");
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->stair_probability.At(32, 31), 0.5, 0.1);  // the height of a level camera
  EXPECT_EQ(seen->features.rows, 4);
  EXPECT_EQ(seen->features.dim, 4);
  EXPECT_NEAR(seen->features.data[1], 1, 1e-5);      // green
  EXPECT_NEAR(seen->features.data[3], 1, 1e-5);      // depth
  EXPECT_NEAR(seen->features.data[4 + 1], 0, 1e-5);  // the cell to its right
  EXPECT_EQ(suite->encoder->Dim(), 4);
  EXPECT_EQ(*suite->encoder->EncodeText("bed"), (std::vector<float>{0, 1, 0, 0}));
  EXPECT_EQ(*suite->encoder->EncodeText("potted plant"), (std::vector<float>{0, 0, 1, 0}));
  EXPECT_EQ(*suite->encoder->EncodeText("wall"), (std::vector<float>{0, 0, 0, 1}));
  EXPECT_NE(suite->encoder->EncodeText("anvil").error().Message().find("no vector for \"anvil\""),
            std::string::npos);
  EXPECT_EQ(suite->encoder->Name(), set->encoder_name());
}

TEST_F(CrossnavFamily, AFrameThatChangedInPlaceIsSeenAnew) {
  auto set = NetworkSet::Read(config_, folder_.path());
  auto suite = set->MakeSuite(0.88);
  ASSERT_TRUE(suite);
  EXPECT_TRUE(suite->Look(obs_, "chair")->detections.empty());
  Paint(16, 16, 24, 24, {255, 0, 0});
  EXPECT_EQ(suite->Look(obs_, "chair")->detections.size(), 1U);
  const float before = suite->stairs->SegmentStairs(obs_)->At(0, 0);
  obs_.depth_m = DepthImage(64, 64, 0.5F);
  EXPECT_NE(suite->stairs->SegmentStairs(obs_)->At(0, 0), before);
}

TEST_F(CrossnavFamily, SaysWhichGoalsItKnows) {
  auto set = NetworkSet::Read(config_, folder_.path());
  auto suite = set->MakeSuite(0.88);
  ASSERT_TRUE(suite);
  const auto seen = suite->Look(obs_, "anvil");
  ASSERT_FALSE(seen);
  EXPECT_NE(seen.error().Message().find(
                "has no class for the goal \"anvil\"; it knows chair, bed, potted plant"),
            std::string::npos);
}

TEST_F(CrossnavFamily, ADepthClusterCanMakeTheMask) {
  config_.segmenter = "depth";
  auto set = NetworkSet::Read(config_, folder_.path());
  ASSERT_TRUE(set);
  auto suite = set->MakeSuite(0.88);
  ASSERT_TRUE(suite);
  Paint(16, 16, 24, 24, {255, 0, 0});
  const auto seen = suite->Look(obs_, "chair");
  ASSERT_EQ(seen->detections.size(), 1U);
  EXPECT_EQ(seen->detections[0].mask.At(9, 9), 1);  // a wall fills the whole box
}

TEST_F(CrossnavFamily, MismatchesWithTheCardAreNamed) {
  EXPECT_EQ(ErrorOf(), "no error");
  std::string card = SmallCard();
  Write(card.replace(card.find("size = 32"), 9, "size = 64"));
  EXPECT_NE(ErrorOf().find("small.onnx: "), std::string::npos) << ErrorOf();
  card = SmallCard();
  Write(card.replace(card.find("\"bed\", "), 7, ""));
  EXPECT_NE(ErrorOf().find("output \"heat\" is 1x6x8x8, and its card asks for 1x5x8x8"),
            std::string::npos)
      << ErrorOf();
  card = SmallCard();
  Write(card.replace(card.find("dim = 4"), 7, "dim = 5"));
  EXPECT_NE(ErrorOf().find("holds vectors of 4 numbers"), std::string::npos) << ErrorOf();
  Write(std::string("sha256 = \"") + std::string(64, '0') + "\"\n" + kCardWithoutHash);
  EXPECT_NE(ErrorOf().find("is not the file"), std::string::npos) << ErrorOf();
  Write(std::string("decoder = \"nowhere.onnx\"\n") + SmallCard());
  EXPECT_NE(ErrorOf().find("nowhere.onnx"), std::string::npos) << ErrorOf();
  Write("decoder = \"small.onnx\"\ndecoder_" + SmallCard());
  EXPECT_NE(ErrorOf().find("key \"sha256\" is missing; of the file as it is, it is \""),
            std::string::npos)
      << ErrorOf();
  Write("decoder = \"small.onnx\"\n" + SmallCard());
  EXPECT_NE(ErrorOf().find("key \"decoder_sha256\" is missing"), std::string::npos) << ErrorOf();
  const std::string hash = SmallCard().substr(0, SmallCard().find('\n') + 1);
  Write("decoder = \"small.onnx\"\ndecoder_" + hash + SmallCard());  // another network
  EXPECT_NE(ErrorOf().find("has no input \"share\""), std::string::npos) << ErrorOf();
  Write(SmallCard());
  config_.stairs = "none";
  EXPECT_NE(ErrorOf().find("needed by networks.stairs"), std::string::npos) << ErrorOf();
}

}  // namespace
}  // namespace crossnav::inference::test
