// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/basis_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "crossnav/core/read_file.h"
#include "support/places.h"

namespace crossnav::sim::test {
namespace {

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Peak signal to noise [dB] over red, green and blue.
double PsnrOf(const Image<Rgba8>& a, const Image<Rgba8>& b) {
  if (a.width != b.width || a.height != b.height) return 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) squares += std::pow(a.data[i][k] - b.data[i][k], 2);
  }
  return 10 * std::log10(255 * 255 / (squares / (3.0 * a.data.size()) + 1e-9));
}

struct Sample {
  const char *basis, *png;
  bool says_how_it_lies = true;
};

class BasisSamples : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasBasisTranscoder()) GTEST_SKIP() << "no transcoder; scripts/setup.sh hm3d";
    if (!std::filesystem::exists(Folder())) GTEST_SKIP() << Folder() << " is not here";
  }
  static std::filesystem::path Folder() { return crossnav::test::SharedPath("data/basis"); }
  static std::string Read(const char* name) { return ReadFile(Folder() / name).value(); }
};

TEST_F(BasisSamples, AreThePicturesTheyWereMadeOfWithTheirTopRowFirst) {
  for (const Sample& sample :
       {Sample{"rgb.basis", "rgb-63x27.png"},
        {"rgb-noflip.basis", "rgb-63x27.png"},
        {"rgb.ktx2", "rgb-63x27.png"},
        {"rgb-noflip.ktx2", "rgb-63x27.png"},
        {"rgba.basis", "rgba-63x27.png"},
        {"rgba-uastc.basis", "rgba-63x27.png"},
        // Turned, and without the key that says so: KTX2 means top row first then.
        {"rgba-uastc.ktx2", "rgba-63x27.png", false}}) {
    const auto image = DecodeBasisImage(BytesOf(Read(sample.basis)), sample.basis);
    ASSERT_TRUE(image.has_value()) << image.error().Message();
    const auto png = DecodePng(BytesOf(Read(sample.png)), sample.png);
    ASSERT_TRUE(png.has_value()) << png.error().Message();
    Image<Rgba8> turned = *png;
    for (int y = 0; y < png->height; ++y) {
      for (int x = 0; x < png->width; ++x) turned.At(x, y) = png->At(x, png->height - 1 - y);
    }
    const Image<Rgba8>& wanted = sample.says_how_it_lies ? *png : turned;
    const Image<Rgba8>& other = sample.says_how_it_lies ? turned : *png;
    EXPECT_GT(PsnrOf(*image, wanted), 19) << sample.basis;
    EXPECT_GT(PsnrOf(*image, wanted), PsnrOf(*image, other) + 5) << sample.basis;
  }
}

TEST_F(BasisSamples, CutShortOrWithAByteChangedAreRefusedOrDecoded) {
  for (const char* name : {"rgb.basis", "rgba-uastc.ktx2", "rgb.ktx2"}) {
    const std::string whole = Read(name);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      const auto image = DecodeBasisImage(BytesOf(whole.substr(0, size)), name);
      EXPECT_FALSE(image.has_value()) << name << " cut to " << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 3) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0xA5);
      (void)DecodeBasisImage(BytesOf(bytes), name);  // must come back
    }
  }
}

TEST(BasisImage, WithoutATranscoderTheMessageNamesTheRemedy) {
  if (HasBasisTranscoder()) GTEST_SKIP() << "this build has the transcoder";
  const auto image = DecodeBasisImage({}, "image 0");
  ASSERT_FALSE(image.has_value());
  EXPECT_NE(image.error().Message().find("scripts/setup.sh hm3d"), std::string::npos);
}

TEST(BasisImage, KindsAreKnownByTheirFirstBytes) {
  EXPECT_TRUE(IsBasisImage(BytesOf(std::string("sB\x13\x00", 4))));
  EXPECT_TRUE(IsBasisImage(BytesOf("\xABKTX 20\xBB\r\n\x1A\n....")));
  EXPECT_FALSE(IsBasisImage(BytesOf("\x89PNG\r\n\x1A\n....")));
  EXPECT_FALSE(IsBasisImage({}));
}

}  // namespace
}  // namespace crossnav::sim::test
