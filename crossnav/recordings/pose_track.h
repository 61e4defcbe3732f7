// SPDX-License-Identifier: MIT
// Poses over time from a tracker, with interpolation. Times are nanoseconds since the recording's
// own epoch.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::recordings {

/// Limits of interpolation between two neighbouring poses.
struct PoseLimits {
  std::int64_t gap_ns = 500'000'000;  ///< longest time to interpolate over; 0 = exact times only
  double speed_mps = 3.0;             // chosen: a fast walk is 2
  double turn_radps = 6.3;            // chosen: a hand-held camera reaches 3
};

enum class PoseState { kKnown, kUnknown, kJump };

struct PoseAt {
  PoseState state = PoseState::kUnknown;
  Pose pose = Pose::Identity();  ///< with kKnown
};

/// T_a_b of one pair of frames.
class PoseTrack {
 public:
  /// In any order. Returns false for poses that are not finite or have no rotation.
  bool Add(std::int64_t time_ns, const Vector3d& p, const Eigen::Quaterniond& q);
  /// Call after the last Add. Of several poses of one time the first stays.
  void Sort();

  /// Position linear, rotation slerp. A pose that leaps from its predecessor is a kJump, and so is
  /// every time between the two.
  PoseAt At(std::int64_t time_ns, const PoseLimits& limits) const;

  bool empty() const { return samples_.empty(); }
  std::size_t size() const { return samples_.size(); }

 private:
  struct Sample {
    std::int64_t time_ns;
    Vector3d p;
    Eigen::Quaterniond q;
  };
  static bool IsJump(const Sample& a, const Sample& b, const PoseLimits& limits);
  std::vector<Sample> samples_;
};

/// The rigid transform of a translation [m] and a unit quaternion.
Pose PoseOf(const Vector3d& p, const Eigen::Quaterniond& q);

}  // namespace crossnav::recordings
