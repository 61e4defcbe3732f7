// SPDX-License-Identifier: MIT
#include "hm3d/stand_in.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/sim/navmesh/habitat_navmesh.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/scene/scene_writer.h"
#ifdef CROSSNAV_HAS_BASIS
#include "support/basis_twin.h"
#endif

namespace crossnav::test {
namespace {

using Json = nlohmann::json;

std::string WithBasisTextures(const std::string& glb) {
#ifdef CROSSNAV_HAS_BASIS
  return BasisTwin(glb);
#else
  return glb;
#endif
}

/// Square picture with a texel for each instance, and the place of each in it.
sim::Texture PaletteOf(const sim::Scene& scene, std::map<int, std::array<float, 2>>& uv_of) {
  const int count = static_cast<int>(scene.instances.size()) + 1;
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  sim::Texture palette;
  palette.rgb = RgbImage(side, side);
  const auto place = [&](int index, int id, Rgb8 colour) {
    palette.rgb.At(index % side, index / side) = colour;
    uv_of[id] = {(static_cast<float>(index % side) + 0.5F) / static_cast<float>(side),
                 (static_cast<float>(index / side) + 0.5F) / static_cast<float>(side)};
  };
  place(0, 0, {0, 0, 0});
  for (int i = 1; i < count; ++i) {
    const int id = scene.instances[static_cast<std::size_t>(i - 1)].id;
    place(i, id, world::SemanticColour(id));
  }
  return palette;
}

/// Keys of HM3D's episodes, from an episode of ours.
Json EpisodeOf(const Json& ours, const std::string& hash, std::size_t number) {
  return {{"episode_id", std::to_string(number)},
          {"scene_id", "hm3d/val/00800-" + hash + "/" + hash + ".basis.glb"},
          {"scene_dataset_config",
           "./data/scene_datasets/hm3d/hm3d_annotated_basis.scene_dataset_config.json"},
          {"additional_obj_config_paths", Json::array()},
          {"start_position", ours["start_position"]},
          {"start_rotation", ours["start_rotation"]},
          {"info", {{"geodesic_distance", 5.0}, {"euclidean_distance", 4.0}}},
          {"goals", Json::array()},
          {"start_room", nullptr},
          {"shortest_paths", nullptr},
          {"object_category", ours["goals"][0]}};
}

Json GoalOf(Json goal) {
  goal["radius"] = goal["object_name_id"] = goal["room_id"] = goal["room_name"] = nullptr;
  for (Json& view_point : goal["view_points"]) view_point["iou"] = 0.05;
  return goal;
}

}  // namespace

std::string PaletteSemanticGlb(const sim::Scene& scene) {
  std::map<int, std::array<float, 2>> uv_of;
  sim::Scene painted;
  painted.id = scene.id;
  painted.textures = {PaletteOf(scene, uv_of)};
  painted.materials = {{{255, 255, 255}, 0, true}};
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(painted.mesh.vertices.size());
    for (const std::uint32_t vertex : scene.mesh.triangles[t]) {
      painted.mesh.vertices.push_back(scene.mesh.vertices[vertex]);
      painted.mesh.uvs.push_back(uv_of.at(scene.mesh.triangle_instance[t]));
    }
    painted.mesh.triangles.push_back({first, first + 1, first + 2});
    painted.mesh.triangle_material.push_back(0);
  }
  return world::EncodeRenderGlb(painted);
}

void WriteAsHm3d(const sim::Scene& scene, const std::string& hash,
                 const std::filesystem::path& folder) {
  const auto navmesh = sim::EncodeHabitatNavMesh(scene, {});
  ASSERT_TRUE(navmesh.has_value()) << navmesh.error().Message();
  const std::string glb = world::EncodeRenderGlb(scene);
  const std::map<std::string, std::string> files{
      {".basis.glb", WithBasisTextures(glb)},
      {".basis.navmesh", *navmesh},
      {".glb", glb},
      {".semantic.glb", PaletteSemanticGlb(scene)},
      {".semantic.txt", world::SemanticText(scene)},
  };
  std::filesystem::create_directories(folder);
  for (const auto& [ending, bytes] : files) {
    ASSERT_TRUE(WriteFileAtomically(folder / (hash + ending), bytes).has_value()) << ending;
  }
}

void WriteAsObjectNavV2(const std::filesystem::path& episodes, const std::string& hash,
                        const std::filesystem::path& folder) {
  const auto text = evaluation::ReadTextFile(episodes);
  ASSERT_TRUE(text.has_value()) << text.error().Message();
  const Json ours = Json::parse(*text);
  Json content = {{"goals_by_category", Json::object()}, {"episodes", Json::array()}};
  for (const auto& [key, goals] : ours["goals_by_category"].items()) {
    Json& list =
        content["goals_by_category"][hash + ".basis.glb" + key.substr(key.find(".glb") + 4)];
    for (const Json& goal : goals) list.push_back(GoalOf(goal));
  }
  for (const Json& episode : ours["episodes"]) {
    content["episodes"].push_back(EpisodeOf(episode, hash, content["episodes"].size()));
  }
  Json index = {{"episodes", Json::array()}};
  for (const char* ids :
       {"category_to_task_category_id", "category_to_scene_annotation_category_id"}) {
    index[ids] = content[ids] = ours[ids];
  }
  ASSERT_TRUE(evaluation::WriteTextFile(folder / "val.json.gz", index.dump()).has_value());
  ASSERT_TRUE(evaluation::WriteTextFile(folder / "content" / (hash + ".json.gz"), content.dump())
                  .has_value());
}

}  // namespace crossnav::test
