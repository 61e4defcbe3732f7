// SPDX-License-Identifier: MIT
#include "crossnav/policy/live_poi.h"

#include <algorithm>
#include <cmath>

#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

std::vector<VoxelKey> MaskVoxels(const perception::Detection& detection, const Observation& obs,
                                 const geometry::MapConfig& map_config) {
  std::vector<VoxelKey> keys;
  const int u1 = std::min(detection.box.u1, obs.depth_m.width);
  const int v1 = std::min(detection.box.v1, obs.depth_m.height);
  for (int v = std::max(0, detection.box.v0); v < v1; ++v)
    for (int u = std::max(0, detection.box.u0); u < u1; ++u) {
      if (!detection.mask.At(u, v)) continue;
      const float depth_m = obs.depth_m.At(u, v);
      if (!(depth_m >= map_config.depth_min_m && depth_m <= map_config.depth_max_m)) continue;
      const Vector3d p_world = obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m);
      const VoxelKey key = geometry::KeyOf(p_world, map_config.voxel_m);
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// The POI's votes in the order of `voxels`, which are the POI's and new ones. New voxels have 0.
VoxelVotes VotesOf(const LivePoi& poi, const std::vector<VoxelKey>& voxels) {
  VoxelVotes votes(voxels.size(), 0.0F);
  std::size_t old = 0;
  for (std::size_t i = 0; i < voxels.size() && old < poi.votes.size(); ++i)
    if (voxels[i] == poi.voxels[old]) votes[i] = poi.votes[old++];
  return votes;
}

std::vector<LivePoi>::iterator FindSame(std::vector<LivePoi>& pois, const Sighting& sighting,
                                        const ObjectConfig& config) {
  return std::find_if(pois.begin(), pois.end(), [&](const LivePoi& poi) {
    return IsSameObject(poi.voxels, poi.p_center_world, sighting.voxels, sighting.p_center_world,
                        config.merge_distance_m);
  });
}

/// The image shows the object's whole length.
bool IsFramed(const perception::PixelBox& box, const CameraIntrinsics& camera) {
  constexpr int kEdge_px = 2;  // chosen: boxes are that wrong
  return box.u0 >= kEdge_px && box.u1 <= camera.width_px - kEdge_px;
}

}  // namespace

std::vector<Sighting> LiftDetections(const std::vector<perception::Detection>& detections,
                                     const Observation& obs, const geometry::MapConfig& map_config,
                                     const ObjectConfig& config, double min_confidence) {
  std::vector<Sighting> sightings;
  const double image_area = static_cast<double>(obs.camera.width_px) * obs.camera.height_px;
  for (const auto& detection : detections) {
    if (detection.confidence < min_confidence) continue;
    auto parts = ConnectedClusters(MaskVoxels(detection, obs, map_config));
    if (parts.empty()) continue;
    auto largest = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
      return a.size() < b.size();
    });
    if (static_cast<int>(largest->size()) < config.min_projected_voxels) continue;
    Sighting sighting;
    sighting.voxels = std::move(*largest);
    parts.erase(largest);
    for (const auto& part : parts)
      sighting.other_parts.insert(sighting.other_parts.end(), part.begin(), part.end());
    std::sort(sighting.other_parts.begin(), sighting.other_parts.end());
    sighting.p_center_world = CentroidOf(sighting.voxels, map_config.voxel_m);
    sighting.confidence = detection.confidence;
    sighting.mask_quality = detection.mask_quality;
    sighting.area_fraction = detection.box.Area() / image_area;
    sighting.is_framed = IsFramed(detection.box, obs.camera);
    sighting.detection = static_cast<int>(&detection - detections.data());
    sightings.push_back(std::move(sighting));
  }
  return sightings;
}

bool IsSameObject(const std::vector<VoxelKey>& a, const Vector3d& a_center,
                  const std::vector<VoxelKey>& b, const Vector3d& b_center,
                  double merge_distance_m) {
  if ((a_center - b_center).norm() <= merge_distance_m) return true;
  const auto& few = a.size() < b.size() ? a : b;
  const auto& many = a.size() < b.size() ? b : a;
  const auto shared = std::count_if(few.begin(), few.end(), [&](const VoxelKey& key) {
    return std::binary_search(many.begin(), many.end(), key);
  });
  return 10 * shared >=
         2 * static_cast<std::ptrdiff_t>(few.size());  // chosen: a fifth of the smaller one
}

void LivePois::Update(const std::vector<Sighting>& sightings, const ObjectConfig& config,
                      double voxel_m, int step, int approached) {
  for (const Sighting& sighting : sightings) {
    if (sighting.confidence < std::min(config.detector_confidence, config.secondary_confidence))
      continue;
    if (sighting.area_fraction < config.min_box_area_fraction) continue;
    auto match = FindSame(pois_, sighting, config);
    const bool is_approached = match != pois_.end() && match->id == approached;
    if (!is_approached && sighting.confidence < config.detector_confidence) continue;
    if (match == pois_.end()) {
      LivePoi poi;
      poi.id = next_id_++;
      poi.last_seen_step = -1;
      pois_.push_back(std::move(poi));
      match = pois_.end() - 1;
    }
    std::vector<VoxelKey> merged;
    std::set_union(match->voxels.begin(), match->voxels.end(), sighting.voxels.begin(),
                   sighting.voxels.end(), std::back_inserter(merged));
    match->votes = VotesOf(*match, merged);
    match->voxels = std::move(merged);
    match->p_center_world = CentroidOf(match->voxels, voxel_m);
    match->confidence = std::max(match->confidence, sighting.confidence);
    match->frames += match->last_seen_step != step;
    match->last_seen_step = step;
  }
}

void LivePois::DropStrays(const std::vector<Sighting>& sightings, const Observation& obs,
                          const ObjectConfig& config, double voxel_m) {
  for (const Sighting& sighting : sightings) {
    const auto match = FindSame(pois_, sighting, config);
    if (match == pois_.end()) continue;
    VoteOnVoxels(sighting, obs, voxel_m, &match->voxels, &match->votes);
    match->p_center_world = CentroidOf(match->voxels, voxel_m);
  }
}

std::vector<const LivePoi*> LivePois::Stable(const ObjectConfig& config) const {
  std::vector<const LivePoi*> stable;
  for (const LivePoi& poi : pois_) {
    if (!poi.is_discarded && poi.frames >= config.stable_frames) stable.push_back(&poi);
  }
  std::stable_sort(stable.begin(), stable.end(), [](const LivePoi* a, const LivePoi* b) {
    return a->confidence > b->confidence;
  });
  return stable;
}

int LivePois::Adopt(const LivePoi& poi, const ObjectConfig& config) {
  LivePoi& adopted = pois_.emplace_back(poi);
  adopted.id = next_id_++;
  adopted.frames = std::max(adopted.frames, config.stable_frames);
  adopted.is_discarded = false;
  return adopted.id;
}

const LivePoi* LivePois::Find(int id) const {
  const auto it =
      std::find_if(pois_.begin(), pois_.end(), [&](const LivePoi& poi) { return poi.id == id; });
  return it == pois_.end() ? nullptr : &*it;
}

void LivePois::Discard(int id) {
  for (LivePoi& poi : pois_) {
    if (poi.id == id) poi.is_discarded = true;
  }
}

void LivePois::Forgive(int id) {
  for (LivePoi& poi : pois_) {
    if (poi.id == id) poi.is_discarded = false;
  }
}

void LivePois::ForgiveDiscarded() {
  for (LivePoi& poi : pois_) poi.is_discarded = false;
}

}  // namespace crossnav::policy
