// SPDX-License-Identifier: MIT
// Pictures of goals in episode files.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "crossnav/core/base64.h"
#include "crossnav/core/png_image.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/perception/goal_picture.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

/// A red square on grey.
std::shared_ptr<const StagePicture> SmallPicture() {
  StagePicture picture;
  picture.picture.rgb = RgbImage(40, 32, {120, 120, 120});
  for (int v = 8; v < 24; ++v)
    for (int u = 10; u < 30; ++u) picture.picture.rgb.At(u, v) = {200, 20, 20};
  picture.picture.box = perception::PixelBox{10, 8, 30, 24};
  picture.object_id = 7;
  picture.taken_from = {{1.5, -2, 0.05}, DegToRad(40), 0};
  picture.camera_height_m = 1.2;
  picture.hfov_deg = 75;
  return std::make_shared<const StagePicture>(std::move(picture));
}

EpisodeFile FileWithPicture() {
  Episode episode;
  episode.scene_id = "val/00001-House/House.glb";
  episode.goals = {"sofa", "bed"};
  episode.floors = {{0, 0.0}};
  episode.certificate = {{0}, {0}};
  const auto picture = SmallPicture();
  episode.goals[1] = perception::NameOfPicture(picture->picture);
  episode.pictures[episode.goals[1]] = picture;
  episode.episode_id = ContentId(episode);
  EpisodeFile file;
  file.episodes = {episode};
  return file;
}

TEST(Episodes, APictureOfAGoalRoundTrips) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "e.json.gz";
  const EpisodeFile file = FileWithPicture();
  ASSERT_TRUE(WriteEpisodes(path, file));
  const auto read = ReadEpisodes(path);
  ASSERT_TRUE(read) << read.error().Message();
  const std::string& goal = read->episodes[0].goals[1];
  ASSERT_EQ(read->episodes[0].pictures.count(goal), 1U);
  const StagePicture &a = *file.episodes[0].pictures.begin()->second,
                     &b = *read->episodes[0].pictures.at(goal);
  EXPECT_EQ(b.picture.rgb.data, a.picture.rgb.data);
  EXPECT_EQ(b.picture.box, a.picture.box);
  EXPECT_EQ(b.object_id, 7);
  EXPECT_NEAR((b.taken_from.p_world - a.taken_from.p_world).norm(), 0, 1e-5);
  EXPECT_NEAR(b.taken_from.yaw_rad, a.taken_from.yaw_rad, 1e-4);
  EXPECT_EQ(b.camera_height_m, 1.2);
  EXPECT_EQ(b.hfov_deg, 75);
}

TEST(Episodes, MissingAndDamagedPicturesAreErrorsThatNameThem) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "e.json";
  const EpisodeFile file = FileWithPicture();
  ASSERT_TRUE(WriteEpisodes(path, file));
  const nlohmann::json good = nlohmann::json::parse(crossnav::test::ReadText(path));
  const std::string name = file.episodes[0].goals[1];
  const auto expect = [&](const char* what, const std::function<void(nlohmann::json&)>& change) {
    nlohmann::json bad = good;
    change(bad);
    crossnav::test::WriteText(path, bad.dump());
    const auto read = ReadEpisodes(path);
    ASSERT_FALSE(read) << what;
    EXPECT_NE(read.error().Message().find(what), std::string::npos) << read.error().Message();
    EXPECT_EQ(read.error().Message().find('\n'), std::string::npos);
  };
  const auto entry = [&](nlohmann::json& json) -> nlohmann::json& {
    return json["goal_pictures"][name];
  };
  expect("is not in \"goal_pictures\"", [](auto& json) { json.erase("goal_pictures"); });
  expect("is no object", [](auto& json) { json["goal_pictures"] = 3; });
  expect("is no object", [&](auto& json) { json["goal_pictures"][name] = "x"; });
  expect("\"png\" is missing", [&](auto& json) { entry(json).erase("png"); });
  expect("no base64", [&](auto& json) { entry(json)["png"] = "%%%%"; });
  expect("PNG", [&](auto& json) { entry(json)["png"] = "AAAA"; });
  expect("PNG", [&](auto& json) {
    const auto png = entry(json)["png"].template get<std::string>();
    entry(json)["png"] = png.substr(0, png.size() / 8 * 4);
  });
  expect("too long", [&](auto& json) { entry(json)["png"] = std::string(6 << 20, 'A'); });
  expect("damaged", [&](auto& json) {
    json["goal_pictures"][name]["png"] = Base64(EncodePng(RgbImage(40, 32, {1, 2, 3})));
  });
  expect("more than 1024 px", [&](auto& json) {
    entry(json)["png"] = Base64(EncodePng(RgbImage(2000, 32, {1, 2, 3})));
  });
  expect("\"box\"", [&](auto& json) { entry(json)["box"] = {1, 2, 3}; });
  expect("\"box\"", [&](auto& json) { entry(json)["box"] = {0, 0, 1e300, 4}; });
  expect("leaves it", [&](auto& json) { entry(json)["box"] = {0, 0, 400, 4}; });
  expect("hfov_deg", [&](auto& json) { entry(json)["hfov_deg"] = 0; });
  expect("object_id", [&](auto& json) { entry(json)["object_id"] = 1e30; });
  expect("position", [&](auto& json) { entry(json)["position"] = {1, 2}; });
}

}  // namespace
}  // namespace crossnav::evaluation
