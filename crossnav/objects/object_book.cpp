// SPDX-License-Identifier: MIT
#include "crossnav/objects/object_book.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "crossnav/objects/frame_view.h"

namespace crossnav::objects {

using geometry::VoxelKey;

namespace {

constexpr double kMostBelief = 0.98;    // chosen: presence is never certain
constexpr double kLeastBelief = 0.001;  // chosen: nor is absence
constexpr double kUnsure = 0.5;        // chosen: before a first sighting, or a new one after doubts
constexpr double kSighting = 3.0;      // chosen: odds of a sure detection, less one
constexpr double kSeenFree = 0.05;     // chosen: odds factor of a good view of free space
constexpr double kNotDetected = 0.25;  // chosen: a detector misses one object in a few
constexpr double kSameOverlap = 0.3;   // chosen: of the smaller box
constexpr double kTwinOverlap = 0.5;   // chosen: likewise, of two records
constexpr double kPictureGain = 1.5;   // chosen: times the pixels, for a new picture
constexpr double kMoved_m = 0.25;      // chosen: one step: another view
constexpr double kTurnedCos = 0.97;    // chosen: or 15 degrees
constexpr int kManyFrames = 10;        // chosen: more than a false detection lasts
constexpr double kClear = 4.0;         // chosen: times the fewest pixels that showed the object
constexpr double kOtherSize = 0.75;    // chosen: distances of two aspects; half the pixels
constexpr double kLeastVisible = 0.3;  // chosen: one side of an object hides the others
constexpr double kMostSurface = 0.2;   // chosen: of a free place
constexpr double kLeastPixels = 300;   // chosen: of an object that a detector finds ...
constexpr double kLeastImage = 0.002;  // chosen: ... and of the image
constexpr double kSureImage = 0.012;   // chosen: likewise, of an object that this run has not found

double BeliefTimes(double belief, double factor) {
  const double odds = factor * belief / (1 - belief);
  return std::clamp(odds / (1 + odds), kLeastBelief, kMostBelief);
}

/// Share of the smaller box that both cover; boxes are a voxel larger.
double OverlapOf(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::AlignedBox3d both = a.intersection(b);
  if (both.isEmpty()) return 0;
  return both.volume() / std::max(1e-9, std::min(a.volume(), b.volume()));
}

Eigen::AlignedBox3d BoxOf(std::span<const VoxelKey> voxels, double voxel_m) {
  Eigen::AlignedBox3d box;
  for (const VoxelKey& key : voxels) {
    box.extend(geometry::MinCornerOf(key, voxel_m));
    box.extend(geometry::MinCornerOf(key + VoxelKey{1, 1, 1}, voxel_m));
  }
  return box;
}

Vector3d CentreOf(std::span<const VoxelKey> voxels, double voxel_m) {
  Vector3d sum = Vector3d::Zero();
  for (const VoxelKey& key : voxels) sum += geometry::CenterOf(key, voxel_m);
  return voxels.empty() ? sum : Vector3d(sum / static_cast<double>(voxels.size()));
}

std::vector<VoxelKey> UnionOf(const std::vector<VoxelKey>& a, const std::vector<VoxelKey>& b) {
  std::vector<VoxelKey> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

/// Whether the object looks different from both places, given from its centre.
bool IsOtherAspect(const Vector3d& a, const Vector3d& b) {
  const double a_m = a.norm(), b_m = b.norm();
  if (b_m <= 0) return true;
  return std::min(a_m, b_m) <= kOtherSize * std::max(a_m, b_m) ||
         a.dot(b) <= kTurnedCos * a_m * b_m;
}

double PixelsShown(const FrameView& view) {
  return view.pixels * view.Visible();
}

/// Removes older voxels that the frame sees through: the object stood a little elsewhere. If these
/// outnumber the older voxels at a surface, both are removed, because the ground behind a foot is
/// no surface of the object.
void Prune(std::vector<VoxelKey>& voxels, const std::vector<VoxelKey>& kept, const Observation& obs,
           double voxel_m) {
  std::vector<VoxelKey> old;
  std::set_difference(voxels.begin(), voxels.end(), kept.begin(), kept.end(),
                      std::back_inserter(old));
  const FrameView all = ViewOf(old, obs, voxel_m);
  if (all.free <= 0) return;
  const bool has_moved = all.free > all.surface;
  std::erase_if(old, [&](const VoxelKey& key) {
    const FrameView view = ViewOf({&key, 1}, obs, voxel_m, 1);
    return view.free > 0 || (has_moved && view.surface > 0);
  });
  voxels = UnionOf(old, kept);
}

}  // namespace

void Measure(ObjectRecord& record, double voxel_m) {
  record.box_world_m = BoxOf(record.voxels, voxel_m);
  record.centre_world_m = CentreOf(record.voxels, voxel_m);
}

int ObjectBook::FindFor(const SeenObject& seen, const Vector3d& centre, std::int64_t step) const {
  const Eigen::AlignedBox3d box = BoxOf(seen.voxels, voxel_m_);
  int best = -1;
  double best_score = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ObjectRecord& record = records_[i];
    if (record.category != seen.category || watches_[i].noted_step == step) continue;
    const double overlap = OverlapOf(box, record.box_world_m);
    const double away_m = (record.centre_world_m - centre).norm();
    if (overlap < kSameOverlap && away_m > config_.same_place_m) continue;
    const double score = overlap + config_.same_place_m / (config_.same_place_m + away_m);
    if (score <= best_score) continue;
    best_score = score;
    best = static_cast<int>(i);
  }
  return best;
}

void ObjectBook::Merge(ObjectRecord& record, Watch& watch, const SeenObject& seen,
                       const Observation& obs) {
  record.voxels = UnionOf(record.voxels, seen.voxels);
  Prune(record.voxels, seen.voxels, obs, voxel_m_);
  Measure(record, voxel_m_);
  record.confidence =
      BeliefTimes(std::max(record.confidence, kUnsure), 1 + kSighting * seen.confidence);
  if (!seen.mask) return;
  const auto colour = MeanColour(obs.rgb, *seen.mask, seen.box);
  if (!colour) return;
  if (record.colour) {
    const double share = 1.0 / static_cast<double>(watch.colour_views + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      const double mean = (*record.colour)[i] + share * ((*colour)[i] - (*record.colour)[i]);
      (*record.colour)[i] = static_cast<std::uint8_t>(std::lround(mean));
    }
  } else {
    record.colour = colour;
  }
  watch.colour_views = std::min<std::int64_t>(watch.colour_views + 1, 20);
  if (std::exchange(watch.has_old_colours, false)) watch.colours = {};
  watch.colours.Add(obs.rgb, *seen.mask, seen.box);
  const double pixels =
      static_cast<double>(seen.box.u1 - seen.box.u0) * (seen.box.v1 - seen.box.v0);
  if (pixels < kPictureGain * watch.picture_px) return;
  watch.picture_px = pixels;
  record.picture_png = PictureOf(obs.rgb, seen.box);
}

/// Merges a record with a record of the same category that it has grown over.
int ObjectBook::MergeTwins(int index) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    ObjectRecord& record = records_[index];
    ObjectRecord& twin = records_[i];
    if (static_cast<int>(i) == index || twin.category != record.category ||
        watches_[i].noted_step == watches_[index].noted_step ||
        OverlapOf(record.box_world_m, twin.box_world_m) < kTwinOverlap)
      continue;
    record.voxels = UnionOf(record.voxels, twin.voxels);
    Measure(record, voxel_m_);
    record.views += twin.views;
    watches_[index].frames += watches_[i].frames;
    record.id = std::min(record.id, twin.id);
    if (std::pair(twin.first_seen_day, twin.first_seen_step) <
        std::pair(record.first_seen_day, record.first_seen_step)) {
      record.first_seen_day = twin.first_seen_day;
      record.first_seen_step = twin.first_seen_step;
    }
    if (watches_[i].picture_px > watches_[index].picture_px) {
      record.picture_png = twin.picture_png;
      watches_[index].picture_px = watches_[i].picture_px;
    }
    watches_[index].colours.Add(watches_[i].colours);
    const int id = record.id;
    records_.erase(records_.begin() + static_cast<std::ptrdiff_t>(i));
    watches_.erase(watches_.begin() + static_cast<std::ptrdiff_t>(i));
    return id;
  }
  return -1;
}

std::vector<int> ObjectBook::Note(std::span<const SeenObject> seen, const Observation& obs,
                                  const Moment& when) {
  std::vector<int> ids;
  for (const SeenObject& object : seen) {
    if (object.voxels.empty()) {
      ids.push_back(-1);
      continue;
    }
    int index = FindFor(object, CentreOf(object.voxels, voxel_m_), when.step);
    if (index < 0) {
      index = static_cast<int>(records_.size());
      ObjectRecord& fresh = records_.emplace_back();
      watches_.emplace_back();
      fresh.id = next_id_++;
      fresh.category = object.category;
      fresh.confidence = kUnsure;
      fresh.first_seen_day = when.day;
      fresh.first_seen_step = when.step;
    }
    ObjectRecord& record = records_[index];
    Merge(record, watches_[index], object, obs);
    watches_[index].noted_step = when.step;
    const double shown_px = PixelsShown(ViewOf(record.voxels, obs, voxel_m_));
    double& least_px = watches_[index].least_shown_px;
    least_px = least_px > 0 ? std::min(least_px, shown_px) : shown_px;
    ++record.views;
    ++watches_[index].frames;
    record.last_seen_day = when.day;
    record.last_seen_step = when.step;
    const int id = record.id;
    const int older = MergeTwins(index);
    ids.push_back(older >= 0 ? older : id);
  }
  // MergeTwins may have erased a record and shifted later indices.
  for (int& id : ids) {
    const auto it = std::find_if(records_.begin(), records_.end(),
                                 [&](const ObjectRecord& record) { return record.id == id; });
    id = it == records_.end() ? -1 : static_cast<int>(it - records_.begin());
  }
  return ids;
}

/// Whether the detector, asked for the record's category, should have found it in `view`.
bool ObjectBook::IsMiss(const FrameView& view, const Watch& watch, const Vector3d& to_camera_m,
                        double image_px) const {
  // An object of many frames does not go while the robot is there: the detector misses it.
  if (watch.frames >= kManyFrames) return false;
  // The detector may miss a thing that is smaller in the picture than in any view that found it.
  const double least_px = watch.least_shown_px > 0 ? watch.least_shown_px : kSureImage * image_px;
  const double shown_px = PixelsShown(view);
  const bool is_good = view.Visible() >= kLeastVisible &&
                       view.free + view.surface + view.hidden >= config_.good_view &&
                       view.pixels >= std::max(kLeastPixels, kLeastImage * image_px);
  if (shown_px < least_px || !is_good) return false;
  // Near that limit the misses of one aspect are one miss.
  return shown_px >= kClear * least_px || IsOtherAspect(to_camera_m, watch.to_camera_missed_m);
}

std::vector<int> ObjectBook::Doubt(std::span<const std::string> asked, const Observation& obs,
                                   const Moment& when) {
  std::vector<int> gone;
  const Vector3d p_camera = obs.T_world_camera.translation();
  const Vector3d along = obs.T_world_camera.linear().col(2);
  const double image_px = static_cast<double>(obs.depth_m.width) * obs.depth_m.height;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    ObjectRecord& record = records_[i];
    Watch& watch = watches_[i];
    if (watch.noted_step == when.step || record.confidence <= kLeastBelief) continue;
    const double away_m = std::sqrt(record.box_world_m.squaredExteriorDistance(p_camera));
    if (away_m > config_.range_m) continue;
    if ((watch.p_doubted_world - p_camera).norm() < kMoved_m &&
        watch.doubted_along.dot(along) > kTurnedCos)
      continue;
    const FrameView view = ViewOf(record.voxels, obs, voxel_m_);
    const bool is_free = view.free >= config_.good_view && view.surface <= kMostSurface;
    const bool is_asked = std::find(asked.begin(), asked.end(), record.category) != asked.end();
    const Vector3d to_camera_m = p_camera - record.centre_world_m;
    if (!is_free && !(is_asked && IsMiss(view, watch, to_camera_m, image_px))) continue;
    if (!is_free) watch.to_camera_missed_m = to_camera_m;
    watch.p_doubted_world = p_camera;
    watch.doubted_along = along;
    const bool was_gone = IsGone(record);
    record.confidence = BeliefTimes(record.confidence, is_free ? kSeenFree : kNotDetected);
    if (IsGone(record) && !was_gone) gone.push_back(static_cast<int>(i));
  }
  return gone;
}

void ObjectBook::Refute(const std::string& category, std::span<const VoxelKey> voxels) {
  if (voxels.empty()) return;
  const Eigen::AlignedBox3d box = BoxOf(voxels, voxel_m_);
  for (ObjectRecord& record : records_)
    if (record.category == category && OverlapOf(box, record.box_world_m) >= kSameOverlap)
      record.confidence = kLeastBelief;
}

void ObjectBook::Disprove(const std::string& category, std::vector<VoxelKey> voxels,
                          const Moment& when) {
  if (voxels.empty()) return;
  std::sort(voxels.begin(), voxels.end());
  const Eigen::AlignedBox3d box = BoxOf(voxels, voxel_m_);
  bool is_known = false;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (records_[i].category != category || OverlapOf(box, records_[i].box_world_m) < kSameOverlap)
      continue;
    is_known = true;
    if (watches_[i].noted_step >= 0) continue;
    records_[i].confidence = kLeastBelief;
    records_[i].voxels = UnionOf(records_[i].voxels, voxels);
    Measure(records_[i], voxel_m_);
  }
  if (is_known) return;
  ObjectRecord& record = records_.emplace_back();
  watches_.emplace_back();
  record.id = next_id_++;
  record.category = category;
  record.voxels = std::move(voxels);
  record.confidence = kLeastBelief;
  record.first_seen_day = record.last_seen_day = when.day;
  record.first_seen_step = record.last_seen_step = when.step;
  Measure(record, voxel_m_);
}

std::vector<ObjectRecord> ObjectBook::Confirmed() const {
  std::vector<ObjectRecord> out;
  for (const ObjectRecord& record : records_)
    if (record.views >= config_.least_views || record.views == 0) out.push_back(record);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return out;
}

void ObjectBook::Load(std::vector<ObjectRecord> records) {
  records_ = std::move(records);
  watches_.assign(records_.size(), {});
  next_id_ = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    next_id_ = std::max(next_id_, records_[i].id + 1);
    watches_[i].colour_views = std::min(records_[i].views, 20);
    // A saved picture stays until a sighting has at least as many pixels.
    if (records_[i].picture_png.empty()) continue;
    watches_[i].picture_px = kPictureSide_px * kPictureSide_px;
    watches_[i].colours = ColoursOfPortrait(records_[i].picture_png);
    watches_[i].has_old_colours = true;
  }
}

}  // namespace crossnav::objects
