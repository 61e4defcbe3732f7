// SPDX-License-Identifier: MIT
// Each adapter against PyTorch, on the architectures of the paper with random weights: small
// networks in data/paper, or networks of networks/paper/reference.py --full in
// $CROSSNAV_PAPER_NETWORKS.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "crossnav/inference/parts.h"
#include "crossnav/inference/text_encoder.h"
#include "inference/model_files.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;
constexpr double kClosePaper = 1e-3;

fs::path Folder() {
  const char* own = std::getenv("CROSSNAV_PAPER_NETWORKS");
  return own != nullptr ? fs::path(own) : DataFile("paper");
}

/// The same numbers as networks/paper/reference.py draws.
Observation Picture(int size) {
  Observation obs;
  obs.rgb = RgbImage(size, size);
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u)
      obs.rgb.At(u, v) = {static_cast<std::uint8_t>((7 * u + 3 * v) % 256),
                          static_cast<std::uint8_t>(u * v / 8 % 256),
                          static_cast<std::uint8_t>((u * u / 16 + 5 * v) % 256)};
  obs.depth_m = DepthImage(size, size, 2.0F);
  return obs;
}

/// A line of golden.tsv: its subject, its name, its numbers.
struct Golden {
  std::string kind, name;
  std::vector<double> numbers;
};

std::vector<Golden> GoldenOf(const std::string& network) {
  std::vector<Golden> all;
  std::ifstream file(Folder() / "golden.tsv");
  for (std::string line; std::getline(file, line);) {
    std::istringstream columns(line);
    std::string owner, column;
    Golden golden;
    std::getline(columns, owner, '\t');
    if (owner != network) continue;
    std::getline(columns, golden.kind, '\t');
    if (golden.kind == "box" || golden.kind == "text") std::getline(columns, golden.name, '\t');
    while (std::getline(columns, column, '\t')) golden.numbers.push_back(std::stod(column));
    all.push_back(std::move(golden));
  }
  return all;
}

/// The larger ones are not in the repository.
bool IsHere(const std::string& network) {
  return fs::exists(Folder() / (network + ".onnx"));
}

class PaperNetworks : public EachBackend {
 protected:
  std::shared_ptr<Model> OpenIt(const std::string& network) {
    auto card = ReadModelCard(Folder() / (network + ".toml"));
    if (!card) {
      ADD_FAILURE() << card.error().Message();
      return nullptr;
    }
    size_ = card->input.width;
    auto model = Open(*card, ModelsOptions());
    if (!model) ADD_FAILURE() << model.error().Message();
    return model ? *model : nullptr;
  }
  int size_ = 0;
};

CROSSNAV_FOR_EACH_BACKEND(PaperNetworks);

/// Every box of PyTorch is among the network's boxes for its label.
void ExpectBoxes(perception::Detector& detector, const std::string& network, int size) {
  const auto golden = GoldenOf(network);
  ASSERT_GE(golden.size(), 3U);
  for (const Golden& wanted : golden) {
    const auto found = detector.Detect(Picture(size), wanted.name);
    ASSERT_TRUE(found) << found.error().Message();
    const auto is_it = [&](const perception::Detection& d) {
      const double edges[] = {static_cast<double>(d.box.u0), static_cast<double>(d.box.v0),
                              static_cast<double>(d.box.u1), static_cast<double>(d.box.v1)};
      for (std::size_t i = 0; i < 4; ++i)
        if (std::abs(edges[i] - wanted.numbers[i + 1]) > 1) return false;  // whole pixels
      return std::abs(d.confidence - wanted.numbers[0]) < kClosePaper;
    };
    EXPECT_TRUE(std::any_of(found->begin(), found->end(), is_it))
        << network << " " << wanted.name << " " << wanted.numbers[0] << " of " << found->size();
  }
}

TEST_P(PaperNetworks, DetectorsGiveTheBoxesOfPyTorch) {
  int tried = 0;
  for (const char* network :
       {"yolox", "yolov7", "yolov8_seg", "yolo_world", "yolo_world_open", "rtdetr"}) {
    if (!IsHere(network)) continue;  // networks/paper/reference.py makes it
    ++tried;
    const auto model = OpenIt(network);
    ASSERT_NE(model, nullptr);
    ExpectBoxes(*model->MakeDetector(), network, size_);
  }
  EXPECT_GE(tried, Folder() == DataFile("paper") ? 5 : 1);
}

TEST_P(PaperNetworks, SegFormersStairsEqualPyTorchs) {
  const auto model = OpenIt("segformer_b2");
  ASSERT_NE(model, nullptr);
  const Observation obs = Picture(size_);
  const auto stairs = model->MakeStairs()->SegmentStairs(obs);
  ASSERT_TRUE(stairs) << stairs.error().Message();
  const auto golden = GoldenOf("segformer_b2");
  ASSERT_GE(golden.size(), 4U);
  for (const Golden& wanted : golden)
    EXPECT_NEAR(
        stairs->At(static_cast<int>(wanted.numbers[0]), static_cast<int>(wanted.numbers[1])),
        wanted.numbers[2], kClosePaper);
}

TEST_P(PaperNetworks, SedsFeaturesAndTextsAreThoseOfPyTorch) {
  const auto model = OpenIt("sed");
  ASSERT_NE(model, nullptr);
  const auto encoder = model->MakeEncoder();
  const auto grid = encoder->EncodeImage(Picture(size_));
  ASSERT_TRUE(grid) << grid.error().Message();
  const auto golden = GoldenOf("sed");
  ASSERT_EQ(golden.size(), 6U);
  for (const Golden& wanted : golden) {
    const bool is_text = wanted.kind == "text";
    const auto text = is_text ? *encoder->EncodeText(wanted.name) : std::vector<float>{};
    const auto place =
        is_text ? 0 : static_cast<std::size_t>(wanted.numbers[0] * grid->cols + wanted.numbers[1]);
    const std::size_t dim = wanted.numbers.size() - (is_text ? 0 : 2);
    ASSERT_EQ(dim, static_cast<std::size_t>(grid->dim));
    for (std::size_t i = 0; i < dim; ++i)
      EXPECT_NEAR(is_text ? text[i] : grid->data[place * dim + i],
                  wanted.numbers[is_text ? i : i + 2], kClosePaper)
          << wanted.kind << " " << wanted.name << " " << i;
  }
}

TEST_P(PaperNetworks, MobileSamsMaskIsThatOfPyTorchAndThePictureIsEncodedOnce) {
  if (!IsHere("mobile_sam")) GTEST_SKIP() << "networks/paper/reference.py makes it";
  const auto model = OpenIt("mobile_sam");
  ASSERT_NE(model, nullptr);
  const auto golden = GoldenOf("mobile_sam");
  ASSERT_EQ(golden.size(), 2U);
  const auto& n = golden[0].numbers;
  const auto segmenter = model->MakeSegmenter();
  const Observation obs = Picture(size_);
  perception::Detection detection;
  detection.box = {static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]),
                   static_cast<int>(n[3])};
  for (int again = 0; again < 2; ++again) {
    const auto ok = segmenter->Segment(obs, detection);
    ASSERT_TRUE(ok) << ok.error().Message();
    EXPECT_NEAR(detection.mask_quality, n[4], kClosePaper);
    const auto filled = std::count(detection.mask.data.begin(), detection.mask.data.end(), 1);
    EXPECT_NEAR(static_cast<double>(filled), golden[1].numbers[4], 0.002 * size_ * size_);
  }
}

TEST_P(PaperNetworks, ClipsTextVectorsEqualPyTorchs) {
  ModelCard card;
  card.path = Folder() / "clip_text.toml";
  card.text.encoder = Folder() / "clip_text.onnx";
  card.text.tokenizer = "clip";
  card.text.vocabulary = DataFile("tokens/merges.txt");
  const auto golden = GoldenOf("clip_text");
  ASSERT_GE(golden.size(), 4U);
  auto encoder =
      TextEncoder::Open(card, static_cast<int>(golden[0].numbers.size()), ModelsOptions());
  ASSERT_TRUE(encoder) << encoder.error().Message();
  for (const Golden& wanted : golden) {
    const auto vector = encoder->Of(wanted.name);
    ASSERT_TRUE(vector) << vector.error().Message();
    for (std::size_t i = 0; i < vector->size(); ++i)
      EXPECT_NEAR((*vector)[i], wanted.numbers[i], kClosePaper) << wanted.name;
  }
}

}  // namespace
}  // namespace crossnav::inference::test
