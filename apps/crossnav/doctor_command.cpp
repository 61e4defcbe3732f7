// SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "commands.h"

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

bool HasLibrary(const char* name) {
  void* handle = ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (handle == nullptr) return false;
  ::dlclose(handle);
  return true;
}

/// Optional parts: what they are for and how to get them.
Json OptionalParts() {
  const bool has_onnx = HasLibrary("libonnxruntime.so.1");
  const bool has_pack = world::FurniturePack::Load(DefaultFurniture()).has_value();
  return Json::array({{{"name", "onnxruntime"},
                       {"found", has_onnx},
                       {"for", "detection and dense features by networks"},
                       {"get", has_onnx ? ""
                                        : "Debian 13: apt-get install libonnxruntime-dev; this "
                                          "version of crossnav does without"}},
                      {{"name", "furniture pack"},
                       {"found", has_pack},
                       {"for", "generated houses with modelled furniture instead of simple shapes"},
                       {"get", has_pack ? ""
                                        : "apt-get install sweethome3d-furniture; crossnav assets "
                                          "import"}}});
}

}  // namespace

Result<void> Doctor(const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const Json json = {{"version", CROSSNAV_VERSION},
                     {"compiler", __VERSION__},
                     {"cores", std::thread::hardware_concurrency()},
                     {"cpu_features", CpuFeatures()},
                     {"perception", {"oracle"}},
                     {"optional", OptionalParts()}};
  std::string text = fmt::format("crossnav {} ({})\n{} cores,", CROSSNAV_VERSION, __VERSION__,
                                 std::thread::hardware_concurrency());
  for (const auto& feature : json["cpu_features"]) text += " " + feature.get<std::string>();
  text += "\nperception: oracle (ground truth from the simulator)\n";
  for (const auto& part : json["optional"]) {
    text += fmt::format("{}: {} - {}\n", part["name"].get<std::string>(),
                        part["found"].get<bool>() ? "found" : "not here (optional)",
                        part["for"].get<std::string>());
    const auto get = part["get"].get<std::string>();
    if (!get.empty()) text += "  " + get + "\n";
  }
  console.Print(text);
  console.Document(json.dump(1));
  return {};
}

}  // namespace crossnav::app
