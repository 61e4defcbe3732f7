// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_pack.h"

#include <fmt/format.h>
#include <xxhash.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "crossnav/core/png_image.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/core/write_file.h"
#include "crossnav/sim/scene/image_codec.h"

namespace crossnav::world {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kPackFormat = 2;
constexpr std::uint64_t kMaxModel = 256U << 20;

struct Writer {
  std::string out;
  void Number(std::uint64_t v) { out.append(reinterpret_cast<const char*>(&v), sizeof v); }
  template <class T>
  void Array(const std::vector<T>& v) {
    Number(v.size());
    out.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
  }
};

struct PackBytes {
  const std::string& in;
  std::size_t at = 0;
  bool is_good = true;

  std::uint64_t Number() {
    std::uint64_t v = 0;
    if (at + sizeof v > in.size()) {
      is_good = false;
      return 0;
    }
    std::memcpy(&v, in.data() + at, sizeof v);
    at += sizeof v;
    return v;
  }
  template <class T>
  std::vector<T> Array() {
    const std::uint64_t n = Number();
    if (!is_good || n > (in.size() - at) / sizeof(T)) {
      is_good = false;
      return {};
    }
    std::vector<T> v(n);
    if (n > 0) std::memcpy(static_cast<void*>(v.data()), in.data() + at, n * sizeof(T));
    at += n * sizeof(T);
    return v;
  }
};

/// A material in the pack, without the padding of the struct, whose bytes are arbitrary.
struct PackMaterial {
  std::array<std::uint8_t, 4> rgb0{};
  std::int32_t texture = -1;
  std::uint32_t is_unlit = 0;
};
static_assert(sizeof(PackMaterial) == 12);

PackMaterial ForPack(const sim::Material& m) {
  return {{m.colour.r, m.colour.g, m.colour.b, 0}, m.texture, m.is_unlit ? 1U : 0U};
}

sim::Material FromPack(const PackMaterial& m) {
  // Older packs have arbitrary bytes behind the first of the last field.
  return {{m.rgb0[0], m.rgb0[1], m.rgb0[2]}, m.texture, (m.is_unlit & 0xFFU) != 0};
}

std::string Packed(const std::string& model) {
  uLongf size = compressBound(model.size());
  std::string packed(8 + size, '\0');
  const std::uint64_t raw = model.size();
  std::memcpy(packed.data(), &raw, 8);
  compress2(reinterpret_cast<Bytef*>(packed.data() + 8), &size,
            reinterpret_cast<const Bytef*>(model.data()), model.size(), 9);
  packed.resize(8 + size);
  return packed;
}

/// True if every index refers to an existing element.
bool IsSound(const ObjectModel& m) {
  const auto& mesh = m.mesh;
  bool ok = mesh.uvs.size() == mesh.vertices.size() &&
            mesh.triangle_material.size() == mesh.triangles.size();
  for (const auto& t : mesh.triangles) {
    for (auto v : t) ok = ok && v < mesh.vertices.size();
  }
  for (auto i : mesh.triangle_material) ok = ok && i < m.materials.size();
  for (const auto& i : m.materials) ok = ok && i.texture < static_cast<int>(m.textures.size());
  return ok;
}

Json ToJson(const PackEntry& e) {
  return {{"id", e.id},
          {"kind", e.kind},
          {"title", e.title},
          {"author", e.author},
          {"licence", e.licence},
          {"licence_uri", e.licence_uri},
          {"source", e.source},
          {"size_m", {e.size_m.x(), e.size_m.y(), e.size_m.z()}},
          {"top_m", e.top_m},
          {"triangles", e.triangles},
          {"original_triangles", e.original_triangles},
          {"offset", e.offset},
          {"bytes", e.bytes}};
}

PackEntry FromJson(const Json& j) {
  PackEntry e;
  e.id = j.at("id");
  e.kind = j.at("kind");
  e.title = j.at("title");
  e.author = j.at("author");
  e.licence = j.at("licence");
  e.licence_uri = j.at("licence_uri");
  e.source = j.at("source");
  for (int i = 0; i < 3; ++i) e.size_m[i] = j.at("size_m").at(static_cast<std::size_t>(i));
  e.top_m = j.at("top_m");
  e.triangles = j.at("triangles");
  e.original_triangles = j.at("original_triangles");
  e.offset = j.at("offset");
  e.bytes = j.at("bytes");
  return e;
}

std::string Attribution(const std::vector<PackModel>& models) {
  std::string text =
      "# Furniture models\n\nThese models are under their own licences, apart from the program's. "
      "All "
      "of them were modified:\nconverted, rescaled to their catalogue size, simplified, pictures "
      "reduced.\n\n";
  for (const auto& m : models) {
    text += fmt::format("- \"{}\" ({}) by {}; {}; {} <{}>; modified as above\n", m.entry.title,
                        m.entry.id, m.entry.author, m.entry.source, m.entry.licence,
                        m.entry.licence_uri);
  }
  return text;
}

std::string HashOf(const std::string& bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace

std::string EncodeModel(const ObjectModel& model) {
  Writer w;
  w.Array(model.mesh.vertices);
  w.Array(model.mesh.uvs);
  w.Array(model.mesh.triangles);
  w.Array(model.mesh.triangle_material);
  std::vector<PackMaterial> materials;
  for (const sim::Material& material : model.materials) materials.push_back(ForPack(material));
  w.Array(materials);
  w.Number(model.textures.size());
  for (const auto& t : model.textures) {
    const std::string png = EncodePng(t.rgb, t.opaque);
    w.Array(std::vector<char>(png.begin(), png.end()));
  }
  return std::move(w.out);
}

Result<void> WritePack(std::vector<PackModel> models, const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), dir.string());
  std::string bytes;
  Json list = Json::array();
  for (auto& m : models) {
    const std::string packed = Packed(EncodeModel(m.model));
    m.entry.offset = bytes.size();
    m.entry.bytes = packed.size();
    m.entry.triangles = static_cast<int>(m.model.mesh.triangles.size());
    bytes += packed;
    list.push_back(ToJson(m.entry));
  }
  const Json manifest = {{"format", kPackFormat}, {"pack_xxh3", HashOf(bytes)}, {"models", list}};
  for (const auto& [name, text] :
       {std::pair<std::string, std::string>{"furniture.pack", bytes},
        {"ATTRIBUTION.md", Attribution(models)},
        {"manifest.json",
         manifest.dump(1, ' ', false, nlohmann::detail::error_handler_t::replace) + "\n"}}) {
    if (auto ok = WriteFileAtomically(dir / name, text); !ok) return ok;
  }
  return {};
}

Result<FurniturePack> FurniturePack::Load(const fs::path& dir) {
  FurniturePack pack;
  pack.dir_ = dir;
  const std::string where = (dir / "manifest.json").string();
  if (!fs::exists(dir / "manifest.json")) {
    return Fail(ErrorCode::kNotFound, "no furniture pack here; `crossnav assets import` makes one",
                where);
  }
  std::string pack_hash;
  const auto text = ReadFile(dir / "manifest.json");
  if (!text) return tl::unexpected(text.error());
  if (auto ok = CheckJsonShape(*text, where); !ok) return tl::unexpected(ok.error());
  pack.hash_ = HashOf(*text);
  try {
    const Json manifest = Json::parse(*text);
    if (manifest.at("format") != kPackFormat) {
      return Fail(ErrorCode::kUnsupported, "another version of the pack; import it again", where);
    }
    pack_hash = manifest.at("pack_xxh3");
    for (const Json& j : manifest.at("models")) pack.entries_.push_back(FromJson(j));
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kMalformed,
                PlainReason(e.what()) + "; `crossnav assets import` makes the pack again", where);
  }
  pack.bytes_ = ReadFile(dir / "furniture.pack").value_or("");  // a missing file counts as damaged
  bool is_whole = HashOf(pack.bytes_) == pack_hash;
  for (const auto& e : pack.entries_) {
    is_whole = is_whole && e.offset <= pack.bytes_.size() &&
               e.bytes <= pack.bytes_.size() - e.offset && e.bytes >= 8;
  }
  if (!is_whole) {
    return Fail(ErrorCode::kMismatch,
                "not the pack of its manifest.json; `crossnav assets import` makes it again",
                (dir / "furniture.pack").string());
  }
  return pack;
}

const PackEntry* FurniturePack::Find(std::string_view id) const {
  const auto it = std::find_if(entries_.begin(), entries_.end(),
                               [&](const PackEntry& e) { return e.id == id; });
  return it == entries_.end() ? nullptr : &*it;
}

Result<ObjectModel> DecodeModel(const std::string& bytes, const PackEntry& entry,
                                const std::string& where) {
  PackBytes r{bytes};
  ObjectModel m;
  m.name = entry.kind;
  m.asset_id = entry.id;
  m.top_m = entry.top_m;
  m.mesh.vertices = r.Array<Vector3f>();
  m.mesh.uvs = r.Array<std::array<float, 2>>();
  m.mesh.triangles = r.Array<std::array<std::uint32_t, 3>>();
  m.mesh.triangle_material = r.Array<std::uint16_t>();
  for (const PackMaterial& material : r.Array<PackMaterial>())
    m.materials.push_back(FromPack(material));
  const std::uint64_t textures = r.Number();
  for (std::uint64_t i = 0; i < textures && r.is_good; ++i) {
    const auto png = r.Array<std::uint8_t>();
    auto texture = sim::DecodeImage(png, where);
    if (!texture) return tl::unexpected(texture.error());
    m.textures.push_back(std::move(*texture));
  }
  if (!r.is_good || !IsSound(m)) return Fail(ErrorCode::kMalformed, "a model is damaged", where);
  m.mesh.triangle_instance.assign(m.mesh.triangles.size(), 0);
  return m;
}

Result<ObjectModel> FurniturePack::Read(const PackEntry& entry) const {
  const std::string where = (dir_ / "furniture.pack").string() + ": " + entry.id;
  std::uint64_t size = 0;
  std::memcpy(&size, bytes_.data() + entry.offset, 8);
  if (size > kMaxModel) return Fail(ErrorCode::kMalformed, "a model is too large", where);
  std::string raw(size, '\0');
  uLongf got = raw.size();
  const int status =
      uncompress(reinterpret_cast<Bytef*>(raw.data()), &got,
                 reinterpret_cast<const Bytef*>(bytes_.data() + entry.offset + 8), entry.bytes - 8);
  if (status != Z_OK || got != size)
    return Fail(ErrorCode::kMalformed, "a model is damaged", where);
  return DecodeModel(raw, entry, where);
}

std::optional<ObjectModel> FurniturePack::Draw(std::string_view kind, Rng& rng) const {
  std::vector<const PackEntry*> fitting;
  for (const auto& e : entries_) {
    if (e.kind == kind) fitting.push_back(&e);
  }
  if (fitting.empty()) return std::nullopt;
  auto model = Read(*fitting[rng.Below(static_cast<std::uint32_t>(fitting.size()))]);
  if (!model) return std::nullopt;
  return std::move(*model);
}

}  // namespace crossnav::world
