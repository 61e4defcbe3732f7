// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/world/furniture/furniture_import.h"
#include "crossnav/world/furniture/furniture_pack.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Folder of the libraries in Debian's package.
constexpr const char* kInstalled = "usr/share/sweethome3d/furniture";

bool HasLibraries(const fs::path& folder) {
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) {
    if (file.path().extension() == ".sh3f") return true;
  }
  return false;
}

/// The file or folder itself, or the library folder of an unpacked package in it; empty =
/// installed.
Result<fs::path> FindLibraries(const std::string& folder) {
  const fs::path root = folder.empty() ? fs::path("/") : fs::path(folder);
  std::error_code error;
  if (fs::is_regular_file(root, error)) return root;
  for (const fs::path& place : {root, root / kInstalled}) {
    if (HasLibraries(place)) return place;
  }
  return Fail(ErrorCode::kNotFound,
              "no .sh3f furniture library here; install the package sweethome3d-furniture, or "
              "unpack it (apt-get download sweethome3d-furniture; dpkg-deb -x "
              "sweethome3d-furniture_*.deb DIR) and name DIR",
              folder.empty() ? (root / kInstalled).string() : folder);
}

std::string ReportText(const world::ImportReport& report, const std::string& place,
                       const std::string& hash) {
  std::string text = fmt::format("{}  {} models, {} triangles of {}, pack {}\n", place,
                                 report.models, report.triangles, report.original_triangles, hash);
  for (const auto& [kind, count] : report.per_kind) text += fmt::format("  {:3} {}\n", count, kind);
  for (const std::string& skipped : report.skipped) text += "  left out: " + skipped + "\n";
  return text + "  credits: " + (fs::path(place) / "ATTRIBUTION.md").string() + "\n";
}

}  // namespace

std::string DefaultFurniture() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  fs::path base = data != nullptr && *data != '\0' ? fs::path(data)
                  : home != nullptr                ? fs::path(home) / ".local/share"
                                                   : fs::path(".");
  return (base / "crossnav/furniture").string();
}

Result<std::optional<world::FurniturePack>> OpenFurniture(const std::string& wish,
                                                          Console& console) {
  if (wish == "none") return std::nullopt;
  const std::string place = wish.empty() ? DefaultFurniture() : wish;
  auto pack = world::FurniturePack::Load(place);
  if (pack) return std::optional(std::move(*pack));
  if (wish.empty() && pack.error().code == ErrorCode::kNotFound) {
    console.Log("no furniture pack in " + place +
                ": simple shapes are used; `crossnav assets import` makes one from the package "
                "sweethome3d-furniture");
    return std::nullopt;
  }
  return tl::unexpected(pack.error());
}

Result<void> AssetsImport(const AssetsOptions& options, const CommonOptions& /*common*/,
                          Console& console) {
  const auto libraries = FindLibraries(options.libraries);
  if (!libraries) return tl::unexpected(libraries.error());
  const std::string place = options.out.empty() ? DefaultFurniture() : options.out;
  if (auto ok = evaluation::CheckOutputFolder(place, "--out"); !ok) return ok;
  console.Log("reading " + libraries->string());
  const auto report = world::ImportFurniture(*libraries, place);
  if (!report) return tl::unexpected(report.error());
  const auto pack = world::FurniturePack::Load(place);
  if (!pack) return tl::unexpected(pack.error());
  console.Print(ReportText(*report, place, pack->hash()));
  console.Document(Json({{"pack", place},
                         {"hash", pack->hash()},
                         {"models", report->models},
                         {"per_kind", report->per_kind},
                         {"triangles", report->triangles},
                         {"original_triangles", report->original_triangles},
                         {"left_out", report->skipped}}));
  return {};
}

}  // namespace crossnav::app
