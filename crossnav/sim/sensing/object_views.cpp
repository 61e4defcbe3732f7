// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/object_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "crossnav/sim/sensing/instance_scene.h"

namespace crossnav::sim {
namespace {

constexpr double kViewGrid_m = 0.2;  // chosen: steps of about one forward action
constexpr double kMinDepth_m = 0.1;  // chosen: a corner beside or behind the camera is too near
constexpr int kCoarse = 4;           // chosen: a picture of a quarter tells which views are good

/// Pixels that may show the box, the picture's borders ignored; nullopt where it is too near.
std::optional<perception::PixelBox> Project(const Box3& box, const CameraIntrinsics& K,
                                            const Pose& T_world_camera) {
  double u_low = 1e9, v_low = 1e9, u_high = -1e9, v_high = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p_world((corner & 1) != 0 ? box.max.x() : box.min.x(),
                           (corner & 2) != 0 ? box.max.y() : box.min.y(),
                           (corner & 4) != 0 ? box.max.z() : box.min.z());
    const Vector3d p_camera = T_world_camera.inverse() * p_world;
    if (p_camera.z() < kMinDepth_m) return std::nullopt;
    const double u = K.cx + K.fx * p_camera.x() / p_camera.z();
    const double v = K.cy + K.fy * p_camera.y() / p_camera.z();
    u_low = std::min(u_low, u);
    v_low = std::min(v_low, v);
    u_high = std::max(u_high, u);
    v_high = std::max(v_high, v);
  }
  return perception::PixelBox{
      static_cast<int>(std::floor(u_low)), static_cast<int>(std::floor(v_low)),
      static_cast<int>(std::ceil(u_high)) + 1, static_cast<int>(std::ceil(v_high)) + 1};
}

/// The camera that takes only the pixels of `part`, inside or outside the picture.
CameraIntrinsics Crop(const CameraIntrinsics& K, const perception::PixelBox& part) {
  return {part.u1 - part.u0, part.v1 - part.v0, K.fx, K.fy, K.cx - part.u0, K.cy - part.v0};
}

VisibleObject Grow(VisibleObject object, int u, int v) {
  auto& box = object.box;
  const bool is_first = object.visible_px++ == 0;
  box.u0 = is_first ? u : std::min(box.u0, u);
  box.v0 = is_first ? v : std::min(box.v0, v);
  box.u1 = is_first ? u + 1 : std::max(box.u1, u + 1);
  box.v1 = is_first ? v + 1 : std::max(box.v1, v + 1);
  return object;
}

class ViewJudge {
 public:
  ViewJudge(const Scene& scene, const RayCaster& caster, const SceneInstance& instance,
            const ViewRules& rules)
      : alone_(ExtractInstance(scene, instance.id)),
        alone_caster_(alone_),
        caster_(caster),
        instance_(instance),
        rules_(rules) {}

  /// The view from `foot` with a camera of a `coarse`-th of the pixels, if it is a good one.
  std::optional<ObjectView> From(const Vector3d& foot, int coarse) const {
    SensorConfig sensor = rules_.sensor;
    sensor.width_px = std::max(sensor.width_px / coarse, 1);
    sensor.height_px = std::max(sensor.height_px / coarse, 1);
    const CameraIntrinsics K = sensor.Intrinsics();
    const Vector3d d = instance_.box.Center() - foot;
    ObjectView view;
    view.instance = instance_.id;
    view.distance_m = std::hypot(d.x(), d.y());
    view.pose = {foot, std::atan2(d.y(), d.x()), 0};
    const Pose T_world_camera = CameraPose(view.pose, sensor.camera_height_m);
    const auto whole = Project(instance_.box, K, T_world_camera);
    if (!whole) return std::nullopt;
    const perception::PixelBox part{std::max(whole->u0, 0), std::max(whole->v0, 0),
                                    std::min(whole->u1, K.width_px),
                                    std::min(whole->v1, K.height_px)};
    if (part.u0 >= part.u1 || part.v0 >= part.v1) return std::nullopt;
    const double picture_px = static_cast<double>(K.width_px) * K.height_px;
    if (part.Area() < rules_.min_box_fraction * picture_px) return std::nullopt;
    const VisibleObject seen = Seen(caster_, K, part, T_world_camera);
    view.box = {seen.box.u0 + part.u0, seen.box.v0 + part.v0, seen.box.u1 + part.u0,
                seen.box.v1 + part.v0};
    view.visible_px = seen.visible_px;
    if (view.box.Area() < rules_.min_box_fraction * picture_px) return std::nullopt;
    const int covered = Seen(alone_caster_, K, *whole, T_world_camera).visible_px;
    if (covered == 0) return std::nullopt;
    view.visible_fraction = std::min(1.0, static_cast<double>(view.visible_px) / covered);
    if (view.visible_fraction < rules_.min_visible) return std::nullopt;
    return view;
  }

 private:
  VisibleObject Seen(const RayCaster& caster, const CameraIntrinsics& K,
                     const perception::PixelBox& part, const Pose& T_world_camera) const {
    const Frame frame = caster.Render(Crop(K, part), T_world_camera);
    VisibleObject object;
    for (int v = 0; v < frame.instance.height; ++v) {
      for (int u = 0; u < frame.instance.width; ++u) {
        if (frame.instance.At(u, v) == instance_.id) object = Grow(object, u, v);
      }
    }
    return object;
  }

  Scene alone_;
  RayCaster alone_caster_;
  const RayCaster& caster_;
  const SceneInstance& instance_;
  const ViewRules& rules_;
};

}  // namespace

std::vector<ObjectView> GoodViews(const Scene& scene, const NavMesh& navmesh,
                                  const RayCaster& caster, const SceneInstance& instance,
                                  const ViewRules& rules) {
  std::vector<ObjectView> all, chosen;
  const Box3& box = instance.box;
  if (box.empty() || rules.per_object <= 0) return chosen;
  const ViewJudge judge(scene, caster, instance, rules);
  const Vector3d middle = box.Center();
  const auto first = [&](double m) {
    return static_cast<int>(std::ceil((m - rules.far_m) / kViewGrid_m));
  };
  const auto last = [&](double m) {
    return static_cast<int>(std::floor((m + rules.far_m) / kViewGrid_m));
  };
  for (int i = first(middle.x()); i <= last(middle.x()); ++i) {
    for (int j = first(middle.y()); j <= last(middle.y()); ++j) {
      const double x = i * kViewGrid_m, y = j * kViewGrid_m;
      const double distance_m = std::hypot(x - middle.x(), y - middle.y());
      if (distance_m < rules.near_m || distance_m > rules.far_m) continue;
      for (const double z :
           navmesh.HeightsAt(x, y, box.min.z() - kAboveFoot_m, box.max.z() + kBelowFoot_m)) {
        if (const auto view = judge.From({x, y, z}, kCoarse)) all.push_back(*view);
      }
    }
  }
  std::sort(all.begin(), all.end(), [](const ObjectView& a, const ObjectView& b) {
    const auto key = [](const ObjectView& v) {
      const Vector3d& p = v.pose.p_world;
      return std::tuple(v.pose.yaw_rad, v.distance_m, p.x(), p.y(), p.z());
    };
    return key(a) < key(b);
  });
  const auto count = std::min(all.size(), static_cast<std::size_t>(rules.per_object));
  for (std::size_t i = 0; i < count; ++i) {
    const ObjectView& good = all[(2 * i + 1) * all.size() / (2 * count)];
    if (const auto view = judge.From(good.pose.p_world, 1)) chosen.push_back(*view);
  }
  return chosen;
}

std::vector<VisibleObject> VisibleObjects(const InstanceImage& image, int min_px) {
  std::map<int, VisibleObject> found;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const int id = image.At(u, v);
      if (id <= 0) continue;
      VisibleObject& object = found[id];
      object.instance = id;
      object = Grow(object, u, v);
    }
  }
  std::vector<VisibleObject> objects;
  for (const auto& [id, object] : found) {
    if (object.visible_px >= min_px) objects.push_back(object);
  }
  return objects;
}

}  // namespace crossnav::sim
