// SPDX-License-Identifier: MIT
#include "crossnav/world/models/zip_reader.h"

#include <gtest/gtest.h>
#include <zip.h>

#include "support/zip_archive.h"

namespace crossnav::world {
namespace {

using test::Zip;

TEST(ZipReader, ReadsValidArchivesAndRefusesOthers) {
  const std::string bytes = Zip({{"a.txt", "hello"}, {"b/c.txt", "world"}});
  const auto zip = ZipReader::Parse(bytes, "test.zip");
  ASSERT_TRUE(zip.has_value()) << zip.error().Message();
  EXPECT_EQ(zip->Names(), (std::vector<std::string>{"a.txt", "b/c.txt"}));
  EXPECT_EQ(zip->Read("b/c.txt").value(), "world");
  EXPECT_EQ(zip->Read("none").error().code, ErrorCode::kNotFound);
  for (std::size_t n = 0; n < bytes.size(); ++n) {  // never reads past the end
    const auto cut = ZipReader::Parse(bytes.substr(0, n), "cut");
    if (cut) (void)cut->Read("a.txt");
  }
  EXPECT_FALSE(ZipReader::Parse("nothing of the kind, but long enough", "x").has_value());
}

TEST(ZipReader, AnEntryThatWouldUnpackToMoreThanDeflateCanIsRefused) {
  std::string bytes = Zip({{"a.txt", "hello"}});
  const auto directory = bytes.find("PK\1\2");
  bytes[directory + 10] = 8;     // deflated
  bytes[directory + 26] = 0x10;  // 1 MiB from five bytes
  const auto entry = ZipReader::Parse(bytes, "zip")->Read("a.txt");
  ASSERT_FALSE(entry);
  EXPECT_NE(entry.error().what.find("damaged"), std::string::npos);
}

/// One deflated entry, encrypted where `password` is given.
std::string Deflated(const char* name, const std::string& text, const char* password = nullptr) {
  zip_source_t* memory = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  zip_source_keep(memory);
  zip_t* zip = zip_open_from_source(memory, ZIP_TRUNCATE, nullptr);
  zip_file_add(zip, name, zip_source_buffer(zip, text.data(), text.size(), 0), 0);
  if (password != nullptr) zip_file_set_encryption(zip, 0, ZIP_EM_AES_128, password);
  EXPECT_EQ(zip_close(zip), 0);
  zip_source_open(memory);
  std::string bytes(1 << 20, '\0');
  bytes.resize(static_cast<std::size_t>(zip_source_read(memory, bytes.data(), bytes.size())));
  zip_source_close(memory);
  zip_source_free(memory);
  return bytes;
}

TEST(ZipReader, ADeflatedEntryComesBackAndEveryCutOrFlippedByteIsSafe) {
  const std::string text(5000, 'x');
  const std::string bytes = Deflated("a.txt", text);
  ASSERT_LT(bytes.size(), 400U);
  const auto zip = ZipReader::Parse(bytes, "zip");
  ASSERT_TRUE(zip) << zip.error().Message();
  EXPECT_EQ(zip->SizeOf("a.txt"), text.size());
  EXPECT_EQ(zip->Read("a.txt").value(), text);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] ^= 0x15;
    for (const auto& damaged :
         {ZipReader::Parse(other, "zip"), ZipReader::Parse(bytes.substr(0, i), "zip")}) {
      if (!damaged) continue;
      const auto read = damaged->Read("a.txt");
      EXPECT_TRUE(!read || *read == text) << i;
    }
  }
}

TEST(ZipReader, AnEncryptedEntryAndNoBytesAtAllAreRefused) {
  const auto zip = ZipReader::Parse(Deflated("a.txt", "hello", "secret"), "zip");
  ASSERT_TRUE(zip) << zip.error().Message();
  EXPECT_EQ(zip->Read("a.txt").error().code, ErrorCode::kUnsupported);
  EXPECT_FALSE(ZipReader::Parse("", "nothing"));
}

TEST(ZipReader, AFlippedBitInAStoredEntryIsFound) {
  std::string bytes = Zip({{"a.txt", "hello"}});
  bytes[bytes.find("hello")] ^= 1;
  EXPECT_FALSE(ZipReader::Parse(bytes, "zip")->Read("a.txt"));
}

}  // namespace
}  // namespace crossnav::world
