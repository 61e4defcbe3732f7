// SPDX-License-Identifier: MIT
// YOLOv7 for its classes and YOLO-World for the rest, with stand-in networks.
#include "crossnav/inference/detector_by_goal.h"

#include "crossnav/inference/boxes.h"
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

/// Knows one goal; its only detection has `confidence`.
class Knows : public perception::Detector {
 public:
  Knows(std::string goal, float confidence) : goal_(std::move(goal)), confidence_(confidence) {}
  Result<std::vector<Detection>> Detect(const Observation&, std::string_view goal) override {
    ++asked;
    if (goal == "broken") return Fail(ErrorCode::kInvalid, "cannot run", goal_);
    if (goal != goal_) return NoSuchLabel(goal, ModelCard{});
    return std::vector<Detection>{{{0, 0, 4, 4}, confidence_, {}, 0}};
  }
  int asked = 0;

 private:
  std::string goal_;
  float confidence_;
};

TEST(DetectorByGoal, TheFirstThatHasTheGoalAnswersAndNoOtherIsAsked) {
  std::vector<std::unique_ptr<perception::Detector>> parts;
  auto coco = std::make_unique<Knows>("chair", 0.8F), open = std::make_unique<Knows>("lamp", 0.3F);
  const Knows &first = *coco, &second = *open;
  parts.push_back(std::move(coco));
  parts.push_back(std::move(open));
  const auto both = MakeDetectorByGoal(std::move(parts));
  EXPECT_FLOAT_EQ(both->Detect({}, "chair").value().at(0).confidence, 0.8F);
  EXPECT_EQ(second.asked, 0);
  EXPECT_FLOAT_EQ(both->Detect({}, "lamp").value().at(0).confidence, 0.3F);
  EXPECT_EQ(both->Detect({}, "piano").error().code, ErrorCode::kUnsupported);
  // An error that is not about labels is not hidden by the next detector.
  const int before = second.asked;
  EXPECT_EQ(both->Detect({}, "broken").error().code, ErrorCode::kInvalid);
  EXPECT_EQ(second.asked, before);
  EXPECT_EQ(first.asked, 4);
  EXPECT_EQ(MakeDetectorByGoal({}), nullptr);
}

class PaperDetectors : public EachBackend {
 protected:
  void SetUp() override {
    EachBackend::SetUp();
    fs::copy(DataFile("paper"), folder_.path() / "paper");
    fs::copy(DataFile("tokens"), folder_.path() / "tokens");
    for (const char* name : {"yolov7", "yolo_world_open", "clip_text"}) AddHash(name);
    config_.detector = "yolov7, yolo_world_open";
    config_.segmenter = "depth";
    config_.stairs = config_.encoder = "";
    config_.backend = GetParam();
  }
  fs::path At(const std::string& name) const { return folder_.path() / "paper" / name; }

  /// Cards of the test's data have no hashes.
  void AddHash(const std::string& name) const {
    const std::string hash = "sha256 = \"" + Sha256(ReadText(At(name + ".onnx"))) + "\"\n";
    if (name != "clip_text") {
      WriteText(At(name + ".toml"), hash + ReadText(At(name + ".toml")));
      return;
    }
    std::string card = ReadText(At("yolo_world_open.toml"));
    card.insert(card.find("[text]\n") + 7, hash);
    WriteText(At("yolo_world_open.toml"), card);
  }
  /// YOLOv7's classes get other names, so that "bed" is no class of it.
  void RenameBed() const {
    std::string card = ReadText(At("yolov7.toml"));
    card.replace(card.find("\"bed\""), 5, "\"boat\"");
    WriteText(At("yolov7.toml"), card);
  }
  static Observation Picture() {
    Observation obs;
    obs.rgb = RgbImage(64, 64, Rgb8{90, 120, 30});
    obs.depth_m = DepthImage(64, 64, 2.0F);
    return obs;
  }
  std::vector<float> Confidences(const std::string& detector, const char* goal) const {
    NetworksConfig config = config_;
    config.detector = detector;
    auto set = NetworkSet::Read(config, At(""));
    EXPECT_TRUE(set) << set.error().Message();
    auto suite = set->MakeSuite(0.88);
    EXPECT_TRUE(suite) << suite.error().Message();
    const auto found = suite->detector->Detect(Picture(), goal);
    EXPECT_TRUE(found) << found.error().Message();
    std::vector<float> all;
    for (const Detection& d : *found) all.push_back(d.confidence);
    return all;
  }
  TempFolder folder_;
  NetworksConfig config_;
};

CROSSNAV_FOR_EACH_BACKEND(PaperDetectors);

TEST_P(PaperDetectors, ClassesAreYoloV7sAndOtherGoalsYoloWorlds) {
  RenameBed();
  const std::string both = "yolov7, yolo_world_open";
  for (const char* goal : {"chair", "bed", "floor lamp"}) {
    const bool is_class = goal == std::string("chair");
    const auto expected = Confidences(is_class ? "yolov7" : "yolo_world_open", goal);
    ASSERT_FALSE(expected.empty()) << goal;
    EXPECT_EQ(Confidences(both, goal), expected) << goal;
  }
  EXPECT_NE(Confidences("yolov7", "chair"), Confidences("yolo_world_open", "chair"));
}

TEST_P(PaperDetectors, BothFilesAreInTheHashesAndAnEmptyNameIsAnError) {
  auto set = NetworkSet::Read(config_, At(""));
  ASSERT_TRUE(set) << set.error().Message();
  EXPECT_EQ(set->hashes().count("yolov7"), 1U);
  EXPECT_EQ(set->hashes().count("yolo_world_open"), 1U);
  config_.detector = "yolov7,";
  set = NetworkSet::Read(config_, At(""));
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().Message().find("networks.detector"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::inference::test
