// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/viewpoint_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/sim/scene/scene_cache.h"
#include "crossnav/sim/sensing/scene_info.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using Viewpoints = std::vector<std::vector<Vector3d>>;  // of each instance

constexpr int kViewpointFormat = 1;  // raise it when sim::Viewpoints gives other results

std::string KeyOf(const ViewedScene& viewed,
                  const std::vector<const sim::SceneInstance*>& instances) {
  const SensorConfig& s = viewed.sensor;
  std::string text = fmt::format("{} {} {} {} {} {} {}", kViewpointFormat,
                                 HexHash(viewed.scene.mesh_hash), HexHash(viewed.navmesh.Hash()),
                                 s.width_px, s.height_px, s.hfov_deg, s.camera_height_m);
  for (const sim::SceneInstance* instance : instances) text += fmt::format(" {}", instance->id);
  return HexHash(HashString(text));
}

/// Empty unless `text` is the output of Text for `key` and that number of instances.
std::optional<Viewpoints> Read(const std::string& text, const std::string& key,
                               std::size_t instances) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("key") || json["key"] != key) return std::nullopt;
  const auto lists = json.find("viewpoints");
  if (lists == json.end() || !lists->is_array() || lists->size() != instances) return std::nullopt;
  Viewpoints viewpoints(instances);
  for (std::size_t i = 0; i < instances; ++i) {
    for (const Json& p : (*lists)[i]) {
      if (!p.is_array() || p.size() != 3) return std::nullopt;
      for (const Json& number : p) {
        if (!number.is_number()) return std::nullopt;
      }
      viewpoints[i].emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
    }
  }
  return viewpoints;
}

std::string Text(const std::string& key, const Viewpoints& viewpoints) {
  Json lists = Json::array();
  for (const auto& points : viewpoints) {
    Json list = Json::array();
    for (const Vector3d& p : points) list.push_back({p.x(), p.y(), p.z()});
    lists.push_back(std::move(list));
  }
  return Json({{"key", key}, {"viewpoints", std::move(lists)}}).dump();
}

}  // namespace

Viewpoints ViewpointsOf(const ViewedScene& viewed,
                        const std::vector<const sim::SceneInstance*>& instances) {
  const std::string key = KeyOf(viewed, instances);
  const std::string name = key + ".crossnav.viewpoints";
  const bool has_folder = !viewed.scene.folder.empty() && !instances.empty();
  for (const auto& file : sim::CachePlaces(viewed.scene.folder, name)) {
    if (!has_folder) break;
    const auto text = ReadTextFile(file);
    if (auto known = text ? Read(*text, key, instances.size()) : std::nullopt) return *known;
  }
  Viewpoints viewpoints;
  for (const sim::SceneInstance* instance : instances) {
    viewpoints.push_back(
        sim::Viewpoints(viewed.scene, viewed.navmesh, viewed.caster, *instance, viewed.sensor));
  }
  if (has_folder) sim::WriteCache(viewed.scene.folder, name, Text(key, viewpoints));
  return viewpoints;
}

}  // namespace crossnav::evaluation
