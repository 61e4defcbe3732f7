// SPDX-License-Identifier: MIT
#include "crossnav/world/models/obj_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "crossnav/sim/scene/image_codec.h"
#include "crossnav/world/models/face_triangles.h"

namespace crossnav::world {
namespace {

constexpr int kMaxTexture_px = 256;  // chosen: furniture fills a part of a 640 px picture

constexpr std::size_t kMaxCorners = 1000;  // chosen: of a face; modellers write up to 200
constexpr double kMaxEarWork = 5e9;        // chosen: a second; a face of n corners costs n^3

struct ObjMaterial {
  Rgb8 colour{200, 200, 200};
  double opacity = 1;
  std::string picture;
};

Rgb8 ColourOf(std::istringstream& in) {
  double c[3] = {0.8, 0.8, 0.8};
  in >> c[0] >> c[1] >> c[2];
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255));
  };
  return {byte(c[0]), byte(c[1]), byte(c[2])};
}

std::string Rest(std::istringstream& in) {
  std::string rest;
  std::getline(in >> std::ws, rest);
  while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back()))) rest.pop_back();
  return rest;
}

void ParseMtl(const std::string& text, std::map<std::string, ObjMaterial>& out) {
  std::istringstream lines(text);
  std::string line;
  ObjMaterial* current = nullptr;
  while (std::getline(lines, line)) {
    std::istringstream in(line);
    std::string key;
    in >> key;
    if (key == "newmtl") {
      current = &out[Rest(in)];
    } else if (!current) {
      continue;
    } else if (key == "Kd") {
      current->colour = ColourOf(in);
    } else if (key == "d") {
      in >> current->opacity;
    } else if (key == "map_Kd") {
      current->picture = Rest(in);
    }
  }
}

struct ObjParser {
  const FileLookup& lookup;
  const std::string& where;
  int most_px = kMaxTexture_px;
  ObjectModel model;
  NamedObj names;  // its model stays empty until the end
  std::vector<Vector3f> points;
  std::vector<std::array<float, 2>> uvs;
  std::map<std::string, ObjMaterial> library;
  std::map<std::string, int> material_of_name;
  std::map<std::string, int> texture_of_picture;
  std::map<std::pair<int, int>, std::uint32_t> vertex_of;
  std::map<std::string, int> group_of_name;
  int material = -1, group = -1;
  double ear_work = 0;

  /// Index of the material in the model, -1 if it is nearly invisible.
  int UseMaterial(const std::string& name) {
    const auto known = material_of_name.find(name);
    if (known != material_of_name.end()) return known->second;
    const auto found = library.find(name);
    const ObjMaterial m = found == library.end() ? ObjMaterial{} : found->second;
    if (m.opacity < 0.15) return material_of_name[name] = -1;
    sim::Material out{m.colour, TextureOf(m.picture)};
    if (out.texture >= 0) out.colour = {255, 255, 255};  // exporters write grey beside a picture
    model.materials.push_back(out);
    names.material_names.push_back(name);
    names.is_material_defined.push_back(found != library.end());
    return material_of_name[name] = static_cast<int>(model.materials.size()) - 1;
  }

  int TextureOf(const std::string& picture) {
    if (picture.empty()) return -1;
    const auto [it, is_new] = texture_of_picture.try_emplace(picture, -1);
    if (!is_new) return it->second;
    const auto bytes = lookup(picture);
    if (!bytes) return -1;
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
    auto decoded = sim::DecodeImage({data, bytes->size()}, where + ": " + picture);
    if (!decoded) return -1;
    model.textures.push_back(Reduced(*decoded, most_px));
    return it->second = static_cast<int>(model.textures.size()) - 1;
  }

  /// Index in file order to vector index; nullopt where out of range.
  template <class T>
  static std::optional<int> Index(long i, const std::vector<T>& of) {
    const long n = static_cast<long>(of.size());
    const long k = i > 0 ? i - 1 : n + i;
    if (i == 0 || k < 0 || k >= n) return std::nullopt;
    return static_cast<int>(k);
  }

  /// Reason for rejecting the face, or nullptr.
  const char* AddFace(std::istringstream& in) {
    std::vector<std::uint32_t> corners;
    std::string corner;
    while (in >> corner) {
      if (corners.size() == kMaxCorners) return "a face has more than 1000 corners";
      char* rest = nullptr;
      const auto v = Index(std::strtol(corner.c_str(), &rest, 10), points);
      if (!v) return "a face names a vertex that is not there";
      std::optional<int> t;
      if (*rest == '/' && rest[1] != '/') t = Index(std::strtol(rest + 1, nullptr, 10), uvs);
      const auto key = std::make_pair(*v, t.value_or(-1));
      const auto [it, is_new] =
          vertex_of.try_emplace(key, static_cast<std::uint32_t>(model.mesh.vertices.size()));
      if (is_new) {
        model.mesh.vertices.push_back(points[static_cast<std::size_t>(*v)]);
        model.mesh.uvs.push_back(t ? uvs[static_cast<std::size_t>(*t)] : std::array{0.0F, 0.0F});
      }
      corners.push_back(it->second);
    }
    if (material < 0) return nullptr;
    if (corners.size() > 4) ear_work += std::pow(static_cast<double>(corners.size()), 3);
    if (ear_work > kMaxEarWork) return "too many faces of many corners; triangulate the model";
    const auto& p = model.mesh.vertices;
    std::vector<Vector3f> at;
    for (const auto v : corners) at.push_back(p[v]);
    for (const auto& [i, j, k] : FaceTriangles(at)) {
      const std::array<std::uint32_t, 3> t = {corners[i], corners[j], corners[k]};
      if ((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).squaredNorm() <= 0) continue;
      model.mesh.triangles.push_back(t);
      model.mesh.triangle_material.push_back(static_cast<std::uint16_t>(material));
      names.triangle_group.push_back(group);
    }
    return nullptr;
  }

  bool AddPoint(std::istringstream& in) {
    Vector3f p = Vector3f::Zero();
    in >> p.x() >> p.y() >> p.z();
    if (!in || !p.allFinite()) return false;
    points.push_back(p);
    return true;
  }

  void UseGroup(const std::string& name) {
    const auto [it, is_new] =
        group_of_name.try_emplace(name, static_cast<int>(names.group_names.size()));
    if (is_new) names.group_names.push_back(name);
    group = it->second;
  }

  Result<void> Parse(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      std::istringstream in(line);
      std::string key;
      in >> key;
      if (key == "v") {
        if (!AddPoint(in)) return Bad(number, "a vertex is not three numbers");
      } else if (key == "vt") {
        std::array<float, 2> uv{};
        in >> uv[0] >> uv[1];
        uvs.push_back({uv[0], 1 - uv[1]});  // OBJ counts from the bottom row
      } else if (key == "f") {
        if (material < 0 && material_of_name.empty()) material = UseMaterial("");
        if (const char* problem = AddFace(in)) return Bad(number, problem);
      } else if (key == "usemtl") {
        material = UseMaterial(Rest(in));
        if (model.materials.size() > 65535) return Bad(number, "more than 65535 materials");
      } else if (key == "g" || key == "o") {
        UseGroup(Rest(in));
      } else if (key == "mtllib") {
        if (const auto mtl = lookup(Rest(in))) ParseMtl(*mtl, library);
      }
    }
    return {};
  }

  tl::unexpected<Error> Bad(int line, const char* what) const {
    return Fail(ErrorCode::kMalformed, what, where + ": line " + std::to_string(line));
  }
};

}  // namespace

sim::Texture Reduced(const sim::Texture& texture, int most_px) {
  const int larger = std::max(texture.rgb.width, texture.rgb.height);
  const int factor = (larger + most_px - 1) / most_px;
  if (factor <= 1) return texture;
  const int width = std::max(1, texture.rgb.width / factor);
  const int height = std::max(1, texture.rgb.height / factor);
  sim::Texture out;
  out.rgb = RgbImage(width, height);
  if (!texture.opaque.empty()) out.opaque = MaskImage(width, height);
  const int nx = std::min(factor, texture.rgb.width), ny = std::min(factor, texture.rgb.height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      int sum[3] = {}, opaque = 0;
      for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
          const Rgb8 c = texture.rgb.At(u * nx + i, v * ny + j);
          sum[0] += c.r;
          sum[1] += c.g;
          sum[2] += c.b;
          if (!texture.opaque.empty()) opaque += texture.opaque.At(u * nx + i, v * ny + j);
        }
      }
      const int n = nx * ny;
      out.rgb.At(u, v) = {static_cast<std::uint8_t>(sum[0] / n),
                          static_cast<std::uint8_t>(sum[1] / n),
                          static_cast<std::uint8_t>(sum[2] / n)};
      if (!texture.opaque.empty()) out.opaque.At(u, v) = 2 * opaque >= n ? 1 : 0;
    }
  }
  return out;
}

Result<NamedObj> ParseNamedObj(const std::string& text, const FileLookup& lookup,
                               const std::string& where, int most_px) {
  ObjParser parser{lookup, where, most_px, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  if (auto ok = parser.Parse(text); !ok) return tl::unexpected(ok.error());
  if (parser.model.mesh.triangles.empty()) {
    return Fail(ErrorCode::kMalformed, "holds no triangles", where);
  }
  parser.model.mesh.triangle_instance.assign(parser.model.mesh.triangles.size(), 0);
  parser.names.model = std::move(parser.model);
  return std::move(parser.names);
}

Result<ObjectModel> ParseObj(const std::string& text, const FileLookup& lookup,
                             const std::string& where) {
  auto named = ParseNamedObj(text, lookup, where, kMaxTexture_px);
  if (!named) return tl::unexpected(named.error());
  return std::move(named->model);
}

}  // namespace crossnav::world
