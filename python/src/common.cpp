// SPDX-License-Identifier: MIT
#include "common.h"

#include <cmath>

#include "crossnav/evaluation/settings/config_file.h"

namespace crossnav::python {

evaluation::RunConfig ConfigOf(const Settings& settings) {
  if (nb::isinstance<evaluation::RunConfig>(settings.value))
    return nb::cast<evaluation::RunConfig>(settings.value);
  evaluation::RunConfig config;
  if (settings.value.is_none()) return config;
  const nb::object pair = nb::module_::import_("crossnav._config").attr("toml_of")(settings.value);
  const auto toml = nb::cast<std::string>(pair[0]);
  const auto name = nb::cast<std::string>(pair[1]);
  std::vector<std::string> warnings;
  Unwrap(evaluation::ApplyConfigText(toml, name, config, &warnings));
  for (const std::string& warning : warnings)
    if (PyErr_WarnEx(PyExc_FutureWarning, warning.c_str(), 1) != 0) nb::raise_python_error();
  if (config.noise.profile != "none") {  // the profile's settings lie below the user's
    config = evaluation::DefaultsOfProfile(config.noise.profile);
    Unwrap(evaluation::ApplyConfigText(toml, name, config));
  }
  return config;
}

PoseOut ToArray(const Pose& T) {
  std::vector<double> rows(16);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      rows[static_cast<std::size_t>(4 * row + column)] = T.matrix()(row, column);
  return ToArray<PoseOut>(std::move(rows), {4, 4});
}

KeysOut ToArray(std::span<const geometry::VoxelKey> keys) {
  std::vector<std::int32_t> flat;
  flat.reserve(3 * keys.size());
  for (const geometry::VoxelKey& key : keys) flat.insert(flat.end(), {key.x, key.y, key.z});
  return ToArray<KeysOut>(std::move(flat), {keys.size(), 3});
}

Vector3d ToPoint(const Point& p, const char* name) {
  const Vector3d point(p.xyz[0], p.xyz[1], p.xyz[2]);
  if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1e6)
    Raise(ErrorCode::kInvalid, "must be three finite numbers of metres", name);
  return point;
}

Pose ToPose(const PoseIn& T, const char* key) {
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) pose.matrix()(row, column) = T(row, column);
  if (!IsValidPose(pose) || pose.translation().cwiseAbs().maxCoeff() > 1e6)
    Raise(ErrorCode::kInvalid, "the camera pose is not a finite rigid transform", key);
  return pose;
}

DepthImage ToImage(const DepthIn& depth_m) {
  DepthImage image;
  image.width = static_cast<int>(depth_m.shape(1));
  image.height = static_cast<int>(depth_m.shape(0));
  image.data.assign(depth_m.data(), depth_m.data() + depth_m.size());
  return image;
}

void CheckCamera(const CameraIntrinsics& camera, std::size_t rows, std::size_t cols) {
  if (rows == 0 || static_cast<std::size_t>(camera.height_px) != rows ||
      static_cast<std::size_t>(camera.width_px) != cols)
    Raise(ErrorCode::kInvalid, "colour, depth and intrinsics must have one size",
          "observation.depth_m");
}

nb::object ToPython(const Observation& obs) {
  nb::object known = nb::find(obs);
  return known.is_valid() ? known : nb::cast(Observation(obs));
}

nb::object FromJson(const std::string& text) {
  return nb::module_::import_("json").attr("loads")(text);
}

}  // namespace crossnav::python
