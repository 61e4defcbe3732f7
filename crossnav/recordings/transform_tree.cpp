// SPDX-License-Identifier: MIT
#include "crossnav/recordings/transform_tree.h"

#include <algorithm>

namespace crossnav::recordings {

void TransformTree::Add(const RosTransform& transform, bool is_static) {
  if (transform.child.empty() || transform.child == transform.header.frame) return;
  const auto [at, is_new] = edges_.try_emplace(transform.child);
  Edge& edge = at->second;
  if (is_new) edge.parent = transform.header.frame;
  if (edge.parent != transform.header.frame) return;
  if (is_static && !edge.is_static) return;
  if (!is_static && edge.is_static) {
    edge.is_static = false;
    edge.track = {};
  }
  edge.track.Add(is_static ? 0 : transform.header.time_ns, transform.p, transform.q);
}

void TransformTree::Sort() {
  for (auto& [child, edge] : edges_) edge.track.Sort();
}

std::vector<std::string> TransformTree::ChainOf(const std::string& frame) const {
  std::vector<std::string> chain = {frame};
  for (auto at = edges_.find(frame); at != edges_.end() && chain.size() <= edges_.size();
       at = edges_.find(at->second.parent))
    chain.push_back(at->second.parent);
  return chain;
}

std::string TransformTree::RootOf(const std::string& frame) const {
  return ChainOf(frame).back();
}

bool TransformTree::AreJoined(const std::string& a, const std::string& b) const {
  return RootOf(a) == RootOf(b);
}

bool TransformTree::IsMoving(const std::string& frame) const {
  const std::vector<std::string> chain = ChainOf(frame);
  return std::any_of(chain.begin(), chain.end() - 1,
                     [this](const std::string& child) { return !edges_.at(child).is_static; });
}

PoseAt TransformTree::Along(const std::vector<std::string>& chain, std::size_t end,
                            std::int64_t time_ns, const PoseLimits& limits) const {
  PoseAt all{PoseState::kKnown, Pose::Identity()};
  for (std::size_t i = end; i-- > 0;) {
    const Edge& edge = edges_.at(chain[i]);
    const PoseAt here = edge.track.At(edge.is_static ? 0 : time_ns, limits);
    if (here.state != PoseState::kKnown) return {here.state, Pose::Identity()};
    // The first factor is copied: identity times a pose would be equal except for -0.
    all.pose = i + 1 == end ? here.pose : all.pose * here.pose;
  }
  return all;
}

PoseAt TransformTree::At(const std::string& a, const std::string& b, std::int64_t time_ns,
                         const PoseLimits& limits) const {
  const std::vector<std::string> above_a = ChainOf(a), above_b = ChainOf(b);
  for (std::size_t i = 0; i < above_b.size(); ++i) {
    const auto common = std::find(above_a.begin(), above_a.end(), above_b[i]);
    if (common == above_a.end()) continue;
    PoseAt T_common_b = Along(above_b, i, time_ns, limits);
    if (T_common_b.state != PoseState::kKnown || common == above_a.begin()) return T_common_b;
    const auto to_a = static_cast<std::size_t>(common - above_a.begin());
    PoseAt T_common_a = Along(above_a, to_a, time_ns, limits);
    if (T_common_a.state != PoseState::kKnown) return T_common_a;
    return {PoseState::kKnown, T_common_a.pose.inverse(Eigen::Isometry) * T_common_b.pose};
  }
  return {};
}

}  // namespace crossnav::recordings
