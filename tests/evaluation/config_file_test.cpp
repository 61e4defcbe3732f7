// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/settings/config_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "crossnav/core/config_visitor.h"
#include "support/places.h"

namespace crossnav::evaluation {
namespace {

TEST(ConfigFile, EmptyTextMeansThePapersNumbersAndOurNavigator) {
  RunConfig config;
  ASSERT_TRUE(ApplyConfigText("", "empty.toml", config));
  EXPECT_EQ(ConfigHash(config), ConfigHash(RunConfig{}));
  EXPECT_EQ(config.agent.policy.profile, "full");
}

TEST(ConfigFile, SectionsReachNestedFields) {
  RunConfig config;
  const auto ok = ApplyConfigText(
      "[policy.poi]\nuse_history = false\n[navmesh]\ncell_m = 0.05\n[map]\nrays = \"exact\"\n"
      "[eval]\naction_budget = 500\n",
      "a.toml", config);
  ASSERT_TRUE(ok) << ok.error().Message();
  EXPECT_FALSE(config.agent.policy.poi.use_history);
  EXPECT_DOUBLE_EQ(config.navmesh.cell_m, 0.05);
  EXPECT_EQ(config.agent.map.rays, "exact");
  EXPECT_EQ(config.eval.action_budget, 500);
}

TEST(ConfigFile, UnknownKeyNamesFileKeyAndNeighbour) {
  RunConfig config;
  const auto ok = ApplyConfigText("[policy.poi]\nuse_histroy = false\n", "a.toml", config);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().Message().find("a.toml"), std::string::npos);
  EXPECT_NE(ok.error().Message().find("policy.poi.use_histroy"), std::string::npos);
  EXPECT_NE(ok.error().Message().find("did you mean \"policy.poi.use_history\""), std::string::npos)
      << ok.error().Message();
}

TEST(ConfigFile, AllProblemsAreReportedAndNothingIsChanged) {
  RunConfig config;
  const auto ok = ApplyConfigText(
      "[sensor]\nwidth_px = 320\nhfov_deg = 400\n[map]\nrays = \"quick\"\nvoxel_m = true\nx = 1\n",
      "a.toml", config);
  ASSERT_FALSE(ok);
  for (const char* part : {"sensor.hfov_deg", "[1, 179]", "map.rays", "fast, exact", "map.voxel_m",
                           "must be a number", "map.x"}) {
    EXPECT_NE(ok.error().what.find(part), std::string::npos) << part << " in " << ok.error().what;
  }
  EXPECT_EQ(config.agent.sensor.width_px, 640);
}

TEST(ConfigFile, SyntaxErrorNamesTheLine) {
  RunConfig config;
  const auto ok = ApplyConfigText("[map]\nvoxel_m = = 2\n", "a.toml", config);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().where.find("line 2"), std::string::npos) << ok.error().Message();
}

TEST(ConfigFile, OverridesAreTypedAndAllOrNothing) {
  RunConfig config;
  ASSERT_TRUE(ApplyOverrides({"map.voxel_m=0.2", "eval.seed=9", "map.rays=exact",
                              "policy.planar=true", "sensor.hfov_deg=79"},
                             config));
  EXPECT_DOUBLE_EQ(config.agent.map.voxel_m, 0.2);
  EXPECT_EQ(config.eval.seed, 9u);
  EXPECT_TRUE(config.agent.policy.planar);
  const std::string before = ConfigHash(config);
  EXPECT_FALSE(ApplyOverrides({"map.voxel_m=0.3", "map.voxel=1"}, config));
  EXPECT_FALSE(ApplyOverrides({"map.voxel_m"}, config));
  EXPECT_EQ(ConfigHash(config), before);
}

TEST(ConfigFile, WholeNumberFieldsRefuseFractions) {
  RunConfig config;
  const auto ok = ApplyOverrides({"sensor.width_px=640.5"}, config);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().what.find("whole number"), std::string::npos);
}

TEST(ConfigFile, TomlDumpReadsBackAsTheSameConfig) {
  RunConfig config;
  ASSERT_TRUE(ApplyVariant("planar", config));
  ASSERT_TRUE(ApplyOverrides({"map.voxel_m=0.125", "fusion.epsilon=1e-9"}, config));
  RunConfig read;
  const auto ok = ApplyConfigText(DumpToml(config), "dump.toml", read);
  ASSERT_TRUE(ok) << ok.error().Message();
  EXPECT_EQ(ConfigHash(read), ConfigHash(config));
  EXPECT_NE(ConfigHash(read), ConfigHash(RunConfig{}));
}

TEST(ConfigFile, JsonDumpHoldsEveryField) {
  RunConfig config;
  const auto json = nlohmann::json::parse(DumpJson(config));
  for (const ConfigField& field : FieldsOf(config)) {
    std::string pointer = "/" + field.key;
    for (char& c : pointer) c = c == '.' ? '/' : c;
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(pointer))) << field.key;
  }
}

TEST(ConfigFile, EveryKeyIsUniqueAndEveryDefaultIsInItsRange) {
  RunConfig config;
  std::set<std::string> keys;
  for (const ConfigField& field : FieldsOf(config)) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
  }
  RunConfig read;
  const auto ok = ApplyConfigText(DumpToml(config), "defaults", read);
  EXPECT_TRUE(ok) << ok.error().Message();
}

TEST(ConfigFile, ADottedKey50000DeepIsAnErrorAndNoCrash) {
  std::string key;
  for (int i = 0; i < 50'000; ++i) key += "a.";
  RunConfig config;
  const auto ok = ApplyConfigText(key + "b = 1\n", "deep.toml", config);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().where, "deep.toml: line 1");
}

TEST(ConfigFile, AMistypedVariantOrChoiceNamesItsNeighbour) {
  RunConfig config;
  const auto variant = ApplyVariant("planr", config);
  ASSERT_FALSE(variant);
  EXPECT_NE(variant.error().what.find("did you mean \"planar\"?"), std::string::npos);
  const auto choice = ApplyOverrides({"map.clearing=nevr"}, config);
  ASSERT_FALSE(choice);
  EXPECT_NE(choice.error().what.find("did you mean \"never\"?"), std::string::npos);
}

TEST(ConfigFile, VoxelSizesThatNoMapHasAreRefused) {
  RunConfig config;
  for (const char* value : {"0", "-1", "1e300", "nan", "inf", "1e999"})
    EXPECT_FALSE(ApplyOverrides({std::string("map.voxel_m=") + value}, config)) << value;
  EXPECT_FALSE(ApplyConfigText("map.voxel_m = nan", "a.toml", config));
}

TEST(ConfigFile, UnknownVariantIsRefused) {
  RunConfig config;
  EXPECT_TRUE(ApplyVariant("no-history-poi", config));
  EXPECT_FALSE(config.agent.policy.poi.use_history);
  EXPECT_TRUE(ApplyVariant("paper", config));
  EXPECT_EQ(config.agent.policy.profile, "paper");
  EXPECT_FALSE(ApplyVariant("fast", config));
  const auto refused = ApplyVariant("no-history", config);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("paper-no-history-poi"), std::string::npos);
}

TEST(ConfigFile, AblationsOfHistoryPoisChangeTheirSettingsAndNoOther) {
  using Settings = std::vector<std::pair<std::string, std::string>>;
  const auto changed = [](std::string_view variant) {
    RunConfig config;
    EXPECT_TRUE(ApplyVariant(variant, config));
    const nlohmann::json defaults = nlohmann::json::parse(DumpJson(RunConfig{})).flatten();
    const nlohmann::json set = nlohmann::json::parse(DumpJson(config)).flatten();
    Settings settings;
    for (const auto& [key, value] : set.items())
      if (value != defaults.at(key)) settings.emplace_back(key, value.dump());
    return settings;
  };
  const std::pair<std::string, std::string> off{"/policy/poi/use_history", "false"};
  EXPECT_EQ(changed("no-history-poi"), (Settings{off}));
  EXPECT_EQ(changed("no-history-poi-pure"), (Settings{{"/policy/poi/keep_coverage", "true"}, off}));
  EXPECT_EQ(changed("paper-no-history-poi"), (Settings{off, {"/policy/profile", "\"paper\""}}));
}

TEST(ConfigFile, AnOldKeyOfASettingIsReadWithAWarningThatNamesBothKeys) {
  RunConfig config;
  std::vector<std::string> warnings;
  ASSERT_TRUE(ApplyConfigText("[policy.explore]\ncrumb_m = 7\n", "a.toml", config, &warnings));
  EXPECT_EQ(config.agent.policy.explore.small_frontier_penalty_m, 7);
  ASSERT_TRUE(ApplyOverrides({"policy.explore.elsewhere_m=1", "policy.explore.resemblance_steps=3",
                              "policy.explore.sighting_m=-2", "policy.explore.storey_bit_m=4"},
                             config, &warnings));
  EXPECT_EQ(config.agent.policy.explore.other_floor_penalty_m, 1);
  EXPECT_EQ(config.agent.policy.explore.relevancy_steps, 3);
  EXPECT_EQ(config.agent.policy.explore.hint_bonus_m, -2);
  EXPECT_EQ(config.agent.policy.explore.floor_prior_m_per_bit, 4);
  ASSERT_EQ(warnings.size(), 5U);
  EXPECT_EQ(warnings[0],
            "a.toml: key \"policy.explore.crumb_m\" is now "
            "\"policy.explore.small_frontier_penalty_m\"; the old key is read until version 0.4");
}

TEST(ConfigFile, WarningsOfOldKeysComeOnceUnderANoiseProfileToo) {
  std::vector<std::string> warnings;
  const std::vector<std::string> overrides{"policy.explore.crumb_m=7", "noise.profile=realsense",
                                           "policy.explore.crumb_m=8"};
  const auto config = ReadConfig({{}, "full", overrides}, &warnings);
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_EQ(config->agent.policy.explore.small_frontier_penalty_m, 8);
  EXPECT_EQ(warnings.size(), 1U);
}

TEST(ConfigFile, OldAndNewKeyOfASettingInOneSourceAreRefused) {
  const std::string old_key = "policy.explore.crumb_m", key = "small_frontier_penalty_m";
  RunConfig config;
  std::vector<std::string> warnings;
  const auto file = ApplyConfigText("[policy.explore]\ncrumb_m = 7\n" + key + " = 8\n", "a.toml",
                                    config, &warnings);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().what.find(old_key), std::string::npos) << file.error().what;
  EXPECT_NE(file.error().what.find(key), std::string::npos) << file.error().what;
  EXPECT_FALSE(ApplyOverrides({old_key + "=7", "policy.explore." + key + "=8"}, config, &warnings));
  EXPECT_EQ(ConfigHash(config), ConfigHash(RunConfig{}));
  EXPECT_TRUE(warnings.empty());
  // An override may replace a setting of the file, under either key.
  ASSERT_TRUE(ApplyConfigText("[policy.explore]\ncrumb_m = 7\n", "a.toml", config, &warnings));
  ASSERT_TRUE(ApplyOverrides({"policy.explore." + key + "=8"}, config, &warnings));
  EXPECT_EQ(config.agent.policy.explore.small_frontier_penalty_m, 8);
}

TEST(ConfigFile, AMistakeInAnOldKeysValueNamesTheKeyAsGiven) {
  RunConfig config;
  const auto ok = ApplyOverrides({"policy.explore.crumb_m=-1"}, config);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().what.find("\"policy.explore.crumb_m\" must be in"), std::string::npos);
}

// The paper's single-object protocol is its frozen configuration: one goal, and nothing else.
TEST(ConfigFile, TheSingleObjectProtocolOfThePaperChangesTheNumberOfGoalsOnly) {
  RunConfig config;
  ASSERT_TRUE(ApplyConfigFile(crossnav::test::SourcePath("config/objectnav_paper.toml"), config));
  EXPECT_EQ(config.dataset.goals, 1);
  config.dataset.goals = 3;
  EXPECT_EQ(DumpJson(config), DumpJson(RunConfig{}));
}

}  // namespace
}  // namespace crossnav::evaluation
