// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_import.h"

#include <algorithm>
#include <sstream>

#include "crossnav/world/furniture/furniture_classes.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/mesh/simplify.h"
#include "crossnav/world/models/obj_reader.h"
#include "crossnav/world/models/zip_reader.h"

namespace crossnav::world {
namespace {

namespace fs = std::filesystem;
using Properties = std::map<std::string, std::string>;

/// Converts ISO-8859-1 with \uXXXX escapes, the encoding of Java's properties, to UTF-8.
std::string Unescape(const std::string& latin1) {
  std::string out;
  const auto put = [&out](unsigned c) {
    if (c < 0x80) {
      out.push_back(static_cast<char>(c));
    } else if (c < 0x800) {
      out.push_back(static_cast<char>(0xC0 | c >> 6));
      out.push_back(static_cast<char>(0x80 | (c & 0x3F)));
    } else {
      out.push_back(static_cast<char>(0xE0 | c >> 12));
      out.push_back(static_cast<char>(0x80 | (c >> 6 & 0x3F)));
      out.push_back(static_cast<char>(0x80 | (c & 0x3F)));
    }
  };
  for (std::size_t i = 0; i < latin1.size(); ++i) {
    if (latin1[i] != '\\' || i + 1 >= latin1.size()) {
      const auto c = static_cast<unsigned char>(latin1[i]);
      if (c >= 0x20) put(c);
    } else if (latin1[i + 1] == 'u' && i + 5 < latin1.size()) {
      put(static_cast<unsigned>(std::strtoul(latin1.substr(i + 2, 4).c_str(), nullptr, 16)));
      i += 5;
    } else {
      put(static_cast<unsigned char>(latin1[++i]));
    }
  }
  return out;
}

Properties ParseProperties(const std::string& text) {
  Properties all;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    const auto equals = line.find('=');
    if (line.empty() || line[0] == '#' || equals == std::string::npos) continue;
    const auto trim = [](const std::string& s) {
      const auto a = s.find_first_not_of(" \t\r"), b = s.find_last_not_of(" \t\r");
      return a == std::string::npos ? std::string() : s.substr(a, b - a + 1);
    };
    all[trim(line.substr(0, equals))] = Unescape(trim(line.substr(equals + 1)));
  }
  return all;
}

std::string Get(const Properties& p, const std::string& key) {
  const auto it = p.find(key);
  return it == p.end() ? std::string() : it->second;
}

double Centimetres(const Properties& p, const std::string& key, double otherwise) {
  const std::string text = Get(p, key);
  return text.empty() ? otherwise : std::strtod(text.c_str(), nullptr) / 100;
}

/// Applies the model rotation, then fits the box to width x depth x height; the result stands on
/// the floor in object frame. Catalogue frame: X width, Y up, front +Z.
void Fit(ObjectModel& model, const Properties& p, const std::string& n, Vector3d size_m) {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  std::istringstream numbers(Get(p, "modelRotation#" + n));
  Eigen::Matrix3f read;
  for (int i = 0; i < 9; ++i) numbers >> read(i / 3, i % 3);
  if (numbers) rotation = read;
  Box3 box;
  for (auto& v : model.mesh.vertices) {
    const Vector3f r = rotation * v;
    v = {-r.x(), r.z(), r.y()};
    box.Add(v.cast<double>());
  }
  const Vector3d extent = (box.max - box.min).cwiseMax(1e-9);
  // Two tables of the catalogue have width and depth exchanged against their mesh.
  const double straight = extent.x() / extent.y() / (size_m.x() / size_m.y());
  if (straight > 1.3 || straight < 1 / 1.3) {
    const double turned = extent.x() / extent.y() / (size_m.y() / size_m.x());
    if (std::abs(std::log(turned)) < 0.05) std::swap(size_m.x(), size_m.y());
  }
  const Vector3d foot(0.5 * (box.min.x() + box.max.x()), 0.5 * (box.min.y() + box.max.y()),
                      box.min.z());
  for (auto& v : model.mesh.vertices) {
    v = (v.cast<double>() - foot).cwiseQuotient(extent).cwiseProduct(size_m).cast<float>();
  }
}

struct Library {
  ZipReader zip;
  Properties properties;
  std::string file;
  std::map<std::string, std::string> number_of_id;  ///< "Scopia#bed1" -> "12"
};

/// Catalogues of a library (.sh3f) and of the program itself (sweethome3d.jar).
constexpr const char* kLibraryCatalogue = "PluginFurnitureCatalog.properties";
constexpr const char* kProgramCatalogue =
    "com/eteks/sweethome3d/io/DefaultFurnitureCatalog.properties";

bool IsProgram(const fs::path& path) {
  return path.extension() == ".jar";
}

Result<Library> OpenLibrary(const fs::path& path) {
  auto zip = ZipReader::Open(path);
  if (!zip) return tl::unexpected(zip.error());
  auto text = zip->Read(IsProgram(path) ? kProgramCatalogue : kLibraryCatalogue);
  if (!text) return tl::unexpected(text.error());
  Library library{std::move(*zip), ParseProperties(*text), path.filename().string(), {}};
  for (const auto& [key, value] : library.properties) {
    if (key.rfind("id#", 0) == 0) library.number_of_id[value] = key.substr(3);
  }
  return library;
}

void SetLicence(PackEntry& e, const Library& library) {
  const bool is_cc0 = library.file.find("CC-0") != std::string::npos && !IsReallyCcBy(e.id);
  const bool is_us = library.file.find("KatorLegaz") != std::string::npos;
  e.licence = is_cc0                    ? "CC0 1.0"
              : is_us                   ? "CC-BY 3.0 US"
              : IsProgram(library.file) ? "GNU GPL / CC-BY 3.0"
                                        : "CC-BY 3.0";
  e.licence_uri = is_cc0  ? "https://creativecommons.org/publicdomain/zero/1.0/"
                  : is_us ? "https://creativecommons.org/licenses/by/3.0/us/"
                          : "https://creativecommons.org/licenses/by/3.0/";
  e.source = library.file + " " + Get(library.properties, "version") + " of Debian's " +
             (IsProgram(library.file) ? "sweethome3d" : "sweethome3d-furniture");
}

Result<PackModel> ImportOne(const Library& library, const FurnitureClass& wanted,
                            const std::string& n) {
  const Properties& p = library.properties;
  std::string path = Get(p, "model#" + n);
  if (!path.empty() && path[0] == '/') path.erase(0, 1);
  auto text = library.zip.Read(path);
  if (!text) return tl::unexpected(text.error());
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  const auto lookup = [&](const std::string& name) -> std::optional<std::string> {
    auto bytes = library.zip.Read(folder + name);
    if (!bytes) return std::nullopt;
    return std::move(*bytes);
  };
  auto model = ParseObj(*text, lookup, library.file + ": " + path);
  if (!model) return tl::unexpected(model.error());
  PackModel out;
  PackEntry& e = out.entry;
  e.id = wanted.id;
  e.kind = wanted.kind;
  e.title = Get(p, "name#" + n);
  e.author = Get(p, "creator#" + n);
  e.size_m = {Centimetres(p, "width#" + n, 1), Centimetres(p, "depth#" + n, 1),
              Centimetres(p, "height#" + n, 1)};
  const double drop = Centimetres(p, "dropOnTopElevation#" + n, e.size_m.z());
  e.top_m = drop < 0 ? -1 : drop;
  e.original_triangles = static_cast<int>(model->mesh.triangles.size());
  SetLicence(e, library);
  Fit(*model, p, n, e.size_m);
  Simplify(*model, TriangleBudget(wanted.kind));
  Compact(*model);
  if (static_cast<int>(model->mesh.triangles.size()) > 4 * TriangleBudget(wanted.kind)) {
    return Fail(ErrorCode::kUnsupported, "does not simplify far enough", e.id);
  }
  out.model = std::move(*model);
  return out;
}

/// The file itself, or the libraries in a folder.
std::vector<fs::path> LibraryFiles(const fs::path& place) {
  std::error_code error;
  if (fs::is_regular_file(place, error)) return {place};
  std::vector<fs::path> files;
  for (const auto& f : fs::directory_iterator(place, error)) {
    if (f.path().extension() == ".sh3f") files.push_back(f.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Result<ImportReport> ImportFurniture(const fs::path& libraries, const fs::path& out_dir) {
  const std::vector<fs::path> files = LibraryFiles(libraries);
  if (files.empty()) {
    return Fail(ErrorCode::kNotFound, "no .sh3f furniture library here", libraries.string());
  }
  ImportReport report;
  std::vector<PackModel> models;
  for (const auto& file : files) {
    auto library = OpenLibrary(file);
    if (!library) return tl::unexpected(library.error());
    for (const FurnitureClass& wanted : FurnitureClasses()) {
      const auto it = library->number_of_id.find(std::string(wanted.id));
      if (it == library->number_of_id.end()) continue;
      auto model = ImportOne(*library, wanted, it->second);
      if (!model) {
        report.skipped.push_back(std::string(wanted.id) + ": " + model.error().what);
        continue;
      }
      ++report.models;
      ++report.per_kind[std::string(wanted.kind)];
      report.original_triangles += model->entry.original_triangles;
      report.triangles += static_cast<long>(model->model.mesh.triangles.size());
      models.push_back(std::move(*model));
    }
  }
  if (auto ok = WritePack(std::move(models), out_dir); !ok) return tl::unexpected(ok.error());
  return report;
}

}  // namespace crossnav::world
