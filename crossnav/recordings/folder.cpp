// SPDX-License-Identifier: MIT
#include "crossnav/recordings/folder.h"

#include "crossnav/core/read_file.h"
#include "crossnav/recordings/depth_image.h"
#include "crossnav/recordings/frames.h"

namespace crossnav::recordings {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;  // of an image

Result<Images> LoadImages(const FolderFrame& frame, double depth_unit_m) {
  const auto depth_bytes = ReadFile(frame.depth, kMostBytes);
  if (!depth_bytes) return tl::unexpected(depth_bytes.error());
  const auto raw = DecodeDepth16(BytesOf(*depth_bytes), frame.depth.string());
  if (!raw) return tl::unexpected(raw.error());
  const auto colour_bytes = ReadFile(frame.colour, kMostBytes);
  if (!colour_bytes) return tl::unexpected(colour_bytes.error());
  auto rgb = DecodeColour(BytesOf(*colour_bytes), frame.colour.string());
  if (!rgb) return tl::unexpected(rgb.error());
  return Images{std::move(*rgb), DepthOf(*raw, depth_unit_m)};
}

/// The user's value, else the format's default.
template <class T>
Result<CameraModel> CameraOf(const std::optional<Pinhole>& typed,
                             const std::optional<Pinhole>& usual, const Image<T>& image,
                             const Folder& folder) {
  const std::string where = folder.path.string();
  const bool is_usual_size =
      folder.are_intrinsics_of_images || (image.width == 640 && image.height == 480);
  if (!typed && (!usual || !is_usual_size)) {
    return Fail(ErrorCode::kInvalid,
                "the intrinsics of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) +
                    " px images are not known; give them with --intrinsics FX,FY,CX,CY",
                where);
  }
  return CameraModel{IntrinsicsOf(typed ? *typed : *usual, image.width, image.height), {}};
}

Result<Rig> RigOf(const Folder& folder, const RecordingOptions& options, const Images& images) {
  auto colour = CameraOf(options.colour, folder.colour, images.rgb, folder);
  if (!colour) return tl::unexpected(colour.error());
  auto depth = CameraOf(options.depth ? options.depth : options.colour, folder.depth,
                        images.depth_m, folder);
  if (!depth) return tl::unexpected(depth.error());
  return Rig{*colour, *depth, options.T_colour_depth.value_or(Pose::Identity())};
}

/// Transform from the frame of the poses to the colour camera.
Pose MountingOf(const Folder& folder, const RecordingOptions& options) {
  if (options.T_base_camera) return *options.T_base_camera;
  if (folder.are_poses_of_depth && options.T_colour_depth)
    return options.T_colour_depth->inverse(Eigen::Isometry);
  return Pose::Identity();
}

}  // namespace

Result<Recording> ReadFolder(const Folder& folder, const RecordingOptions& options,
                             const FrameVisitor& visit) {
  const auto T_world_folder = WorldOf(options.up.empty() ? folder.up : options.up);
  if (!T_world_folder) return tl::unexpected(T_world_folder.error());
  const double unit_m = options.depth_unit_m > 0 ? options.depth_unit_m : folder.depth_unit_m;
  const Pose T_base_camera = MountingOf(folder, options);
  Recording recording{folder.format, true, {}};
  RecordingCounts& counts = recording.counts;
  std::optional<Rig> rig;
  for (const FolderFrame& frame : folder.frames) {
    ++counts.depth_images;
    if (frame.colour.empty()) {
      ++counts.without_colour;
      continue;
    }
    const PoseAt pose = folder.poses.At(frame.time_ns, folder.limits);
    if (!IsUsable(pose, counts)) continue;
    auto images = LoadImages(frame, unit_m);
    if (!images && options.skip_damaged) {
      ++counts.damaged;
      continue;
    }
    if (!images) return tl::unexpected(images.error());
    if (!rig) {
      const auto made = RigOf(folder, options, *images);
      if (!made) return tl::unexpected(made.error());
      rig = *made;
    }
    auto obs = MakeObservation(*rig, std::move(*images),
                               *T_world_folder * pose.pose * T_base_camera, frame.depth.string());
    if (!obs) return tl::unexpected(obs.error());
    obs->time_ns = frame.time_ns;
    ++counts.frames;
    const double share =
        static_cast<double>(counts.depth_images) / static_cast<double>(folder.frames.size());
    if (auto ok = visit(recording, {std::move(*obs), share}); !ok)
      return tl::unexpected(ok.error());
  }
  if (auto ok = CheckFrames(counts, folder.path.string()); !ok) return tl::unexpected(ok.error());
  return recording;
}

}  // namespace crossnav::recordings
