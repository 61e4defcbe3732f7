// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands.h"
#include "crossnav/core/version.h"
#include "crossnav/inference/suite.h"
#include "perception_source.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json CpuFeatures() {
  Json features = Json::array();
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("sse4.2")) features.push_back("sse4.2");
  if (__builtin_cpu_supports("avx2")) features.push_back("avx2");
  if (__builtin_cpu_supports("fma")) features.push_back("fma");
  if (__builtin_cpu_supports("avx512f")) features.push_back("avx512f");
#endif
  return features;
}

/// Optional parts: purpose, and how to install them.
Json OptionalParts() {
  const bool has_pack = world::FurniturePack::Load(DefaultFurniture()).has_value();
  Json parts = Json::array();
  for (const inference::Backend& backend : inference::Backends())
    parts.push_back({{"name", backend.name},
                     {"found", backend.is_available},
                     {"version", backend.version},
                     {"providers", backend.providers},
                     {"for", "perception by networks instead of ground truth"},
                     {"get", backend.is_available ? std::string() : backend.get}});
  parts.push_back({{"name", "furniture pack"},
                   {"found", has_pack},
                   {"for", "generated houses with modelled furniture instead of simple shapes"},
                   {"get", has_pack ? ""
                                    : "apt-get install sweethome3d-furniture; crossnav assets "
                                      "import"}});
  return parts;
}

/// Name and state of each network with a card.
Json NetworksFound(const evaluation::RunConfig& config) {
  Json found = Json::array();
  const auto cards = inference::ListCards(NetworksDir(config));
  if (!cards) return found;
  for (const auto& path : *cards) {
    const auto card = inference::ReadModelCard(path);
    const auto bytes = card ? inference::ReadNetworkFile(*card)
                            : Result<std::string>(tl::unexpected(card.error()));
    found.push_back({{"name", path.stem().string()},
                     {"found", bytes.has_value()},
                     {"error", bytes ? "" : bytes.error().Message()}});
  }
  return found;
}

}  // namespace

Result<void> Doctor(const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  Json perception = {"oracle"};
  const auto& backends = inference::Backends();
  if (std::any_of(backends.begin(), backends.end(), [](const auto& b) { return b.is_available; }))
    perception.push_back("networks");
  const Json json = {{"version", CROSSNAV_VERSION},
                     {"compiler", __VERSION__},
                     {"cores", std::thread::hardware_concurrency()},
                     {"cpu_features", CpuFeatures()},
                     {"perception", std::move(perception)},
                     {"networks", NetworksFound(*config)},
                     {"optional", OptionalParts()}};
  std::string text = fmt::format("crossnav {} ({})\n{} cores,", CROSSNAV_VERSION, __VERSION__,
                                 std::thread::hardware_concurrency());
  for (const auto& feature : json["cpu_features"]) text += " " + feature.get<std::string>();
  text += "\nperception: oracle (ground truth from the simulator)\n";
  for (const auto& network : json["networks"])
    text +=
        fmt::format("network {}: {}\n", network["name"].get<std::string>(),
                    network["found"].get<bool>() ? "found" : network["error"].get<std::string>());
  for (const auto& part : json["optional"]) {
    text += fmt::format("{}: {} - {}\n", part["name"].get<std::string>(),
                        part["found"].get<bool>() ? "found" : "not here (optional)",
                        part["for"].get<std::string>());
    const auto get = part["get"].get<std::string>();
    if (!get.empty()) text += "  " + get + "\n";
  }
  console.Print(text);
  console.Document(json);
  return {};
}

}  // namespace crossnav::app
