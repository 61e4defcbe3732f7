// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/store/map_file.h"
#include "eval_progress.h"
#include "goal_sightings.h"
#include "map_build.h"
#include "network_choice.h"
#include "perception_source.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
using recordings::RecordingCounts;

std::optional<recordings::Pinhole> PinholeOf(const std::vector<double>& typed) {
  if (typed.empty()) return std::nullopt;
  return recordings::Pinhole{typed[0], typed[1], typed[2], typed[3]};
}

Result<std::optional<Pose>> PoseTyped(const std::vector<double>& typed, const char* option) {
  if (typed.empty()) return std::optional<Pose>();
  const Eigen::Quaterniond q(typed[6], typed[3], typed[4], typed[5]);
  if (!(std::abs(q.norm() - 1) < 0.01))
    return Fail(ErrorCode::kInvalid, "its last four numbers must be a unit quaternion", option);
  return std::optional<Pose>(
      recordings::PoseOf(Vector3d(typed[0], typed[1], typed[2]), q.normalized()));
}

Result<recordings::RecordingOptions> OptionsOf(const MapBuildOptions& options) {
  recordings::RecordingOptions recording = options.recording;
  recording.colour = PinholeOf(options.intrinsics);
  recording.depth = PinholeOf(options.depth_intrinsics);
  for (const auto& pinhole : {recording.colour, recording.depth})
    if (pinhole && !(pinhole->fx > 0 && pinhole->fy > 0))
      return Fail(ErrorCode::kInvalid, "focal lengths must be positive", "--intrinsics");
  auto extrinsics = PoseTyped(options.extrinsics, "--extrinsics");
  if (!extrinsics) return tl::unexpected(extrinsics.error());
  recording.T_colour_depth = *extrinsics;
  auto mount = PoseTyped(options.mount, "--mount");
  if (!mount) return tl::unexpected(mount.error());
  recording.T_base_camera = *mount;
  recording.poses.gap_ns = std::llround(options.pose_gap_s * 1e9);
  return recording;
}

bool IsByNetworks(const MapBuildOptions& options) {
  if (!options.perception.empty()) return options.perception == "networks";
  return !options.goal.empty() || !options.networks.empty();
}

Result<evaluation::RunConfig> ConfigOf(const MapBuildOptions& options,
                                       const CommonOptions& common) {
  CommonOptions all = common;
  if (IsByNetworks(options)) {
    all.overrides.push_back("eval.perception=networks");
    return LoadWithNetworks(all, options.networks);
  }
  if (!options.goal.empty()) {
    return Fail(ErrorCode::kInvalid,
                "a map without features answers nothing; leave out --perception none", "--goal");
  }
  return LoadConfig(all);
}

/// Checks, before the work, that the output can be written; only maps are replaced.
Result<void> CheckOut(const std::string& out) {
  if (auto ok = evaluation::CheckOutputFile(out, "--out"); !ok) return ok;
  std::error_code error;
  if (!std::filesystem::exists(out, error)) return {};
  const auto header = store::ReadMapHeader(out);
  if (!header) return tl::unexpected(header.error());
  return {};
}

/// Map and memory under construction.
class Builder {
 public:
  Builder(const evaluation::RunConfig& config, perception::PerceptionSuite* suite,
          GoalSightings* sightings, Console& console)
      : sightings_(sightings),
        encoder_(suite != nullptr ? suite->encoder.get() : nullptr),
        console_(console),
        map_(config.agent.map),
        memory_(config.agent.fusion, config.agent.map.voxel_m),
        start_ms_(evaluation::WallMs()) {}

  Result<void> Add(const recordings::Recording& so_far, const recordings::RecordedFrame& frame) {
    const Observation& obs = frame.obs;
    if (encoder_ != nullptr && !so_far.has_colour)
      return Fail(ErrorCode::kInvalid, "networks need colour images, and there are none",
                  "--perception");
    const auto& ends = map_.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    map_.UpdateStates();
    if (encoder_ != nullptr) {
      const auto grid = encoder_->EncodeImage(obs);
      if (!grid) return tl::unexpected(grid.error());
      memory_.FuseRuns(ends.runs(), obs.depth_m, obs.camera, obs.T_world_camera,
                       {grid->rows, grid->cols, grid->dim, grid->data});
    }
    if (sightings_ != nullptr)
      if (auto ok = sightings_->Look(obs); !ok) return ok;
    Show(so_far.counts, frame.share_done);
    return {};
  }

  Result<store::SaveReport> Save(const std::string& path, const std::string& encoder,
                                 const std::string& frame) const {
    store::SaveInfo info;
    info.encoder_name = encoder;
    info.frame = frame;
    return store::SaveMemory(path, map_, memory_, info);
  }
  const geometry::VoxelMap& map() const { return map_; }
  const memory::SemanticMemory& memory() const { return memory_; }

 private:
  void Show(const RecordingCounts& counts, double share) {
    const double seconds = std::max(1e-3, (evaluation::WallMs() - start_ms_) * 1e-3);
    console_.Progress(fmt::format("{} frames | {:.0f} % | {:.1f} per second | {} left",
                                  counts.frames, 100 * share,
                                  static_cast<double>(counts.frames) / seconds,
                                  DurationText(seconds / std::max(share, 1e-6) * (1 - share))));
  }

  GoalSightings* sightings_;
  perception::DenseEncoder* encoder_;
  Console& console_;
  geometry::VoxelMap map_;
  memory::SemanticMemory memory_;
  double start_ms_;
};

/// Text of the detector's places for the goal.
std::string GoalText(const GoalSightings& sightings, const std::string& goal,
                     const std::string& detector) {
  if (!sightings.is_known())
    return fmt::format("\"{}\" is no class of {}: the memory alone answers\n", goal, detector);
  const std::size_t count = sightings.Places().size();
  if (count == 0) return fmt::format("\"{}\": none found by {}\n", goal, detector);
  return fmt::format("\"{}\": {} found by {}\n{}", goal, count, detector, sightings.PlacesText());
}

/// Whether the goal is there: by the detector where it has the class, else by the memory.
struct GoalVerdict {
  std::string verdict, by;
};

GoalVerdict VerdictOf(const GoalSightings& sightings, const std::string& by_memory) {
  if (!sightings.is_known()) return {by_memory, "memory"};
  const auto verdict =
      sightings.Places().empty() ? memory::Verdict::kAbsent : memory::Verdict::kPresent;
  return {std::string(memory::NameOf(verdict)), "detector"};
}

Json GoalJson(const GoalSightings& sightings, const std::string& detector) {
  return {{"detector", detector},
          {"is_class", sightings.is_known()},
          {"places", Json::parse(sightings.PlacesJson())}};
}

std::string TextOf(const recordings::Recording& recording) {
  const RecordingCounts& c = recording.counts;
  return fmt::format(
      "{}: {} of {} depth images mapped{}\n  left out: {} without a colour image, {} without a "
      "pose, {} in a jump of the pose, {} damaged{}\n",
      recording.format, c.frames, c.depth_images, recording.has_colour ? "" : " (no colour)",
      c.without_colour, c.without_pose, c.jumps, c.damaged,
      c.is_torn ? "; the recording has no end" : "");
}

Json JsonOf(const recordings::Recording& recording) {
  const RecordingCounts& c = recording.counts;
  return {{"format", recording.format},
          {"has_colour", recording.has_colour},
          {"depth_images", c.depth_images},
          {"frames", c.frames},
          {"without_colour", c.without_colour},
          {"without_pose", c.without_pose},
          {"jumps", c.jumps},
          {"damaged", c.damaged},
          {"is_torn", c.is_torn}};
}

}  // namespace

Result<void> MapBuild(const MapBuildOptions& options, const CommonOptions& common,
                      Console& console) {
  const auto recording_options = OptionsOf(options);
  if (!recording_options) return tl::unexpected(recording_options.error());
  const auto config = ConfigOf(options, common);
  if (!config) return tl::unexpected(config.error());
  if (auto ok = CheckOut(options.out); !ok) return ok;
  std::optional<perception::PerceptionSuite> suite;
  std::string encoder;
  if (IsByNetworks(options)) {
    console.Log(NetworksText(config->networks));
    const auto source = PerceptionSource::Read(*config);
    if (!source) return tl::unexpected(source.error());
    auto made = source->MakeSuite();
    if (!made || !*made)
      return made ? tl::unexpected(made->error()) : Fail(ErrorCode::kInvalid, "no networks");
    suite = std::move(**made);
    encoder = source->EncoderName();
  }
  std::optional<GoalSightings> sightings;
  if (!options.goal.empty()) sightings.emplace(config->agent, *suite, options.goal);
  Builder builder(*config, suite ? &*suite : nullptr, sightings ? &*sightings : nullptr, console);
  const auto recording = recordings::ReadRecording(
      options.from, *recording_options,
      [&](const auto& so_far, const auto& frame) { return builder.Add(so_far, frame); });
  if (!recording) return tl::unexpected(recording.error());
  console.EndProgress();
  const std::filesystem::path from =
      std::filesystem::path(options.from) / "";  // accepts a trailing slash
  const auto saved = builder.Save(options.out, encoder,
                                  recording->format + " " + from.parent_path().filename().string());
  if (!saved) return tl::unexpected(saved.error());
  const geometry::MapStats stats = builder.map().Stats();
  console.Print(TextOf(*recording));
  console.Print(fmt::format("{}: revision {}, {} known, {} occupied, {} traversable, {} features\n",
                            options.out, saved->revision, stats.known, stats.occupied,
                            stats.traversable, builder.memory().Size()));
  Json document = {{"file", options.out},
                   {"recording", JsonOf(*recording)},
                   {"revision", saved->revision},
                   {"known", stats.known},
                   {"occupied", stats.occupied},
                   {"traversable", stats.traversable},
                   {"feature_rows", builder.memory().Size()}};
  if (!options.goal.empty()) {
    MapOptions query;
    query.file = options.out;
    query.text = options.goal;
    query.top = options.top;
    const auto answer = AnswerQuery(query, *config, console);
    if (!answer) return tl::unexpected(answer.error());
    document["detected"] = GoalJson(*sightings, config->networks.detector);
    document["answer"] = Json::parse(answer->json);
    const auto by_memory = document["answer"].value("verdict", "unknown");
    const GoalVerdict verdict = VerdictOf(*sightings, by_memory);
    document["verdict"] = verdict.verdict;
    document["verdict_by"] = verdict.by;
    if (verdict.by == "detector")
      console.Print(fmt::format("\"{}\" is {}, says the detector {}\n", options.goal,
                                verdict.verdict, config->networks.detector));
    console.Print(GoalText(*sightings, options.goal, config->networks.detector) +
                  "by the memory, " + answer->text);
  }
  console.Document(document);
  return {};
}

}  // namespace crossnav::app
