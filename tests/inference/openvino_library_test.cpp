// SPDX-License-Identifier: MIT
#include "crossnav/inference/openvino_library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "support/temp_folder.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable for the life of the object.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before, had_ = true;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
  bool had_ = false;
};

bool Holds(const std::vector<fs::path>& folders, const fs::path& folder) {
  return std::find(folders.begin(), folders.end(), folder) != folders.end();
}

TEST(OpenVinoFolders, ANamedFolderExcludesTheOthers) {
  const Variable named("CROSSNAV_OPENVINO", "/opt/ov");
  EXPECT_EQ(OpenVinoFolders("/usr/bin"),
            (std::vector<fs::path>{"/opt/ov", "/opt/ov/libs", "/opt/ov/openvino/libs"}));
}

TEST(OpenVinoFolders, PythonPackagesAreFoundForEachVersion) {
  const crossnav::test::TempFolder folder;
  const fs::path lib = fs::path(folder.path()) / "lib";
  for (const char* name : {"python3.13", "python3.10", "pkgconfig"})
    fs::create_directories(lib / name);
  const Variable unnamed("CROSSNAV_OPENVINO", ""), active("VIRTUAL_ENV", folder.path());
  const auto folders = OpenVinoFolders("/site-packages/crossnav/bin");
  EXPECT_EQ(folders.front().lexically_normal(), "/site-packages/openvino/libs");
  EXPECT_TRUE(Holds(folders, lib / "python3.10/site-packages/openvino/libs"));
  EXPECT_TRUE(Holds(folders, lib / "python3.13/site-packages/openvino/libs"));
  EXPECT_FALSE(Holds(folders, lib / "pkgconfig/site-packages/openvino/libs"));
}

TEST(OpenVinoFolders, NoHomeAddsNoRelativeFolder) {
  const Variable unnamed("CROSSNAV_OPENVINO", ""), home("HOME", ""), active("VIRTUAL_ENV", "");
  const Variable data("XDG_DATA_HOME", "/data");
  for (const fs::path& folder : OpenVinoFolders("/usr/bin"))
    EXPECT_TRUE(folder.is_absolute()) << folder;
}

}  // namespace
}  // namespace crossnav::inference::test
