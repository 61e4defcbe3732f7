// SPDX-License-Identifier: MIT
#include "crossnav/trace/replay_writer.h"

#include <algorithm>
#include <unordered_map>

#include "crossnav/core/png_image.h"
#include "crossnav/trace/foxglove.h"
#include "crossnav/trace/mcap_writer.h"
#include "crossnav/trace/preview.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/replay_schemas.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/voxel_codec.h"

namespace crossnav::trace {
namespace {

using geometry::VoxelKey;
using geometry::VoxelState;

struct Channels {
  std::uint16_t tf = 0, pose = 0, image = 0, calibration = 0, depth = 0;
  std::uint16_t step = 0, changes = 0, cloud = 0, plan = 0, goals = 0, log = 0, stage = 0;
  std::uint16_t boxes = 0, maps = 0, flights = 0, graph = 0;
};

Channels AddChannels(McapWriter& mcap) {
  const std::string descriptors(ReplayDescriptors());
  const auto proto = [&](const char* topic, const char* schema) {
    return mcap.AddChannel(topic, mcap.AddSchema(schema, "protobuf", descriptors), "protobuf");
  };
  const auto json = [&](const char* topic, const char* name, std::string_view schema) {
    return mcap.AddChannel(topic, mcap.AddSchema(name, "jsonschema", std::string(schema)), "json");
  };
  Channels c;
  c.tf = proto("/tf", "foxglove.FrameTransform");
  c.pose = proto("/agent/pose", "foxglove.PoseInFrame");
  c.image = proto("/camera/image", "foxglove.CompressedImage");
  c.calibration = proto("/camera/calibration", "foxglove.CameraCalibration");
  c.depth = proto("/camera/depth", "foxglove.RawImage");
  c.step = json("/agent/step", "crossnav.Step", StepJsonSchema());
  c.changes = proto("/map/voxel_changes", "crossnav.VoxelChanges");
  c.cloud = proto("/map/voxels", "foxglove.PointCloud");
  c.plan = proto("/agent/plan", "foxglove.SceneUpdate");
  c.flights = proto("/map/flights", "foxglove.SceneUpdate");
  c.goals = proto("/episode/goals", "foxglove.SceneUpdate");
  c.log = proto("/log", "foxglove.Log");
  c.stage = json("/episode/stage", "crossnav.Stage", StageJsonSchema());
  c.boxes = json("/perception/boxes", "crossnav.Sight", SightJsonSchema());
  c.maps = proto("/perception/maps", "foxglove.CompressedImage");
  c.graph = json("/map/graph", "crossnav.Graph", GraphJsonSchema());
  return c;
}

/// Pose of the frame "agent": x ahead, z up, at the foot.
Pose PoseOf(const AgentPose& agent) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(agent.yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = agent.p_world;
  return T;
}

}  // namespace

struct ReplayWriter::Impl {
  McapWriter mcap;
  ReplayInfo info;
  ReplayOptions options;
  Channels channels;
  int last_step = -1;
  std::string last_mode, last_reason;
  /// Surface voxels so far, for whole clouds; sorted before writing.
  std::unordered_map<VoxelKey, VoxelState, geometry::VoxelKeyHash> surface;
  bool is_cloud_stale = false;

  void Put(std::uint16_t channel, std::uint64_t time_ns, const std::string& data) {
    mcap.Write(channel, time_ns, data);
  }

  void PutImages(std::uint64_t t, const Observation& obs) {
    if (!obs.rgb.empty()) {
      const int factor = ShrinkFactor(std::max(obs.rgb.width, obs.rgb.height), options.image_px);
      Put(channels.image, t,
          EncodeImage(t, EncodeJpeg(Shrink(obs.rgb, factor), options.jpeg_quality), "jpeg"));
      Put(channels.calibration, t, EncodeCalibration(t, obs.camera, factor));
    }
    if (!obs.depth_m.empty()) {
      const int factor =
          ShrinkFactor(std::max(obs.depth_m.width, obs.depth_m.height), options.depth_px);
      Put(channels.depth, t, EncodeDepth(t, ShrinkDepthMm(obs.depth_m, factor)));
    }
  }

  void PutSight(std::uint64_t t, const Sight& sight) {
    if (sight.width_px <= 0 || sight.height_px <= 0) return;
    Put(channels.boxes, t, ToJson(NoteOf(sight)));
    Put(channels.maps, t, EncodeImage(t, EncodePng(MapsOf(sight, options.maps_px)), "png"));
  }

  void PutMap(std::uint64_t t, const StepTrace& trace) {
    const auto& changes = trace.voxel_changes;
    Put(channels.changes, t,
        EncodeVoxelChanges(t, info.voxel_m, changes.size(), EncodeVoxelRuns(changes)));
    if (options.cloud_every_steps <= 0) return;
    for (const auto& change : changes) {
      if (geometry::IsSurface(change.voxel.state)) {
        surface[change.key] = change.voxel.state;
      } else {
        surface.erase(change.key);
      }
    }
    is_cloud_stale = is_cloud_stale || !changes.empty();
    if (trace.step % options.cloud_every_steps == 0) PutCloud(t);
  }

  void PutCloud(std::uint64_t t) {
    if (!is_cloud_stale) return;
    std::vector<ColouredVoxel> voxels;
    voxels.reserve(surface.size());
    for (const auto& [key, state] : surface) voxels.push_back({key, state});
    std::sort(voxels.begin(), voxels.end(),
              [](const ColouredVoxel& a, const ColouredVoxel& b) { return a.key < b.key; });
    Put(channels.cloud, t, EncodeCloud(t, voxels, info.voxel_m));
    is_cloud_stale = false;
  }

  void PutLog(std::uint64_t t, const StepTrace& trace) {
    if (trace.mode != last_mode || trace.reason != last_reason) {
      Put(channels.log, t, EncodeLog(t, "mode", trace.mode + ": " + trace.reason));
      last_mode = trace.mode;
      last_reason = trace.reason;
    }
    for (const std::string& event : trace.events)
      Put(channels.log, t, EncodeLog(t, "event", event));
  }
};

ReplayWriter::ReplayWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ReplayWriter::~ReplayWriter() = default;
ReplayWriter::ReplayWriter(ReplayWriter&&) noexcept = default;
ReplayWriter& ReplayWriter::operator=(ReplayWriter&&) noexcept = default;

Result<ReplayWriter> ReplayWriter::Open(const std::filesystem::path& path, const ReplayInfo& info,
                                        const ReplayOptions& options) {
  McapOptions mcap_options;
  mcap_options.library = "crossnav " + info.version;
  auto mcap = McapWriter::Open(path, mcap_options);
  if (!mcap) return tl::unexpected(mcap.error());
  mcap->AddMetadata("crossnav.replay", {{"info", ToJson(info)}});
  const Channels channels = AddChannels(*mcap);
  auto impl = std::make_unique<Impl>(
      Impl{std::move(*mcap), info, options, channels, -1, {}, {}, {}, false});
  if (!info.goal_instances.empty()) {
    impl->Put(channels.goals, 0, EncodeGoals(0, info.goal_instances));
  }
  return ReplayWriter(std::move(impl));
}

Result<void> ReplayWriter::Write(const ReplayFrame& frame) {
  Impl& w = *impl_;
  const StepTrace& trace = frame.trace;
  if (trace.step <= w.last_step) {
    return Fail(ErrorCode::kInvalid, "a step of a replay must come after the one before it",
                "step " + std::to_string(trace.step));
  }
  w.last_step = trace.step;
  const std::uint64_t t = static_cast<std::uint64_t>(trace.step) * kStepNs;
  w.Put(w.channels.tf, t, EncodeTransform(t, "agent", PoseOf(trace.agent)));
  w.Put(w.channels.tf, t, EncodeTransform(t, "camera", trace.T_world_camera));
  w.Put(w.channels.pose, t, EncodePose(t, trace.agent));
  if (frame.observation != nullptr) w.PutImages(t, *frame.observation);
  if (frame.sight != nullptr) w.PutSight(t, *frame.sight);
  w.Put(w.channels.step, t, ToJson(trace, VoxelText::kOmit));
  w.PutMap(t, trace);
  w.Put(w.channels.plan, t, EncodePlan(t, trace));
  if (trace.flights) w.Put(w.channels.flights, t, EncodeFlights(t, *trace.flights));
  if (frame.graph != nullptr) w.Put(w.channels.graph, t, ToJson(*frame.graph));
  w.PutLog(t, trace);
  return w.mcap.EndGroup();
}

Result<void> ReplayWriter::WriteStage(const StageResult& stage) {
  Impl& w = *impl_;
  const std::uint64_t t = static_cast<std::uint64_t>(std::max(0, w.last_step)) * kStepNs;
  w.Put(w.channels.stage, t, ToJson(stage));
  w.Put(w.channels.log, t, EncodeLog(t, "stage", stage.goal + ": " + stage.outcome));
  return w.mcap.EndGroup();
}

Result<void> ReplayWriter::Close() {
  Impl& w = *impl_;
  if (w.last_step >= 0 && w.options.cloud_every_steps > 0) {
    w.PutCloud(static_cast<std::uint64_t>(w.last_step) * kStepNs);
  }
  return w.mcap.Close();
}

}  // namespace crossnav::trace
