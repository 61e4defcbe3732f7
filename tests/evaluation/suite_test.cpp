// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/suite.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

SuiteManifest Manifest() {
  SuiteManifest manifest;
  manifest.suite = "crossnav-mfmon-1-mini";
  manifest.generator_version = world::kGeneratorVersion;
  manifest.furniture = "simple shapes";
  manifest.episodes = 24;
  manifest.first_transitions = {3, 3, 2};
  manifest.episodes_hash = "00000000000000aa";
  for (int i = 1; i <= 6; ++i) manifest.meshes["House" + std::to_string(i)] = "bb";
  return manifest;
}

TEST(Suite, TheFullSuiteHasThePapersCounts) {
  const auto suite = FindSuite("crossnav-mfmon-1");
  ASSERT_TRUE(suite);
  EXPECT_EQ(suite->houses, 36);
  EXPECT_EQ(suite->episodes, 927);
  EXPECT_EQ(suite->first_transitions, (std::vector<int>{102, 101, 85}));
  EXPECT_FALSE(suite->has_pack);
}

TEST(Suite, NamesAreDifferentAndSoAreTheHousesOfDevelopmentAndTest) {
  std::set<std::string> names;
  std::set<std::uint64_t> seeds;
  for (const SuiteDefinition& suite : AllSuites()) {
    EXPECT_TRUE(names.insert(suite.name).second) << suite.name;
    EXPECT_LE(std::accumulate(suite.first_transitions.begin(), suite.first_transitions.end(), 0),
              suite.episodes);
    EXPECT_EQ(suite.has_pack, suite.name.ends_with("-pack"));
    if (suite.has_pack) continue;
    for (int i = 0; i < 2 * suite.houses; ++i) {
      EXPECT_TRUE(seeds.insert(suite.first_seed + static_cast<std::uint64_t>(i)).second);
    }
  }
  const auto unknown = FindSuite("hm3d");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().Message().find("crossnav-mfmon-1-val"), std::string::npos);
}

TEST(Suite, ManifestRoundTripsAndItsHashGuardsIt) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "manifest.json";
  ASSERT_TRUE(WriteManifest(path, Manifest()));
  const auto read = ReadManifest(path);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(SuiteHash(*read), SuiteHash(Manifest()));
  EXPECT_EQ(read->meshes, Manifest().meshes);
  EXPECT_TRUE(CheckManifest(*FindSuite("crossnav-mfmon-1-mini"), *read, path));
  std::string text = crossnav::test::ReadText(path);
  text.replace(text.find("\"bb\""), 4, "\"cc\"");
  crossnav::test::WriteText(path, text);
  const auto tampered = ReadManifest(path);
  ASSERT_FALSE(tampered);
  EXPECT_NE(tampered.error().Message().find("manifest.json: hash"), std::string::npos);
  crossnav::test::WriteText(path, "{}");
  EXPECT_FALSE(ReadManifest(path));
  text.replace(text.find("24"), 2, "2e99");
  crossnav::test::WriteText(path, text);
  EXPECT_NE(ReadManifest(path).error().Message().find("out of range"), std::string::npos);
}

TEST(Suite, ManifestOfAnotherSuiteOrGeneratorIsRefusedWithItsKey) {
  const auto suite = *FindSuite("crossnav-mfmon-1-mini");
  const auto expect = [&](const SuiteManifest& manifest, const std::string& key) {
    const auto ok = CheckManifest(suite, manifest, "manifest.json");
    ASSERT_FALSE(ok) << key;
    EXPECT_NE(ok.error().Message().find("manifest.json: " + key), std::string::npos)
        << ok.error().Message();
    EXPECT_NE(ok.error().Message().find("make it anew"), std::string::npos);
  };
  SuiteManifest other = Manifest();
  other.generator_version = 0;
  expect(other, "generator_version");
  other = Manifest();
  other.suite = "crossnav-mfmon-1";
  expect(other, "suite");
  other = Manifest();
  other.first_transitions = {8, 0, 0};
  expect(other, "first_transition_stage");
  other = Manifest();
  other.meshes.erase("House1");
  expect(other, "meshes");
}

}  // namespace
}  // namespace crossnav::evaluation
