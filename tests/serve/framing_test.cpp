// SPDX-License-Identifier: MIT
#include "crossnav/serve/framing.h"

#include <gtest/gtest.h>

#include <vector>

#include "crossnav/core/rng.h"

namespace crossnav::serve {
namespace {

std::string RandomBytes(Rng& rng, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(rng.Int(0, 255)));
  return bytes;
}

std::string LengthOf(std::uint32_t n) {
  std::string bytes;
  for (int byte = 0; byte < 4; ++byte) bytes.push_back(static_cast<char>(n >> (8 * byte)));
  return bytes;
}

TEST(Framing, AFrameIsALittleEndianLengthAndThePayload) {
  EXPECT_EQ(FrameOf("abc"), std::string("\x03\0\0\0abc", 7));
  EXPECT_EQ(FrameOf(std::string(0x0201, 'x')).substr(0, 4), std::string("\x01\x02\0\0", 4));
}

TEST(Framing, PayloadsComeOutAsTheyWentInHoweverTheStreamIsCut) {
  Rng rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::string> sent, got;
    std::string stream;
    for (int i = 0; i < 20; ++i) {
      sent.push_back(RandomBytes(rng, rng.Int(1, 300)));
      stream += FrameOf(sent.back());
    }
    FrameReader reader;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t size = static_cast<std::size_t>(rng.Int(1, 500));
      reader.Append(std::string_view(stream).substr(at, size));
      at += size;
      for (;;) {
        const auto next = reader.Next();
        ASSERT_TRUE(next.has_value());
        if (!*next) break;
        got.emplace_back(**next);
      }
    }
    EXPECT_EQ(got, sent);
    EXPECT_EQ(reader.pending_bytes(), 0u);
  }
}

TEST(Framing, NoPrefixOfAFrameIsAPayload) {
  const std::string frame = FrameOf("a payload");
  for (std::size_t size = 0; size < frame.size(); ++size) {
    FrameReader reader;
    reader.Append(std::string_view(frame).substr(0, size));
    const auto next = reader.Next();
    ASSERT_TRUE(next.has_value());
    EXPECT_FALSE(next->has_value()) << size;
  }
}

TEST(Framing, ImpossibleLengthsAreErrors) {
  for (const std::uint32_t length : {0U, kMaxFrame_bytes + 1, 0xffffffffU}) {
    FrameReader reader;
    reader.Append(FrameOf("good") + LengthOf(length) + "xyz");
    EXPECT_EQ(reader.Next().value().value(), "good");
    EXPECT_FALSE(reader.Next().has_value()) << length;
  }
  FrameReader reader;
  reader.Append(LengthOf(kMaxFrame_bytes));
  EXPECT_TRUE(reader.Next().has_value());
}

}  // namespace
}  // namespace crossnav::serve
