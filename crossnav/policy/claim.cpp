// SPDX-License-Identifier: MIT
#include "crossnav/policy/claim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "crossnav/core/pose.h"
#include "crossnav/policy/goal_length.h"

namespace crossnav::policy {
namespace {

// chosen: furniture that is taken for goals. Floors and walls are left out: they would win for
// every object smaller than a cell of the features.
constexpr std::array<const char*, 18> kRivals = {
    "chair", "bed",          "plant",   "toilet",   "tv_monitor", "sofa",
    "table", "desk",         "cabinet", "wardrobe", "sink",       "bathtub",
    "stool", "refrigerator", "stove",   "bench",    "picture",    "bookcase"};

template <class Numbers>
double Dot(const Numbers& a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

double Norm(std::span<const float> v) {
  double squared = 0;
  for (const float x : v) squared += static_cast<double>(x) * x;
  return std::sqrt(squared);
}

double Cosine(std::span<const float> a, std::span<const float> b) {
  return Dot(a, b) / std::max(1e-12, Norm(a) * Norm(b));
}

bool IsOf(const Sighting& sighting, const std::vector<VoxelKey>& voxels, const Vector3d& p_center,
          const ObjectConfig& object) {
  return IsSameObject(voxels, p_center, sighting.voxels, sighting.p_center_world,
                      object.merge_distance_m);
}

/// Overlap is tested with the box of the rejected voxels: a sighting from another side may share no
/// voxel with them.
bool IsOfRejected(const Sighting& sighting, const RejectedObject& rejected,
                  const ObjectConfig& object) {
  if (IsOf(sighting, rejected.voxels, rejected.p_center_world, object)) return true;
  constexpr int kMargin_vox = 2;  // chosen: noise of depth and pose
  VoxelKey lo = rejected.voxels.front(), hi = lo;
  for (const VoxelKey& key : rejected.voxels) {
    lo = {std::min(lo.x, key.x), std::min(lo.y, key.y), std::min(lo.z, key.z)};
    hi = {std::max(hi.x, key.x), std::max(hi.y, key.y), std::max(hi.z, key.z)};
  }
  const auto inside =
      std::count_if(sighting.voxels.begin(), sighting.voxels.end(), [&](const VoxelKey& key) {
        return key.x >= lo.x - kMargin_vox && key.x <= hi.x + kMargin_vox &&
               key.y >= lo.y - kMargin_vox && key.y <= hi.y + kMargin_vox &&
               key.z >= lo.z - kMargin_vox && key.z <= hi.z + kMargin_vox;
      });
  return 2 * inside > static_cast<std::ptrdiff_t>(sighting.voxels.size());
}

void Grow(RejectedObject& rejected, const std::vector<VoxelKey>& seen) {
  std::vector<VoxelKey> all;
  std::set_union(rejected.voxels.begin(), rejected.voxels.end(), seen.begin(), seen.end(),
                 std::back_inserter(all));
  rejected.voxels = std::move(all);
}

}  // namespace

std::span<const char* const> RivalNames() {
  return kRivals;
}

std::optional<MemoryOpinion> OpinionOf(const memory::SemanticMemory& memory,
                                       const std::vector<VoxelKey>& voxels,
                                       std::span<const float> goal,
                                       const std::vector<NamedText>& others) {
  MemoryOpinion opinion;
  std::vector<double> fused(static_cast<std::size_t>(std::max(0, memory.Dim())), 0.0);
  for (const VoxelKey& key : voxels) {
    const auto row = memory.RowOf(key);
    if (!row) continue;
    const std::vector<float> feature = memory.FeatureAt(*row);
    for (std::size_t i = 0; i < fused.size(); ++i) fused[i] += memory.WeightAt(*row) * feature[i];
    ++opinion.rows;
  }
  const double length = std::sqrt(Dot(fused, std::vector<float>(fused.begin(), fused.end())));
  if (opinion.rows == 0 || !(length > 0)) return std::nullopt;
  const auto cosine = [&](std::span<const float> text) {
    return Dot(fused, text) / (length * std::max(1e-12, Norm(text)));
  };
  opinion.goal = cosine(goal);
  for (const NamedText& other : others) {
    const double answer = cosine(other.vector);
    if (answer <= opinion.best_other) continue;
    opinion.best_other = answer;
    opinion.other = other.name;
  }
  return opinion;
}

bool IsOfSurroundings(const memory::SemanticMemory& memory, const std::vector<VoxelKey>& voxels,
                      double voxel_m, const MemoryOpinion& opinion,
                      const std::vector<NamedText>& others) {
  constexpr double kSmall_m = 0.45;   // chosen: largest side; half of a chair is larger
  constexpr int kRing_vox = 2;        // chosen: a cell of the features from near
  constexpr std::size_t kParts = 10;  // chosen: the support beside a wall is two of ten parts
  if (voxels.empty() || opinion.Margin() >= 0) return false;
  const auto other = std::find_if(others.begin(), others.end(), [&](const NamedText& text) {
    return text.name == opinion.other;
  });
  if (other == others.end()) return false;
  VoxelKey lo = voxels.front(), hi = lo;
  for (const VoxelKey& key : voxels) {
    lo = {std::min(lo.x, key.x), std::min(lo.y, key.y), std::min(lo.z, key.z)};
    hi = {std::max(hi.x, key.x), std::max(hi.y, key.y), std::max(hi.z, key.z)};
  }
  // A surface lies anywhere in its voxel: the box is a voxel larger than the thing.
  const int side_vox = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  if (side_vox * voxel_m > kSmall_m) return false;
  std::vector<double> around;
  for (int x = lo.x - kRing_vox; x <= hi.x + kRing_vox; ++x)
    for (int y = lo.y - kRing_vox; y <= hi.y + kRing_vox; ++y)
      for (int z = lo.z - kRing_vox; z <= hi.z + kRing_vox; ++z) {
        const VoxelKey key{x, y, z};
        const auto row = memory.RowOf(key);
        if (row && std::find(voxels.begin(), voxels.end(), key) == voxels.end())
          around.push_back(Cosine(memory.FeatureAt(*row), other->vector));
      }
  if (around.empty()) return false;
  // The support is a small part of the ring, so that the best tenth answers for it.
  const std::size_t best = around.size() / kParts;
  std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(best), around.end(),
                   std::greater<>());
  return around[best] >= opinion.best_other;
}

bool IsOtherView(const Vector3d& p_object, const Vector3d& p_a, const Vector3d& p_b,
                 const VerifyConfig& config) {
  if ((p_a - p_b).head<2>().norm() < config.view_baseline_m) return false;
  const Vector3d a = p_a - p_object, b = p_b - p_object;
  const double angle_rad = WrapAngle(std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x()));
  return std::abs(angle_rad) >= DegToRad(config.view_angle_deg);
}

bool IsNewView(const Vector3d& p_object, const Vector3d& p_camera,
               const std::vector<Vector3d>& views, const VerifyConfig& config) {
  return std::all_of(views.begin(), views.end(), [&](const Vector3d& p_view) {
    return IsOtherView(p_object, p_camera, p_view, config);
  });
}

const ClaimViews* ClaimTracker::ViewsOf(int poi_id) const {
  const auto it = std::find_if(views.begin(), views.end(),
                               [&](const ClaimViews& v) { return v.poi_id == poi_id; });
  return it == views.end() ? nullptr : &*it;
}

const SettledObject* ClaimTracker::SettledFor(int poi_id) const {
  const auto it = std::find_if(settled_for.begin(), settled_for.end(),
                               [&](const SettledObject& s) { return s.poi_id == poi_id; });
  return it == settled_for.end() ? nullptr : &*it;
}

std::vector<Sighting> WithoutRejected(std::vector<Sighting> sightings,
                                      const Vector3d& p_camera_world, const ObjectConfig& object,
                                      const VerifyConfig& config, ClaimTracker* tracker,
                                      std::vector<int>* revived) {
  auto& rejected = tracker->rejected;
  std::erase_if(sightings, [&](const Sighting& sighting) {
    const auto it = std::find_if(rejected.begin(), rejected.end(), [&](const RejectedObject& r) {
      return IsOfRejected(sighting, r, object);
    });
    if (it == rejected.end()) return false;
    const bool is_likelier =
        config.evidence == "views"
            ? it->probability >= config.views.decided
            : sighting.confidence >= std::min(1.0, it->confidence + config.new_evidence);
    if (!is_likelier ||
        !IsNewView(it->p_center_world, p_camera_world, it->p_cameras_world, config)) {
      Grow(*it, sighting.voxels);
      return true;
    }
    revived->push_back(it->poi_id);
    rejected.erase(it);
    return false;
  });
  return sightings;
}

void NoteViews(const std::vector<LivePoi>& pois, const std::vector<Sighting>& sightings,
               const Vector3d& p_camera_world, const ObjectConfig& object,
               const VerifyConfig& config, ClaimTracker* tracker) {
  for (const LivePoi& poi : pois) {
    const bool is_claimed =
        std::any_of(sightings.begin(), sightings.end(), [&](const Sighting& sighting) {
          return sighting.confidence >= object.found_confidence &&
                 IsOf(sighting, poi.voxels, poi.p_center_world, object);
        });
    if (!is_claimed) continue;
    auto it = std::find_if(tracker->views.begin(), tracker->views.end(),
                           [&](const ClaimViews& v) { return v.poi_id == poi.id; });
    if (it == tracker->views.end()) it = tracker->views.insert(it, ClaimViews{poi.id, {}, {}});
    if (IsNewView(poi.p_center_world, p_camera_world, it->p_cameras_world, config))
      it->p_cameras_world.push_back(p_camera_world);
  }
}

void NoteScores(const std::vector<LivePoi>& pois, const std::vector<Sighting>& sightings,
                const Observation& obs, double voxel_m, const ObjectConfig& object,
                const VerifyConfig& config, ClaimTracker* tracker) {
  const Vector3d p_camera_world = obs.T_world_camera.translation();
  for (const LivePoi& poi : pois) {
    double best = 0, length_m = 0;
    for (const Sighting& sighting : sightings) {
      if (!IsOf(sighting, poi.voxels, poi.p_center_world, object)) continue;
      best = std::max(best, sighting.confidence);
      if (sighting.is_framed) length_m = std::max(length_m, LengthOf(sighting.voxels, voxel_m));
    }
    if (best <= 0 && !IsPlain(SightOf(poi.voxels, obs, voxel_m))) continue;
    auto it = std::find_if(tracker->views.begin(), tracker->views.end(),
                           [&](const ClaimViews& v) { return v.poi_id == poi.id; });
    if (it == tracker->views.end()) it = tracker->views.insert(it, ClaimViews{poi.id, {}, {}});
    auto view = std::find_if(it->scores.begin(), it->scores.end(), [&](const ViewScore& score) {
      return !IsOtherView(poi.p_center_world, p_camera_world, score.p_camera_world, config);
    });
    if (view == it->scores.end())
      view = it->scores.insert(view, ViewScore{.p_camera_world = p_camera_world});
    if (best <= 0) {
      ++view->missed_frames;
      continue;
    }
    view->sum_length_m += length_m;
    view->uncut_frames += length_m > 0 ? 1 : 0;
    view->sum += best;
    ++view->frames;
  }
}

ClaimVerdict Judge(const std::optional<MemoryOpinion>& opinion, double confidence, int views,
                   const VerifyConfig& config) {
  constexpr double kOutvoted = 0.1;  // chosen: cosine that two clear views make up for
  const double margin = opinion ? opinion->Margin() : 0;
  const bool is_weak_frame = confidence < config.strong_confidence;
  if (margin < -config.refute_margin) {
    if (is_weak_frame || margin < -kOutvoted) return ClaimVerdict::kRefuted;
    return views < 2 ? ClaimVerdict::kWeak : ClaimVerdict::kAgreed;
  }
  const bool is_weak_memory = margin < config.strong_margin;
  if (is_weak_frame && is_weak_memory) {
    if (views < 2) return ClaimVerdict::kWeak;
    if (margin < 0) return ClaimVerdict::kRefuted;
    return views < 3 ? ClaimVerdict::kWeak : ClaimVerdict::kAgreed;
  }
  return (is_weak_frame || is_weak_memory) && views < 2 ? ClaimVerdict::kWeak
                                                        : ClaimVerdict::kAgreed;
}

double ProbabilityOf(const ViewSummary& views, const std::optional<MemoryOpinion>& opinion,
                     const VerifyConfig& config) {
  const double against = opinion ? std::min(0.0, opinion->Margin()) : 0;
  EvidenceConfig contradicted = config.views;
  contradicted.offset += config.contradiction * against;
  return ProbabilityOf(views, contradicted);
}

ClaimVerdict Judge(const std::optional<MemoryOpinion>& opinion, const ViewSummary& views,
                   const VerifyConfig& config) {
  const double margin = opinion ? opinion->Margin() : 0;
  const double probability = ProbabilityOf(views, opinion, config);
  if (margin < -config.refute_margin && probability < config.views.refused)
    return ClaimVerdict::kRefuted;
  constexpr int kMost = 4;  // chosen: views; each further one is worth an eighth or less
  const bool is_weak_memory = margin < config.strong_margin;
  const bool is_enough = !is_weak_memory && probability >= config.views.decided_alone;
  if (probability >= config.views.decided)
    return views.views < 2 && !is_enough ? ClaimVerdict::kWeak : ClaimVerdict::kAgreed;
  if (IsDisproved(views, config)) return ClaimVerdict::kRefuted;
  return views.views < kMost ? ClaimVerdict::kWeak : ClaimVerdict::kRefuted;
}

bool IsDisproved(const ViewSummary& views, const VerifyConfig& config) {
  return config.evidence == "views" && views.views >= 2 &&
         ProbabilityOf(views, config.views) < config.views.refused;
}

std::optional<std::size_t> LikeliestOfRejected(const ClaimTracker& claims,
                                               const VerifyConfig& config) {
  constexpr double kMissedOdds = 0.1;  // chosen: a thing in plain sight that no view showed
  double all = kMissedOdds, best = 0;
  std::optional<std::size_t> likeliest;
  for (std::size_t i = 0; i < claims.rejected.size(); ++i) {
    if (claims.SettledFor(claims.rejected[i].poi_id)) continue;
    const double odds = std::exp(LogOddsOf(claims.rejected[i].probability));
    all += odds;
    if (odds <= best) continue;
    best = odds;
    likeliest = i;
  }
  return best >= config.settle * all ? likeliest : std::nullopt;
}

}  // namespace crossnav::policy
