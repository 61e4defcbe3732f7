// SPDX-License-Identifier: MIT
// Imperfect sensors in a run: profiles and settings, determinism, effect on a map.
#include "crossnav/core/config_visitor.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/scoring/map_error.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/trace/trace_json.h"
#include "evaluation/embedded_house_fixture.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

RunConfig Read(const std::vector<std::string>& overrides, const std::filesystem::path& file = {}) {
  const auto config = ReadConfig({file, "full", overrides});
  EXPECT_TRUE(config) << config.error().Message();
  return config ? *config : RunConfig{};
}

TEST(NoiseConfig, WithoutAProfileEverythingIsAsBefore) {
  EXPECT_EQ(ConfigHash(Read({})), ConfigHash(RunConfig{}));
  EXPECT_EQ(ConfigHash(Read({"noise.profile=none"})), ConfigHash(RunConfig{}));
  EXPECT_EQ(Read({}).agent.map.clearing, "never");
  EXPECT_EQ(Read({"noise.slip=0.1"}).agent.map.clearing, "never");
}

TEST(NoiseConfig, AProfileGivesItsSettingsAndEvidenceClears) {
  const RunConfig config = Read({"noise.profile=kinect"});
  EXPECT_EQ(config.noise.profile, "kinect");
  EXPECT_EQ(config.noise.depth_max_m, 5);
  EXPECT_EQ(config.agent.map.clearing, "evidence");
  RunConfig again;
  ASSERT_TRUE(ApplyConfigText(DumpToml(config), "dump", again));
  EXPECT_EQ(ConfigHash(again), ConfigHash(config));
}

TEST(NoiseConfig, UserSettingsTakePrecedenceInAnyOrder) {
  const crossnav::test::TempFolder folder;
  const auto file = folder.path() / "a.toml";
  crossnav::test::WriteText(file, "[noise]\nslip = 0.5\n[map]\nclearing = \"never\"\n");
  const RunConfig config = Read({"noise.depth_max_m=9", "noise.profile=spot"}, file);
  EXPECT_EQ(config.noise.slip, 0.5);
  EXPECT_EQ(config.noise.depth_max_m, 9);
  EXPECT_EQ(config.noise.drop, 0.02);
  EXPECT_EQ(config.agent.map.clearing, "never");
}

TEST(NoiseConfig, AnUnknownProfileListsTheKnownProfiles) {
  const auto config = ReadConfig({{}, "full", {"noise.profile=lidar"}});
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().Message().find("noise.profile"), std::string::npos);
  EXPECT_NE(config.error().Message().find("none, realsense, kinect, spot"), std::string::npos);
}

TEST(NoiseConfig, EveryProfileIsWithinTheRangesOfItsSettings) {
  for (const char* profile : {"none", "realsense", "kinect", "spot"}) {
    RunConfig config = DefaultsOfProfile(profile), read;
    const auto ok = ApplyConfigText(DumpToml(config), profile, read);
    EXPECT_TRUE(ok) << ok.error().Message();
  }
}

/// Summary of an episode of a few steps.
struct Played {
  std::string record, traces;
  MapError map;
};

class Watcher : public RunObserver {
 public:
  explicit Watcher(const SceneContext& context) : context_(context) {}
  Result<void> OnStep(const StepView& step) override {
    played.traces += trace::ToJson(step.trace) + "\n";
    return {};
  }
  Result<void> OnEpisodeEnd(const agent::Agent& state, const EpisodeRecord& record) override {
    played.record = ToJsonLine(record, /*with_timings=*/false);
    played.map = MeasureMapError(state.map(), context_.caster());
    return {};
  }
  Played played;

 private:
  const SceneContext& context_;
};

class NoisyRun : public test::EmbeddedHouseTest {
 protected:
  static Played Play(const sim::NoiseConfig& noise) {
    RunConfig config = test::SmallConfig();
    config.eval.action_budget = 60;
    config.noise = noise;
    auto episode =
        MakeEpisode({scene_id_, context_.get()}, config, {"sofa", "toilet", "bed"}, 0, 1);
    EXPECT_TRUE(episode) << episode.error().Message();
    Watcher watcher(*context_);
    RunObserver* observers[] = {&watcher};
    const auto record = RunEpisode(*context_, *episode, config, observers);
    EXPECT_TRUE(record) << record.error().Message();
    return watcher.played;
  }
};

TEST_F(NoisyRun, OffIsThePerfectRunForEverySeed) {
  sim::NoiseConfig off;
  off.seed = 77;
  const Played perfect = Play({}), other = Play(off);
  EXPECT_EQ(perfect.record, other.record);
  EXPECT_EQ(perfect.traces, other.traces);
}

TEST_F(NoisyRun, TheSameSeedGivesTheSameBytes) {
  sim::NoiseConfig noise = sim::NoiseOfProfile("spot");
  const Played a = Play(noise), b = Play(noise);
  EXPECT_EQ(a.record, b.record);
  EXPECT_EQ(a.traces, b.traces);
  noise.seed = 2;
  EXPECT_NE(Play(noise).traces, a.traces);
}

TEST_F(NoisyRun, NoiseMakesTheMapWorse) {
  const Played perfect = Play({});
  EXPECT_GT(perfect.map.voxels, 1000);
  EXPECT_LT(perfect.map.mean_m, 0.06);  // half a voxel's diagonal at most, usually less
  EXPECT_LT(perfect.map.stray_share, 0.01);
  sim::NoiseConfig drift;
  drift.drift_xy_m = 0.05;
  sim::NoiseConfig depth;
  depth.depth_sigma_per_m2 = 0.03;
  for (const sim::NoiseConfig& noise : {drift, depth}) {
    const Played noisy = Play(noise);
    EXPECT_GT(noisy.map.stray_share, perfect.map.stray_share + 0.02);
    EXPECT_GT(noisy.map.mean_m, 1.1 * perfect.map.mean_m);
  }
}

}  // namespace
}  // namespace crossnav::evaluation
