// SPDX-License-Identifier: MIT
// Every target reads its seeds, and the inputs that are kept in corpus/TARGET/ because they once
// crashed, hung or took too much memory.
#include <gtest/gtest.h>

#include <chrono>

#include "fuzz/harness.h"
#include "fuzz/seeds.h"
#include "support/places.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = crossnav::test::SourcePath("tests/fuzz/corpus");
constexpr auto kMost = std::chrono::seconds(10);  // chosen: 2 s, five times for sanitizers

void RunAll(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    ASSERT_TRUE(Targets().count(name)) << "no target for " << entry.path();
    for (const auto& input : fs::directory_iterator(entry.path())) {
      SCOPED_TRACE(input.path().string());
      const std::string bytes = test::ReadText(input.path());
      const auto start = std::chrono::steady_clock::now();
      Targets()[name]({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      EXPECT_LT(std::chrono::steady_clock::now() - start, kMost);
    }
  }
}

TEST(FuzzCorpus, EveryTargetHasSeedsAndReadsThem) {
  const test::TempFolder folder;
  WriteSeeds(folder.path());
  for (const auto& [name, target] : Targets())
    EXPECT_TRUE(fs::is_directory(folder.path() / name)) << "no seed for " << name;
  RunAll(folder.path());
}

TEST(FuzzCorpus, EveryKeptInputIsReadOrRefusedInTime) {
  RunAll(kCorpus);
}

}  // namespace
}  // namespace crossnav::fuzz
