// SPDX-License-Identifier: MIT
// The YOLO family on small networks whose tables are in make_models.py.
#include <cmath>

#include "crossnav/inference/parts.h"
#include "inference/model_files.h"
#include "inference/small_network.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;

class YoloFamily : public WithBackend {
 protected:
  std::shared_ptr<Model> OpenIt(const std::string& family, int size,
                                const std::string& output = "") {
    const auto path = folder_.path() / (family + ".toml");
    crossnav::test::WriteText(path, "family = \"" + family + "\"\nlabels = [\"tv\", \"couch\"]\n" +
                                        "[input]\nsize = " + std::to_string(size) + "\n[output]\n" +
                                        output + "\n");
    fs::copy_file(DataFile(family + ".onnx"), folder_.path() / (family + ".onnx"),
                  fs::copy_options::overwrite_existing);
    const auto card = ReadModelCard(path);
    EXPECT_TRUE(card) << card.error().Message();
    auto model = Open(*card, {});
    EXPECT_TRUE(model) << model.error().Message();
    return model ? *model : nullptr;
  }
  /// "u0 v0 u1 v1 score" of each detection in a white picture.
  std::string Found(Model& model, const char* goal, int size) {
    Observation obs;
    obs.rgb = RgbImage(size, size, Rgb8{255, 255, 255});
    const auto found = model.MakeDetector()->Detect(obs, goal);
    if (!found) return found.error().Message();
    std::string text;
    for (const auto& d : *found)
      text += (text.empty() ? "" : "; ") + std::to_string(d.box.u0) + " " +
              std::to_string(d.box.v0) + " " + std::to_string(d.box.u1) + " " +
              std::to_string(d.box.v1) + " " +
              std::to_string(static_cast<int>(std::lround(100 * d.confidence)));
    return text;
  }
  crossnav::test::TempFolder folder_;
};

TEST_F(YoloFamily, SevenMultipliesObjectnessAndClass) {
  const auto model = OpenIt("yolov7", 16);
  ASSERT_TRUE(model);
  EXPECT_EQ(Found(*model, "sofa", 32), "4 8 20 24 90");
  EXPECT_EQ(Found(*model, "tv_monitor", 16), "10 2 14 6 80");
  EXPECT_EQ(model->MakeSegmenter(), nullptr);
}

TEST_F(YoloFamily, SevenEndToEndGivesCorners) {
  const auto model = OpenIt("yolov7-end2end", 16);
  ASSERT_TRUE(model);
  EXPECT_EQ(Found(*model, "sofa", 16), "2 4 10 12 90");
  EXPECT_EQ(Found(*model, "tv_monitor", 16), "10 2 14 6 80");
}

TEST_F(YoloFamily, XDecodesTheCellsOfThreeGrids) {
  const auto model = OpenIt("yolox", 32);
  ASSERT_TRUE(model);
  EXPECT_EQ(Found(*model, "sofa", 32), "12 6 28 14 90");
  EXPECT_EQ(Found(*model, "tv_monitor", 32), "0 0 32 32 80");
}

TEST_F(YoloFamily, EightSegmentsWithItsPrototypes) {
  const auto model = OpenIt("yolov8-seg", 16, "dim = 1");
  ASSERT_TRUE(model);
  EXPECT_EQ(Found(*model, "tv_monitor", 16), "10 10 14 14 90");
  Observation obs;
  obs.rgb = RgbImage(16, 16, Rgb8{0, 255, 255});
  for (int v = 0; v < 8; ++v)
    for (int u = 0; u < 8; ++u) obs.rgb.At(u, v).r = 255;
  const auto detector = model->MakeDetector();
  const auto segmenter = model->MakeSegmenter();
  auto found = detector->Detect(obs, "sofa");
  ASSERT_TRUE(found) << found.error().Message();
  ASSERT_EQ(found->size(), 1U);  // the second box is the same sofa
  EXPECT_EQ((*found)[0].box.u0, 2);
  ASSERT_TRUE(segmenter->Segment(obs, (*found)[0]));
  EXPECT_EQ((*found)[0].mask.At(4, 4), 1);
  EXPECT_EQ((*found)[0].mask.At(9, 9), 0);
  EXPECT_EQ((*found)[0].mask.At(1, 1), 0);  // red, and outside the box
  perception::Detection other{{0, 0, 5, 5}, 1, {}, 0};
  EXPECT_NE(segmenter->Segment(obs, other).error().Message().find("its own boxes"),
            std::string::npos);
}

class YoloWorld : public YoloFamily {
 protected:
  /// `classes`: texts that the network is said to take; it takes 3.
  Result<std::shared_ptr<Model>> OpenWorld(const std::string& classes, const std::string& names) {
    const auto path = folder_.path() / "world.toml";
    crossnav::test::WriteText(path,
                              "family = \"yolo-world\"\nfile = \"world.onnx\"\nlabels = [\"tv\"]\n"
                              "[input]\nsize = 16\n[output]\nclasses = " +
                                  classes + "\ndim = 2\n[text]\ntable = \"names.npy\"\nnames = [" +
                                  names + "]\n");
    crossnav::test::WriteText(folder_.path() / "names.npy", Npy({{2, 0}, {0, 2}}));
    fs::copy_file(DataFile("yolo-world.onnx"), folder_.path() / "world.onnx",
                  fs::copy_options::overwrite_existing);
    const auto card = ReadModelCard(path);
    EXPECT_TRUE(card) << card.error().Message();
    return Open(*card, {});
  }
};

TEST_F(YoloWorld, GetsItsLabelsAndAnUnlabelledGoal) {
  const auto model = OpenWorld("3", "\"tv\", \"lamp\"");
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(Found(**model, "tv_monitor", 16), "2 4 10 12 90");
  EXPECT_EQ(Found(**model, "lamp", 16), "10 2 14 6 90");
  EXPECT_EQ(Found(**model, "tv_monitor", 16), "2 4 10 12 90");
  EXPECT_NE(Found(**model, "couch", 16).find("has no vector for \"couch\""), std::string::npos);
}

TEST_F(YoloWorld, MissingPartsOfItsCardAreNamed) {
  const auto error = [&](const char* classes, const char* names) {
    const auto model = OpenWorld(classes, names);
    return model ? std::string() : model.error().Message();
  };
  EXPECT_NE(error("3", "\"sofa\", \"lamp\"").find("has no vector for \"tv\""), std::string::npos);
  EXPECT_NE(error("2", "\"tv\", \"lamp\"").find("input \"texts\" is 1x3x2"), std::string::npos);
}

class GridFamily : public WithBackend {
 protected:
  Result<std::shared_ptr<Model>> OpenIt(const std::string& family, const std::string& output) {
    const auto path = folder_.path() / (family + ".toml");
    crossnav::test::WriteText(
        path, "family = \"" + family + "\"\n[input]\nsize = 16\nantialias = false\n" + output);
    fs::copy_file(DataFile(family + ".onnx"), folder_.path() / (family + ".onnx"),
                  fs::copy_options::overwrite_existing);
    const auto card = ReadModelCard(path);
    if (!card) return tl::unexpected(card.error());
    return Open(*card, {});
  }
  static Observation Painted() {
    Observation obs;
    obs.rgb = RgbImage(16, 16, Rgb8{255, 0, 0});
    for (int v = 0; v < 16; ++v)
      for (int u = 8; u < 16; ++u) obs.rgb.At(u, v) = {0, 0, 255};
    return obs;
  }
  crossnav::test::TempFolder folder_;
};

TEST_F(GridFamily, StairsAreTheSumOfTheirClasses) {
  const auto model = OpenIt("segformer", "[output]\nclasses = 3\nstair_classes = [1, 2]\n");
  ASSERT_TRUE(model) << model.error().Message();
  const auto stairs = (*model)->MakeStairs()->SegmentStairs(Painted());
  ASSERT_TRUE(stairs) << stairs.error().Message();
  const double e = std::exp(-10.0);
  EXPECT_NEAR(stairs->At(0, 0), 2 * e / (1 + 2 * e), 1e-6);
  EXPECT_NEAR(stairs->At(15, 15), (1 + e) / (1 + 2 * e), 1e-6);
  EXPECT_NE(OpenIt("segformer", "[output]\nclasses = 3\nstair_classes = [3]\n")
                .error()
                .Message()
                .find("names a class that there is not"),
            std::string::npos);
}

TEST_F(GridFamily, DenseFeaturesComeInRowsOfCellsForEveryLayout) {
  const std::string output = "[output]\nrows = 4\ncols = 4\ndim = 3\nlayout = \"chw\"\n";
  EXPECT_NE(OpenIt("dense", output).error().Message().find("\"text.table\" is missing"),
            std::string::npos);
  crossnav::test::WriteText(folder_.path() / "names.txt", "couch\nloveseat\nlamp\n");
  std::string npy("\x93NUMPY\x01\x00\x46\x00", 10);
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 3), }";
  header.resize(0x46, ' ');
  const float rows[9] = {3, 0, 0, 0, 4, 0, 0, 0, 2};
  npy += header + std::string(reinterpret_cast<const char*>(rows), sizeof(rows));
  crossnav::test::WriteText(folder_.path() / "names.npy", npy);
  const auto model =
      OpenIt("dense", output + "[text]\nnames_file = \"names.txt\"\ntable = \"names.npy\"\n");
  ASSERT_TRUE(model) << model.error().Message();
  const auto encoder = (*model)->MakeEncoder();
  const auto grid = encoder->EncodeImage(Painted());
  ASSERT_TRUE(grid) << grid.error().Message();
  EXPECT_EQ(grid->dim, 3);
  EXPECT_NEAR(grid->data[0], 1, 1e-6);          // first cell: red
  EXPECT_NEAR(grid->data[3 * 3 + 2], 1, 1e-6);  // last cell of the row: blue
  EXPECT_NEAR(grid->data[3 * 3 + 0], 0, 1e-6);
  const auto sofa = encoder->EncodeText("sofa");  // the mean of couch and loveseat
  ASSERT_TRUE(sofa) << sofa.error().Message();
  EXPECT_NEAR((*sofa)[0], std::sqrt(0.5), 1e-6);
  EXPECT_NEAR((*sofa)[1], std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace crossnav::inference::test
