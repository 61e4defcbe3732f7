// SPDX-License-Identifier: MIT
// Ground reachable without a floor change, in a house with a ground floor in two halves, joined by
// a bridge above.
#include "crossnav/evaluation/scoring/floor_parts.h"

#include "crossnav/evaluation/generation/episode_generator.h"
#include "evaluation/embedded_house_fixture.h"
#include "sim/micro_scene.h"

namespace crossnav::evaluation {
namespace {

using sim::test::kGoing_m;
using sim::test::kRise_m;
using sim::test::kRisers;
using sim::test::MicroScene;

constexpr double kHalf_m = 8, kDeep_m = 4, kFoot_m = 2;
constexpr double kTop_m = kFoot_m + kRisers * kGoing_m;
const Vector3d kLeft(1, 3, 0), kRight(15, 3, 0), kAbove(9.2, 0.5, 3);

/// A flight in each half, up to a bridge over the wall between them; a sofa left, a bed right, a
/// plant on the bridge.
sim::Scene TwoHalves() {
  MicroScene m;
  m.Begin("floor");
  m.Ground(0, 0, 2 * kHalf_m, kDeep_m);
  m.Begin("floor");
  m.Box({kTop_m, 0, 2.85}, {2 * kHalf_m - kTop_m, kDeep_m, 3});
  m.Begin("stairs");
  for (int i = 0; i < kRisers; ++i) {
    const double x0 = kFoot_m + i * kGoing_m, x1 = x0 + kGoing_m, z = (i + 1) * kRise_m;
    m.Box({x0, 0, 0}, {x1, 1, z});
    m.Box({2 * kHalf_m - x1, 0, 0}, {2 * kHalf_m - x0, 1, z});
  }
  m.Begin("wall");
  m.Box({kHalf_m - 0.1, 0, 0}, {kHalf_m + 0.1, kDeep_m, 2.85});
  m.Box({-0.1, -0.1, 0}, {2 * kHalf_m + 0.1, 0, 5.6});
  m.Box({-0.1, kDeep_m, 0}, {2 * kHalf_m + 0.1, kDeep_m + 0.1, 5.6});
  m.Box({-0.1, 0, 0}, {0, kDeep_m, 5.6});
  m.Box({2 * kHalf_m, 0, 0}, {2 * kHalf_m + 0.1, kDeep_m, 5.6});
  m.Begin("sofa", "sofa");
  m.Box({3, 3.2, 0}, {4, 3.9, 0.8});
  m.Begin("bed", "bed");
  m.Box({12, 3.0, 0}, {13, 3.9, 0.5});
  m.Begin("plant", "plant");
  m.Box({7.2, 3.4, 3}, {7.5, 3.7, 3.9});
  return m.Finish();
}

class FloorPartsTest : public testing::Test {
 protected:
  void SetUp() override {
    auto context = SceneContext::Of(TwoHalves(), config_);
    ASSERT_TRUE(context) << context.error().Message();
    context_ = std::move(*context);
    ASSERT_EQ(context_->navmesh().Floors().size(), 2u);
    ASSERT_TRUE(context_->navmesh().Geodesic(kLeft, kRight));  // over the bridge
  }
  Episode From(const Vector3d& start, std::vector<std::string> goals) const {
    Episode episode;
    episode.start.p_world = start;
    episode.goals = std::move(goals);
    Certify(*context_, episode);
    episode.episode_id = ContentId(episode);
    return episode;
  }

  RunConfig config_ = test::SmallConfig();
  std::unique_ptr<SceneContext> context_;
};

TEST_F(FloorPartsTest, AFloorInTwoHalvesIsTwoParts) {
  const FloorParts& parts = context_->Parts();
  EXPECT_NE(parts.PartAt(kLeft), parts.PartAt(kRight));
  EXPECT_NE(parts.PartAt(kLeft), parts.PartAt(kAbove));
  EXPECT_EQ(parts.PartAt(kLeft), parts.PartAt({7, 3, 0}));
  EXPECT_EQ(parts.PartAt({8, 3, 0}), -1);  // in the wall
  EXPECT_EQ(parts.PartAt({1, 3, 1}), -1);
}

TEST_F(FloorPartsTest, GroundBeyondTheBridgeRequiresAFloorChange) {
  EXPECT_EQ(From(kLeft, {"sofa", "bed"}).first_transition_stage, 2);
  EXPECT_EQ(From(kRight, {"sofa", "bed"}).first_transition_stage, 1);
  EXPECT_EQ(From(kLeft, {"sofa"}).first_transition_stage, 0);
  EXPECT_EQ(From(kLeft, {"sofa", "plant"}).first_transition_stage, 2);
}

TEST_F(FloorPartsTest, TheSearchAgreesWithEveryTrueCertificateAndRefutesEveryFalseOne) {
  for (const Vector3d& start : {kLeft, kRight, kAbove}) {
    for (const char* goal : {"sofa", "bed", "plant"}) {
      const Episode episode = From(start, {goal});
      EXPECT_TRUE(CheckCertificate(*context_, episode, config_).empty()) << start << goal;
      Episode lie = episode;
      lie.first_transition_stage = 1 - lie.first_transition_stage;
      lie.cross_floor_required = !lie.cross_floor_required;
      EXPECT_FALSE(CheckCertificate(*context_, lie, config_).empty()) << start << goal;
    }
  }
}

}  // namespace
}  // namespace crossnav::evaluation
