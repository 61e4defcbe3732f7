// SPDX-License-Identifier: MIT
#include "crossnav/inference/boxes.h"
#include "crossnav/inference/sha256.h"
#include "crossnav/inference/text_table.h"
#include "inference/model_files.h"

namespace crossnav::inference::test {
namespace {

using crossnav::test::TempFolder;
using crossnav::test::WriteText;

constexpr const char* kCard = R"(file = "net.onnx"
family = "detr"
labels = ["person", "couch", "tv", "couch potato"]
[input]
size = 320
mean = [0.5, 0.5, 0.5]
[thresholds]
score = 0.25
weak = 0.3
accept = [0.5, 0.5, 0.6, 0.7]
)";

class Cards : public ::testing::Test {
 protected:
  std::string ErrorOf(const std::string& text) {
    WriteText(path(), text);
    const auto card = ReadModelCard(path());
    if (card) return "no error";
    EXPECT_EQ(card.error().Message().rfind(path().string() + ": ", 0), 0U);
    return card.error().Message().substr(path().string().size() + 2);
  }
  std::filesystem::path path() const { return folder_.path() / "net.toml"; }
  TempFolder folder_;
};

TEST_F(Cards, AreReadWithDefaults) {
  WriteText(path(), kCard);
  const auto card = ReadModelCard(path());
  ASSERT_TRUE(card) << card.error().Message();
  EXPECT_EQ(card->name(), "net");
  EXPECT_EQ(card->file, folder_.path() / "net.onnx");
  EXPECT_EQ(card->labels.size(), 4U);
  EXPECT_EQ(card->output.classes, 4);
  EXPECT_EQ(card->input.mean[1], 0.5);
  EXPECT_EQ(card->input.resize, "plain");
  EXPECT_FALSE(card->input.focal_px);
}

TEST_F(Cards, OfOurNetworksAreRead) {
  WriteText(path(), R"(family = "crossnav"
name = "crossnav-small"
goals = ["chair", "sofa"]
limits = ["six goals only"]
[input]
size = 224
focal_px = 112
image = "colours"
height = "height"
[output]
stride = 4
stairs = "stairs"
[text]
table = "t.npy"
names = ["chair", "sofa"]
[thresholds]
heat = [0.4, 0.2]
nms_iou = 0.5
stairs = 0.5
[data]
minutes = 6.1
)");
  const auto card = ReadModelCard(path());
  ASSERT_TRUE(card) << card.error().Message();
  EXPECT_EQ(card->labels.size(), 2U);
  EXPECT_EQ(card->input.height, 224);
  EXPECT_EQ(card->input.focal_px, 112);
  EXPECT_EQ(card->PortName("image"), "colours");
  EXPECT_EQ(card->PortName("dense"), "dense");
  EXPECT_DOUBLE_EQ(card->thresholds.accept[1], 0.2);
  EXPECT_DOUBLE_EQ(card->thresholds.weak[0], 0.3);
  EXPECT_DOUBLE_EQ(card->thresholds.score, 0.1);
}

TEST_F(Cards, ErrorsNameTheKey) {
  const std::string good = kCard;
  EXPECT_EQ(ErrorOf(good), "no error");
  EXPECT_EQ(ErrorOf("colour = 1\n" + good), "key \"colour\" is no key of a card");
  EXPECT_EQ(ErrorOf(good + "sharp = true\n"), "key \"thresholds.sharp\" is no key of a card");
  EXPECT_EQ(ErrorOf("[input]\nsize = 3\n"), "key \"family\" is missing");
  EXPECT_EQ(ErrorOf("family = \"detr\"\n"), "key \"input.size\" is missing");
  EXPECT_EQ(ErrorOf("sha256 = \"12\"\n" + good),
            "key \"sha256\" must be 64 hexadecimal digits in lower case");
  EXPECT_EQ(ErrorOf("family = \"detr\"\n[input]\nsize = 100000\n"),
            "key \"input.size\" must be from 1 to 4096 px");
  EXPECT_EQ(ErrorOf("family = \"detr\"\n[input]\nresize = \"crop\"\n"),
            "key \"input.resize\" must be one of plain, letterbox, corner, not \"crop\"");
  EXPECT_EQ(ErrorOf("family = \"detr\"\nlabels = [1]\n[input]\nsize = 3\n"),
            "key \"labels\" must be a list of texts");
  EXPECT_EQ(ErrorOf("family = \"detr\"\ninput = 3\n").substr(0, 11), "key \"input\"");
  EXPECT_EQ(ErrorOf("family = \n").rfind("line 1: ", 0), 0U);
}

TEST_F(Cards, RetrievalThresholdsAreReadAndWrittenInPlaceOfOldOnes) {
  const std::string card =
      "family = \"dense\"\n[input]\nsize = 8\n\n[retrieval]\nmin_z_score = 2\n"
      "\n[text]  # kept\ntemplates = [\"{}\"]\n";
  const std::string section =
      "[retrieval]\nmin_similarity = 0.3\nabsent_below = 0.25\npresent_from = 0.5\nmargin = 0.15\n";
  for (const std::string& before : {card, card.substr(0, card.find("[retrieval]"))}) {
    const std::string text = WithRetrieval(before, section);
    EXPECT_EQ(WithRetrieval(text, section), text);
    EXPECT_EQ(text.find("min_z_score"), std::string::npos);
    WriteText(path(), text);
    const auto read = ReadModelCard(path());
    ASSERT_TRUE(read) << read.error().Message();
    EXPECT_EQ(read->retrieval.min_similarity, 0.3);
    EXPECT_EQ(read->retrieval.absent_below, 0.25);
    EXPECT_EQ(read->retrieval.present_from, 0.5);
    EXPECT_EQ(read->retrieval.margin, 0.15);
    EXPECT_FALSE(read->retrieval.min_z_score);
  }
  EXPECT_NE(WithRetrieval(card, section).find("[text]  # kept"), std::string::npos);
  for (const char* text : {"absent_below = 0.6\npresent_from = 0.5\n", "absent_below = 0.6\n"})
    EXPECT_EQ(ErrorOf("family = \"detr\"\n[input]\nsize = 3\n[retrieval]\n" + std::string(text)),
              "key \"retrieval.absent_below\" must come with a present_from that is not smaller");
}

TEST_F(Cards, EvidenceIsMeasuredWhereAllItsNumbersAre) {
  const std::string part =
      std::string(kCard) + "\n[evidence]\noffset = -4\nslope = 3\nmissed = -1.5\ntoo_short = -1\n";
  WriteText(path(), part);
  ASSERT_TRUE(ReadModelCard(path()));
  EXPECT_FALSE(ReadModelCard(path())->evidence.IsMeasured());
  WriteText(path(), part + "found = 2\n");
  const auto read = ReadModelCard(path());
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_TRUE(read->evidence.IsMeasured());
  EXPECT_EQ(read->evidence.missed, -1.5);
  EXPECT_EQ(ErrorOf(part + "found = -2\n").rfind("key \"evidence.found\"", 0), 0U);
}

TEST_F(Cards, ATruncatedCardIsAnErrorOrACard) {
  const std::string good = kCard;
  for (std::size_t size = 0; size < good.size(); ++size) {
    WriteText(path(), good.substr(0, size));
    const auto card = ReadModelCard(path());
    if (!card) {
      EXPECT_FALSE(card.error().Message().empty());
    }
  }
}

TEST_F(Cards, TheFileMustMatchTheCardsHash) {
  const std::string hash = Sha256("network");
  WriteText(path(), "sha256 = \"" + hash + "\"\n" + kCard);
  const auto card = ReadModelCard(path());
  ASSERT_TRUE(card);
  const auto missing = ReadNetworkFile(*card);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().Message().find("net.onnx: is not there"), std::string::npos);
  WriteText(folder_.path() / "net.onnx", "network");
  EXPECT_TRUE(ReadNetworkFile(*card));
  WriteText(folder_.path() / "net.onnx", "networks");
  const auto other = ReadNetworkFile(*card);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().Message().find("is not the file that"), std::string::npos);
}

TEST(Sha256, GivesTheStandardsVectors) {
  EXPECT_EQ(Sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Confidence, IsTheScoreOrGoesThroughTheCardsPoints) {
  EXPECT_DOUBLE_EQ(ConfidenceOf({}, 0, 0.37), 0.37);
  ModelCard::Thresholds t;
  t.weak = {0.9, 0.3};
  t.accept = {0.95, 0.5};
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 1, 0), 0);
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 1, 0.15), 0.30);
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 1, 0.3), 0.60);
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 1, 0.5), 0.70);
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 1, 1), 1);
  EXPECT_DOUBLE_EQ(ConfidenceOf(t, 0, 0.95), 0.70);
  std::vector<float> stairs = {0, 0.5F, 1};
  t.stairs = 0.5;
  ScaleStairs(t, stairs);
  EXPECT_EQ(stairs, (std::vector<float>{0, 0.25F, 1}));
}

TEST(Labels, AreMatchedThroughTheTableNeverBySubstring) {
  const std::vector<std::string> labels = {"chair",        "couch",        "potted plant", "tv",
                                           "dining table", "couch potato", "TV_Monitor"};
  EXPECT_EQ(LabelsOf("sofa", labels), (std::vector<int>{1}));
  EXPECT_EQ(LabelsOf("plant", labels), (std::vector<int>{2}));
  EXPECT_EQ(LabelsOf("tv_monitor", labels), (std::vector<int>{3, 6}));
  EXPECT_EQ(LabelsOf("dining table", labels), (std::vector<int>{4}));
  EXPECT_TRUE(LabelsOf("table", labels).empty());
  EXPECT_TRUE(LabelsOf("plan", labels).empty());
}

TEST(Suppression, KeepsTheBestOfAClassAndEveryClass) {
  const std::vector<FoundBox> boxes = {{0, 0, 10, 10, 0.5, 0, 0},
                                       {0, 1, 10, 11, 0.9, 0, 1},
                                       {0, 0, 10, 10, 0.4, 1, 2},
                                       {20, 0, 30, 10, 0.3, 0, 3}};
  const auto kept = Suppress(boxes, 0.5);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].index, 1U);
  EXPECT_EQ(kept[1].index, 2U);
  EXPECT_EQ(kept[2].index, 3U);
}

}  // namespace
}  // namespace crossnav::inference::test
