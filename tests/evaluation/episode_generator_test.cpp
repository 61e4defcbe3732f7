// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/generation/episode_generator.h"

#include <set>

#include "evaluation/embedded_house_fixture.h"

namespace crossnav::evaluation {
namespace {

class EpisodeGenerator : public test::EmbeddedHouseTest {
 protected:
  static Result<EpisodeFile> Generate(int count, double share, std::uint64_t seed) {
    const GeneratorScene scene{scene_id_, context_.get()};
    return GenerateEpisodes({&scene, 1}, test::SmallConfig(), {count, share, seed});
  }
};

TEST_F(EpisodeGenerator, EveryCertificateHoldsAndTheShareIsMet) {
  const auto file = Generate(12, 0.5, 5);
  ASSERT_TRUE(file) << file.error().Message();
  int required = 0;
  std::set<int> first_stages;
  for (const Episode& episode : file->episodes) {
    EXPECT_TRUE(CheckCertificate(*context_, episode, test::SmallConfig()).empty());
    const std::set<std::string> different(episode.goals.begin(), episode.goals.end());
    EXPECT_EQ(different.size(), 3u);
    required += episode.cross_floor_required ? 1 : 0;
    if (episode.cross_floor_required) first_stages.insert(episode.first_transition_stage);
  }
  EXPECT_EQ(required, 6);
  EXPECT_EQ(first_stages, (std::set<int>{1, 2, 3}));
}

TEST_F(EpisodeGenerator, EveryStageOfAnAlternatingEpisodeRequiresAnotherFloor) {
  const GeneratorScene scene{scene_id_, context_.get()};
  GeneratorOptions options{6, 1.0, 5};
  options.alternating_share = 1;
  const auto file = GenerateEpisodes({&scene, 1}, test::SmallConfig(), options);
  ASSERT_TRUE(file) << file.error().Message();
  for (const Episode& episode : file->episodes) {
    EXPECT_TRUE(Alternates(episode));
    EXPECT_TRUE(CheckCertificate(*context_, episode, test::SmallConfig()).empty());
    for (std::size_t k = 0; k < episode.goals.size(); ++k) {  // one floor or the other, in turn
      const int other = k % 2 == 0 ? 1 - episode.start_floor : episode.start_floor;
      EXPECT_EQ(episode.certificate[k], std::vector<int>{other});
    }
  }
}

TEST_F(EpisodeGenerator, SaysHowManyEpisodesThereAreAfterEach) {
  const GeneratorScene scene{scene_id_, context_.get()};
  std::vector<int> told;
  const auto file = GenerateEpisodes({&scene, 1}, test::SmallConfig(),
                                     {3, 0, 5, {}, [&](int done) { told.push_back(done); }});
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_EQ(told, (std::vector<int>{1, 2, 3}));
}

TEST_F(EpisodeGenerator, CountsPerStageOfTheFirstTransitionAreExact) {
  const GeneratorScene scene{scene_id_, context_.get()};
  const auto file = GenerateEpisodes({&scene, 1}, test::SmallConfig(), {9, 0.9, 5, {3, 0, 2}});
  ASSERT_TRUE(file) << file.error().Message();
  std::map<int, int> stages;
  for (const Episode& episode : file->episodes) ++stages[episode.first_transition_stage];
  EXPECT_EQ(stages, (std::map<int, int>{{0, 4}, {1, 3}, {3, 2}}));
}

TEST_F(EpisodeGenerator, SceneBySceneLoadsOneSceneAtATimeAndMeetsEveryCount) {
  const std::vector<std::string> ids = {scene_id_, scene_id_, scene_id_};
  int loads = 0;
  const auto load = [&](const std::string& id) {
    ++loads;
    return SceneContext::Load(folder_->path(), id, test::SmallConfig());
  };
  const auto file = GenerateByScene(ids, load, test::SmallConfig(), {9, 0.9, 5, {3, 0, 2}});
  ASSERT_TRUE(file) << file.error().Message();
  std::map<int, int> stages;
  std::set<std::string> different;
  for (const Episode& episode : file->episodes) {
    ++stages[episode.first_transition_stage];
    different.insert(episode.episode_id);
    EXPECT_TRUE(CheckCertificate(*context_, episode, test::SmallConfig()).empty());
  }
  EXPECT_EQ(stages, (std::map<int, int>{{0, 4}, {1, 3}, {3, 2}}));
  EXPECT_EQ(different.size(), 9u);
  EXPECT_EQ(loads, 3);
  EXPECT_FALSE(file->goals_by_category.empty());
}

TEST_F(EpisodeGenerator, SceneBySceneRetriesAllScenesForMissingEpisodes) {
  const std::vector<std::string> ids = {scene_id_};
  int loads = 0;
  const auto load = [&](const std::string& id) {
    ++loads;
    return SceneContext::Load(folder_->path(), id, test::SmallConfig());
  };
  RunConfig config = test::SmallConfig();
  config.dataset.min_first_goal_m = 1000;
  EXPECT_FALSE(GenerateByScene(ids, load, config, {2, 0, 5}).has_value());
  EXPECT_EQ(loads, 2);
}

TEST_F(EpisodeGenerator, CrossFloorFollowsFromFloorsAlone) {
  const auto file = Generate(8, 0.5, 6);
  ASSERT_TRUE(file) << file.error().Message();
  for (const Episode& episode : file->episodes) {
    int first = 0;
    for (std::size_t k = 0; k < episode.goals.size() && first == 0; ++k) {
      bool is_here = false;
      for (const Target& target : context_->TargetsOf(episode.goals[k])) {
        for (const Vector3d& p : target.viewpoints_world) {
          is_here = is_here || context_->navmesh().FloorOf(p) == episode.start_floor;
        }
      }
      if (!is_here) first = static_cast<int>(k) + 1;
    }
    EXPECT_EQ(episode.first_transition_stage, first) << episode.episode_id;
  }
}

TEST_F(EpisodeGenerator, SameSeedSameEpisodes) {
  const auto a = Generate(4, 0.5, 7), b = Generate(4, 0.5, 7), c = Generate(4, 0.5, 8);
  ASSERT_TRUE(a && b && c);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(a->episodes[i].episode_id, b->episodes[i].episode_id);
    EXPECT_NE(a->episodes[i].episode_id, c->episodes[i].episode_id);
  }
}

TEST_F(EpisodeGenerator, TamperedCertificatesAreFound) {
  auto file = Generate(1, 1.0, 9);
  ASSERT_TRUE(file) << file.error().Message();
  const Episode good = file->episodes[0];
  Episode floors = good, stage = good, moved = good;
  floors.certificate[0] = {0, 1, 2};
  stage.first_transition_stage = 0;
  moved.start.p_world.x() += 0.1;
  for (const Episode& bad : {floors, stage, moved}) {
    EXPECT_FALSE(CheckCertificate(*context_, bad, test::SmallConfig()).empty());
  }
}

TEST_F(EpisodeGenerator, RefusesUncertifiableEpisodes) {
  const GeneratorScene scene{scene_id_, context_.get()};
  RunConfig config = test::SmallConfig();
  config.dataset.goals = 7;  // there are six categories
  config.dataset.tries_per_episode = 5;
  const auto file = GenerateEpisodes({&scene, 1}, config, {1, 0.0, 1});
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().Message().find("cannot certify"), std::string::npos);
}

TEST_F(EpisodeGenerator, UnknownGoalIsNamed) {
  Episode episode;
  episode.where = "e.json: episodes[0]";
  episode.start.p_world = context_->TargetsOf("sofa")[0].viewpoints_world[0];
  episode.goals = {"sofa", "unicorn"};
  const auto ok = CheckPlayable(*context_, episode);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().Message().find("unicorn"), std::string::npos);
  EXPECT_NE(ok.error().Message().find("e.json"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::evaluation
