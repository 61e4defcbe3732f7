// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/gltf_reader.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "crossnav/core/read_file.h"
#include "crossnav/sim/scene/basis_image.h"
#include "crossnav/sim/scene/gltf_accessor.h"
#include "crossnav/sim/scene/gltf_colour.h"
#include "crossnav/sim/scene/image_codec.h"

namespace crossnav::sim {
namespace {

constexpr int kMaxNodeDepth = 64;  // chosen: deeper is a cycle or an attack
// A mesh may be instanced many times, so that a small file can draw many triangles: limited. Above
// kFreeElements a file draws at most as many vertices and as many triangles as it has bytes.
constexpr std::size_t kMaxElements = 400'000'000;
constexpr std::size_t kFreeElements = 2'000'000;  // chosen: a furnished house

/// A pass over a parsed file; holds the state of its steps.
class Reader {
 public:
  Reader(const tinygltf::Model& gltf, std::string where, const GltfOptions& options)
      : gltf_(gltf), where_(std::move(where)), options_(options), is_drawn_(gltf.nodes.size()) {
    std::size_t bytes = 0;
    for (const auto& buffer : gltf.buffers) bytes += buffer.data.size();
    most_elements_ = std::clamp(bytes, kFreeElements, kMaxElements);
  }

  Result<GltfModel> Read() {
    if (auto ok = ReadMaterials(); !ok) return tl::unexpected(ok.error());
    std::vector<int> roots;
    if (gltf_.scenes.empty()) {
      roots = NodesWithoutParent();
    } else {
      const auto scene = static_cast<std::size_t>(std::max(gltf_.defaultScene, 0));
      if (scene >= gltf_.scenes.size()) return Bad("the default scene does not exist");
      roots = gltf_.scenes[scene].nodes;
    }
    for (const int root : roots) {
      if (auto ok = AddNode(root, Eigen::Matrix4d::Identity(), {0, -1}); !ok) {
        return tl::unexpected(ok.error());
      }
    }
    if (model_.mesh.triangles.empty()) return Bad("holds no triangles");
    PadVertexData();
    return std::move(model_);
  }

 private:
  tl::unexpected<Error> Bad(const std::string& what, const std::string& at = {}) const {
    return Fail(ErrorCode::kMalformed, what, at.empty() ? where_ : where_ + ": " + at);
  }

  tl::unexpected<Error> TooMany(const char* what, const std::string& at) const {
    return Fail(ErrorCode::kUnsupported,
                "draws more than " + std::to_string(most_elements_) + " " + what +
                    ", more than the file's size explains",
                where_ + ": " + at);
  }

  void Note(std::string note) {
    auto& notes = model_.notes;
    if (std::find(notes.begin(), notes.end(), note) == notes.end())
      notes.push_back(std::move(note));
  }

  /// Encoded bytes of an image, empty where its buffer view is out of range.
  std::span<const std::uint8_t> BytesOf(const tinygltf::Image& image) const {
    if (image.bufferView < 0) return image.image;
    if (image.bufferView >= static_cast<int>(gltf_.bufferViews.size())) return {};
    const auto& view = gltf_.bufferViews[static_cast<std::size_t>(image.bufferView)];
    if (view.buffer < 0 || view.buffer >= static_cast<int>(gltf_.buffers.size())) return {};
    const auto& bytes = gltf_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
      return {};
    return std::span(bytes).subspan(view.byteOffset, view.byteLength);
  }

  /// Image of a texture: an extension's Basis image, if this build can read it or there is no
  /// other. -1 = no existing image.
  int ImageOf(const tinygltf::Texture& texture) const {
    int image = texture.source;
    for (const char* basis : {"GOOGLE_texture_basis", "KHR_texture_basisu"}) {
      const auto found = texture.extensions.find(basis);
      if (found == texture.extensions.end() || !found->second.Has("source")) continue;
      const tinygltf::Value& source = found->second.Get("source");
      if (source.IsInt() && (HasBasisTranscoder() || image < 0)) image = source.GetNumberAsInt();
    }
    return image < static_cast<int>(gltf_.images.size()) ? image : -1;
  }

  /// Index of the decoded texture, or -1 with a note where the image cannot be used.
  int TextureOf(int gltf_texture) {
    if (gltf_texture < 0 || gltf_texture >= static_cast<int>(gltf_.textures.size())) return -1;
    const int image = ImageOf(gltf_.textures[static_cast<std::size_t>(gltf_texture)]);
    if (image < 0) return -1;
    const auto source = static_cast<std::size_t>(image);
    if (image_texture_.size() < gltf_.images.size()) {
      image_texture_.assign(gltf_.images.size(), kUnread);
    }
    if (image_texture_[source] != kUnread) return image_texture_[source];
    const auto bytes = BytesOf(gltf_.images[source]);
    auto decoded = DecodeImage(bytes, where_ + ": image " + std::to_string(source));
    if (decoded) {
      model_.textures.push_back(std::move(*decoded));
      return image_texture_[source] = static_cast<int>(model_.textures.size()) - 1;
    }
    const bool one_for_all = IsBasisImage(bytes) && !HasBasisTranscoder();
    Note((one_for_all ? decoded.error().what : decoded.error().Message()) +
         "; the flat colour is used instead");
    return image_texture_[source] = -1;
  }

  Result<void> ReadMaterials() {
    if (gltf_.materials.size() >= std::numeric_limits<std::uint16_t>::max()) {
      return Bad("has more than 65534 materials");
    }
    std::vector<bool> texture_cut_out;
    for (const tinygltf::Material& m : gltf_.materials) {
      const auto& pbr = m.pbrMetallicRoughness;
      Material material{{255, 255, 255}};
      if (pbr.baseColorFactor.size() >= 3) {
        material.colour = {LinearToSrgb(pbr.baseColorFactor[0]),
                           LinearToSrgb(pbr.baseColorFactor[1]),
                           LinearToSrgb(pbr.baseColorFactor[2])};
      }
      material.texture = TextureOf(pbr.baseColorTexture.index);
      material.is_unlit = m.extensions.count("KHR_materials_unlit") > 0;
      if (material.texture < 0 && pbr.baseColorTexture.index >= 0)
        material.colour = {200, 200, 200};
      texture_cut_out.resize(model_.textures.size(), false);
      if (material.texture >= 0 && m.alphaMode != "OPAQUE") {
        texture_cut_out[static_cast<std::size_t>(material.texture)] = true;
      }
      model_.materials.push_back(material);
    }
    // An alpha channel counts only where a material says so.
    for (std::size_t i = 0; i < texture_cut_out.size(); ++i) {
      if (!texture_cut_out[i]) model_.textures[i].opaque = {};
    }
    model_.materials.push_back(Material{});  // for primitives without one
    return {};
  }

  static Eigen::Matrix4d LocalTransform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) return Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    if (node.translation.size() == 3) {
      T.translate(Eigen::Vector3d(node.translation[0], node.translation[1], node.translation[2]));
    }
    if (node.rotation.size() == 4) {
      T.rotate(
          Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
              .normalized());
    }
    if (node.scale.size() == 3) {
      T.scale(Eigen::Vector3d(node.scale[0], node.scale[1], node.scale[2]));
    }
    return T.matrix();
  }

  std::vector<int> NodesWithoutParent() const {
    std::vector<bool> is_child(gltf_.nodes.size());
    for (const auto& node : gltf_.nodes)
      for (const int child : node.children)
        if (child >= 0 && child < static_cast<int>(is_child.size()))
          is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> nodes;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) nodes.push_back(static_cast<int>(i));
    return nodes;
  }

  struct Place {
    int depth = 0, parent = -1;  ///< index into GltfModel::parts
  };

  // NOLINTNEXTLINE(misc-no-recursion): depth is limited
  Result<void> AddNode(int index, const Eigen::Matrix4d& T_file_parent, Place place) {
    const std::string at = "node " + std::to_string(index);
    if (index < 0 || index >= static_cast<int>(gltf_.nodes.size()))
      return Bad("does not exist", at);
    if (place.depth > kMaxNodeDepth) return Bad("is nested deeper than 64 levels", at);
    if (std::exchange(is_drawn_[static_cast<std::size_t>(index)], char{true}) != 0)
      return Bad("hangs in two places of the node tree, or below itself, which glTF does not allow",
                 at);
    const tinygltf::Node& node = gltf_.nodes[static_cast<std::size_t>(index)];
    const Eigen::Matrix4d T_file_node = T_file_parent * LocalTransform(node);
    if (!T_file_node.allFinite()) return Bad("has a transform that is not finite", at);
    if (node.mesh >= static_cast<int>(gltf_.meshes.size()))
      return Bad("its mesh does not exist", at);
    const int part = static_cast<int>(model_.parts.size());
    model_.parts.push_back({node.name, place.parent});
    if (node.mesh >= 0) {
      const tinygltf::Mesh& mesh = gltf_.meshes[static_cast<std::size_t>(node.mesh)];
      if (node.name.empty()) model_.parts.back().name = mesh.name;
      for (const auto& primitive : mesh.primitives) {
        if (auto ok = AddPrimitive(primitive, T_file_node, at); !ok) return ok;
      }
      model_.triangle_part.resize(model_.mesh.triangles.size(), part);
    }
    for (const int child : node.children) {
      if (auto ok = AddNode(child, T_file_node, {place.depth + 1, part}); !ok) return ok;
    }
    return {};
  }

  Result<void> AddPrimitive(const tinygltf::Primitive& p, const Eigen::Matrix4d& T_file_node,
                            const std::string& at) {
    const int mode = p.mode < 0 ? TINYGLTF_MODE_TRIANGLES : p.mode;
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
        mode != TINYGLTF_MODE_TRIANGLE_FAN) {
      return {};  // points and lines have no surface
    }
    const std::string here = where_ + ": " + at;
    if (p.extensions.count("KHR_draco_mesh_compression") != 0) {
      return Fail(ErrorCode::kUnsupported, "Draco-compressed meshes are not read", here);
    }
    const auto position = p.attributes.find("POSITION");
    if (position == p.attributes.end()) return Bad("a primitive has no POSITION", at);
    auto points = ViewAccessor(gltf_, position->second, here);
    if (!points) return tl::unexpected(points.error());
    if (points->components != 3) return Bad("POSITION is not VEC3", at);
    TriangleMesh& mesh = model_.mesh;
    const std::size_t base = mesh.vertices.size();
    if (base + points->count > most_elements_) return TooMany("vertices", at);
    for (std::size_t i = 0; i < points->count; ++i) {
      const Eigen::Vector4d v(points->Float(i, 0), points->Float(i, 1), points->Float(i, 2), 1);
      const Eigen::Vector3d q = (T_file_node * v).head<3>();
      if (!q.allFinite() || q.cwiseAbs().maxCoeff() > 1e6) {
        return Bad("vertex " + std::to_string(i) + " is not finite or beyond 1000 km", at);
      }
      mesh.vertices.push_back(q.cast<float>());
    }
    if (auto ok = AddUvs(p, base, points->count, here); !ok) return ok;
    if (auto ok = AddColours(p, base, points->count, here); !ok) return ok;
    return AddTriangles(p, mode, base, points->count, at);
  }

  Result<void> AddUvs(const tinygltf::Primitive& p, std::size_t base, std::size_t count,
                      const std::string& here) {
    const auto found = p.attributes.find("TEXCOORD_0");
    if (found == p.attributes.end()) return {};
    auto uv = ViewAccessor(gltf_, found->second, here);
    if (!uv) return tl::unexpected(uv.error());
    if (uv->components != 2 || uv->count != count) {
      return Fail(ErrorCode::kMalformed, "TEXCOORD_0 does not fit POSITION", here);
    }
    model_.mesh.uvs.resize(base, {0.0F, 0.0F});
    for (std::size_t i = 0; i < count; ++i) {
      const float u = uv->Float(i, 0), v = uv->Float(i, 1);
      const bool sane = std::abs(u) < 1e6F && std::abs(v) < 1e6F;  // also false for NaN
      model_.mesh.uvs.push_back(sane ? std::array{u, v} : std::array{0.0F, 0.0F});
    }
    return {};
  }

  Result<void> AddColours(const tinygltf::Primitive& p, std::size_t base, std::size_t count,
                          const std::string& here) {
    const auto found = p.attributes.find("COLOR_0");
    if (found == p.attributes.end()) return {};
    auto colour = ViewAccessor(gltf_, found->second, here);
    if (!colour) return tl::unexpected(colour.error());
    if (colour->components < 3 || colour->count != count) {
      return Fail(ErrorCode::kMalformed, "COLOR_0 does not fit POSITION", here);
    }
    const bool is_float = colour->component_type == TINYGLTF_COMPONENT_TYPE_FLOAT;
    colour->normalized = !is_float;  // integer colours always are, whatever the file says
    const bool is_name = options_.raw_vertex_colours &&
                         colour->component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    const auto convert = [is_name](float x) { return is_name ? ToByte(x) : LinearToSrgb(x); };
    model_.mesh.vertex_colours.resize(base, {255, 255, 255});
    for (std::size_t i = 0; i < count; ++i) {
      model_.mesh.vertex_colours.push_back({convert(colour->Float(i, 0)),
                                            convert(colour->Float(i, 1)),
                                            convert(colour->Float(i, 2))});
    }
    return {};
  }

  /// Empty where the primitive has none.
  Result<AccessorView> IndicesOf(const tinygltf::Primitive& p, const std::string& at) {
    if (p.indices < 0) return AccessorView();
    auto view = ViewAccessor(gltf_, p.indices, where_ + ": " + at);
    if (!view) return view;
    const int type = view->component_type;
    if (view->components != 1 || (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                  type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                  type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
      return Bad("indices are not unsigned integers", at);
    }
    return view;
  }

  Result<void> AddTriangles(const tinygltf::Primitive& p, int mode, std::size_t base,
                            std::size_t vertex_count, const std::string& at) {
    const auto read = IndicesOf(p, at);
    if (!read) return tl::unexpected(read.error());
    const AccessorView& indices = *read;
    const std::size_t corners = p.indices >= 0 ? indices.count : vertex_count;
    const bool separate = mode == TINYGLTF_MODE_TRIANGLES;
    const std::size_t count = separate ? corners / 3 : (corners < 3 ? 0 : corners - 2);
    if (model_.mesh.triangles.size() + count > most_elements_) return TooMany("triangles", at);
    const bool has_material =
        p.material >= 0 && p.material + 1 < static_cast<int>(model_.materials.size());
    const auto material = static_cast<std::uint16_t>(
        has_material ? static_cast<std::size_t>(p.material) : model_.materials.size() - 1);
    for (std::size_t t = 0; t < count; ++t) {
      std::array<std::size_t, 3> corner{3 * t, 3 * t + 1, 3 * t + 2};
      if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) corner = {t, t + 1 + t % 2, t + 2 - t % 2};
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) corner = {0, t + 1, t + 2};
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = p.indices >= 0 ? indices.Index(corner[k]) : corner[k];
        if (i >= vertex_count) return Bad("index " + std::to_string(i) + " has no vertex", at);
        triangle[k] = static_cast<std::uint32_t>(base + i);
      }
      model_.mesh.triangles.push_back(triangle);
      model_.mesh.triangle_material.push_back(material);
    }
    return {};
  }

  /// Pads primitives without uvs or colours after primitives that have them.
  void PadVertexData() {
    TriangleMesh& mesh = model_.mesh;
    if (!mesh.uvs.empty()) mesh.uvs.resize(mesh.vertices.size(), {0.0F, 0.0F});
    if (!mesh.vertex_colours.empty()) {
      mesh.vertex_colours.resize(mesh.vertices.size(), {255, 255, 255});
    }
    mesh.triangle_instance.assign(mesh.triangles.size(), 0);
  }

  static constexpr int kUnread = -2;
  const tinygltf::Model& gltf_;
  std::string where_;
  GltfOptions options_;
  GltfModel model_;
  std::vector<int> image_texture_;
  std::vector<char> is_drawn_;  // by node
  std::size_t most_elements_ = 0;
};

bool KeepRawImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  // Images in a buffer view are read later, with bounds checks that the library does not make.
  if (image->bufferView < 0) image->image.assign(bytes, bytes + std::max(size, 0));
  image->as_is = true;
  return true;
}

}  // namespace

Result<GltfModel> ParseGlb(std::span<const std::uint8_t> bytes, const std::string& where,
                           const std::filesystem::path& folder, const GltfOptions& options) {
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    return Fail(ErrorCode::kUnsupported, "GLB files above 4 GiB are not read", where);
  }
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(KeepRawImage, nullptr);
  tinygltf::Model gltf;
  std::string error, warning;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    const bool is_json = !bytes.empty() && bytes[0] != 'g';
    const bool is_read =
        is_json ? loader.LoadASCIIFromString(&gltf, &error, &warning,
                                             reinterpret_cast<const char*>(bytes.data()), size,
                                             folder.string())
                : loader.LoadBinaryFromMemory(&gltf, &error, &warning, bytes.data(), size,
                                              folder.string());
    if (!is_read) {
      while (!error.empty() && error.back() == '\n') error.pop_back();
      return Fail(ErrorCode::kMalformed, "not a readable GLB file: " + error, where);
    }
    return Reader(gltf, where, options).Read();
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kMalformed, std::string("not a readable GLB file: ") + e.what(), where);
  }
}

Result<GltfModel> ReadGlb(const std::filesystem::path& file, const GltfOptions& options) {
  const auto bytes = ReadFile(file, std::numeric_limits<std::uint32_t>::max());
  if (!bytes) return tl::unexpected(bytes.error());
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
  return ParseGlb({data, bytes->size()}, file.string(), file.parent_path(), options);
}

}  // namespace crossnav::sim
