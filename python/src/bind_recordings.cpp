// SPDX-License-Identifier: MIT
// Recordings of real sensors: read_recording.
#include "crossnav/recordings/recording.h"

#include <cmath>

#include "common.h"

namespace crossnav::python {
namespace {

using recordings::RecordedFrame;
using recordings::Recording;
using recordings::RecordingOptions;
using Numbers4 = std::optional<std::array<double, 4>>;

std::optional<recordings::Pinhole> PinholeOf(const Numbers4& k, const char* name) {
  if (!k) return std::nullopt;
  const auto& [fx, fy, cx, cy] = *k;
  if (!(fx > 0 && fy > 0) || !std::isfinite(fx + fy + cx + cy))
    Raise(ErrorCode::kInvalid, "must be finite fx, fy, cx, cy with positive focal lengths", name);
  return recordings::Pinhole{fx, fy, cx, cy};
}

nb::dict ToDict(const Recording& recording) {
  const recordings::RecordingCounts& counts = recording.counts;
  nb::dict out;
  out["format"] = recording.format;
  out["has_colour"] = recording.has_colour;
  out["depth_images"] = counts.depth_images;
  out["frames"] = counts.frames;
  out["without_colour"] = counts.without_colour;
  out["without_pose"] = counts.without_pose;
  out["jumps"] = counts.jumps;
  out["damaged"] = counts.damaged;
  out["is_torn"] = counts.is_torn;
  return out;
}

nb::dict Read(const PathIn& path, const nb::callable& visit, const Numbers4& intrinsics,
              const Numbers4& depth_intrinsics, const std::string& up, double match_s,
              double pose_gap_s, bool skip_damaged, const std::string& colour_topic,
              const std::string& depth_topic, const std::string& pose_topic,
              const std::string& world_frame) {
  RecordingOptions options;
  options.colour = PinholeOf(intrinsics, "intrinsics");
  options.depth = PinholeOf(depth_intrinsics, "depth_intrinsics");
  if (!(match_s >= 0 && match_s < 1e6)) Raise(ErrorCode::kInvalid, "must be seconds", "match_s");
  if (!(pose_gap_s >= 0 && pose_gap_s < 1e6))
    Raise(ErrorCode::kInvalid, "must be seconds", "pose_gap_s");
  if (!up.empty() && up != "z" && up != "y" && up != "-y")
    Raise(ErrorCode::kInvalid, "must be z, y or -y", "up");
  options.up = up;
  options.match_s = match_s;
  options.poses.gap_ns = std::llround(pose_gap_s * 1e9);
  options.skip_damaged = skip_damaged;
  options.bag = {colour_topic, depth_topic, pose_topic, world_frame};
  const Recording recording = [&] {
    const nb::gil_scoped_release others_run;
    return Unwrap(recordings::ReadRecording(
        path.path, options,
        [&](const Recording& /*so_far*/, const RecordedFrame& frame) -> Result<void> {
          const nb::gil_scoped_acquire python;
          visit(nb::cast(Observation(frame.obs)), frame.share_done);
          return {};
        }));
  }();
  return ToDict(recording);
}

}  // namespace

void BindRecordings(nb::module_& m) {
  m.def(
      "read_recording", &Read, "path"_a, "visit"_a, nb::kw_only(), "intrinsics"_a = nb::none(),
      "depth_intrinsics"_a = nb::none(), "up"_a = "", "match_s"_a = RecordingOptions().match_s,
      "pose_gap_s"_a = 0.5, "skip_damaged"_a = false, "colour_topic"_a = "", "depth_topic"_a = "",
      "pose_topic"_a = "", "world_frame"_a = "",
      nb::sig("def read_recording(path: str | os.PathLike[str], visit: "
              "collections.abc.Callable[[Observation, float], typing.Any], *, intrinsics: "
              "tuple[float, float, float, float] | None = None, depth_intrinsics: tuple[float, "
              "float, float, float] | None = None, up: str = '', match_s: float = 0.02, "
              "pose_gap_s: float = 0.5, skip_damaged: bool = False, colour_topic: str = '', "
              "depth_topic: str = '', pose_topic: str = '', world_frame: str = '') -> dict[str, "
              "typing.Any]"),
      "Reads a TUM RGB-D or 7-Scenes folder, numbered frames or a ROS 2 bag (MCAP) and calls "
      "visit(observation, share_done) for each frame, in order of time; an exception in it ends "
      "the reading. intrinsics: (fx, fy, cx, cy) [px] instead of the recording's own. Returns what "
      "was read and what was left out, and why.");
}

}  // namespace crossnav::python
