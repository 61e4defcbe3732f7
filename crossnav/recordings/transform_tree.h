// SPDX-License-Identifier: MIT
// Frames and the transforms between them over time, from /tf and /tf_static.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "crossnav/recordings/pose_track.h"
#include "crossnav/recordings/ros_messages.h"

namespace crossnav::recordings {

class TransformTree {
 public:
  /// A frame keeps its first parent.
  void Add(const RosTransform& transform, bool is_static);
  /// Call after the last Add.
  void Sort();

  /// The root above `frame`; itself without a parent.
  std::string RootOf(const std::string& frame) const;
  /// Whether both have the same root.
  bool AreJoined(const std::string& a, const std::string& b) const;
  /// Whether a transform between the frame and its root moves.
  bool IsMoving(const std::string& frame) const;

  /// T_a_b. kUnknown if the frames are not joined, or a transform between them is not known at that
  /// time; kJump if one of them leaps.
  PoseAt At(const std::string& a, const std::string& b, std::int64_t time_ns,
            const PoseLimits& limits) const;

 private:
  struct Edge {
    std::string parent;
    PoseTrack track;  ///< T_parent_child; of a static one, a single sample at time 0
    bool is_static = true;
  };
  /// The frame and its ancestors. Stops at a cycle.
  std::vector<std::string> ChainOf(const std::string& frame) const;
  /// Product of the transforms from chain[end] down to chain[0].
  PoseAt Along(const std::vector<std::string>& chain, std::size_t end, std::int64_t time_ns,
               const PoseLimits& limits) const;

  std::map<std::string, Edge> edges_;  // by child
};

}  // namespace crossnav::recordings
