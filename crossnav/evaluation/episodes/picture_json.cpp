// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/picture_json.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "crossnav/core/base64.h"
#include "crossnav/evaluation/episodes/habitat_frame.h"
#include "crossnav/perception/goal_picture.h"

namespace crossnav::evaluation {
namespace {

namespace dom = simdjson::dom;

// chosen: room for a PNG of the largest picture that does not compress, as text
constexpr std::size_t kMostPictureText =
    std::size_t{5} * perception::kMostPictureSide_px * perception::kMostPictureSide_px;

tl::unexpected<Error> BadPicture(const std::string& what, const std::string& where) {
  return Fail(ErrorCode::kMalformed, what, where);
}

template <std::size_t n>
std::optional<std::array<double, n>> Numbers(dom::object object, const char* key) {
  dom::array list;
  std::array<double, n> numbers{};
  if (object[key].get(list) != simdjson::SUCCESS || list.size() != n) return std::nullopt;
  for (std::size_t i = 0; i < n; ++i)
    if (list.at(i).get(numbers[i]) != simdjson::SUCCESS || !std::isfinite(numbers[i]))
      return std::nullopt;
  return numbers;
}

/// A finite number within limits.
std::optional<double> Number(dom::object object, const char* key, double least, double most) {
  double number = 0;
  if (object[key].get(number) != simdjson::SUCCESS || !(number >= least && number <= most))
    return std::nullopt;
  return number;
}

Result<std::optional<perception::PixelBox>> ReadBox(dom::object object, const std::string& where) {
  if (object["box"].error() == simdjson::NO_SUCH_FIELD)
    return std::optional<perception::PixelBox>();
  const auto sides = Numbers<4>(object, "box");
  perception::PixelBox box;
  const std::array<int*, 4> to = {&box.u0, &box.v0, &box.u1, &box.v1};
  for (std::size_t i = 0; sides && i < to.size(); ++i) {
    const double side = (*sides)[i];
    if (side != std::floor(side) || std::abs(side) > perception::kMostPictureSide_px)
      return BadPicture("key \"box\" must hold four whole numbers within the picture", where);
    *to[i] = static_cast<int>(side);
  }
  if (!sides) return BadPicture("key \"box\" must hold four numbers", where);
  return std::optional(box);
}

Result<perception::GoalPicture> ReadPng(dom::object object, const std::string& where) {
  std::string_view text;
  if (object["png"].get(text) != simdjson::SUCCESS)
    return BadPicture("key \"png\" is missing or no text", where);
  if (text.size() > kMostPictureText)
    return BadPicture("key \"png\" is too long for a picture", where);
  const auto bytes = DecodeBase64(text);
  if (!bytes) return BadPicture("key \"png\" is no base64", where);
  auto box = ReadBox(object, where);
  if (!box) return tl::unexpected(box.error());
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
  return perception::DecodeGoalPicture({data, bytes->size()}, *box, where);
}

Result<StagePicture> ReadPicture(dom::object object, std::string_view name,
                                 const std::string& where) {
  auto picture = ReadPng(object, where);
  if (!picture) return tl::unexpected(picture.error());
  if (perception::NameOfPicture(*picture) != name)
    return BadPicture(
        "is damaged: its content has another name, \"" + perception::NameOfPicture(*picture) + "\"",
        where);
  StagePicture read;
  read.picture = std::move(*picture);
  std::int64_t id = 0;
  const auto position = Numbers<3>(object, "position");
  const auto rotation = Numbers<4>(object, "rotation");
  const auto height_m = Number(object, "camera_height_m", 0, 10);
  const auto hfov_deg = Number(object, "hfov_deg", 1, 179);
  if (object["object_id"].get(id) != simdjson::SUCCESS || id < 0 || id > INT32_MAX || !position ||
      !rotation || !height_m || !hfov_deg)
    return BadPicture(
        "needs \"object_id\", \"position\", \"rotation\", \"camera_height_m\" (0 to 10) and "
        "\"hfov_deg\" (1 to 179)",
        where);
  read.object_id = static_cast<int>(id);
  read.taken_from.p_world = WorldFromHabitat({(*position)[0], (*position)[1], (*position)[2]});
  read.taken_from.yaw_rad = YawFromHabitat(*rotation);
  read.camera_height_m = *height_m;
  read.hfov_deg = *hfov_deg;
  return read;
}

Result<void> GivePictures(const StagePictures& pictures, std::vector<Episode>& episodes) {
  for (Episode& episode : episodes)
    for (const std::string& goal : episode.goals) {
      if (!perception::IsPictureName(goal) || episode.pictures.count(goal) > 0) continue;
      const auto found = pictures.find(goal);
      if (found == pictures.end())
        return BadPicture("goal \"" + goal + "\" is not in \"goal_pictures\"", episode.where);
      episode.pictures.insert(*found);
    }
  return {};
}

}  // namespace

Result<void> ReadGoalPictures(dom::object root, const std::string& where,
                              std::vector<Episode>& episodes) {
  StagePictures pictures;
  dom::object entries;
  const auto error = root["goal_pictures"].get(entries);
  if (error != simdjson::SUCCESS && error != simdjson::NO_SUCH_FIELD)
    return BadPicture("key \"goal_pictures\" is no object", where);
  if (error == simdjson::NO_SUCH_FIELD) return GivePictures(pictures, episodes);
  for (const auto [name, value] : entries) {
    const std::string at = where + ": goal_pictures[\"" + std::string(name.substr(0, 40)) + "\"]";
    dom::object object;
    if (value.get(object) != simdjson::SUCCESS) return BadPicture("is no object", at);
    auto picture = ReadPicture(object, name, at);
    if (!picture) return tl::unexpected(picture.error());
    pictures[std::string(name)] = std::make_shared<const StagePicture>(std::move(*picture));
  }
  return GivePictures(pictures, episodes);
}

}  // namespace crossnav::evaluation
