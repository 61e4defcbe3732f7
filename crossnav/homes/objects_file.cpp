// SPDX-License-Identifier: MIT
#include "crossnav/homes/objects_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "crossnav/core/text_shape.h"
#include "crossnav/homes/piece_names.h"

namespace crossnav::homes {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxObjects = 100'000;  // chosen: far above any house
constexpr double kMaxObjectNumber = 1e6;

/// Reads with the path of the key, for errors.
class ObjectsReader {
 public:
  explicit ObjectsReader(std::string where) : where_(std::move(where)) {}

  Result<ObjectsFile> Read(const Json& root) {
    ObjectsFile file;
    if (!root.is_object()) Bad("", "is no JSON object");
    KnownKeys(root, "", {"format", "up", "unit_m", "objects"});
    if (!error_ && root.contains("format") && root["format"] != 1) Bad("format", "is not 1");
    const std::string up = Text(root, "up", "up", "y");
    if (up != "y" && up != "z") Bad("up", "is neither \"y\" nor \"z\"");
    file.is_y_up = up == "y";
    if (!error_ && root.contains("unit_m")) file.unit_m = Number(root["unit_m"], "unit_m");
    if (!(file.unit_m > 0)) Bad("unit_m", "is not above 0");
    if (!error_ && (!root.contains("objects") || !root["objects"].is_array())) {
      Bad("objects", "is no list");
    }
    if (!error_ && root["objects"].size() > kMaxObjects) Bad("objects", "has more than 100000");
    for (std::size_t i = 0; !error_ && i < root["objects"].size(); ++i) {
      file.objects.push_back(Object(root["objects"][i], "objects[" + std::to_string(i) + "]"));
    }
    if (error_) return tl::unexpected(*error_);
    return file;
  }

 private:
  void Bad(const std::string& key, const std::string& what) {
    if (error_) return;
    error_ = Error{ErrorCode::kMalformed, what + "; see docs/formats/objects.md",
                   key.empty() ? where_ : where_ + ": " + key};
  }

  void KnownKeys(const Json& json, const std::string& at,
                 std::initializer_list<const char*> known) {
    if (!json.is_object()) return Bad(at, "is no JSON object");
    for (const auto& [key, value] : json.items()) {
      bool is_known = false;
      for (const char* name : known) is_known = is_known || key == name;
      if (!is_known) Bad((at.empty() ? "" : at + ".").append(key), "is no known key");
    }
  }

  std::string Text(const Json& json, const char* key, const std::string& at,
                   const std::string& otherwise) {
    if (error_ || !json.contains(key)) return otherwise;
    if (!json[key].is_string()) {
      Bad(at, "is no text");
      return otherwise;
    }
    return json[key].get<std::string>();
  }

  double Number(const Json& json, const std::string& at) {
    const double value = json.is_number() ? json.get<double>() : NAN;
    if (!std::isfinite(value) || std::abs(value) > kMaxObjectNumber)
      Bad(at, "is no number up to 1e6");
    return error_ ? 0 : value;
  }

  Vector3d Point(const Json& json, const char* key, const std::string& at) {
    const std::string here = at + "." + key;
    Vector3d p = Vector3d::Zero();
    if (error_) return p;
    if (!json.contains(key) || !json[key].is_array() || json[key].size() != 3) {
      Bad(here, "is no list of three numbers");
      return p;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      p[static_cast<Eigen::Index>(k)] = Number(json[key][k], here);
    }
    return p;
  }

  ObjectBox Box(const Json& json, const std::string& at) {
    ObjectBox box;
    KnownKeys(json, at, {"min", "max", "center", "size", "yaw_deg"});
    if (error_) return box;
    if (json.contains("min")) {
      const Vector3d low = Point(json, "min", at), high = Point(json, "max", at);
      box.center = 0.5 * (low + high);
      box.size = high - low;
    } else {
      box.center = Point(json, "center", at);
      box.size = Point(json, "size", at);
    }
    if (box.size.minCoeff() <= 0) Bad(at, "has no extent above 0 in each direction");
    if (!error_ && json.contains("yaw_deg")) {
      box.yaw_rad = DegToRad(Number(json["yaw_deg"], at + ".yaw_deg"));
    }
    return box;
  }

  NamedObject Object(const Json& json, const std::string& at) {
    NamedObject object;
    KnownKeys(json, at, {"id", "name", "category", "parts", "box", "room"});
    object.id = Text(json, "id", at + ".id", "");
    object.name = Text(json, "name", at + ".name", Text(json, "category", at + ".category", ""));
    if (object.name.empty()) Bad(at, "has neither name nor category");
    object.name = Normalised(object.name);
    if (error_) return object;
    if (json.contains("room")) {
      object.region = static_cast<int>(Number(json["room"], at + ".room"));
      if (object.region < 0) Bad(at + ".room", "is below 0");
    }
    if (json.contains("parts")) {
      if (!json["parts"].is_array()) Bad(at + ".parts", "is no list of texts");
      for (const Json& part : json["parts"]) {
        if (!part.is_string() || part.get<std::string>().empty()) {
          Bad(at + ".parts", "holds something that is no text");
          break;
        }
        object.parts.push_back(part.get<std::string>());
      }
    }
    if (!error_ && json.contains("box")) object.box = Box(json["box"], at + ".box");
    if (object.parts.empty() && !object.box) Bad(at, "has neither parts nor box");
    return object;
  }

  std::string where_;
  std::optional<Error> error_;
};

}  // namespace

Result<ObjectsFile> ParseObjectsFile(const std::string& text, const std::string& where) {
  if (auto ok = CheckJsonShape(text, where); !ok) return tl::unexpected(ok.error());
  try {
    return ObjectsReader(where).Read(Json::parse(text));
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kMalformed, "is not readable JSON: " + PlainReason(e.what()), where);
  }
}

}  // namespace crossnav::homes
