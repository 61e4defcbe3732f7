// SPDX-License-Identifier: MIT
#include "crossnav/policy/claim.h"

#include <cmath>

#include <gtest/gtest.h>

#include "crossnav/core/camera.h"

namespace crossnav::policy {
namespace {

using memory::MemoryRow;
using memory::SemanticMemory;

const VerifyConfig kConfig;
const ObjectConfig kObject;

memory::MemoryRow MemoryRowOf(const VoxelKey& key, float weight, std::vector<float> feature) {
  MemoryRow row{key, weight, weight};
  for (const float x : feature) row.half.push_back(x == 0 ? 0 : 0x3c00);  // 0 or 1
  return row;
}

std::vector<VoxelKey> ColumnAt(int x) {
  return {{x, 0, 0}, {x, 0, 1}, {x, 0, 2}, {x, 0, 3}, {x, 0, 4}};
}

Sighting SightingOf(int x, double confidence) {
  Sighting sighting;
  sighting.voxels = ColumnAt(x);
  sighting.p_center_world = Vector3d(0.1 * x, 0, 0.25);
  sighting.confidence = confidence;
  return sighting;
}

TEST(Opinion, IsThatOfAllViewsByTheirWeight) {
  SemanticMemory memory({}, 0.1, 2);
  memory.AppendRow(MemoryRowOf({0, 0, 0}, 3, {1, 0}));
  memory.AppendRow(MemoryRowOf({0, 0, 1}, 1, {0, 1}));
  const std::vector<NamedText> others = {{"sofa", {0, 1}}, {"desk", {0, -1}}};
  const auto opinion = OpinionOf(memory, ColumnAt(0), std::vector<float>{1, 0}, others);
  ASSERT_TRUE(opinion.has_value());
  EXPECT_EQ(opinion->rows, 2);
  EXPECT_EQ(opinion->other, "sofa");
  EXPECT_NEAR(opinion->goal, 3 / std::sqrt(10.0), 1e-6);
  EXPECT_NEAR(opinion->best_other, 1 / std::sqrt(10.0), 1e-6);
}

TEST(Opinion, IsNoneWhereNothingIsRemembered) {
  const SemanticMemory memory({}, 0.1, 2);
  EXPECT_FALSE(OpinionOf(memory, ColumnAt(0), std::vector<float>{1, 0}, {}).has_value());
}

/// A thing of two voxels on a desk, or in the open; `around` is the feature of its surroundings.
SemanticMemory SmallThing(std::vector<float> around) {
  SemanticMemory memory({}, 0.1, 2);
  for (int x = -2; x <= 3; ++x)
    for (int y = -2; y <= 2; ++y) memory.AppendRow(MemoryRowOf({x, y, -1}, 1, around));
  for (int x = 0; x < 2; ++x) memory.AppendRow(MemoryRowOf({x, 0, 0}, 1, {0, 1}));
  return memory;
}

/// Regression: a bowl on a desk was refuted, because its voxels held the features of the desk.
TEST(Opinion, OfASmallThingThatItsSurroundingsGiveSaysNothing) {
  const std::vector<NamedText> others = {{"desk", {0, 1}}, {"floor", {1, 0}}};
  const std::vector<VoxelKey> small = {{0, 0, 0}, {1, 0, 0}};
  const MemoryOpinion denies{0.1, 0.9, "desk", 2};
  EXPECT_TRUE(IsOfSurroundings(SmallThing({0, 1}), small, 0.1, denies, others));
  EXPECT_FALSE(IsOfSurroundings(SmallThing({1, 0}), small, 0.1, denies, others))
      << "a desk on the floor is a desk";
  std::vector<VoxelKey> tall = ColumnAt(0);
  tall.push_back({0, 0, 5});
  EXPECT_FALSE(IsOfSurroundings(SmallThing({0, 1}), tall, 0.1, denies, others))
      << "as large as furniture";
  const MemoryOpinion agrees{0.9, 0.1, "desk", 2};
  EXPECT_FALSE(IsOfSurroundings(SmallThing({0, 1}), small, 0.1, agrees, others));
}

/// Regression: a laptop of 5 x 4 voxels beside a wall was refuted by its desk.
TEST(Opinion, OfALaptopBesideAWallIsThatOfItsDesk) {
  const std::vector<NamedText> others = {{"desk", {0, 1}}, {"wardrobe", {1, 0}}};
  SemanticMemory memory({}, 0.1, 2);
  std::vector<VoxelKey> laptop;
  for (int x = -2; x <= 6; ++x)
    for (int y = -2; y <= 5; ++y) {
      const bool is_in = x >= 0 && x < 5 && y >= 0 && y < 4;
      if (is_in) laptop.push_back({x, y, 0});
      // The desk is two voxels deep in front of the laptop; the rest is the wall.
      memory.AppendRow(MemoryRowOf(
          {x, y, 0}, 1, is_in || y < 0 ? std::vector<float>{0, 1} : std::vector<float>{1, 0}));
      memory.AppendRow(MemoryRowOf({x, y, 2}, 1, {1, 0}));
    }
  const MemoryOpinion denies{0.8, 0.85, "desk", 20};
  EXPECT_TRUE(IsOfSurroundings(memory, laptop, 0.1, denies, others));
  laptop.push_back({5, 0, 0});
  EXPECT_FALSE(IsOfSurroundings(memory, laptop, 0.1, denies, others)) << "as large as furniture";
}

TEST(Judge, WeakClaimsNeedTwoViewsAndRefutedClaimsEnd) {
  const MemoryOpinion agrees{0.9, 0.5, "sofa", 9}, unsure{0.7, 0.7, "sofa", 9},
      denies{0.5, 0.9, "sofa", 9};
  EXPECT_EQ(Judge(agrees, 0.9, 1, kConfig), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, 0.72, 1, kConfig), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(agrees, 0.72, 2, kConfig), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(unsure, 0.9, 1, kConfig), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(denies, 0.99, 3, kConfig), ClaimVerdict::kRefuted);
  EXPECT_EQ(Judge(std::nullopt, 0.9, 1, kConfig), ClaimVerdict::kWeak);
}

/// Regression: a plant that a clear view showed was refuted by the wardrobe behind it.
TEST(Judge, TwoClearViewsOutvoteAMemoryThatAnswersAlike) {
  const MemoryOpinion alike{0.78, 0.81, "wardrobe", 9}, other{0.6, 0.81, "wardrobe", 9};
  EXPECT_EQ(Judge(alike, 0.85, 1, kConfig), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(alike, 0.85, 2, kConfig), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(alike, 0.75, 2, kConfig), ClaimVerdict::kRefuted);
  EXPECT_EQ(Judge(other, 0.85, 2, kConfig), ClaimVerdict::kRefuted);
}

TEST(Judge, ASecondViewAloneDoesNotSaveWhatFrameAndMemoryDoubt) {
  const MemoryOpinion unsure{0.71, 0.7, "sofa", 9}, against{0.69, 0.7, "sofa", 9};
  EXPECT_EQ(Judge(unsure, 0.72, 2, kConfig), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(unsure, 0.72, 3, kConfig), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(unsure, 0.9, 2, kConfig), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(against, 0.72, 1, kConfig), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(against, 0.72, 2, kConfig), ClaimVerdict::kRefuted);
}

ViewScore View(double score, int frames = 1, double length_m = 0) {
  return {.sum = frames * score,
          .frames = frames,
          .sum_length_m = length_m,
          .uncut_frames = length_m > 0 ? 1 : 0};
}

ViewSummary Summary(const std::vector<ViewScore>& views, const char* goal = "sofa") {
  return SummaryOf(views, goal, EvidenceConfig{}.discount);
}

TEST(ViewEvidence, NearIdenticalViewsCountOnceAndOthersAtADiscount) {
  EvidenceConfig config;
  config.missed = -2;
  config.found = 3;
  const auto odds = [&](const std::vector<ViewScore>& views) {
    const double p = ProbabilityOf(Summary(views), config);
    return std::log(p / (1 - p));
  };
  EXPECT_DOUBLE_EQ(ProbabilityOf(Summary({}), config), 0.5);
  EXPECT_NEAR(ProbabilityOf(Summary({View(0.8)}), config), 0.8, 1e-9);
  EXPECT_NEAR(ProbabilityOf(Summary({View(0.8, 9)}), config), 0.8, 1e-9);
  const double one = odds({View(0.8)});
  EXPECT_NEAR(odds({View(0.8), View(0)}) - one, -2, 1e-9);
  EXPECT_NEAR(odds({View(0), View(0.8)}) - one, -2, 1e-9);
  EXPECT_NEAR(odds({View(0.8), View(0.4)}) - one, 0, 1e-9);  // on the line from -2 to 3
  EXPECT_NEAR(odds({View(0.8), View(0), View(0)}) - one, -3, 1e-9);
  EXPECT_NEAR(odds({View(0.8), View(0.8), View(0)}) - one, 0, 1e-9);
}

TEST(ViewEvidence, DecidesOnceTheViewsAgree) {
  VerifyConfig config;
  config.evidence = "views";
  const MemoryOpinion agrees{0.9, 0.5, "sofa", 9}, unsure{0.71, 0.7, "sofa", 9},
      denies{0.5, 0.9, "sofa", 9};
  EXPECT_EQ(Judge(agrees, Summary({View(0.98)}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({View(0.95)}), config), ClaimVerdict::kWeak) << "not alone";
  EXPECT_EQ(Judge(agrees, Summary({View(0.95), View(0.9)}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(unsure, Summary({View(0.98)}), config), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(unsure, Summary({View(0.95), View(0.9)}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({View(0.7)}), config), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(agrees, Summary({View(0.7), View(0)}), config), ClaimVerdict::kRefuted);
  EXPECT_EQ(Judge(agrees, Summary({View(0.8), View(0.5)}), config), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(denies, Summary({View(0.9), View(0.5)}), config), ClaimVerdict::kRefuted);
  EXPECT_EQ(Judge(denies, Summary({View(0.9)}), config), ClaimVerdict::kRefuted);
  EXPECT_EQ(Judge(denies, Summary({View(0.99), View(0.99)}), config), ClaimVerdict::kAgreed)
      << "views that are sure outweigh it";
  const double half = 0.6;  // undecided from one side, and from four
  EXPECT_EQ(Judge(agrees, Summary({View(0.7), View(half)}), config), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(agrees, Summary({View(0.7), View(half), View(half), View(half)}), config),
            ClaimVerdict::kRefuted)
      << "put aside";
  EXPECT_TRUE(IsDisproved(Summary({View(0.7), View(0)}), config));
  EXPECT_FALSE(IsDisproved(Summary({View(0.3)}), config)) << "one view";
  config.evidence = "frame";
  EXPECT_FALSE(IsDisproved(Summary({View(0.7), View(0)}), config));
}

TEST(ViewEvidence, ALengthThatNoSofaHasCountsAgainstIt) {
  VerifyConfig config;
  config.evidence = "views";
  config.views.too_short = -2;
  const MemoryOpinion agrees{0.9, 0.5, "chair", 9};
  const ViewScore cut = View(0.98), armchair = View(0.98, 1, 1.0), sofa = View(0.98, 1, 1.6);
  EXPECT_EQ(Judge(agrees, Summary({cut}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({sofa}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({armchair}), config), ClaimVerdict::kWeak);
  EXPECT_EQ(Judge(agrees, Summary({armchair}, "chair"), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({armchair, sofa}), config), ClaimVerdict::kAgreed);
  EXPECT_EQ(Judge(agrees, Summary({View(0.8, 1, 1.0), View(0.5)}), config), ClaimVerdict::kRefuted);
}

/// Frame of a camera at `p_camera` that looks along -x, at the height of the object of ColumnAt(0).
Observation FrameFrom(const Vector3d& p_camera, float depth_m) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  obs.depth_m = DepthImage(64, 64, depth_m);
  Eigen::Matrix3d R_world_camera;  // optical: x right, y down, z forward
  R_world_camera.col(0) = Vector3d::UnitY();
  R_world_camera.col(1) = -Vector3d::UnitZ();
  R_world_camera.col(2) = -Vector3d::UnitX();
  obs.T_world_camera.linear() = R_world_camera;
  obs.T_world_camera.translation() = p_camera;
  return obs;
}

TEST(ViewEvidence, PlainSightIsNearFramedAndNotHidden) {
  const auto voxels = ColumnAt(0);
  const double voxel_m = 0.1;
  const auto plain = [&](const Vector3d& p_camera, float depth_m) {
    return IsPlain(SightOf(voxels, FrameFrom(p_camera, depth_m), voxel_m));
  };
  EXPECT_TRUE(plain({2, 0, 0.3}, 2));
  EXPECT_FALSE(plain({5, 0, 0.3}, 5)) << "far";
  EXPECT_FALSE(plain({0.6, 0, 0.3}, 0.6F)) << "it fills the image";
  EXPECT_FALSE(plain({2, 4, 0.3}, 2)) << "outside the image";
  EXPECT_FALSE(plain({-2, 0, 0.3}, 2)) << "behind the camera";
  EXPECT_FALSE(plain({2, 0, 0.3}, 1)) << "something stands before it";
}

TEST(ViewEvidence, MissesInPlainSightAreNotedByViewToo) {
  LivePoi poi;
  poi.id = 7;
  poi.voxels = ColumnAt(0);
  poi.p_center_world = Vector3d(0, 0, 0.25);
  ClaimTracker book;
  const auto note = [&](const Vector3d& p_camera, float depth_m, std::vector<Sighting> seen) {
    NoteScores({poi}, seen, FrameFrom(p_camera, depth_m), 0.1, kObject, kConfig, &book);
  };
  note({2, 0, 0.9}, 2, {SightingOf(0, 0.5)});
  note({3, 0, 0.9}, 3, {SightingOf(0, 0.5)});
  note({1, 1.5, 0.9}, 0.2F, {});
  ASSERT_NE(book.ViewsOf(7), nullptr);
  ASSERT_EQ(book.ViewsOf(7)->scores.size(), 1U) << "a hidden object was not missed";
  EXPECT_EQ(book.ViewsOf(7)->scores[0].frames, 2);
  note({1, 0.9, 0.3}, 1, {});
  ASSERT_EQ(book.ViewsOf(7)->scores.size(), 2U);
  EXPECT_DOUBLE_EQ(book.ViewsOf(7)->scores[1].Mean(), 0);
  note({1, 0.9, 0.3}, 1, {SightingOf(0, 0.6)});
  note({1, 0.9, 0.3}, 1, {});
  ASSERT_EQ(book.ViewsOf(7)->scores.size(), 2U);
  EXPECT_DOUBLE_EQ(book.ViewsOf(7)->scores[1].Mean(), 0.6) << "of the frames with a detection";
  EXPECT_TRUE(book.ViewsOf(7)->p_cameras_world.empty()) << "too weak a score for a claim";
}

TEST(Views, AreOthersByAngleAroundTheObjectAndByDistance) {
  const Vector3d p_object(0, 0, 0.5);
  const Vector3d south(0, -2, 0.9), further(0.1, -4, 0.9), east(2, 0, 0.9);
  EXPECT_FALSE(IsOtherView(p_object, south, further, kConfig));
  EXPECT_TRUE(IsOtherView(p_object, south, east, kConfig));
  EXPECT_FALSE(IsOtherView(p_object, 0.05 * south, 0.05 * east, kConfig)) << "0.14 m apart";
}

TEST(Views, AreNotedOnceForASide) {
  LivePoi poi;
  poi.id = 7;
  poi.voxels = ColumnAt(0);
  poi.p_center_world = Vector3d(0, 0, 0.25);
  ClaimTracker book;
  const auto note = [&](const Vector3d& p_camera, double confidence) {
    NoteViews({poi}, {SightingOf(0, confidence)}, p_camera, kObject, kConfig, &book);
    const ClaimViews* views = book.ViewsOf(7);
    return views ? views->p_cameras_world.size() : 0;
  };
  EXPECT_EQ(note({2, 0, 0.9}, 0.65), 0U) << "not what STOP asks for";
  EXPECT_EQ(note({2, 0, 0.9}, 0.75), 1U);
  EXPECT_EQ(note({3, 0, 0.9}, 0.75), 1U);
  EXPECT_EQ(note({0, 3, 0.9}, 0.75), 2U);
}

TEST(Rejected, AnObjectIsNotTriedAgainWithoutNewEvidence) {
  ClaimTracker book;
  book.rejected.push_back({3, ColumnAt(0), Vector3d(0, 0, 0.25), 0.75, {Vector3d(2, 0, 0.9)}});
  std::vector<int> revived;
  const auto left = [&](const Vector3d& p_camera, double confidence) {
    return WithoutRejected({SightingOf(0, confidence), SightingOf(30, 0.7)}, p_camera, kObject,
                           kConfig, &book, &revived)
        .size();
  };
  EXPECT_EQ(left({2, 0, 0.9}, 0.95), 1U) << "from the same side";
  EXPECT_EQ(left({0, 2, 0.9}, 0.76), 1U) << "no more sure than before";
  EXPECT_TRUE(revived.empty());
  EXPECT_EQ(left({0, 2, 0.9}, 0.85), 2U);
  EXPECT_EQ(revived, std::vector<int>{3});
  EXPECT_TRUE(book.rejected.empty());
}

TEST(Rejected, ViewsThatDecideForAnObjectAreNewEvidence) {
  VerifyConfig config = kConfig;
  config.evidence = "views";
  ClaimTracker book;
  book.rejected.push_back({3, ColumnAt(0), Vector3d(0, 0, 0.25), 0.75, {Vector3d(2, 0, 0.9)}, 0.8});
  std::vector<int> revived;
  const auto is_kept = [&](const Vector3d& p_camera) {
    return !WithoutRejected({SightingOf(0, 0.7)}, p_camera, kObject, config, &book, &revived)
                .empty();
  };
  EXPECT_FALSE(is_kept({0, 2, 0.9})) << "undecided";
  book.rejected.front().probability = 0.95;
  EXPECT_FALSE(is_kept({2, 0, 0.9})) << "from the same side";
  EXPECT_TRUE(is_kept({0, 2, 0.9}));
  EXPECT_EQ(revived, std::vector<int>{3});
}

TEST(Rejected, TheLikeliestIsTheAnswerWhereItOutweighsTheOthers) {
  VerifyConfig config;
  ClaimTracker book;
  const auto reject = [&](int id, double probability) {
    book.rejected.push_back({id, ColumnAt(10 * id), Vector3d(id, 0, 0.25), 0.75, {}, probability});
  };
  EXPECT_EQ(LikeliestOfRejected(book, config), std::nullopt);
  reject(1, 0.02);
  EXPECT_EQ(LikeliestOfRejected(book, config), std::nullopt) << "missed by all views, rather";
  reject(2, 0.3);
  EXPECT_EQ(LikeliestOfRejected(book, config), 1U);
  reject(3, 0.28);
  EXPECT_EQ(LikeliestOfRejected(book, config), 1U);
  reject(4, 0.29);
  EXPECT_EQ(LikeliestOfRejected(book, config), std::nullopt) << "three that are as likely";
  book.settled_for = {{3, Vector3d::Zero()}, {4, Vector3d::Zero()}};
  EXPECT_EQ(LikeliestOfRejected(book, config), 1U);
  config.settle = 1;
  EXPECT_EQ(LikeliestOfRejected(book, config), std::nullopt);
}

}  // namespace
}  // namespace crossnav::policy
