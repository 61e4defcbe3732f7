// SPDX-License-Identifier: MIT
#include "crossnav/agent/carriers.h"

#include <algorithm>
#include <cmath>

#include "crossnav/agent/search_shares.h"
#include "crossnav/agent/whereabouts.h"

namespace crossnav::agent {
namespace {

using objects::ObjectRecord;

constexpr double kThingsToHalf = 4;   // chosen: with as many things on tops, half is believed
constexpr double kMostWeight = 3.0;   // chosen: few things teach little
constexpr double kReach_vox = 1.5;    // chosen: a thing hides the surface below it
constexpr double kOneThing_m = 0.25;  // chosen: two records this near are names of one thing

bool IsOn(const ObjectRecord& furniture, const Vector3d& p_world, double voxel_m) {
  const double reach_m = kReach_vox * voxel_m;
  if (furniture.box_world_m.exteriorDistance(p_world) > reach_m) return false;
  return std::any_of(furniture.voxels.begin(), furniture.voxels.end(), [&](const auto& voxel) {
    const Vector3d up = p_world - CenterOf(voxel, voxel_m);
    return up.head<2>().cwiseAbs().maxCoeff() <= reach_m && up.z() >= 0 && up.z() <= reach_m;
  });
}

}  // namespace

Carriers::Carriers(const World& world) : voxel_m_(world.objects.voxel_m()) {
  for (const ObjectRecord& record : world.objects.records()) {
    const auto base_m = HeightAboveFloor(world, record);
    if (base_m && *base_m <= kFurnitureTop_m && record.views > 0 && !world.objects.IsGone(record))
      furniture_.push_back(&record);
  }
  std::map<std::string, double> areas;
  double area = 0;
  for (const auto& [cell, patch] : world.full.field.patches()) {
    if (patch.height_m <= kFurnitureTop_m) continue;
    areas[KindAt(patch.p_world)] += patch.columns;
    area += patch.columns;
  }
  std::map<std::string, int> things;
  int count = 0;
  for (const Vector3d& p_foot : FeetOfThingsOnTops(world)) {
    ++things[KindAt(p_foot)];
    ++count;
  }
  for (const auto& [kind, part] : areas) {
    const double prior = kThingsToHalf * part / area;
    const double weight = (things[kind] + prior) / ((count + kThingsToHalf) * part / area);
    weights_[kind] = std::min(weight, kMostWeight);
  }
}

std::vector<Vector3d> Carriers::FeetOfThingsOnTops(const World& world) const {
  std::vector<Vector3d> feet_world;
  for (const ObjectRecord& record : world.objects.records()) {
    const auto base_m = HeightAboveFloor(world, record);
    if (!base_m || *base_m <= kFurnitureTop_m || *base_m > policy::SearchPatch::kHighestTop_m ||
        record.views == 0)
      continue;
    Vector3d p_foot = record.box_world_m.center();
    p_foot.z() = record.box_world_m.min().z();
    const bool is_known = std::any_of(feet_world.begin(), feet_world.end(), [&](const auto& other) {
      return (other - p_foot).norm() <= kOneThing_m;
    });
    if (!is_known) feet_world.push_back(p_foot);
  }
  return feet_world;
}

std::string Carriers::KindAt(const Vector3d& p_top_world) const {
  const auto it = std::find_if(furniture_.begin(), furniture_.end(), [&](const auto* record) {
    return IsOn(*record, p_top_world, voxel_m_);
  });
  return it == furniture_.end() ? std::string() : (*it)->category;
}

double Carriers::WeightAt(const Vector3d& p_top_world) const {
  const auto it = weights_.find(KindAt(p_top_world));
  return it == weights_.end() ? 1 : it->second;
}

}  // namespace crossnav::agent
