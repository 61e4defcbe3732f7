// SPDX-License-Identifier: MIT
#include "crossnav/inference/openvino_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "crossnav/core/version.h"

namespace crossnav::inference {
namespace {

namespace fs = std::filesystem;

#ifdef CROSSNAV_WITH_OPENVINO
constexpr const char* kVersion = CROSSNAV_OPENVINO_VERSION;
constexpr const char* kLibrary = CROSSNAV_OPENVINO_LIBRARY;
#else
constexpr const char* kVersion = "";
constexpr const char* kLibrary = "";
#endif

fs::path EnvironmentPath(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

/// Adds the package's libraries for each Python version under `prefix`, e.g.
/// PREFIX/python3.13/NAME.
void AddPythonPackages(const fs::path& prefix, const char* name, std::vector<fs::path>& folders) {
  if (!prefix.is_absolute()) return;
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it(prefix, error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().rfind("python3", 0) == 0)
      found.push_back(it->path() / name / "openvino/libs");
  std::sort(found.begin(), found.end());
  folders.insert(folders.end(), found.begin(), found.end());
}

/// libcrossnav_openvino.so: lib/crossnav beside or above the program's folder.
fs::path PluginFile(fs::path folder) {
  std::error_code error;
  for (int up = 0; up < 3; ++up, folder = folder.parent_path()) {
    const fs::path file = folder / "lib/crossnav/libcrossnav_openvino.so";
    if (fs::exists(file, error)) return file;
  }
  return {};
}

std::string LastLoadError() {
  const char* text = dlerror();
  return text == nullptr ? "unknown reason" : text;
}

/// OpenVINO's libraries stay loaded to the end of the process. Its TBB is loaded first: a library
/// already loaded under the same name serves both.
bool LoadOpenVino(const fs::path& folder) {
  const auto load = [&](const char* name) {
    const fs::path file = folder.empty() ? fs::path(name) : folder / name;
    return dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL) != nullptr;
  };
  if (dlopen("libtbb.so.12", RTLD_NOW | RTLD_NOLOAD) == nullptr) load("libtbb.so.12");
  return load(kLibrary);
}

bool LoadOpenVinoFrom(const std::vector<fs::path>& folders) {
  std::error_code error;
  for (const fs::path& folder : folders)
    if (fs::exists(folder / kLibrary, error) && LoadOpenVino(folder)) return true;
  return EnvironmentPath("CROSSNAV_OPENVINO").empty() && LoadOpenVino({});
}

OpenVinoLibrary Missing(const std::string& what) {
  return {nullptr, what};
}

OpenVinoLibrary NotInstalled() {
  const std::string version = kVersion;
  if (const fs::path named = EnvironmentPath("CROSSNAV_OPENVINO"); !named.empty())
    return Missing("CROSSNAV_OPENVINO names " + named.string() + ", which has no " + kLibrary +
                   "; name the folder of OpenVINO " + version + "'s libraries");
  return Missing("pip install openvino==" + version +
                 ", or run scripts/setup.sh, or name its folder with CROSSNAV_OPENVINO");
}

OpenVinoLibrary Load() {
  if (*kLibrary == '\0')
    return Missing("scripts/setup.sh fetches it; then configure and build again");
  std::error_code error;
  const fs::path program_dir = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path file = PluginFile(program_dir);
  if (file.empty())
    return Missing("lib/crossnav/libcrossnav_openvino.so is missing near " + program_dir.string() +
                   "; install crossnav again");
  if (!LoadOpenVinoFrom(OpenVinoFolders(program_dir))) return NotInstalled();
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return Missing("it cannot be loaded: " + LastLoadError());
  auto* get = reinterpret_cast<GetOpenVinoPlugin*>(dlsym(handle, kGetOpenVinoPlugin));
  const OpenVinoPlugin* plugin = get == nullptr ? nullptr : get();
  if (plugin == nullptr || std::strcmp(plugin->crossnav_version, CROSSNAV_VERSION) != 0)
    return Missing(file.string() + " is of another version of crossnav; install crossnav again");
  return {plugin, {}};
}

}  // namespace

std::vector<fs::path> OpenVinoFolders(const fs::path& program_dir) {
  if (const fs::path named = EnvironmentPath("CROSSNAV_OPENVINO"); !named.empty())
    return {named, named / "libs", named / "openvino/libs"};
  std::vector<fs::path> folders = {program_dir / "../../openvino/libs"};  // site-packages
  AddPythonPackages(EnvironmentPath("VIRTUAL_ENV") / "lib", "site-packages", folders);
  const fs::path home = EnvironmentPath("HOME");
  AddPythonPackages(home / ".local/lib", "site-packages", folders);
  fs::path data = EnvironmentPath("XDG_DATA_HOME");
  if (data.empty()) data = home / ".local/share";
  folders.push_back(data / "crossnav" / ("openvino-" + std::string(kVersion)) / "openvino/libs");
  AddPythonPackages("/usr/local/lib", "dist-packages", folders);
  AddPythonPackages("/usr/local/lib", "site-packages", folders);
  return folders;
}

const OpenVinoLibrary& TheOpenVino() {
  static const OpenVinoLibrary library = Load();
  return library;
}

}  // namespace crossnav::inference
