// SPDX-License-Identifier: MIT
// Encodes a step as messages of Foxglove's protobuf schemas (proto/foxglove.proto), so that
// Foxglove and Rerun display a replay. Frames: "world", "agent" (x ahead, z up, at the foot),
// "camera" (x right, y down, z forward). Every function returns the message's bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/geometry/voxel_states.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

/// Display colour of a state, here and in the page. // chosen: distinguishable with every colour
/// vision
Rgb8 ColourOf(geometry::VoxelState state);

std::string EncodeTransform(std::uint64_t time_ns, std::string_view child,
                            const Pose& T_world_child);
std::string EncodePose(std::uint64_t time_ns, const AgentPose& agent);
/// `format`: jpeg | png.
std::string EncodeImage(std::uint64_t time_ns, std::string_view bytes, std::string_view format);
std::string EncodeDepth(std::uint64_t time_ns, const Image<std::uint16_t>& depth_mm);
/// `factor`: ratio of the size in `camera` to the size of the written image.
std::string EncodeCalibration(std::uint64_t time_ns, const CameraIntrinsics& camera, int factor);
std::string EncodeLog(std::uint64_t time_ns, std::string_view name, std::string_view message);

/// Centres of voxels with colour and state, in the order given.
struct ColouredVoxel {
  geometry::VoxelKey key;
  geometry::VoxelState state = geometry::VoxelState::kUnknown;
};
std::string EncodeCloud(std::uint64_t time_ns, const std::vector<ColouredVoxel>& voxels,
                        double voxel_m);

/// The plan: path, candidates with labels, target. Replaces the previous plan.
std::string EncodePlan(std::uint64_t time_ns, const StepTrace& trace);
/// Known flights as lines with labels: walked flights thick, others thin.
std::string EncodeFlights(std::uint64_t time_ns, const std::vector<geometry::StairFlight>& flights);
/// Boxes around the true instances of the goals.
std::string EncodeGoals(std::uint64_t time_ns, const std::vector<GoalInstance>& goals);

std::string EncodeVoxelChanges(std::uint64_t time_ns, double voxel_m, std::size_t count,
                               std::string_view runs);

}  // namespace crossnav::trace
