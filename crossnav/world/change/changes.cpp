// SPDX-License-Identifier: MIT
#include "crossnav/world/change/changes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"

namespace crossnav::world {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kChangesFormat = 1;
constexpr std::size_t kMaxChanges = 10'000;  // chosen: more than any house has objects

/// Rounds to millimetres: precise enough to find an object, and short to read.
Json ToJson(const Vector3d& p) {
  const auto rounded = [](double m) { return std::round(m * 1000) / 1000; };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json ToJson(const ChangePlace& place) {
  Json json = {{"p_world", ToJson(place.p_world)},
               {"box", {ToJson(place.box.min), ToJson(place.box.max)}}};
  if (place.room >= 0) json["room"] = place.room;
  if (place.floor >= 0) json["floor"] = place.floor;
  if (place.support > 0) json["support"] = place.support;
  return json;
}

Json ToJson(const std::vector<Change>& changes) {
  Json list = Json::array();
  for (const Change& change : changes) {
    Json json = {
        {"kind", NameOf(change.kind)}, {"instance", change.instance}, {"name", change.name}};
    if (!change.category.empty()) json["category"] = change.category;
    if (change.from) json["from"] = ToJson(*change.from);
    if (change.to) json["to"] = ToJson(*change.to);
    list.push_back(std::move(json));
  }
  return list;
}

/// Reads values of one document; the first invalid value is the error.
class Reader {
 public:
  explicit Reader(const std::string& where) : where_(where) {}

  std::optional<Error> error;

  Vector3d Point(const Json& json, const std::string& key) {
    Vector3d p = Vector3d::Zero();
    if (!json.is_array() || json.size() != 3) return Bad(key, "is not three numbers"), p;
    for (int i = 0; i < 3; ++i) {
      const Json& value = json[static_cast<std::size_t>(i)];
      if (!value.is_number()) return Bad(key, "is not three numbers"), p;
      p[i] = value.get<double>();
      if (!std::isfinite(p[i])) return Bad(key, "is not finite"), p;
    }
    return p;
  }

  int Int(const Json& json, const std::string& key, int low) {
    if (!json.is_number_integer() || json.get<std::int64_t>() < low ||
        json.get<std::int64_t>() > 1'000'000'000) {
      Bad(key, "is not a whole number from " + std::to_string(low) + " on");
      return low;
    }
    return json.get<int>();
  }

  std::string Text(const Json& json, const std::string& key) {
    if (!json.is_string()) return Bad(key, "is not a text"), std::string();
    return json.get<std::string>();
  }

  ChangePlace Place(const Json& json, const std::string& key) {
    ChangePlace place;
    if (!json.is_object() || !json.contains("p_world") || !json.contains("box") ||
        !json["box"].is_array() || json["box"].size() != 2) {
      Bad(key, "has no p_world and box of two corners");
      return place;
    }
    place.p_world = Point(json["p_world"], key + ".p_world");
    place.box.min = Point(json["box"][0], key + ".box[0]");
    place.box.max = Point(json["box"][1], key + ".box[1]");
    if (json.contains("room")) place.room = Int(json["room"], key + ".room", 0);
    if (json.contains("floor")) place.floor = Int(json["floor"], key + ".floor", 0);
    if (json.contains("support")) place.support = Int(json["support"], key + ".support", 0);
    return place;
  }

  Change OneChange(const Json& json, const std::string& key) {
    Change change;
    if (!json.is_object() || !json.contains("kind") || !json.contains("instance") ||
        !json.contains("name")) {
      Bad(key, "has no kind, instance and name");
      return change;
    }
    const auto kind = ChangeKindFromName(Text(json["kind"], key + ".kind"));
    if (!kind) return Bad(key + ".kind", "is no kind of change"), change;
    change.kind = *kind;
    change.instance = Int(json["instance"], key + ".instance", 1);
    change.name = Text(json["name"], key + ".name");
    if (json.contains("category")) change.category = Text(json["category"], key + ".category");
    if (json.contains("from")) change.from = Place(json["from"], key + ".from");
    if (json.contains("to")) change.to = Place(json["to"], key + ".to");
    if (IsMove(change.kind) && !(change.from && change.to))
      Bad(key, "is a move without from and to");
    if (change.kind == ChangeKind::kRemoved && !change.from) Bad(key, "is removed from nowhere");
    if (change.kind > ChangeKind::kRemoved && !change.to) Bad(key, "has no place \"to\"");
    return change;
  }

  std::vector<Change> Changes(const Json& json, const std::string& key) {
    std::vector<Change> changes;
    if (!json.is_array() || json.size() > kMaxChanges) {
      Bad(key, "is not a list of at most " + std::to_string(kMaxChanges));
      return changes;
    }
    for (std::size_t i = 0; i < json.size() && !error; ++i) {
      changes.push_back(OneChange(json[i], key + "[" + std::to_string(i) + "]"));
    }
    return changes;
  }

  void Bad(const std::string& key, const std::string& what) {
    if (!error) error = Error{ErrorCode::kMalformed, what, where_ + ": " + key};
  }

 private:
  std::string where_;
};

}  // namespace

std::optional<ChangeKind> ChangeKindFromName(std::string_view name) {
  const auto at = std::find(kChangeNames.begin(), kChangeNames.end(), name);
  if (at == kChangeNames.end()) return std::nullopt;
  return static_cast<ChangeKind>(at - kChangeNames.begin());
}

std::string ChangesText(const DayChanges& day) {
  const Json json = {{"format", kChangesFormat},
                     {"scene", day.scene},
                     {"before", day.before},
                     {"day", day.day},
                     {"seed", day.seed},
                     {"changes", ToJson(day.changes)},
                     {"lifted", ToJson(day.lifted)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<DayChanges> ParseChanges(std::string_view text, const std::string& where) {
  if (auto ok = CheckJsonShape(text, where); !ok) return tl::unexpected(ok.error());
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return Fail(ErrorCode::kMalformed, "is no list of changes", where);
  for (const char* key : {"format", "scene", "before", "day", "seed", "changes", "lifted"}) {
    if (!json.contains(key)) return Fail(ErrorCode::kMalformed, "is missing", where + ": " + key);
  }
  if (json["format"] != kChangesFormat) {
    return Fail(ErrorCode::kUnsupported, "is of another format; make the days anew",
                where + ": format");
  }
  Reader reader(where);
  DayChanges day;
  day.scene = reader.Text(json["scene"], "scene");
  day.before = reader.Text(json["before"], "before");
  day.day = reader.Int(json["day"], "day", 1);
  if (!json["seed"].is_number_unsigned()) {
    reader.Bad("seed", "is not a whole number from 0 on");
  } else {
    day.seed = json["seed"].get<std::uint64_t>();
  }
  day.changes = reader.Changes(json["changes"], "changes");
  day.lifted = reader.Changes(json["lifted"], "lifted");
  if (reader.error) return tl::unexpected(*reader.error);
  return day;
}

Result<DayChanges> ReadChanges(const std::filesystem::path& folder) {
  const std::string id = folder.filename().string();
  const auto dash = id.find('-');
  const std::string stem = dash == std::string::npos ? id : id.substr(dash + 1);
  const std::filesystem::path file = folder / (stem + ".changes.json");
  const auto text = ReadFile(file);
  if (!text) return tl::unexpected(text.error());
  return ParseChanges(*text, file.string());
}

}  // namespace crossnav::world
