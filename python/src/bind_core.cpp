// SPDX-License-Identifier: MIT
// Action, CameraIntrinsics, Observation, AgentPose, Config.
#include <cmath>

#include "common.h"
#include "crossnav/core/action.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/core/colour_grid.h"
#include "crossnav/evaluation/settings/config_file.h"

namespace crossnav::python {
namespace {

using RgbView = Array<std::uint8_t, nb::shape<-1, -1, 3>>;
using DepthView = Array<float, nb::ndim<2>>;

RgbView RgbOf(Observation& obs) {
  static_assert(sizeof(Rgb8) == 3);
  return RgbView(&obs.rgb.data.data()->r,
                 {static_cast<std::size_t>(obs.rgb.height), static_cast<std::size_t>(obs.rgb.width),
                  std::size_t{3}});
}

DepthView DepthOf(Observation& obs) {
  return DepthView(obs.depth_m.data.data(), {static_cast<std::size_t>(obs.depth_m.height),
                                             static_cast<std::size_t>(obs.depth_m.width)});
}

/// Optional colour of an observation.
struct Colour {
  const std::optional<RgbIn>& rgb;
  const std::optional<CameraIntrinsics>& camera;  ///< its own; empty = depth's
  const std::optional<PoseIn>& T_camera_rgb;
};

/// Checks the colour of a separate camera.
void CheckColour(const Colour& colour) {
  if (!colour.camera) {
    if (colour.T_camera_rgb)
      Raise(ErrorCode::kInvalid, "is needed with T_camera_rgb", "observation.rgb_camera");
    return;
  }
  const bool has_size =
      colour.rgb && static_cast<std::size_t>(colour.camera->height_px) == colour.rgb->shape(0) &&
      static_cast<std::size_t>(colour.camera->width_px) == colour.rgb->shape(1);
  if (!has_size)
    Raise(ErrorCode::kInvalid, "colour has another size than rgb_camera", "observation.rgb");
}

Observation MakeObservation(const DepthIn& depth_m, const CameraIntrinsics& camera,
                            const PoseIn& T_world_camera, const Colour& colour) {
  CheckCamera(camera, depth_m.shape(0), depth_m.shape(1));
  CheckColour(colour);
  const std::optional<RgbIn>& rgb = colour.rgb;
  if (rgb && !colour.camera) CheckCamera(camera, rgb->shape(0), rgb->shape(1));
  Observation obs;
  obs.camera = camera;
  obs.T_world_camera = ToPose(T_world_camera);
  obs.depth_m = ToImage(depth_m);
  if (colour.camera) obs.rgb_camera = *colour.camera;
  if (colour.T_camera_rgb)
    obs.T_camera_rgb = ToPose(*colour.T_camera_rgb, "observation.T_camera_rgb");
  const CameraIntrinsics& K_rgb = colour.camera ? *colour.camera : camera;
  obs.rgb.width = K_rgb.width_px;
  obs.rgb.height = K_rgb.height_px;
  if (rgb) {
    const auto* first = reinterpret_cast<const Rgb8*>(rgb->data());
    obs.rgb.data.assign(first, first + rgb->size() / 3);
  } else {
    obs.rgb.data.resize(obs.depth_m.data.size());
  }
  return obs;
}

CameraIntrinsics MakeIntrinsics(int width_px, int height_px, std::array<double, 4> f_and_c) {
  const auto [fx, fy, cx, cy] = f_and_c;
  const bool is_finite = std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) &&
                         std::isfinite(cy) && fx > 0 && fy > 0;
  if (!is_finite || width_px < 1 || height_px < 1 || width_px > 8192 || height_px > 8192)
    Raise(ErrorCode::kInvalid, "sizes and focal lengths must be positive and finite", "camera");
  return {width_px, height_px, fx, fy, cx, cy};
}

void BindCamera(nb::module_& m) {
  nb::class_<CameraIntrinsics>(m, "CameraIntrinsics",
                               "Pinhole camera; pixel centres have integer coordinates. [px]")
      .def(
          "__init__",
          [](CameraIntrinsics* self, int width_px, int height_px, double fx, double fy, double cx,
             double cy) {
            new (self) CameraIntrinsics(MakeIntrinsics(width_px, height_px, {fx, fy, cx, cy}));
          },
          "width_px"_a, "height_px"_a, "fx"_a, "fy"_a, "cx"_a, "cy"_a)
      .def_static(
          "from_hfov",
          [](int width_px, int height_px, double hfov_deg) {
            if (!(hfov_deg > 0 && hfov_deg < 180))
              Raise(ErrorCode::kInvalid, "must lie between 0 and 180", "hfov_deg");
            const CameraIntrinsics k = IntrinsicsFromHfov(width_px, height_px, DegToRad(hfov_deg));
            return MakeIntrinsics(width_px, height_px, {k.fx, k.fy, k.cx, k.cy});
          },
          "width_px"_a, "height_px"_a, "hfov_deg"_a,
          "Square pixels, horizontal field of view in degrees.")
      .def_ro("width_px", &CameraIntrinsics::width_px)
      .def_ro("height_px", &CameraIntrinsics::height_px)
      .def_ro("fx", &CameraIntrinsics::fx)
      .def_ro("fy", &CameraIntrinsics::fy)
      .def_ro("cx", &CameraIntrinsics::cx)
      .def_ro("cy", &CameraIntrinsics::cy);
}

void BindObservation(nb::module_& m) {
  nb::class_<Observation>(m, "Observation", "Input of the agent in each step.")
      .def(
          "__init__",
          [](Observation* self, const DepthIn& depth_m, const CameraIntrinsics& camera,
             const PoseIn& T_world_camera, const std::optional<RgbIn>& rgb,
             const std::optional<CameraIntrinsics>& rgb_camera,
             const std::optional<PoseIn>& T_camera_rgb,
             const std::optional<PoseIn>& T_base_camera) {
            Observation obs =
                MakeObservation(depth_m, camera, T_world_camera, {rgb, rgb_camera, T_camera_rgb});
            if (T_base_camera)
              obs.T_base_camera = ToPose(*T_base_camera, "observation.T_base_camera");
            new (self) Observation(std::move(obs));
          },
          "depth_m"_a.noconvert(), "camera"_a, "T_world_camera"_a, "rgb"_a.noconvert() = nb::none(),
          nb::kw_only(), "rgb_camera"_a = nb::none(), "T_camera_rgb"_a = nb::none(),
          "T_base_camera"_a = nb::none(),
          "depth_m: H x W float32, planar [m], 0 = invalid. T_world_camera: 4 x 4, camera (x "
          "right, "
          "y down, z forward) to world (z up). rgb: H x W x 3 uint8; black where left out. The "
          "images are copied once. rgb_camera: of colour that is not registered to depth, with any "
          "size; T_camera_rgb: 4 x 4, the colour camera in the depth camera's frame. "
          "T_base_camera: 4 x 4, how the camera is mounted on the base (x ahead, z up, at the "
          "foot); straight above the foot where left out.")
      .def_prop_ro("rgb", &RgbOf, nb::rv_policy::reference_internal,
                   "H x W x 3 uint8, a view without a copy.")
      .def_prop_ro("depth_m", &DepthOf, nb::rv_policy::reference_internal,
                   "H x W float32 [m], a view without a copy.")
      .def_ro("camera", &Observation::camera)
      .def_rw("time_ns", &Observation::time_ns,
              "Of the depth image, since its sensor's epoch; 0 = not known.")
      .def_prop_ro(
          "T_world_camera", [](const Observation& o) { return ToArray(o.T_world_camera); },
          kOwnArray, "4 x 4 float64, camera to world.")
      .def_prop_ro(
          "rgb_camera",
          [](const Observation& o) {
            return HasOwnColourGrid(o) ? std::optional(o.rgb_camera) : std::nullopt;
          },
          "Of colour with a grid of its own; None: that is `camera`.")
      .def_prop_ro(
          "T_camera_rgb", [](const Observation& o) { return ToArray(o.T_camera_rgb); }, kOwnArray,
          "4 x 4 float64, the colour camera in the depth camera's frame.")
      .def_prop_ro(
          "T_base_camera",
          [](const Observation& o) {
            return o.T_base_camera ? std::optional(ToArray(*o.T_base_camera)) : std::nullopt;
          },
          kOwnArray, "4 x 4 float64, the camera in the base's frame; None where it was not given.")
      .def(
          "registered",
          [](const Observation& o) { return HasOwnColourGrid(o) ? WithColourOnDepthGrid(o) : o; },
          "With colour on the grid of depth, as the agent and its perception see it; the nearest "
          "pixel of the colour image, black outside it.");
}

void BindPose(nb::module_& m) {
  nb::class_<AgentPose>(m, "AgentPose", "Foot point on the ground and the camera's direction.")
      .def(
          "__init__",
          [](AgentPose* self, const Point& p_world, double yaw_rad, double pitch_rad) {
            new (self) AgentPose{ToPoint(p_world, "p_world"), yaw_rad, pitch_rad};
          },
          "p_world"_a, "yaw_rad"_a = 0.0, "pitch_rad"_a = 0.0)
      .def_prop_ro(
          "p_world", [](const AgentPose& p) { return ToArray(p.p_world); }, kOwnArray,
          "(3,) float64 [m], on the ground.")
      .def_ro("yaw_rad", &AgentPose::yaw_rad, "Counter-clockwise from world +x.")
      .def_ro("pitch_rad", &AgentPose::pitch_rad, "Positive looks up.")
      .def(
          "camera_pose",
          [](const AgentPose& p, double camera_height_m) {
            return ToArray(CameraPose(p, camera_height_m));
          },
          "camera_height_m"_a, "T_world_camera, 4 x 4, of a camera so far above the foot.")
      .def("__repr__", [](const AgentPose& p) {
        const nb::str form(
            "AgentPose(p_world=({:.3f}, {:.3f}, {:.3f}), yaw_rad={:.3f}, pitch_rad={:.3f})");
        return nb::cast<std::string>(form.attr("format")(p.p_world.x(), p.p_world.y(),
                                                         p.p_world.z(), p.yaw_rad, p.pitch_rad));
      });
}

void BindConfig(nb::module_& m) {
  nb::class_<evaluation::RunConfig>(
      m, "Config",
      "Every setting: the numbers of the paper's table and our navigator (policy.profile = full; "
      "variant \"paper\" is the paper's method), with a mapping, a TOML text or a TOML file on "
      "top.")
      .def(
          "__init__",
          [](evaluation::RunConfig* self, const Settings& settings, const std::string& variant) {
            evaluation::RunConfig config = ConfigOf(settings);
            Unwrap(evaluation::ApplyVariant(variant, config));
            new (self) evaluation::RunConfig(std::move(config));
          },
          "settings"_a = nb::none(), "variant"_a = "full")
      .def(
          "to_dict",
          [](const evaluation::RunConfig& c) { return FromJson(evaluation::DumpJson(c)); },
          nb::sig("def to_dict(self) -> dict[str, typing.Any]"), "Every field, nested.")
      .def_prop_ro("hash", &evaluation::ConfigHash, "16 hex digits over every key and value.");
}

}  // namespace

void BindCore(nb::module_& m) {
  nb::enum_<Action>(m, "Action", nb::is_arithmetic(), "The six discrete actions.")
      .value("MOVE_FORWARD", Action::kMoveForward)
      .value("TURN_LEFT", Action::kTurnLeft)
      .value("TURN_RIGHT", Action::kTurnRight)
      .value("LOOK_UP", Action::kLookUp)
      .value("LOOK_DOWN", Action::kLookDown)
      .value("STOP", Action::kStop);
  nb::list categories;
  for (const std::string_view name : kCategories) categories.append(nb::cast(name));
  m.attr("CATEGORIES") = nb::tuple(categories);
  m.def(
      "category_of",
      [](const std::string& name) {
        const auto found = DefaultCategories().find(name);
        return found == DefaultCategories().end() ? std::string() : found->second;
      },
      "name"_a, "Goal of a raw name of a scene (\"armchair\": \"chair\"), \"\" without one.");
  BindCamera(m);
  BindPose(m);
  BindConfig(m);
  BindObservation(m);
}

}  // namespace crossnav::python
