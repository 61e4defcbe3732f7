// SPDX-License-Identifier: MIT
// Two detectors as one, with stand-in networks.
#include "crossnav/inference/second_opinion.h"

#include <cmath>

#include "crossnav/inference/sha256.h"
#include "crossnav/inference/suite.h"
#include "inference/model_files.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;
using crossnav::test::ReadText;
using crossnav::test::TempFolder;
using crossnav::test::WriteText;
using perception::Detection;
using perception::PixelBox;

enum Label { kChair, kCouch, kBench };

class FirstDetector : public perception::Detector {
 public:
  explicit FirstDetector(std::vector<Detection>* found) : found_(found) {}
  Result<std::vector<Detection>> Detect(const Observation& /*obs*/,
                                        std::string_view /*goal*/) override {
    return *found_;
  }

 private:
  std::vector<Detection>* found_;
};

/// Marks the box, to tell it from the depth segmenter.
class FirstSegmenter : public perception::Segmenter {
 public:
  Result<void> Segment(const Observation& /*obs*/, Detection& detection) override {
    detection.mask_quality = 0.123F;
    return {};
  }
};

class SecondModel : public Model {
 public:
  Result<std::vector<FoundBox>> DetectAll(const Observation& /*obs*/, double least) override {
    ++runs;
    std::vector<FoundBox> out;
    for (const FoundBox& box : boxes)
      if (box.score >= least) out.push_back(box);
    return out;
  }
  std::vector<FoundBox> boxes;
  int runs = 0;
};

class SecondOpinion : public ::testing::Test {
 protected:
  static ModelCard Card() {
    ModelCard card;
    card.labels = {"chair", "couch", "bench"};
    card.opinion = {0.5, 0.2, -1, {-1, -2, -1}};
    return card;
  }
  DetectorPair Make(int every) {
    return MakeDetectorPair(std::make_unique<FirstDetector>(&first_),
                            std::make_unique<FirstSegmenter>(), second_, Card(), every);
  }
  /// Frame `i` of many that differ.
  static Observation Frame(int i = 0) {
    Observation obs;
    obs.rgb = RgbImage(64, 64, Rgb8{static_cast<std::uint8_t>(i), 120, 30});
    obs.depth_m = DepthImage(64, 64, 2.0F);
    return obs;
  }
  std::vector<Detection> first_;
  std::shared_ptr<SecondModel> second_ = std::make_shared<SecondModel>();
};

double LogOdds(double p) {
  return std::log(p / (1 - p));
}

TEST_F(SecondOpinion, AddsLogOddsOfTheGoalAndTakesThoseOfARival) {
  const ModelCard::Opinion opinion = Card().opinion;
  const double agreed = FusedConfidence(0.7, 0.6, 0, kChair, opinion);
  EXPECT_NEAR(LogOdds(agreed), LogOdds(0.7) + 0.5 * (LogOdds(0.6) - LogOdds(0.05)) + 0.2, 1e-9);
  const double silent = FusedConfidence(0.7, 0, 0, kChair, opinion);
  EXPECT_NEAR(LogOdds(silent), LogOdds(0.7) + 0.2, 1e-9);
  EXPECT_LT(FusedConfidence(0.7, 0, 0.6, kChair, opinion), silent);
  EXPECT_NEAR(FusedConfidence(0.7, 0.6, 0.6, kChair, opinion), silent, 1e-9);
  // Without a box of the first: by the label's own number.
  EXPECT_NEAR(LogOdds(FusedConfidence(std::nullopt, 0.05, 0, kCouch, opinion)), -2 + 0.2, 1e-9);
}

TEST_F(SecondOpinion, CorrectsTheBoxOfTheSameThingOnly) {
  first_ = {{{0, 0, 20, 20}, 0.7F, {}, 0}, {{40, 40, 60, 60}, 0.7F, {}, 0}};
  second_->boxes = {{1, 0, 20, 21, 0.8, kChair, 0}, {39, 40, 60, 60, 0.8, kBench, 1}};
  const DetectorPair pair = Make(1);
  const auto found = pair.detector->Detect(Frame(), "chair");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);  // the bench is no chair
  EXPECT_GT((*found)[0].confidence, 0.8F);
  EXPECT_LT((*found)[1].confidence, 0.5F);
  // No label for the goal: the first alone, and the second is not asked.
  second_->runs = 0;
  EXPECT_FLOAT_EQ(pair.detector->Detect(Frame(1), "lamp").value().at(0).confidence, 0.7F);
  EXPECT_EQ(second_->runs, 0);
}

TEST_F(SecondOpinion, BoxesOfTheSecondAloneHaveTheirMaskFromDepth) {
  second_->boxes = {{10, 10, 50, 50, 0.9, kChair, 0}, {0, 0, 9, 9, 0.07, kChair, 1}};
  first_ = {{{0, 30, 9, 60}, 0.7F, {}, 0}};
  const DetectorPair pair = Make(1);
  auto found = pair.detector->Detect(Frame(), "chair");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);  // the score of .07 says nothing
  EXPECT_EQ((*found)[1].box, (PixelBox{10, 10, 50, 50}));
  for (Detection& detection : *found) ASSERT_TRUE(pair.segmenter->Segment(Frame(), detection));
  EXPECT_FLOAT_EQ((*found)[0].mask_quality, 0.123F);
  EXPECT_GT((*found)[1].mask_quality, 0.9F);
}

TEST_F(SecondOpinion, RunsOnceAFrameAndRarelyWhereTheFirstHasNothing) {
  const DetectorPair pair = Make(4);
  constexpr int kFrames = 200;
  for (int i = 0; i < kFrames; ++i)
    for (const char* goal : {"chair", "sofa"}) ASSERT_TRUE(pair.detector->Detect(Frame(i), goal));
  EXPECT_GT(second_->runs, kFrames / 8);
  EXPECT_LT(second_->runs, kFrames / 2);
  first_ = {{{0, 0, 20, 20}, 0.7F, {}, 0}};
  second_->runs = 0;
  for (int i = 0; i < kFrames; ++i)
    for (const char* goal : {"chair", "sofa"}) ASSERT_TRUE(pair.detector->Detect(Frame(i), goal));
  EXPECT_EQ(second_->runs, kFrames);
}

TEST(SecondOpinionCard, NumbersOfLabelsHaveTheSectionsAsDefault) {
  const TempFolder folder;
  const fs::path path = folder.path() / "detr.toml";
  const std::string card =
      "family = \"detr\"\nlabels = [\"chair\", \"potted plant\"]\n[input]\nsize = 8\n";
  WriteText(path, card);
  EXPECT_FALSE(ReadModelCard(path)->opinion.weight);
  WriteText(path, card +
                      "[opinion]\nweight = 0.3\nunseen = -1.5\n"
                      "[opinion.unseen_of]\n\"potted plant\" = -0.4\n");
  const auto read = ReadModelCard(path);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->opinion.unseen_of, (std::vector<double>{-1.5, -0.4}));
  WriteText(path, card + "[opinion]\nweight = 0.3\n[opinion.unseen_of]\nsofa = -0.4\n");
  const auto unknown = ReadModelCard(path);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().Message().find("unseen_of.sofa"), std::string::npos)
      << unknown.error().Message();
}

TEST(SecondOpinionSuite, NeedsTheNumbersAndAFamilyThatGivesAllBoxes) {
  const TempFolder folder;
  fs::copy_file(DataFile("detr.onnx"), folder.path() / "detr.onnx");
  const std::string card = "family = \"detr\"\nsha256 = \"" +
                           Sha256(ReadText(folder.path() / "detr.onnx")) +
                           "\"\nlabels = [\"chair\", \"couch\", \"tv\"]\n[input]\nsize = 8\n";
  WriteText(folder.path() / "detr.toml", card);
  NetworksConfig config;
  config.detector = config.second_detector = "detr";
  config.segmenter = "depth";
  config.stairs = config.encoder = "";
  const auto without = NetworkSet::Read(config, folder.path());
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().Message().find("opinion.weight"), std::string::npos);
  WriteText(folder.path() / "detr.toml", card + "[opinion]\nweight = 0.3\n");
  auto set = NetworkSet::Read(config, folder.path());
  EXPECT_TRUE(set) << set.error().Message();

  std::string other = card;
  other.replace(other.find("detr"), 4, "yolov8");
  WriteText(folder.path() / "yolo.toml", "file = \"detr.onnx\"\n" + other);
  config.second_detector = "yolo";
  const auto refused = NetworkSet::Read(config, folder.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().Message().find("networks.second_detector"), std::string::npos)
      << refused.error().Message();
}

}  // namespace
}  // namespace crossnav::inference::test
