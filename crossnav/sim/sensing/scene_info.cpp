// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/scene_info.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/sim/sensing/instance_scene.h"

namespace crossnav::sim {
namespace {

constexpr double kGrid_m = 0.1;  // benchmark protocol, "Viewpoints and distances"
constexpr double kReach_m = 1.0;
constexpr double kMinCoverage = 0.05;
constexpr double kPitchStep_deg = 30;  // three pitches: -30, 0, +30
// chosen: objects wholly below the ground are on another floor
constexpr int kRaysAcross = 24;  // chosen: 576 rays over the instance's angular extent

/// Directions to the box as seen from `eye`: azimuth relative to `towards`, tangent of elevation.
struct Extent {
  double azimuth_low = 1e9, azimuth_high = -1e9;  // [rad]
  double slope_low = 1e9, slope_high = -1e9;      // tan(elevation)
};

Extent ExtentOf(const Box3& box, const Vector3d& eye, double towards_rad) {
  Extent extent;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p((corner & 1) != 0 ? box.max.x() : box.min.x(),
                     (corner & 2) != 0 ? box.max.y() : box.min.y(),
                     (corner & 4) != 0 ? box.max.z() : box.min.z());
    const Vector3d d = p - eye;
    const double azimuth = WrapAngle(std::atan2(d.y(), d.x()) - towards_rad);
    const double slope = d.z() / std::max(std::hypot(d.x(), d.y()), 1e-3);
    extent.azimuth_low = std::min(extent.azimuth_low, azimuth);
    extent.azimuth_high = std::max(extent.azimuth_high, azimuth);
    extent.slope_low = std::min(extent.slope_low, slope);
    extent.slope_high = std::max(extent.slope_high, slope);
  }
  if (box.HorizontalDistance(eye) <= 0) {  // over or under it: every direction may show it
    extent = {-std::numbers::pi, std::numbers::pi, -1e3, 1e3};
  } else {
    // Faces nearer than the corners reach steeper than any corner.
    const double nearest = std::max(box.HorizontalDistance(eye), 1e-3);
    extent.slope_low = std::min(extent.slope_low, (box.min.z() - eye.z()) / nearest);
    extent.slope_high = std::max(extent.slope_high, (box.max.z() - eye.z()) / nearest);
  }
  return extent;
}

struct Coverage {
  int covered = 0, visible = 0;  // rays
};

class CoverageMeter {
 public:
  CoverageMeter(const Scene& scene, const RayCaster& caster, const SceneInstance& instance,
                const SensorConfig& sensor)
      : alone_(ExtractInstance(scene, instance.id)),
        alone_caster_(alone_),
        caster_(caster),
        instance_(instance) {
    half_wide_rad_ = DegToRad(sensor.hfov_deg) / 2;
    const double half_high_rad =
        std::atan(std::tan(half_wide_rad_) * sensor.height_px / sensor.width_px);
    max_elevation_rad_ = std::min(half_high_rad + DegToRad(kPitchStep_deg), DegToRad(89));
  }

  Coverage From(const Vector3d& eye) const {
    const Vector3d d = instance_.box.Center() - eye;
    const double towards = std::atan2(d.y(), d.x());
    Extent extent = ExtentOf(instance_.box, eye, towards);
    const double azimuth_low = std::max(extent.azimuth_low, -half_wide_rad_);
    const double azimuth_high = std::min(extent.azimuth_high, half_wide_rad_);
    const double low = std::max(std::atan(extent.slope_low), -max_elevation_rad_);
    const double high = std::min(std::atan(extent.slope_high), max_elevation_rad_);
    Coverage coverage;
    if (azimuth_low >= azimuth_high || low >= high) return coverage;
    for (int row = 0; row < kRaysAcross; ++row) {
      const double elevation = low + (high - low) * (row + 0.5) / kRaysAcross;
      for (int column = 0; column < kRaysAcross; ++column) {
        const double azimuth =
            towards + azimuth_low + (azimuth_high - azimuth_low) * (column + 0.5) / kRaysAcross;
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const auto own = alone_caster_.Cast(eye, ray, kMaxRay_m);
        if (!own) continue;
        ++coverage.covered;
        const auto first = caster_.Cast(eye, ray, own->distance_m + 1e-3);
        if (first && first->instance == instance_.id) ++coverage.visible;
      }
    }
    return coverage;
  }

 private:
  static constexpr double kMaxRay_m = 20;
  Scene alone_;
  RayCaster alone_caster_;
  const RayCaster& caster_;
  const SceneInstance& instance_;
  double half_wide_rad_ = 0, max_elevation_rad_ = 0;
};

}  // namespace

std::vector<Vector3d> Viewpoints(const Scene& scene, const NavMesh& navmesh,
                                 const RayCaster& caster, const SceneInstance& instance,
                                 const SensorConfig& sensor) {
  std::vector<Vector3d> points;
  const Box3& box = instance.box;
  if (box.empty()) return points;
  const CoverageMeter meter(scene, caster, instance, sensor);
  const auto first = [](double m) { return static_cast<int>(std::ceil((m - kReach_m) / kGrid_m)); };
  const auto last = [](double m) { return static_cast<int>(std::floor((m + kReach_m) / kGrid_m)); };
  for (int x = first(box.min.x()); x <= last(box.max.x()); ++x) {
    for (int y = first(box.min.y()); y <= last(box.max.y()); ++y) {
      const Vector3d column(x * kGrid_m, y * kGrid_m, 0);
      if (box.HorizontalDistance(column) > kReach_m) continue;
      const auto heights = navmesh.HeightsAt(column.x(), column.y(), box.min.z() - kAboveFoot_m,
                                             box.max.z() + kBelowFoot_m);
      for (const double z : heights) {
        const Vector3d foot(column.x(), column.y(), z);
        const Coverage c = meter.From(foot + Vector3d(0, 0, sensor.camera_height_m));
        if (c.covered > 0 && c.visible >= kMinCoverage * c.covered) points.push_back(foot);
      }
    }
  }
  return points;
}

int FloorOfViewpoints(const NavMesh& navmesh, const std::vector<Vector3d>& viewpoints) {
  std::map<int, int> votes;
  for (const Vector3d& p : viewpoints) ++votes[navmesh.FloorOf(p)];
  int best = -1, most = 0;
  for (const auto& [floor, count] : votes) {
    if (count <= most) continue;
    best = floor;
    most = count;
  }
  return best;
}

SceneInfo DescribeScene(const Scene& scene, const NavMesh& navmesh, const RayCaster& caster,
                        const SensorConfig& sensor) {
  SceneInfo info;
  info.scene = scene.id;
  info.navmesh_settings = navmesh.settings();
  info.navmesh_hash = navmesh.Hash();
  info.navmesh_area_m2 = navmesh.AreaM2();
  info.floors = navmesh.Floors();
  info.connections = navmesh.Connections();
  for (const SceneInstance& instance : scene.instances) {
    if (instance.category.empty()) continue;
    InstanceInfo described{instance.id, instance.name, -1, instance.box,
                           Viewpoints(scene, navmesh, caster, instance, sensor)};
    described.floor = FloorOfViewpoints(navmesh, described.viewpoints);
    info.instances[instance.category].push_back(std::move(described));
  }
  return info;
}

}  // namespace crossnav::sim
