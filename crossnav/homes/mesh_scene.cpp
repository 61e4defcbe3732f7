// SPDX-License-Identifier: MIT
#include "crossnav/homes/mesh_scene.h"

#include <algorithm>
#include <set>

#include "crossnav/core/read_file.h"
#include "crossnav/sim/scene/gltf_reader.h"
#include "crossnav/world/models/obj_reader.h"

namespace crossnav::homes {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxPicture_px = 2048;             // chosen: walls of a scan fill the whole view
constexpr std::uintmax_t kMaxFile = 2ULL << 30;  // chosen: HM3D's largest has 0.5 GB
constexpr std::size_t kMaxListed = 12;           // names in an error

Result<PartedModel> ReadObj(const fs::path& file) {
  const auto text = ReadFile(file, kMaxFile);
  if (!text) return tl::unexpected(text.error());
  const auto lookup = [&](std::string name) -> std::optional<std::string> {
    std::replace(name.begin(), name.end(), '\\', '/');
    auto bytes = ReadFile(file.parent_path() / name, kMaxFile);
    if (!bytes) return std::nullopt;
    return std::move(*bytes);
  };
  auto obj = world::ParseNamedObj(*text, lookup, file.string(), kMaxPicture_px);
  if (!obj) return tl::unexpected(obj.error());
  PartedModel out{std::move(obj->model.mesh),     std::move(obj->model.materials),
                  std::move(obj->model.textures), {},
                  std::move(obj->triangle_group), {}};
  for (auto& name : obj->group_names) out.parts.push_back({std::move(name), -1});
  return out;
}

Result<PartedModel> ReadGltf(const fs::path& file) {
  auto gltf = sim::ReadGlb(file);
  if (!gltf) return tl::unexpected(gltf.error());
  PartedModel out{std::move(gltf->mesh),          std::move(gltf->materials),
                  std::move(gltf->textures),      {},
                  std::move(gltf->triangle_part), std::move(gltf->notes)};
  for (auto& part : gltf->parts) out.parts.push_back({std::move(part.name), part.parent});
  return out;
}

bool Matches(const std::string& name, const std::string& pattern) {
  if (pattern.back() != '*') return name == pattern;
  return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
}

/// Assigns triangles to instances.
class Claims {
 public:
  Claims(const PartedModel& model, const ObjectsFile& objects)
      : model_(model), objects_(objects), instance_(model.mesh.triangles.size(), 0) {}

  /// Claims the triangles of the parts of object `i` and of their descendants. Returns their
  /// number.
  std::size_t ByParts(std::size_t i) {
    std::vector<bool> is_named(model_.parts.size(), false);
    for (std::size_t p = 0; p < model_.parts.size(); ++p) {
      const auto& part = model_.parts[p];  // parents come before their children
      is_named[p] = part.parent >= 0 && is_named[static_cast<std::size_t>(part.parent)];
      for (const auto& pattern : objects_.objects[i].parts) {
        is_named[p] = is_named[p] || Matches(part.name, pattern);
      }
    }
    std::size_t claimed = 0;
    for (std::size_t t = 0; t < instance_.size(); ++t) {
      const int part = model_.triangle_part[t];
      if (instance_[t] != 0 || part < 0 || !is_named[static_cast<std::size_t>(part)]) continue;
      instance_[t] = static_cast<int>(i) + 1;
      ++claimed;
    }
    return claimed;
  }

  /// Claims the free triangles with their centre in the box of object `i`.
  std::size_t ByBox(std::size_t i) {
    const ObjectBox& box = *objects_.objects[i].box;
    const Vector3d up = objects_.is_y_up ? Vector3d::UnitY() : Vector3d::UnitZ();
    const Eigen::AngleAxisd back(-box.yaw_rad, up);
    std::size_t claimed = 0;
    for (std::size_t t = 0; t < instance_.size(); ++t) {
      if (instance_[t] != 0) continue;
      Vector3d center = Vector3d::Zero();
      for (const auto v : model_.mesh.triangles[t]) {
        center += model_.mesh.vertices[v].cast<double>() / 3;
      }
      const Vector3d p = back * (center - box.center);
      if ((p.cwiseAbs() - 0.5 * box.size).maxCoeff() > 1e-9) continue;
      instance_[t] = static_cast<int>(i) + 1;
      ++claimed;
    }
    return claimed;
  }

  std::vector<std::int32_t> Take() { return std::move(instance_); }

 private:
  const PartedModel& model_;
  const ObjectsFile& objects_;
  std::vector<std::int32_t> instance_;
};

tl::unexpected<Error> ClaimsNothing(const PartedModel& model, const ObjectsFile& objects,
                                    std::size_t i, const std::string& where) {
  std::set<std::string> names;
  for (const auto& part : model.parts) {
    if (!part.name.empty()) names.insert(part.name);
  }
  std::string list;
  std::size_t listed = 0;
  for (const auto& name : names) {
    if (++listed > kMaxListed) break;
    list += (list.empty() ? "" : ", ") + name;
  }
  if (names.size() > kMaxListed) list += ", ...";
  const NamedObject& object = objects.objects[i];
  std::string what = "'" + (object.id.empty() ? object.name : object.id) + "' ";
  what += object.box ? "holds no triangle that is not another object's already"
                     : "names no part of the model that is not another object's already";
  what += list.empty() ? "; the model names no parts, use boxes" : "; its parts are: " + list;
  return Fail(ErrorCode::kMismatch, what, where + ": objects[" + std::to_string(i) + "]");
}

void ToWorld(sim::TriangleMesh& mesh, const ObjectsFile& objects) {
  const auto unit = static_cast<float>(objects.unit_m);
  for (auto& v : mesh.vertices) {
    v = (objects.is_y_up ? Vector3f(v.x(), -v.z(), v.y()) : v) * unit;
  }
}

}  // namespace

Result<PartedModel> ReadPartedModel(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".obj") return ReadObj(file);
  return ReadGltf(file);
}

Result<sim::Scene> NameObjects(PartedModel model, const ObjectsFile& objects,
                               const std::string& where) {
  Claims claims(model, objects);
  std::vector<std::size_t> claimed(objects.objects.size(), 0);
  for (std::size_t i = 0; i < claimed.size(); ++i) claimed[i] = claims.ByParts(i);
  for (std::size_t i = 0; i < claimed.size(); ++i) {
    if (objects.objects[i].box) claimed[i] += claims.ByBox(i);
    if (claimed[i] == 0) return ClaimsNothing(model, objects, i, where);
  }
  sim::Scene scene;
  scene.mesh = std::move(model.mesh);
  scene.materials = std::move(model.materials);
  scene.textures = std::move(model.textures);
  scene.notes = std::move(model.notes);
  scene.mesh.triangle_instance = claims.Take();
  const int unknown = static_cast<int>(objects.objects.size()) + 1;
  bool has_unknown = false;
  for (auto& instance : scene.mesh.triangle_instance) {
    if (instance != 0) continue;
    instance = unknown;
    has_unknown = true;
  }
  for (std::size_t i = 0; i < claimed.size(); ++i) {
    const NamedObject& object = objects.objects[i];
    scene.instances.push_back({static_cast<int>(i) + 1, object.name, "", object.region, {}});
  }
  if (has_unknown) scene.instances.push_back({unknown, "unknown", "", 0, {}});
  ToWorld(scene.mesh, objects);
  sim::UpdateDerived(scene);
  return scene;
}

}  // namespace crossnav::homes
