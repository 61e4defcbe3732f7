// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/episodes/habitat_episodes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <set>

#include "crossnav/evaluation/episodes/habitat_frame.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "support/places.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

Episode MakeEpisode() {
  Episode episode;
  episode.scene_id = "val/00001-House/House.glb";
  episode.start.p_world = {1.2345, -2.5, 0.05};
  episode.start.yaw_rad = DegToRad(123);
  episode.goals = {"sofa", "bed"};
  episode.has_certificate = true;
  episode.floors = {{0, 0.05}, {1, 2.85}};
  episode.certificate = {{0}, {1}};
  episode.cross_floor_required = true;
  episode.first_transition_stage = 2;
  episode.episode_id = ContentId(episode);
  return episode;
}

TEST(HabitatFrame, RoundTripAndKnownPoses) {
  const Vector3d p(1, 2, 3);
  EXPECT_EQ(WorldFromHabitat(HabitatFromWorld(p)), p);
  EXPECT_EQ(WorldFromHabitat({0, 0, -1}), Vector3d(1, 0, 0));  // forward
  EXPECT_EQ(WorldFromHabitat({-1, 0, 0}), Vector3d(0, 1, 0));  // left
  EXPECT_DOUBLE_EQ(YawFromHabitat({0, 0, 0, 1}), 0);
  for (const double yaw : {-3.0, -1.0, 0.5, 2.9}) {
    EXPECT_NEAR(YawFromHabitat(HabitatFromYaw(yaw)), yaw, 1e-12);
  }
}

TEST(Episodes, OurFileRoundTripsPlainAndGzip) {
  const crossnav::test::TempFolder folder;
  EpisodeFile file;
  file.episodes = {MakeEpisode()};
  file.goals_by_category["House.glb_sofa"] = {{7, "loveseat", "sofa", {1, 2, 0.4}, {{1, 1, 0}}}};
  for (const char* name : {"e.json", "e.json.gz"}) {
    const auto path = folder.path() / name;
    ASSERT_TRUE(WriteEpisodes(path, file));
    const auto read = ReadEpisodes(path);
    ASSERT_TRUE(read) << read.error().Message();
    ASSERT_EQ(read->episodes.size(), 1u);
    const Episode &a = file.episodes[0], &b = read->episodes[0];
    EXPECT_EQ(b.episode_id, a.episode_id);
    EXPECT_EQ(b.scene_id, a.scene_id);
    EXPECT_EQ(b.goals, a.goals);
    EXPECT_EQ(b.floors, a.floors);
    EXPECT_EQ(b.certificate, a.certificate);
    EXPECT_EQ(b.first_transition_stage, 2);
    EXPECT_TRUE(b.cross_floor_required);
    EXPECT_NEAR((b.start.p_world - a.start.p_world).norm(), 0, 1e-5);
    EXPECT_NEAR(b.start.yaw_rad, a.start.yaw_rad, 1e-4);
    EXPECT_EQ(read->goals_by_category.at("House.glb_sofa")[0].viewpoints_world.size(), 1u);
  }
}

TEST(Episodes, IdSurvivesTheRoundTripForEveryHeading) {
  const crossnav::test::TempFolder folder;
  EpisodeFile file;
  for (int degrees = -179; degrees <= 180; ++degrees) {
    Episode episode = MakeEpisode();
    episode.start.yaw_rad = DegToRad(degrees);
    episode.episode_id = ContentId(episode);
    file.episodes.push_back(episode);
  }
  ASSERT_TRUE(WriteEpisodes(folder.path() / "e.json", file));
  const auto read = ReadEpisodes(folder.path() / "e.json");
  ASSERT_TRUE(read) << read.error().Message();
  for (const Episode& episode : read->episodes) EXPECT_EQ(ContentId(episode), episode.episode_id);
}

TEST(Episodes, SameContentGivesTheSameBytes) {
  const crossnav::test::TempFolder folder;
  EpisodeFile file;
  file.episodes = {MakeEpisode()};
  ASSERT_TRUE(WriteEpisodes(folder.path() / "a.json.gz", file));
  ASSERT_TRUE(WriteEpisodes(folder.path() / "b.json.gz", file));
  const auto a = ReadTextFile(folder.path() / "a.json.gz");
  const auto b = ReadTextFile(folder.path() / "b.json.gz");
  EXPECT_EQ(*a, *b);
}

TEST(Episodes, OneMapFileGetsIdsFromContent) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "scene_episodes.json";
  ASSERT_TRUE(WriteTextFile(path, R"({"episodes":[
    {"start_position":[1,0.1,2],"start_rotation":[0,0,0,1],"object_goals":["chair","bed"],
     "scene_id":"hm3d/val/00800-A/A.basis.glb","floor":0,"best_seq_dists":[[2.5,[0,0,0]]]}]})"));
  const auto file = ReadEpisodes(path);
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_EQ(file->format, EpisodeFormat::kOneMap);
  EXPECT_EQ(file->episodes[0].goals, (std::vector<std::string>{"chair", "bed"}));
  EXPECT_EQ(file->episodes[0].episode_id, ContentId(file->episodes[0]));
  EXPECT_TRUE(file->episodes[0].episode_id.starts_with("00800-A-"));
  EXPECT_EQ(file->episodes[0].start.p_world, Vector3d(-2, -1, 0.1));
}

TEST(Episodes, RealObjectNavFilesAreRead) {
  const std::filesystem::path path =
      crossnav::test::SharedPath("data/objectnav_mini/v2/val_mini.json.gz");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const auto file = ReadEpisodes(path);
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_EQ(file->format, EpisodeFormat::kObjectNav);
  ASSERT_EQ(file->episodes.size(), 30u);
  const Episode& first = file->episodes[0];
  EXPECT_EQ(first.episode_id, "00800-TEEsavR23oF-7");
  EXPECT_EQ(first.goals, std::vector<std::string>{"bed"});
  EXPECT_TRUE(first.start.p_world.isApprox(Vector3d(2.67815, 3.99935, 0.01338), 1e-9));
  EXPECT_EQ(file->goals_by_category.at("TEEsavR23oF.basis.glb_chair").size(), 12u);
  EXPECT_FALSE(
      file->goals_by_category.at("wcojb4TFT35.basis.glb_sofa")[0].viewpoints_world.empty());
}

// Made by hand after the v1 files of Matterport3D: ids of that dataset, a start room, a
// category outside of ours, shortest paths as action numbers.
TEST(Episodes, AnObjectNavFileOfVersion1IsRead) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "17DRP5sb8fy.json.gz";
  ASSERT_TRUE(WriteTextFile(path, R"({
    "category_to_task_category_id": {"chair": 0, "chest_of_drawers": 6},
    "category_to_mp3d_category_id": {"chair": 3, "chest_of_drawers": 13},
    "goals_by_category": {
      "17DRP5sb8fy.glb_chest_of_drawers": [
        {"object_id": 42, "object_name": "mp3d/17DRP5sb8fy/object_42", "object_name_id": 7,
         "object_category": "chest_of_drawers", "room_id": 3, "room_name": "bedroom",
         "position": [1.0, 0.4, 2.0], "radius": null,
         "view_points": [{"agent_state": {"position": [1.0, 0.1, 3.0], "rotation": [0, 0, 0, 1]},
                          "iou": 0.2}]}]},
    "episodes": [
      {"episode_id": 0, "scene_id": "mp3d/17DRP5sb8fy/17DRP5sb8fy.glb",
       "start_position": [-3.0, 0.1, 0.5], "start_rotation": [0, 0, 0, 1], "start_room": "2",
       "info": {"geodesic_distance": 7.1, "closest_goal_object_id": 42}, "goals": [],
       "shortest_paths": [[1, 1, 3, null]], "object_category": "chest_of_drawers"}]})"));
  const auto file = ReadEpisodes(path);
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_EQ(file->format, EpisodeFormat::kObjectNav);
  ASSERT_EQ(file->episodes.size(), 1u);
  EXPECT_EQ(file->episodes[0].episode_id, "17DRP5sb8fy-0");
  EXPECT_EQ(file->episodes[0].goals, std::vector<std::string>{"chest_of_drawers"});
  EXPECT_EQ(file->episodes[0].start.p_world, Vector3d(-0.5, 3, 0.1));
  const auto& goals = file->goals_by_category.at("17DRP5sb8fy.glb_chest_of_drawers");
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].object_id, 42);
  EXPECT_EQ(goals[0].viewpoints_world, std::vector<Vector3d>{Vector3d(-3, -1, 0.1)});
}

// The oldest v1 files have no goals_by_category and name the category at the goals only.
TEST(Episodes, GoalsInsideTheEpisodesOfAnObjectNavFileAreRead) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "old.json";
  const auto episode = [](int id, const char* scene, double x) {
    return R"({"episode_id": ")" + std::to_string(id) + R"(", "scene_id": "mp3d/)" + scene + "/" +
           scene + R"(.glb", "start_position": [0, 0, 0], "start_rotation": [0, 0, 0, 1],
           "goals": [{"object_id": 5, "object_name": "bed_5", "object_category": "bed",
           "position": [)" +
           std::to_string(x) + R"(, 0, 0], "view_points": [
           {"agent_state": {"position": [2, 0, 0], "rotation": [0, 0, 0, 1]}, "iou": 0.5}]}]})";
  };
  ASSERT_TRUE(WriteTextFile(path, R"({"episodes": [)" + episode(1, "A", 1) + "," +
                                      episode(2, "A", 9) + "," + episode(1, "B", 3) + "]}"));
  const auto file = ReadEpisodes(path);
  ASSERT_TRUE(file) << file.error().Message();
  ASSERT_EQ(file->episodes.size(), 3u);
  EXPECT_EQ(file->episodes[2].goals, std::vector<std::string>{"bed"});
  ASSERT_EQ(file->goals_by_category.size(), 2u);
  ASSERT_EQ(file->goals_by_category.at("A.glb_bed").size(), 1u);
  EXPECT_EQ(file->goals_by_category.at("A.glb_bed")[0].p_world, Vector3d(0, -1, 0));
  EXPECT_EQ(file->goals_by_category.at("B.glb_bed")[0].p_world, Vector3d(0, -3, 0));
}

TEST(Episodes, EveryGoalOfTheRealFilesHasViewpointsOfItsScene) {
  const std::filesystem::path path =
      crossnav::test::SharedPath("data/objectnav_mini/v2/val_mini.json.gz");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const auto file = ReadEpisodes(path);
  ASSERT_TRUE(file) << file.error().Message();
  for (const Episode& episode : file->episodes) {
    ASSERT_EQ(episode.goals.size(), 1u);
    const std::string key =
        std::filesystem::path(episode.scene_id).filename().string() + "_" + episode.goals[0];
    const auto goals = file->goals_by_category.find(key);
    ASSERT_NE(goals, file->goals_by_category.end()) << key;
    for (const GoalObject& goal : goals->second) EXPECT_FALSE(goal.viewpoints_world.empty()) << key;
  }
}

struct BadFile {
  const char* text;
  const char* message;
};

class BadEpisodes : public testing::TestWithParam<BadFile> {};

TEST_P(BadEpisodes, GiveOneErrorWithFileAndKey) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "bad.json";
  ASSERT_TRUE(WriteTextFile(path, GetParam().text));
  const auto file = ReadEpisodes(path);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().Message().find("bad.json"), std::string::npos);
  EXPECT_NE(file.error().Message().find(GetParam().message), std::string::npos)
      << file.error().Message();
}

INSTANTIATE_TEST_SUITE_P(
    All, BadEpisodes,
    testing::Values(BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,0,2],)"
                            R"("start_rotation":[0,0,0,1],"goals":[],"episode_id":"7"}]})",
                            "object_category"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,0,2],)"
                            R"("start_rotation":[0,0,0,1],"goals":[],"object_category":"bed"}]})",
                            "episode_id"},
                    BadFile{R"({"episodes":[],"goals_by_category":{"a_bed":[{"position":[0,1]}]}})",
                            "goals_by_category[\"a_bed\"]"},
                    BadFile{R"({"episodes":[],"goals_by_category":{"a_bed":[{"position":[0,1,2],)"
                            R"("view_points":[{"iou":1}]}]}})",
                            "agent_state"},
                    BadFile{"", "JSON"}, BadFile{"{\"episodes\": 3}", "episodes"},
                    BadFile{"[]", "episodes"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,NaN,2],)"
                            R"("start_rotation":[0,0,0,1],"goals":["bed"],"episode_id":"x"}]})",
                            "start_position"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,null,2],)"
                            R"("start_rotation":[0,0,0,1],"goals":["bed"],"episode_id":"x"}]})",
                            "start_position"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,2],)"
                            R"("start_rotation":[0,0,0,1],"goals":["bed"],"episode_id":"x"}]})",
                            "start_position"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,2,3],)"
                            R"("start_rotation":[0,0,0,0],"goals":["bed"],"episode_id":"x"}]})",
                            "start_rotation"},
                    BadFile{R"({"episodes":[{"start_position":[1,2,3],"start_rotation":[0,0,0,1],)"
                            R"("goals":["bed"],"episode_id":"x"}]})",
                            "scene_id"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,2,3],)"
                            R"("start_rotation":[0,0,0,1],"goals":["bed"]}]})",
                            "episode_id"},
                    BadFile{R"({"episodes":[{"scene_id":"a","start_position":[1,2,3],)"
                            R"("start_rotation":[0,0,0,1],"goals":["bed","sofa"],"episode_id":"x",)"
                            R"("floors":[],"start_floor":0,"cross_floor_required":false,)"
                            R"("first_transition_stage":0,"certificate":[[0]]}]})",
                            "certificate"}));

TEST(Episodes, TruncatedGzipIsAnErrorAtEveryLength) {
  const crossnav::test::TempFolder folder;
  EpisodeFile file;
  file.episodes = {MakeEpisode()};
  const auto path = folder.path() / "e.json.gz";
  ASSERT_TRUE(WriteEpisodes(path, file));
  const auto size = std::filesystem::file_size(path);
  for (std::uintmax_t cut = size - 1; cut > 20; cut -= 37) {
    std::filesystem::resize_file(path, cut);
    EXPECT_FALSE(ReadEpisodes(path)) << cut;
    if (cut < 57) break;
  }
}

TEST(Episodes, AGzipBombIsRefusedBeforeItFillsTheMemory) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "bomb.json.gz";
  const std::string blanks(std::size_t{16} << 20, ' ');
  ASSERT_TRUE(WriteTextFile(path, blanks));
  // Members of a gzip file follow one another.
  const std::string one = crossnav::test::ReadText(path);
  std::string bomb;
  for (int i = 0; i < 40; ++i) bomb += one;
  crossnav::test::WriteText(path, bomb);
  const auto file = ReadEpisodes(path);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().what.find("more than 512 MiB"), std::string::npos) << file.error().what;
}

TEST(Episodes, DuplicateIdsAreRefused) {
  const crossnav::test::TempFolder folder;
  EpisodeFile file;
  file.episodes = {MakeEpisode(), MakeEpisode()};
  ASSERT_TRUE(WriteEpisodes(folder.path() / "e.json", file));
  EXPECT_FALSE(ReadEpisodes(folder.path() / "e.json"));
}

TEST(Episodes, SceneNameIsTheFolder) {
  EXPECT_EQ(SceneName("hm3d/val/00800-A/A.basis.glb"), "00800-A");
  EXPECT_EQ(SceneName("00800-A"), "00800-A");
  EXPECT_EQ(SceneName("val/00800-A"), "00800-A");
}

TEST(HabitatEpisodes, HoldOnlyKeysThatHabitatLabKnowsAndKeepOursUnderInfo) {
  const crossnav::test::TempFolder dir;
  EpisodeFile file;
  Episode episode;
  episode.episode_id = "00001-A-1";
  episode.scene_id = "00001-A/A.glb";
  episode.goals = {"sofa", "bed"};
  episode.certificate = {{0}, {1}};
  episode.cross_floor_required = true;
  episode.first_transition_stage = 2;
  file.episodes = {episode};
  file.goals_by_category["A.glb_sofa"] = {{7, "couch", "sofa", {1, 2, 3}, {{1, 1, 0}}}};
  const auto path = dir.path() / "habitat.json";
  ASSERT_TRUE(WriteHabitatEpisodes(path, file));
  const auto json = nlohmann::json::parse(ReadTextFile(path).value());
  const std::set<std::string> known{"episode_id",
                                    "scene_id",
                                    "scene_dataset_config",
                                    "start_position",
                                    "start_rotation",
                                    "object_category",
                                    "goals",
                                    "info"};
  const auto& written = json["episodes"][0];
  for (const auto& [key, value] : written.items()) EXPECT_TRUE(known.contains(key)) << key;
  EXPECT_EQ(written["object_category"], "sofa");
  EXPECT_EQ(written["info"]["goals"], nlohmann::json({"sofa", "bed"}));
  EXPECT_EQ(written["info"]["certificate"], nlohmann::json({{0}, {1}}));
  EXPECT_EQ(written["scene_dataset_config"], "crossnav.scene_dataset_config.json");
  EXPECT_EQ(json["goals_by_category"]["A.glb_sofa"][0]["view_points"][0]["iou"], 1.0);
}

}  // namespace
}  // namespace crossnav::evaluation
