// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/scene.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <xxhash.h>

#include "crossnav/core/check.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/sim/scene/scene_reader.h"

namespace crossnav::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxTransfer_m = 0.05;  // chosen: half a voxel

/// THE conversion from an HM3D file's frame to the world's. Files are z up; Habitat turns them into
/// (x_f, z_f, -y_f), and world = (-z_h, -x_h, y_h).
Vector3f WorldFromFile(const Vector3f& p_file) {
  return {p_file.y(), -p_file.x(), p_file.z()};
}

void ToWorld(TriangleMesh& mesh) {
  for (Vector3f& v : mesh.vertices) v = WorldFromFile(v);
}

bool EndsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

struct SceneFiles {
  fs::path render, semantic, text;  // the last two may be empty
};

/// Which file is which, by suffix; a file called like the folder's hash is preferred.
Result<SceneFiles> FindSceneFiles(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    files.push_back(it->path());
  }
  if (error) return Fail(ErrorCode::kNotFound, "scene folder cannot be read", folder.string());
  std::sort(files.begin(), files.end());
  const std::string name = folder.filename().string();
  const std::string hash =
      name.substr(name.find('-') == std::string::npos ? 0 : name.find('-') + 1);
  SceneFiles found;
  const auto prefer = [&hash](fs::path& slot, const fs::path& file, const std::string& wanted) {
    if (slot.empty() || file.filename() == hash + wanted) slot = file;
  };
  for (const fs::path& file : files) {
    const std::string f = file.filename().string();
    if (EndsWith(f, ".semantic.glb"))
      prefer(found.semantic, file, ".semantic.glb");
    else if (EndsWith(f, ".semantic.txt"))
      prefer(found.text, file, ".semantic.txt");
    else if (EndsWith(f, ".glb"))
      prefer(found.render, file, ".glb");
  }
  if (found.render.empty())
    return Fail(ErrorCode::kNotFound, "holds no .glb file", folder.string());
  if (found.semantic.empty() != found.text.empty()) {
    return Fail(ErrorCode::kNotFound,
                "has only one of .semantic.glb and .semantic.txt; both are needed",
                folder.string());
  }
  return found;
}

Result<void> AddSemantics(const SceneFiles& files, const CategoryTable& categories, Scene& scene) {
  const auto text = ReadFile(files.text);
  if (!text) return tl::unexpected(text.error());
  const auto lines = ParseSemanticText(*text, files.text.string(), &scene.notes);
  if (!lines) return tl::unexpected(lines.error());
  auto semantic = ReadGlb(files.semantic, {.raw_vertex_colours = true});
  if (!semantic) return tl::unexpected(semantic.error());
  ToWorld(semantic->mesh);
  semantic->mesh.triangle_instance = InstancesByColour(*semantic, *lines);
  scene.mesh.triangle_instance = TransferInstances(semantic->mesh, scene.mesh, kMaxTransfer_m);
  std::set<int> named;
  for (const SemanticLine& line : *lines) {
    if (!named.insert(line.id).second) continue;
    const auto category = categories.find(line.name);
    scene.instances.push_back({line.id, line.name,
                               category == categories.end() ? "" : category->second, line.region,
                               Box3{}});
  }
  return {};
}

class Hasher {
 public:
  Hasher() : state_(XXH3_createState()) {
    CROSSNAV_CHECK(state_ != nullptr, "out of memory");
    XXH3_64bits_reset(state_);
  }
  ~Hasher() { XXH3_freeState(state_); }
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void Add(const void* bytes, std::size_t size) { XXH3_64bits_update(state_, bytes, size); }
  template <class T>
  void AddAll(const std::vector<T>& values) {
    const std::uint64_t count = values.size();
    Add(&count, sizeof(count));
    Add(values.data(), values.size() * sizeof(T));
  }
  std::uint64_t Get() const { return XXH3_64bits_digest(state_); }

 private:
  XXH3_state_t* state_;
};

std::uint64_t HashOf(const Scene& scene) {
  Hasher hasher;
  hasher.AddAll(scene.mesh.vertices);
  hasher.AddAll(scene.mesh.triangles);
  hasher.AddAll(scene.mesh.triangle_instance);
  for (const SceneInstance& instance : scene.instances) {
    hasher.Add(&instance.id, sizeof(instance.id));
    hasher.Add(instance.name.data(), instance.name.size() + 1);
    hasher.Add(instance.category.data(), instance.category.size() + 1);
  }
  return hasher.Get();
}

}  // namespace

void UpdateDerived(Scene& scene) {
  TriangleMesh& mesh = scene.mesh;
  if (scene.materials.empty()) scene.materials.emplace_back();
  mesh.triangle_material.resize(mesh.triangles.size(), 0);
  mesh.triangle_instance.resize(mesh.triangles.size(), 0);
  std::sort(scene.instances.begin(), scene.instances.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  std::map<int, Box3> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] == 0) continue;
    Box3& box = boxes[mesh.triangle_instance[t]];
    for (const std::uint32_t v : mesh.triangles[t]) box.Add(mesh.vertices[v].cast<double>());
  }
  for (SceneInstance& instance : scene.instances) {
    const auto box = boxes.find(instance.id);
    instance.box = box == boxes.end() ? Box3{} : box->second;
  }
  scene.mesh_hash = HashOf(scene);
}

const SceneInstance* Scene::FindInstance(int wanted) const {
  const auto it = std::lower_bound(instances.begin(), instances.end(), wanted,
                                   [](const SceneInstance& a, int b) { return a.id < b; });
  return it != instances.end() && it->id == wanted ? &*it : nullptr;
}

Result<Scene> LoadScene(const fs::path& folder, const CategoryTable& categories) {
  const std::string id = (folder.has_filename() ? folder : folder.parent_path()).filename();
  if (!IsUtf8(id))
    return Fail(ErrorCode::kInvalid,
                "its name is not UTF-8, which episodes need; rename the folder", folder.string());
  const auto files = FindSceneFiles(folder);
  if (!files) return tl::unexpected(files.error());
  auto model = ReadGlb(files->render);
  if (!model) return tl::unexpected(model.error());
  Scene scene;
  scene.folder = folder;
  scene.id = id;
  scene.mesh = std::move(model->mesh);
  scene.materials = std::move(model->materials);
  scene.textures = std::move(model->textures);
  scene.notes = std::move(model->notes);
  ToWorld(scene.mesh);
  if (!files->text.empty()) {
    if (auto ok = AddSemantics(*files, categories, scene); !ok) return tl::unexpected(ok.error());
  }
  UpdateDerived(scene);
  return scene;
}

Result<fs::path> FindScene(const fs::path& scenes_dir, std::string_view scene_id) {
  // "…/00800-TEEsavR23oF/TEEsavR23oF.basis.glb" names its folder.
  fs::path id(scene_id);
  if (id.extension() == ".glb") id = id.parent_path();
  if (!id.has_filename()) id = id.parent_path();
  const std::string wanted = id.filename().string();
  if (wanted.empty() || wanted == "." || wanted == "..") {
    return Fail(ErrorCode::kInvalid, "\"" + std::string(scene_id) + "\" is not a scene id");
  }
  std::error_code error;
  std::vector<fs::path> matches;
  auto it = fs::recursive_directory_iterator(
      scenes_dir, fs::directory_options::follow_directory_symlink, error);
  for (; !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    if (it.depth() >= 3) it.disable_recursion_pending();
    if (!it->is_directory(error)) continue;
    const std::string name = it->path().filename().string();
    if (name == wanted || EndsWith(name, "-" + wanted)) matches.push_back(it->path());
  }
  if (matches.empty()) {
    return Fail(ErrorCode::kNotFound, "no scene folder called \"" + wanted + "\"",
                scenes_dir.string());
  }
  return *std::min_element(matches.begin(), matches.end());
}

}  // namespace crossnav::sim
