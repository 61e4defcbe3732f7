// SPDX-License-Identifier: MIT
// Verification of claims: a detection that would end the search is compared with the features
// that the semantic memory fused at the object from every view and, if weak, with a second view
// from another side. Refuted objects are remembered. World frame, metres. Functions over plain
// structs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/setting.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/policy/view_evidence.h"

namespace crossnav::policy {

/// Settings `verify.*`; policy.profile = full.
struct VerifyConfig {
  std::string memory = "on";        ///< on | off: off believes the frame before the agent
  std::string evidence = "auto";    ///< auto | frame | views: judged by this frame or by all views;
                                    ///< auto: views where the detector's card has their numbers
  EvidenceConfig views;             ///< of evidence = views
  double contradiction = 6;         // chosen: log-odds against the goal for each unit of cosine by
                                    // which another name answers better; evidence = views
  double refute_margin = 0.02;      // chosen: cosine by which another name must answer better
  double strong_margin = 0.02;      // chosen: cosine by which the goal must, or the claim is weak
  double strong_confidence = 0.80;  // chosen: of a frame; less is weak
  double view_angle_deg = 40;       // chosen: minimum angle between two views, seen from the object
  double view_baseline_m = 0.5;     // chosen: and so far apart at least
  double new_evidence = 0.05;       // chosen: confidence above that of the refuted claim
  double patience = 400;            // chosen: actions of search after a refuted claim, times the
                                    // probability that it is wrong, before it is the answer
  double settle = 0.35;             // chosen: least share of the odds of a refuted object that is
                                    // the answer once nothing is left to see; 1 = never
};

template <class V>
void Visit(V& visit, VerifyConfig& c) {
  visit("memory", c.memory, {"on", "off"});
  visit("evidence", c.evidence, {"auto", "frame", "views"});
  visit("score_offset", c.views.offset, -20.0, 20.0);
  visit("score_slope", c.views.slope, 0.0, 20.0);
  visit("view_missed", c.views.missed, -20.0, 0.0);
  visit("view_found", c.views.found, 0.0, 20.0);
  visit("too_short", c.views.too_short, -20.0, 0.0);
  visit("view_discount", c.views.discount, 0.0, 1.0);
  visit("decided", c.views.decided, 0.5, 1.0);
  visit("decided_alone", c.views.decided_alone, 0.5, 1.0);
  visit("refused", c.views.refused, 0.0, 1.0);
  visit("contradiction", c.contradiction, 0.0, 100.0);
  visit("refute_margin", c.refute_margin, 0.0, 2.0);
  visit("strong_margin", c.strong_margin, -2.0, 2.0);
  visit("strong_confidence", c.strong_confidence, 0.0, 1.0);
  visit("view_angle_deg", c.view_angle_deg, 0.0, 180.0);
  visit("view_baseline_m", c.view_baseline_m, 0.0, 10.0);
  visit("new_evidence", c.new_evidence, 0.0, 1.0);
  visit("patience", c.patience, 0.0, 1e6);
  visit("settle", c.settle, 0.0, 1.0);
}

/// A name and its unit text vector.
struct NamedText {
  std::string name;
  std::vector<float> vector;
};

/// Names that compete with a goal: the benchmark's categories, and furniture taken for them. Names
/// that the encoder cannot encode are left out.
std::span<const char* const> RivalNames();

/// Similarities that the memory holds for an object.
struct MemoryOpinion {
  double goal = 0;         ///< cosine of the fused feature with the goal's text
  double best_other = -1;  ///< and with the best of the other names; -1 without any
  std::string other;       ///< name with that cosine
  int rows = 0;            ///< feature-bearing voxels
  double Margin() const { return goal - best_other; }
};

/// Mean over the object's voxels of the fused features, weighted by confidence, compared with the
/// goal and with `others`. nullopt if the memory has no features there.
std::optional<MemoryOpinion> OpinionOf(const memory::SemanticMemory& memory,
                                       const std::vector<VoxelKey>& voxels,
                                       std::span<const float> goal,
                                       const std::vector<NamedText>& others);

/// Whether the rival that `opinion` prefers is what a small object stands on or among: its voxels
/// are no finer than the object, and hold the features of its surroundings as well. Such an opinion
/// says nothing about the object.
bool IsOfSurroundings(const memory::SemanticMemory& memory, const std::vector<VoxelKey>& voxels,
                      double voxel_m, const MemoryOpinion& opinion,
                      const std::vector<NamedText>& others);

/// Views from which an object was claimed: camera places with pairwise different views.
struct ClaimViews {
  int poi_id = 0;
  std::vector<Vector3d> p_cameras_world;
  std::vector<ViewScore> scores;  ///< weak sightings and misses, too; pairwise other views
};

/// Whether `p_a` and `p_b` look at `p_object` from two sides: around the upright axis.
bool IsOtherView(const Vector3d& p_object, const Vector3d& p_a, const Vector3d& p_b,
                 const VerifyConfig& config);
/// Whether `p_camera` is another view than all of `views`.
bool IsNewView(const Vector3d& p_object, const Vector3d& p_camera,
               const std::vector<Vector3d>& views, const VerifyConfig& config);

/// An object that turned out not to be the goal.
struct RejectedObject {
  int poi_id = 0;
  std::vector<VoxelKey> voxels;  ///< not empty; sorted; grows with each view
  Vector3d p_center_world = Vector3d::Zero();
  double confidence = 0;                     ///< the best it was claimed with
  std::vector<Vector3d> p_cameras_world;     ///< views from which it was
  double probability = 0;                    ///< that it is the goal after all, by its views
  Vector3d p_foot_world = Vector3d::Zero();  ///< of the agent at the rejection
  int step = 0;                              ///< of the rejection
};

/// A rejected object that was taken for want of better ones.
struct SettledObject {
  int poi_id = 0;
  Vector3d p_foot_world = Vector3d::Zero();  ///< as above
};

/// All claims about one goal.
struct ClaimTracker {
  std::vector<ClaimViews> views;
  std::vector<RejectedObject> rejected;
  int second_view_of = -1;     ///< id of the POI that is to be seen from another side, -1 = none
  int no_second_view_of = -1;  ///< id of the POI whose other sides could not be reached, -1 = none
  int decided_by_views = -1;   ///< id of the POI that all views hold and near frames miss, or -1
  std::vector<SettledObject> settled_for;

  const ClaimViews* ViewsOf(int poi_id) const;
  /// Null if it was not settled for.
  const SettledObject* SettledFor(int poi_id) const;
};

/// Drops sightings of rejected objects. A sighting from another side is new evidence if it has more
/// confidence than the rejected claim (evidence = views: if the object's probability is that of a
/// decided claim by now): it is kept, the rejection is withdrawn, and the POI's id goes to
/// `revived`.
std::vector<Sighting> WithoutRejected(std::vector<Sighting> sightings,
                                      const Vector3d& p_camera_world, const ObjectConfig& object,
                                      const VerifyConfig& config, ClaimTracker* tracker,
                                      std::vector<int>* revived);

/// Notes the camera place of each POI that this frame claims with the confidence for STOP.
void NoteViews(const std::vector<LivePoi>& pois, const std::vector<Sighting>& sightings,
               const Vector3d& p_camera_world, const ObjectConfig& object,
               const VerifyConfig& config, ClaimTracker* tracker);

/// Notes the score of each POI in this frame at the view it belongs to: weak ones too, and 0 where
/// it is in plain sight without a detection. `obs`: the frame of `sightings`.
void NoteScores(const std::vector<LivePoi>& pois, const std::vector<Sighting>& sightings,
                const Observation& obs, double voxel_m, const ObjectConfig& object,
                const VerifyConfig& config, ClaimTracker* tracker);

enum class ClaimVerdict { kAgreed, kWeak, kRefuted };

/// kWeak: another view is wanted. `confidence` is the frame's, `views` from how many sides the
/// object was claimed. What is weak in the frame and in the memory takes three views, of which none
/// helps where the memory answers better to another name.
ClaimVerdict Judge(const std::optional<MemoryOpinion>& opinion, double confidence, int views,
                   const VerifyConfig& config);

/// Probability that an object is the goal, from its views and the memory's contradiction.
double ProbabilityOf(const ViewSummary& views, const std::optional<MemoryOpinion>& opinion,
                     const VerifyConfig& config);

/// The same by all views (verify.evidence = views). A memory that answers better to another name
/// refutes what its views do not outweigh. A memory without a preference takes a second
/// view, and so does a first view that is not sure; views that leave the claim undecided are at
/// most four: then it is put aside (LikeliestOfRejected).
ClaimVerdict Judge(const std::optional<MemoryOpinion>& opinion, const ViewSummary& views,
                   const VerifyConfig& config);

/// Whether the views alone refute an object (verify.evidence = views).
bool IsDisproved(const ViewSummary& views, const VerifyConfig& config);

/// The goal is assumed to be in the house, and everything was looked at: it is one of the rejected
/// objects, or it was missed by all views. Index of the likeliest object that was not settled for;
/// nullopt if its share of the odds is less than `settle`.
std::optional<std::size_t> LikeliestOfRejected(const ClaimTracker& claims,
                                               const VerifyConfig& config);

}  // namespace crossnav::policy
