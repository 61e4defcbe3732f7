// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/frame_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "crossnav/core/camera.h"
#include "crossnav/sim/sensing/instance_scene.h"

namespace crossnav::sim {
namespace {

constexpr int kTries = 60;       // chosen: of places for one frame before it is taken anywhere
constexpr double kNear_m = 0.6;  // chosen: from the middle of an object
constexpr double kFar_m = 4.5;   // chosen: as far as claims are judged
constexpr double kAroundStairs_m = 3.0;  // chosen: where stairs are looked for with a camera
constexpr double kTurn_deg = 25;         // chosen: objects are not always in the middle
constexpr double kNose_m = 0.4;          // chosen: a frame of a wall alone teaches little
constexpr double kPitch_deg = 30;        // the camera's step (tab:supp_configuration)

bool IsStairs(const SceneInstance& instance) {
  return instance.name == "stairs" || instance.name == "staircase" || instance.name == "stair";
}

class Chooser {
 public:
  Chooser(const Scene& scene, const NavMesh& navmesh, const RayCaster& caster,
          const FrameRules& rules)
      : navmesh_(navmesh), caster_(caster), rules_(rules), rng_(rules.seed, 77) {
    for (const SceneInstance& instance : scene.instances) {
      if (instance.box.empty()) continue;
      if (!instance.category.empty()) goals_[instance.category].push_back(&instance);
      if (IsStairs(instance)) stairs_.push_back(&instance);
    }
  }

  std::optional<FramePlace> Next() {
    const double share = rng_.Uniform();
    std::optional<FramePlace> place;
    if (share < rules_.object_share && !goals_.empty()) {
      place = Try([this] { return AtObject(); });
    } else if (share < rules_.object_share + rules_.stair_share && !stairs_.empty()) {
      place = Try([this] { return AtStairs(); });
    }
    return place ? place : Try([this] { return Anywhere(); });
  }

 private:
  template <class F>
  std::optional<FramePlace> Try(F&& draw) {
    for (int i = 0; i < kTries; ++i) {
      if (auto place = draw()) return place;
    }
    return std::nullopt;
  }

  double Height() {
    return rng_.Chance(rules_.other_height_share) ? rng_.Uniform(0.65, 1.15)
                                                  : rules_.camera_height_m;
  }

  double Pitch(double down, double up) {
    const double share = rng_.Uniform();
    return DegToRad(share < down ? -kPitch_deg : share < down + up ? kPitch_deg : 0);
  }

  template <class T>
  const T& OneOf(const std::vector<T>& list) {
    return list[rng_.Below(static_cast<std::uint32_t>(list.size()))];
  }

  /// Whether the ray from the camera to `p_world` ends on `instance` or nearly there.
  bool Sees(const FramePlace& place, const Vector3d& p_world, int instance) const {
    const Vector3d eye = place.pose.p_world + Vector3d(0, 0, place.camera_height_m);
    const Vector3d d = p_world - eye;
    const double length_m = d.norm();
    if (length_m < kNear_m / 2) return false;
    const auto hit = caster_.Cast(eye, d / length_m, 20.0);
    return hit && (hit->instance == instance || hit->distance_m > length_m - 0.1);
  }

  std::optional<FramePlace> AtObject() {
    auto row = goals_.begin();
    std::advance(row, rng_.Below(static_cast<std::uint32_t>(goals_.size())));
    const SceneInstance& goal = *OneOf(row->second);
    const Vector3d middle = goal.box.Center();
    const double angle = rng_.Uniform(-M_PI, M_PI), range_m = rng_.Uniform(kNear_m, kFar_m);
    const double x = middle.x() + range_m * std::cos(angle);
    const double y = middle.y() + range_m * std::sin(angle);
    const auto heights =
        navmesh_.HeightsAt(x, y, goal.box.min.z() - kAboveFoot_m, goal.box.max.z() + kBelowFoot_m);
    if (heights.empty()) return std::nullopt;
    FramePlace place{{{x, y, OneOf(heights)}, 0, 0}, Height()};
    if (!Sees(place, middle, goal.id)) return std::nullopt;
    const double turn = DegToRad(rng_.Uniform(-kTurn_deg, kTurn_deg));
    place.pose.yaw_rad = WrapAngle(angle + M_PI + turn);
    place.pose.pitch_rad = Pitch(range_m < 2.5 ? 0.45 : 0.15, 0.05);
    return place;
  }

  std::optional<FramePlace> AtStairs() {
    const SceneInstance& stairs = *OneOf(stairs_);
    const Box3& box = stairs.box;
    const double x = rng_.Uniform(box.min.x() - kAroundStairs_m, box.max.x() + kAroundStairs_m);
    const double y = rng_.Uniform(box.min.y() - kAroundStairs_m, box.max.y() + kAroundStairs_m);
    const auto heights = navmesh_.HeightsAt(x, y, box.min.z() - 0.5, box.max.z() + 0.5);
    if (heights.empty()) return std::nullopt;
    FramePlace place{{{x, y, OneOf(heights)}, 0, 0}, Height()};
    Vector3d target;
    for (const int axis : {2, 1, 0}) target[axis] = rng_.Uniform(box.min[axis], box.max[axis]);
    if (!Sees(place, target, stairs.id) && !rng_.Chance(0.1)) return std::nullopt;
    const double turn = DegToRad(rng_.Uniform(-kTurn_deg, kTurn_deg));
    place.pose.yaw_rad = WrapAngle(std::atan2(target.y() - y, target.x() - x) + turn);
    const double rise_m = target.z() - place.pose.p_world.z() - place.camera_height_m;
    place.pose.pitch_rad = rise_m < -0.5 ? Pitch(0.6, 0) : Pitch(0.1, rise_m > 0.5 ? 0.4 : 0.05);
    return place;
  }

  std::optional<FramePlace> Anywhere() {
    const auto foot = navmesh_.RandomPoint(rng_);
    if (!foot) return std::nullopt;
    FramePlace place{{*foot, rng_.Uniform(-M_PI, M_PI), Pitch(0.2, 0.1)}, Height()};
    const double yaw = place.pose.yaw_rad;
    const Vector3d eye = *foot + Vector3d(0, 0, place.camera_height_m);
    const auto hit = caster_.Cast(eye, {std::cos(yaw), std::sin(yaw), 0}, 20.0);
    if (hit && hit->distance_m < kNose_m) return std::nullopt;
    return place;
  }

  const NavMesh& navmesh_;
  const RayCaster& caster_;
  FrameRules rules_;
  Rng rng_;
  std::map<std::string, std::vector<const SceneInstance*>>
      goals_;  // ordered: same seed, same frames
  std::vector<const SceneInstance*> stairs_;
};

}  // namespace

std::vector<FramePlace> FramePlaces(const Scene& scene, const NavMesh& navmesh,
                                    const RayCaster& caster, const FrameRules& rules) {
  Chooser chooser(scene, navmesh, caster, rules);
  std::vector<FramePlace> places;
  while (static_cast<int>(places.size()) < rules.count) {
    const auto place = chooser.Next();
    if (!place) break;
    places.push_back(*place);
  }
  return places;
}

}  // namespace crossnav::sim
