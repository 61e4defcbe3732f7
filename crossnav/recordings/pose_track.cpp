// SPDX-License-Identifier: MIT
#include "crossnav/recordings/pose_track.h"

#include <algorithm>
#include <cmath>

namespace crossnav::recordings {
namespace {

constexpr double kFarthestPose_m = 1e5;  // as the agent's: far beyond any house
constexpr double kNoise_m = 0.05;        // chosen: momentary error of a tracker's pose
constexpr double kNoise_rad = 0.087;     // chosen: likewise

}  // namespace

Pose PoseOf(const Vector3d& p, const Eigen::Quaterniond& q) {
  Pose pose = Pose::Identity();
  pose.linear() = q.toRotationMatrix();
  pose.translation() = p;
  return pose;
}

bool PoseTrack::Add(std::int64_t time_ns, const Vector3d& p, const Eigen::Quaterniond& q) {
  const double norm = q.norm();
  const bool is_good = p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthestPose_m &&
                       std::isfinite(norm) && std::abs(norm - 1) < 0.1;
  // A unit quaternion keeps its bytes.
  if (is_good) samples_.push_back({time_ns, p, std::abs(norm - 1) < 1e-12 ? q : q.normalized()});
  return is_good;
}

void PoseTrack::Sort() {
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.time_ns < b.time_ns; });
  const auto is_same = [](const Sample& a, const Sample& b) { return a.time_ns == b.time_ns; };
  samples_.erase(std::unique(samples_.begin(), samples_.end(), is_same), samples_.end());
}

bool PoseTrack::IsJump(const Sample& a, const Sample& b, const PoseLimits& limits) {
  const double seconds = 1e-9 * static_cast<double>(b.time_ns - a.time_ns);
  return (b.p - a.p).norm() > kNoise_m + limits.speed_mps * seconds ||
         a.q.angularDistance(b.q) > kNoise_rad + limits.turn_radps * seconds;
}

PoseAt PoseTrack::At(std::int64_t time_ns, const PoseLimits& limits) const {
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), time_ns,
                       [](const Sample& sample, std::int64_t t) { return sample.time_ns < t; });
  if (after == samples_.end()) return {};
  const bool is_exact = after->time_ns == time_ns;
  if (after == samples_.begin())
    return is_exact ? PoseAt{PoseState::kKnown, PoseOf(after->p, after->q)} : PoseAt{};
  const Sample& a = *(after - 1);
  const Sample& b = *after;
  if (!is_exact && b.time_ns - a.time_ns > limits.gap_ns) return {};
  if (IsJump(a, b, limits)) return {PoseState::kJump, Pose::Identity()};
  if (is_exact) return {PoseState::kKnown, PoseOf(b.p, b.q)};
  const double share =
      static_cast<double>(time_ns - a.time_ns) / static_cast<double>(b.time_ns - a.time_ns);
  return {PoseState::kKnown, PoseOf(a.p + share * (b.p - a.p), a.q.slerp(share, b.q))};
}

}  // namespace crossnav::recordings
