// SPDX-License-Identifier: MIT
// Poses between poses: of one track, and along the frames of a tree.
#include "crossnav/recordings/pose_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crossnav/recordings/transform_tree.h"

namespace crossnav::recordings {
namespace {

constexpr std::int64_t kTenth_ns = 100'000'000;

Eigen::Quaterniond Yaw(double rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Vector3d::UnitZ()));
}

PoseTrack Straight() {
  PoseTrack track;
  for (const int i : {2, 0, 1}) track.Add(i * kTenth_ns, {0.1 * i, 0, 1}, Yaw(0.2 * i));
  track.Sort();
  return track;
}

TEST(PoseTrack, IsLinearAndSlerpBetweenItsPoses) {
  const PoseAt at = Straight().At(kTenth_ns / 4, {});
  ASSERT_EQ(at.state, PoseState::kKnown);
  EXPECT_TRUE(at.pose.translation().isApprox(Vector3d(0.025, 0, 1), 1e-12));
  EXPECT_NEAR(Eigen::Quaterniond(at.pose.linear()).angularDistance(Yaw(0.05)), 0, 1e-9);
}

TEST(PoseTrack, GivesItsOwnPosesExactly) {
  const Pose expected = PoseOf({0.1, 0, 1}, Yaw(0.2));
  EXPECT_EQ(Straight().At(kTenth_ns, {}).pose.matrix(), expected.matrix());
  PoseLimits exact;
  exact.gap_ns = 0;
  EXPECT_EQ(Straight().At(kTenth_ns, exact).state, PoseState::kKnown);
  EXPECT_EQ(Straight().At(kTenth_ns + 1, exact).state, PoseState::kUnknown);
}

TEST(PoseTrack, KnowsNothingBeforeBehindAndInLongGaps) {
  PoseTrack track = Straight();
  EXPECT_EQ(track.At(-1, {}).state, PoseState::kUnknown);
  EXPECT_EQ(track.At(2 * kTenth_ns + 1, {}).state, PoseState::kUnknown);
  track.Add(20 * kTenth_ns, {0.2, 0, 1}, Yaw(0.4));
  EXPECT_EQ(track.At(10 * kTenth_ns, {}).state, PoseState::kUnknown);
  EXPECT_EQ(track.At(20 * kTenth_ns, {}).state, PoseState::kKnown);
  EXPECT_EQ(PoseTrack().At(0, {}).state, PoseState::kUnknown);
}

TEST(PoseTrack, SaysWhereThePoseLeaps) {
  PoseTrack track = Straight();
  track.Add(3 * kTenth_ns, {2.3, 0, 1}, Yaw(0.6));  // 2 m in a tenth of a second
  track.Add(4 * kTenth_ns, {2.4, 0, 1}, Yaw(0.6));
  track.Add(5 * kTenth_ns, {2.4, 0, 1}, Yaw(3.0));
  EXPECT_EQ(track.At(2 * kTenth_ns, {}).state, PoseState::kKnown);
  EXPECT_EQ(track.At(5 * kTenth_ns / 2, {}).state, PoseState::kJump);
  EXPECT_EQ(track.At(3 * kTenth_ns, {}).state, PoseState::kJump);
  EXPECT_EQ(track.At(4 * kTenth_ns, {}).state, PoseState::kKnown);
  EXPECT_EQ(track.At(5 * kTenth_ns, {}).state, PoseState::kJump) << "turned too fast";
}

TEST(PoseTrack, RefusesInvalidPoses) {
  PoseTrack track;
  EXPECT_FALSE(track.Add(0, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, Yaw(0)));
  EXPECT_FALSE(track.Add(0, {1e9, 0, 0}, Yaw(0)));
  EXPECT_FALSE(track.Add(0, {0, 0, 0}, Eigen::Quaterniond(0, 0, 0, 0)));
  EXPECT_TRUE(track.empty());
}

RosTransform Link(const char* parent, const char* child, const Vector3d& p,
                  std::int64_t time_ns = 0) {
  RosTransform transform;
  transform.header = {time_ns, parent};
  transform.child = child;
  transform.p = p;
  return transform;
}

TEST(TransformTree, FollowsFramesUpAndDown) {
  TransformTree tree;
  tree.Add(Link("base", "left", {0, 0.1, 1}), true);
  tree.Add(Link("base", "right", {0, -0.1, 1}), true);
  for (int i = 0; i < 3; ++i) tree.Add(Link("odom", "base", {0.1 * i, 0, 0}, i * kTenth_ns), false);
  tree.Add(Link("map", "base", {9, 9, 9}), true);  // it has a parent already
  tree.Sort();
  EXPECT_EQ(tree.RootOf("left"), "odom");
  EXPECT_TRUE(tree.IsMoving("left"));
  EXPECT_TRUE(tree.AreJoined("left", "odom"));
  EXPECT_FALSE(tree.AreJoined("left", "map"));
  const auto p = [&](const char* a, const char* b, std::int64_t time_ns) {
    return tree.At(a, b, time_ns, {}).pose.translation().eval();
  };
  EXPECT_TRUE(p("odom", "left", kTenth_ns / 2).isApprox(Vector3d(0.05, 0.1, 1), 1e-12));
  EXPECT_TRUE(p("left", "right", 5).isApprox(Vector3d(0, -0.2, 0), 1e-12));
  EXPECT_TRUE(p("left", "odom", kTenth_ns).isApprox(Vector3d(-0.1, -0.1, -1), 1e-12));
  EXPECT_EQ(tree.At("odom", "left", -5, {}).state, PoseState::kUnknown);
  EXPECT_EQ(tree.At("left", "nowhere", 0, {}).state, PoseState::kUnknown);
}

TEST(TransformTree, EndsWhereFramesHangOnThemselves) {
  TransformTree tree;
  tree.Add(Link("a", "b", {1, 0, 0}), true);
  tree.Add(Link("b", "a", {1, 0, 0}), true);
  tree.Add(Link("c", "c", {1, 0, 0}), true);
  tree.Sort();
  EXPECT_FALSE(tree.IsMoving("a"));
  EXPECT_EQ(tree.RootOf("c"), "c");
  EXPECT_EQ(tree.At("a", "z", 0, {}).state, PoseState::kUnknown);
}

}  // namespace
}  // namespace crossnav::recordings
