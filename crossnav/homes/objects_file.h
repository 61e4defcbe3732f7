// SPDX-License-Identifier: MIT
// JSON file that maps parts of a 3D model to objects (docs/formats/objects.md). Any bytes are safe
// to pass; errors name the key.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"

namespace crossnav::homes {

/// A box in the file's frame and units; upright, rotated about the file's up axis.
struct ObjectBox {
  Vector3d center = Vector3d::Zero(), size = Vector3d::Zero();
  double yaw_rad = 0;
};

struct NamedObject {
  std::string id;                  ///< for messages; may be empty
  std::string name;                ///< raw semantic name
  std::vector<std::string> parts;  ///< names in the model file; "Chair*" = all with this prefix
  std::optional<ObjectBox> box;
  int region = 0;
};

struct ObjectsFile {
  bool is_y_up = true;
  double unit_m = 1;
  std::vector<NamedObject> objects;
};

Result<ObjectsFile> ParseObjectsFile(const std::string& text, const std::string& where);

}  // namespace crossnav::homes
