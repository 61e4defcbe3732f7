// SPDX-License-Identifier: MIT
#include <simdjson.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/episodes/habitat_frame.h"
#include "crossnav/evaluation/episodes/picture_json.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/not_a_number.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

namespace dom = simdjson::dom;

tl::unexpected<Error> Malformed(const std::string& what, const std::string& where) {
  return Fail(ErrorCode::kMalformed, what, where);
}

Result<std::string> GetString(dom::object object, std::string_view key, const std::string& where) {
  std::string_view text;
  if (object[key].get(text) != simdjson::SUCCESS) {
    return Malformed("key \"" + std::string(key) + "\" is missing or no string", where);
  }
  return std::string(text);
}

/// `n` finite numbers.
template <std::size_t n>
Result<std::array<double, n>> GetNumbers(dom::object object, std::string_view key,
                                         const std::string& where) {
  const std::string name = "key \"" + std::string(key) + "\"";
  dom::array list;
  if (object[key].get(list) != simdjson::SUCCESS) {
    return Malformed(name + " is missing or no list", where);
  }
  std::array<double, n> numbers{};
  std::size_t count = 0;
  for (const dom::element element : list) {
    double number = 0;
    if (element.get(number) != simdjson::SUCCESS || !std::isfinite(number)) {
      return Fail(ErrorCode::kInvalid, name + " holds something that is no finite number", where);
    }
    if (count < n) numbers[count] = number;
    ++count;
  }
  if (count != n) return Malformed(name + " must hold " + std::to_string(n) + " numbers", where);
  return numbers;
}

Result<AgentPose> GetStart(dom::object object, const std::string& where) {
  const auto position = GetNumbers<3>(object, "start_position", where);
  if (!position) return tl::unexpected(position.error());
  const auto rotation = GetNumbers<4>(object, "start_rotation", where);
  if (!rotation) return tl::unexpected(rotation.error());
  double norm = 0;
  for (const double q : *rotation) norm += q * q;
  if (std::abs(norm - 1) > 0.02) {
    return Fail(ErrorCode::kInvalid, "key \"start_rotation\" is no unit quaternion", where);
  }
  AgentPose start;
  start.p_world = WorldFromHabitat({(*position)[0], (*position)[1], (*position)[2]});
  start.yaw_rad = YawFromHabitat(*rotation);
  return start;
}

Result<std::vector<std::string>> GetStrings(dom::object object, std::string_view key,
                                            const std::string& where) {
  const std::string name = "key \"" + std::string(key) + "\"";
  dom::array list;
  if (object[key].get(list) != simdjson::SUCCESS) return Malformed(name + " is no list", where);
  std::vector<std::string> strings;
  for (const dom::element element : list) {
    std::string_view text;
    if (element.get(text) != simdjson::SUCCESS || text.empty()) {
      return Malformed(name + " holds something that is no name", where);
    }
    strings.emplace_back(text);
  }
  if (strings.empty()) return Malformed(name + " is empty", where);
  return strings;
}

bool HoldsStrings(dom::object object, std::string_view key) {
  dom::array list;
  if (object[key].get(list) != simdjson::SUCCESS || list.size() == 0) return false;
  return list.at(0).is_string();
}

/// Floors, certificate and derived fields of an episode in our format.
Result<void> ReadCertificate(dom::object object, Episode& episode) {
  dom::array floors, stages;
  std::int64_t start_floor = 0, first = 0;
  bool is_cross_floor = false;
  if (object["certificate"].get(stages) != simdjson::SUCCESS) return {};
  if (object["floors"].get(floors) != simdjson::SUCCESS ||
      object["start_floor"].get(start_floor) != simdjson::SUCCESS ||
      object["cross_floor_required"].get(is_cross_floor) != simdjson::SUCCESS ||
      object["first_transition_stage"].get(first) != simdjson::SUCCESS) {
    return Malformed(
        "keys \"floors\", \"start_floor\", \"cross_floor_required\" and "
        "\"first_transition_stage\" must stand beside \"certificate\"",
        episode.where);
  }
  for (const dom::element floor : floors) {
    std::int64_t id = 0;
    double height_m = 0;
    if (floor["id"].get(id) != simdjson::SUCCESS ||
        floor["height_m"].get(height_m) != simdjson::SUCCESS) {
      return Malformed("key \"floors\" holds something without id and height_m", episode.where);
    }
    episode.floors.push_back({static_cast<int>(id), height_m});
  }
  for (const dom::element stage : stages) {
    std::vector<int> ids;
    dom::array list;
    if (stage.get(list) != simdjson::SUCCESS) {
      return Malformed("key \"certificate\" must hold one list of floors per stage", episode.where);
    }
    for (const dom::element element : list) {
      std::int64_t id = 0;
      if (element.get(id) != simdjson::SUCCESS) {
        return Malformed("key \"certificate\" holds a floor that is no whole number",
                         episode.where);
      }
      ids.push_back(static_cast<int>(id));
    }
    episode.certificate.push_back(std::move(ids));
  }
  if (episode.certificate.size() != episode.goals.size()) {
    return Malformed("key \"certificate\" must hold one list of floors per goal", episode.where);
  }
  if (first < 0 || first > static_cast<std::int64_t>(episode.goals.size()) ||
      is_cross_floor != (first > 0)) {
    return Malformed(
        "key \"first_transition_stage\" is no stage, or contradicts \"cross_floor_required\"",
        episode.where);
  }
  episode.start_floor = static_cast<int>(start_floor);
  episode.cross_floor_required = is_cross_floor;
  episode.first_transition_stage = static_cast<int>(first);
  episode.has_certificate = true;
  return {};
}

EpisodeFormat FormatOf(dom::object object) {
  dom::array list;
  if (object["object_goals"].get(list) == simdjson::SUCCESS) return EpisodeFormat::kOneMap;
  return HoldsStrings(object, "goals") ? EpisodeFormat::kCrossnav : EpisodeFormat::kObjectNav;
}

/// Ids are strings, in some files numbers.
std::string IdText(dom::object object) {
  std::string_view text;
  std::int64_t number = 0;
  if (object["episode_id"].get(text) == simdjson::SUCCESS) return std::string(text);
  if (object["episode_id"].get(number) == simdjson::SUCCESS) return std::to_string(number);
  return "";
}

/// Category of an ObjectNav episode; the oldest files give it at the goals only.
Result<std::string> CategoryOf(dom::object object, const std::string& where) {
  dom::array goals;
  dom::object first;
  if (object["object_category"].is_string() || object["goals"].get(goals) != simdjson::SUCCESS ||
      goals.at(0).get(first) != simdjson::SUCCESS) {
    return GetString(object, "object_category", where);
  }
  return GetString(first, "object_category", where + ": goals[0]");
}

Result<void> ReadGoals(dom::object object, EpisodeFormat format, Episode& episode) {
  if (format == EpisodeFormat::kObjectNav) {
    auto category = CategoryOf(object, episode.where);
    if (!category) return tl::unexpected(category.error());
    episode.goals = {std::move(*category)};
    // Episode numbers repeat between scenes.
    const std::string id = IdText(object);
    if (id.empty()) return Malformed("key \"episode_id\" is missing", episode.where);
    episode.episode_id = SceneName(episode.scene_id) + "-" + id;
    return {};
  }
  const bool is_ours = format == EpisodeFormat::kCrossnav;
  auto goals = GetStrings(object, is_ours ? "goals" : "object_goals", episode.where);
  if (!goals) return tl::unexpected(goals.error());
  episode.goals = std::move(*goals);
  episode.episode_id = is_ours ? IdText(object) : ContentId(episode);
  if (episode.episode_id.empty()) return Malformed("key \"episode_id\" is missing", episode.where);
  return is_ours ? ReadCertificate(object, episode) : Result<void>{};
}

Result<Episode> ReadEpisode(dom::object object, EpisodeFormat format, const std::string& where) {
  Episode episode;
  episode.where = where;
  auto scene_id = GetString(object, "scene_id", where);
  if (!scene_id) return tl::unexpected(scene_id.error());
  episode.scene_id = std::move(*scene_id);
  std::string_view track;
  if (object["track"].get(track) == simdjson::SUCCESS) episode.track = track;
  auto start = GetStart(object, where);
  if (!start) return tl::unexpected(start.error());
  episode.start = *start;
  if (auto ok = ReadGoals(object, format, episode); !ok) return tl::unexpected(ok.error());
  return episode;
}

Result<GoalObject> ReadGoalObject(dom::object object, const std::string& where) {
  GoalObject goal;
  const auto position = GetNumbers<3>(object, "position", where);
  if (!position) return tl::unexpected(position.error());
  goal.p_world = WorldFromHabitat({(*position)[0], (*position)[1], (*position)[2]});
  std::int64_t id = 0;
  if (object["object_id"].get(id) == simdjson::SUCCESS) goal.object_id = static_cast<int>(id);
  std::string_view text;
  if (object["object_name"].get(text) == simdjson::SUCCESS) goal.name = text;
  if (object["object_category"].get(text) == simdjson::SUCCESS) goal.category = text;
  bool is_confirmable = true;
  if (object["confirmable"].get(is_confirmable) == simdjson::SUCCESS)
    goal.is_confirmable = is_confirmable;
  dom::array viewpoints;
  if (object["view_points"].get(viewpoints) != simdjson::SUCCESS) return goal;
  for (const dom::element viewpoint : viewpoints) {
    dom::object state;
    if (viewpoint["agent_state"].get(state) != simdjson::SUCCESS) {
      return Malformed("a view point without \"agent_state\"", where);
    }
    const auto p = GetNumbers<3>(state, "position", where + ", view_points");
    if (!p) return tl::unexpected(p.error());
    goal.viewpoints_world.push_back(WorldFromHabitat({(*p)[0], (*p)[1], (*p)[2]}));
  }
  return goal;
}

Result<std::vector<GoalObject>> ReadGoalObjects(dom::array objects, const std::string& where) {
  std::vector<GoalObject> goals;
  for (const dom::element element : objects) {
    dom::object object;
    if (element.get(object) != simdjson::SUCCESS) return Malformed("holds no object", where);
    auto goal = ReadGoalObject(object, where);
    if (!goal) return tl::unexpected(goal.error());
    goals.push_back(std::move(*goal));
  }
  return goals;
}

/// Goals inside the episode itself; the goals of the first episode of a kind count for all.
Result<void> ReadOwnGoals(dom::object object, const Episode& episode, EpisodeFile& file) {
  dom::array objects;
  if (object["goals"].get(objects) != simdjson::SUCCESS || objects.size() == 0) return {};
  const std::string scene = std::filesystem::path(episode.scene_id).filename().string();
  const std::string key = scene + "_" + episode.goals.front();
  if (file.goals_by_category.count(key) > 0) return {};
  auto goals = ReadGoalObjects(objects, episode.where + ": goals");
  if (!goals) return tl::unexpected(goals.error());
  file.goals_by_category[key] = std::move(*goals);
  return {};
}

Result<void> ReadGoalsByCategory(dom::object root, const std::string& where, EpisodeFile& file) {
  dom::object categories;
  if (root["goals_by_category"].get(categories) != simdjson::SUCCESS) return {};
  for (const auto [key, value] : categories) {
    const std::string at = where + ": goals_by_category[\"" + std::string(key) + "\"]";
    dom::array objects;
    if (value.get(objects) != simdjson::SUCCESS) return Malformed("is no list", at);
    auto goals = ReadGoalObjects(objects, at);
    if (!goals) return tl::unexpected(goals.error());
    file.goals_by_category[std::string(key)] = std::move(*goals);
  }
  return {};
}

/// Edition of the file's certificates; all files of one read must have the same.
Result<void> ReadEdition(dom::object root, const std::string& where, EpisodeFile& file) {
  std::int64_t edition = 1;
  if (const auto error = root["certificate_edition"].get(edition);
      error != simdjson::SUCCESS && error != simdjson::NO_SUCH_FIELD) {
    return Malformed("key \"certificate_edition\" is no whole number", where);
  }
  if (edition < 1 || edition > 2) {
    return Malformed("key \"certificate_edition\" is " + std::to_string(edition) +
                         "; this version knows 1 and 2",
                     where);
  }
  if (!file.episodes.empty() && file.certificate_edition != edition)
    return Malformed("mixes two editions of certificates", where);
  file.certificate_edition = static_cast<int>(edition);
  return {};
}

/// Adds one file's content to `file`.
Result<void> ReadText(const std::string& text, const std::string& where, EpisodeFile& file) {
  dom::parser parser;
  dom::element document;
  if (const auto error = parser.parse(text).get(document); error != simdjson::SUCCESS) {
    const std::string reason = DescribeNotANumber(text);
    return Malformed(
        reason.empty() ? std::string("is no JSON: ") + simdjson::error_message(error) : reason,
        where);
  }
  dom::object root;
  dom::array episodes;
  if (document.get(root) != simdjson::SUCCESS ||
      root["episodes"].get(episodes) != simdjson::SUCCESS) {
    return Malformed("key \"episodes\" is missing or no list", where);
  }
  if (auto ok = ReadEdition(root, where, file); !ok) return ok;
  for (const dom::element element : episodes) {
    const std::string at = where + ": episodes[" + std::to_string(file.episodes.size()) + "]";
    dom::object object;
    if (element.get(object) != simdjson::SUCCESS) return Malformed("is no object", at);
    const EpisodeFormat format = FormatOf(object);
    if (!file.episodes.empty() && format != file.format) {
      return Malformed("mixes two episode formats", at);
    }
    file.format = format;
    auto episode = ReadEpisode(object, format, at);
    if (!episode) return tl::unexpected(episode.error());
    if (format == EpisodeFormat::kObjectNav) {
      if (auto ok = ReadOwnGoals(object, *episode, file); !ok) return ok;
    }
    file.episodes.push_back(std::move(*episode));
  }
  file.content_hash = MixSeed(file.content_hash, HashString(text));
  if (auto ok = ReadGoalPictures(root, where, file.episodes); !ok) return ok;
  return ReadGoalsByCategory(root, where, file);
}

bool IsEpisodeFile(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.ends_with(".json") || name.ends_with(".json.gz");
}

std::vector<std::filesystem::path> FilesBelow(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file() && IsEpisodeFile(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<void> CheckUniqueIds(const EpisodeFile& file) {
  std::set<std::string> ids;
  for (const Episode& episode : file.episodes) {
    if (!ids.insert(episode.episode_id).second) {
      return Fail(ErrorCode::kInvalid, "duplicate episode_id \"" + episode.episode_id + "\"",
                  episode.where);
    }
  }
  return {};
}

Result<void> ReadFileInto(const std::filesystem::path& path, EpisodeFile& file) {
  const auto text = ReadTextFile(path);
  if (!text) return tl::unexpected(text.error());
  return ReadText(*text, path.string(), file);
}

}  // namespace

std::string SceneName(const std::string& scene_id) {
  const std::filesystem::path path(scene_id);
  if (!path.has_extension()) return path.filename().string();
  const std::string folder = path.parent_path().filename().string();
  return folder.empty() ? path.stem().string() : folder;
}

Result<EpisodeFile> ReadEpisodes(const std::filesystem::path& path) {
  EpisodeFile file;
  std::vector<std::filesystem::path> parts = {path};
  if (std::filesystem::is_directory(path)) {
    parts = FilesBelow(path);
    if (parts.empty())
      return Fail(ErrorCode::kNotFound, "holds no .json or .json.gz", path.string());
  }
  for (const auto& part : parts) {
    if (auto ok = ReadFileInto(part, file); !ok) return tl::unexpected(ok.error());
  }
  if (file.episodes.empty() && std::filesystem::is_directory(path.parent_path() / "content")) {
    for (const auto& part : FilesBelow(path.parent_path() / "content")) {
      if (auto ok = ReadFileInto(part, file); !ok) return tl::unexpected(ok.error());
    }
  }
  if (auto ok = CheckUniqueIds(file); !ok) return tl::unexpected(ok.error());
  return file;
}

}  // namespace crossnav::evaluation
