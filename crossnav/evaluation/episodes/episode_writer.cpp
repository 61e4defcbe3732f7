// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "crossnav/core/base64.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/png_image.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/episodes/habitat_episodes.h"
#include "crossnav/evaluation/episodes/habitat_frame.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

/// Rounded to 1e-5 m, as Habitat's files are.
double RoundedForFile(double value) {
  const double rounded = std::round(value * 1e5) / 1e5;
  return rounded == 0 ? 0 : rounded;  // no -0
}

Json PositionJson(const Vector3d& p_world) {
  const Vector3d p = HabitatFromWorld(p_world);
  return Json::array({RoundedForFile(p.x()), RoundedForFile(p.y()), RoundedForFile(p.z())});
}

Json RotationJson(double yaw_rad) {
  const auto q = HabitatFromYaw(yaw_rad);
  return Json::array({q[0], RoundedForFile(q[1]), q[2], RoundedForFile(q[3])});
}

Json EpisodeJson(const Episode& episode) {
  Json floors = Json::array();
  for (const EpisodeFloor& floor : episode.floors) {
    floors.push_back({{"id", floor.id}, {"height_m", RoundedForFile(floor.height_m)}});
  }
  Json json = {{"episode_id", episode.episode_id},
               {"scene_id", episode.scene_id},
               {"scene_dataset_config", "scene_dataset_config.json"},
               {"start_position", PositionJson(episode.start.p_world)},
               {"start_rotation", RotationJson(episode.start.yaw_rad)},
               {"object_category", episode.goals.front()},
               {"goals", episode.goals},
               {"floors", std::move(floors)},
               {"start_floor", episode.start_floor},
               {"cross_floor_required", episode.cross_floor_required},
               {"first_transition_stage", episode.first_transition_stage},
               {"certificate", episode.certificate}};
  if (!episode.track.empty()) json["track"] = episode.track;
  return json;
}

/// The episode with our own keys under "info".
Json HabitatEpisodeJson(const Episode& episode) {
  Json json = EpisodeJson(episode);
  Json info;
  for (const char* key : {"goals", "floors", "start_floor", "cross_floor_required",
                          "first_transition_stage", "certificate", "track"}) {
    if (!json.contains(key)) continue;
    info[key] = std::move(json[key]);
    json.erase(key);
  }
  json["scene_dataset_config"] = kSceneDatasetConfig;
  json["goals"] = Json::array();
  json["info"] = std::move(info);
  return json;
}

/// Yaw at which an agent at `from` faces `to`.
double YawTowards(const Vector3d& from, const Vector3d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

Json GoalJson(const GoalObject& goal) {
  Json viewpoints = Json::array();
  for (const Vector3d& p_world : goal.viewpoints_world) {
    viewpoints.push_back({{"agent_state",
                           {{"position", PositionJson(p_world)},
                            {"rotation", RotationJson(YawTowards(p_world, goal.p_world))}}}});
  }
  Json json = {{"position", PositionJson(goal.p_world)},
               {"object_id", goal.object_id},
               {"object_name", goal.name},
               {"object_category", goal.category},
               {"view_points", std::move(viewpoints)}};
  if (!goal.is_confirmable) json["confirmable"] = false;
  return json;
}

Json PictureJson(const StagePicture& picture) {
  Json json = {{"png", Base64(EncodePng(picture.picture.rgb))},
               {"object_id", picture.object_id},
               {"position", PositionJson(picture.taken_from.p_world)},
               {"rotation", RotationJson(picture.taken_from.yaw_rad)},
               {"camera_height_m", RoundedForFile(picture.camera_height_m)},
               {"hfov_deg", RoundedForFile(picture.hfov_deg)}};
  if (const auto& box = picture.picture.box) json["box"] = {box->u0, box->v0, box->u1, box->v1};
  return json;
}

Json FileJson(const EpisodeFile& file, Json (*episode_json)(const Episode&)) {
  Json goals_by_category = Json::object();
  for (const auto& [key, goals] : file.goals_by_category) {
    Json list = Json::array();
    for (const GoalObject& goal : goals) list.push_back(GoalJson(goal));
    goals_by_category[key] = std::move(list);
  }
  Json episodes = Json::array();
  for (const Episode& episode : file.episodes) episodes.push_back(episode_json(episode));
  Json ids = Json::object();
  for (std::size_t i = 0; i < kCategories.size(); ++i) ids[std::string(kCategories[i])] = i;
  Json json = {{"goals_by_category", std::move(goals_by_category)},
               {"episodes", std::move(episodes)},
               {"category_to_task_category_id", ids},
               {"category_to_scene_annotation_category_id", ids}};
  Json pictures = Json::object();
  for (const Episode& episode : file.episodes)
    for (const auto& [name, picture] : episode.pictures)
      if (!pictures.contains(name)) pictures[name] = PictureJson(*picture);
  if (!pictures.empty()) json["goal_pictures"] = std::move(pictures);
  if (file.certificate_edition > 1) json["certificate_edition"] = file.certificate_edition;
  return json;
}

}  // namespace

std::string ContentId(const Episode& episode) {
  // Whole tenths of millimetres and hundredths of degrees: unchanged by any round trip.
  const auto whole = [](double value, double unit) { return std::llround(value / unit); };
  const Vector3d& p = episode.start.p_world;
  const auto yaw = (whole(RadToDeg(episode.start.yaw_rad), 0.01) % 36000 + 36000) % 36000;
  const Json content = {SceneName(episode.scene_id),
                        {whole(p.x(), 1e-4), whole(p.y(), 1e-4), whole(p.z(), 1e-4), yaw},
                        episode.goals};
  return SceneName(episode.scene_id) + "-" + HexHash(HashString(content.dump())).substr(0, 10);
}

Result<void> WriteEpisodes(const std::filesystem::path& path, const EpisodeFile& file) {
  return WriteTextFile(path, FileJson(file, EpisodeJson).dump() + "\n");
}

Result<void> WriteHabitatEpisodes(const std::filesystem::path& path, const EpisodeFile& file) {
  Json json = FileJson(file, HabitatEpisodeJson);
  for (auto& [key, goals] : json["goals_by_category"].items()) {
    for (Json& goal : goals) {
      goal.erase("confirmable");
      for (Json& viewpoint : goal["view_points"]) viewpoint["iou"] = 1.0;
    }
  }
  return WriteTextFile(path, json.dump() + "\n");
}

}  // namespace crossnav::evaluation
