// SPDX-License-Identifier: MIT
#include "crossnav/trace/foxglove.h"

#include <array>

#include "crossnav/trace/labelled_boxes.h"
#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

using Eigen::Quaterniond;
using geometry::VoxelState;

// NumericType of proto/foxglove.proto.
constexpr int kUint8 = 1, kFloat32 = 7;

ProtoMessage Time(std::uint64_t ns) {
  return ProtoMessage().Varint(1, ns / 1'000'000'000).Varint(2, ns % 1'000'000'000);
}

/// Vector3 and Point3 have the same fields.
ProtoMessage Xyz(const Vector3d& v) {
  return ProtoMessage().Double(1, v.x()).Double(2, v.y()).Double(3, v.z());
}

ProtoMessage Rotation(Quaterniond q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();  // canonical sign: q and -q are the same rotation
  return ProtoMessage().Double(1, q.x()).Double(2, q.y()).Double(3, q.z()).Double(4, q.w());
}

ProtoMessage PoseAt(const Vector3d& p, const Quaterniond& q = Quaterniond::Identity()) {
  return ProtoMessage().Message(1, Xyz(p)).Message(2, Rotation(q));
}

ProtoMessage Colour(const Rgb8& c, double alpha) {
  return ProtoMessage()
      .Double(1, c.r / 255.0)
      .Double(2, c.g / 255.0)
      .Double(3, c.b / 255.0)
      .Double(4, alpha);
}

/// CubePrimitive and SpherePrimitive have the same fields.
ProtoMessage Solid(const Vector3d& centre, const Vector3d& size, const ProtoMessage& colour) {
  return ProtoMessage().Message(1, PoseAt(centre)).Message(2, Xyz(size)).Message(3, colour);
}

ProtoMessage Line(const std::vector<Vector3d>& points, double thickness_m,
                  const ProtoMessage& colour) {
  ProtoMessage line;
  line.Varint(1, 0).Message(2, PoseAt(Vector3d::Zero())).Double(3, thickness_m);
  for (const Vector3d& p : points) line.Message(5, Xyz(p));
  return line.Message(6, colour);
}

ProtoMessage Label(const Vector3d& p, const std::string& text, const ProtoMessage& colour) {
  return ProtoMessage()
      .Message(1, PoseAt(p))
      .Varint(2, 1)   // faces the viewer
      .Double(3, 14)  // chosen: [px]
      .Varint(4, 1)   // at any distance
      .Message(5, colour)
      .Bytes(6, text);
}

ProtoMessage Entity(std::uint64_t time_ns, std::string_view id) {
  return ProtoMessage().Message(1, Time(time_ns)).Bytes(2, "world").Bytes(3, id);
}

Rgb8 ColourOfKind(std::string_view kind) {
  if (kind == "live_poi") return {214, 51, 108};
  if (kind == "history_poi") return {156, 54, 181};
  if (kind == "traversable_frontier") return {28, 126, 214};
  if (kind == "descend_frontier") return {232, 89, 12};
  if (kind == "ascent_frontier" || kind == "stair_frontier") return {245, 159, 0};
  return {90, 90, 90};
}

}  // namespace

Rgb8 ColourOf(VoxelState state) {
  switch (state) {
    case VoxelState::kUnknown:
      return {0, 0, 0};
    case VoxelState::kOccupied:
      return {201, 205, 212};
    case VoxelState::kTraversable:
      return {120, 190, 140};
    case VoxelState::kTraversableStair:
      return {250, 214, 120};
    case VoxelState::kTraversableFake:
      return {200, 220, 240};
    case VoxelState::kStair:
      return {245, 159, 0};
    case VoxelState::kStairExpanded:
      return {240, 120, 40};
    case VoxelState::kFakeStair:
      return {190, 75, 150};
  }
  return {};
}

std::string EncodeTransform(std::uint64_t time_ns, std::string_view child,
                            const Pose& T_world_child) {
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Bytes(2, "world")
      .Bytes(3, child)
      .Message(4, Xyz(T_world_child.translation()))
      .Message(5, Rotation(Quaterniond(T_world_child.linear())))
      .Take();
}

std::string EncodePose(std::uint64_t time_ns, const AgentPose& agent) {
  const Quaterniond q(Eigen::AngleAxisd(agent.yaw_rad, Vector3d::UnitZ()));
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Bytes(2, "world")
      .Message(3, PoseAt(agent.p_world, q))
      .Take();
}

std::string EncodeImage(std::uint64_t time_ns, std::string_view bytes, std::string_view format) {
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Bytes(2, bytes)
      .Bytes(3, format)
      .Bytes(4, "camera")
      .Take();
}

std::string EncodeDepth(std::uint64_t time_ns, const Image<std::uint16_t>& depth_mm) {
  const auto width = static_cast<std::uint32_t>(depth_mm.width);
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Fixed32(2, width)
      .Fixed32(3, static_cast<std::uint32_t>(depth_mm.height))
      .Bytes(4, "16UC1")
      .Fixed32(5, 2 * width)
      .Bytes(6, {reinterpret_cast<const char*>(depth_mm.data.data()), 2 * depth_mm.data.size()})
      .Bytes(7, "camera")
      .Take();
}

std::string EncodeCalibration(std::uint64_t time_ns, const CameraIntrinsics& camera, int factor) {
  const double f = factor;
  const double fx = camera.fx / f, fy = camera.fy / f;
  // A block's centre is at ((factor - 1) / 2) of its pixels.
  const double cx = (camera.cx - (f - 1) / 2) / f, cy = (camera.cy - (f - 1) / 2) / f;
  const std::array<double, 5> D{};
  const std::array<double, 9> K = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  const std::array<double, 9> R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<double, 12> P = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Fixed32(2, static_cast<std::uint32_t>(camera.width_px / factor))
      .Fixed32(3, static_cast<std::uint32_t>(camera.height_px / factor))
      .Bytes(4, "plumb_bob")
      .Doubles(5, D.data(), D.size())
      .Doubles(6, K.data(), K.size())
      .Doubles(7, R.data(), R.size())
      .Doubles(8, P.data(), P.size())
      .Bytes(9, "camera")
      .Take();
}

std::string EncodeLog(std::uint64_t time_ns, std::string_view name, std::string_view message) {
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Varint(2, 2)  // INFO
      .Bytes(3, message)
      .Bytes(4, name)
      .Take();
}

std::string EncodeCloud(std::uint64_t time_ns, const std::vector<ColouredVoxel>& voxels,
                        double voxel_m) {
  std::string data;
  for (const ColouredVoxel& v : voxels) {
    const Eigen::Vector3f p = geometry::CenterOf(v.key, voxel_m).cast<float>();
    for (int axis = 0; axis < 3; ++axis) AppendRaw(data, p[axis]);
    const Rgb8 c = ColourOf(v.state);
    for (const std::uint8_t byte : {c.r, c.g, c.b, std::uint8_t{255}}) AppendRaw(data, byte);
    AppendRaw(data, static_cast<std::uint8_t>(v.state));
  }
  const auto field = [](std::string_view name, std::uint32_t offset, int type) {
    return ProtoMessage().Bytes(1, name).Fixed32(2, offset).Varint(3, type);
  };
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Bytes(2, "world")
      .Message(3, PoseAt(Vector3d::Zero()))
      .Fixed32(4, 17)
      .Message(5, field("x", 0, kFloat32))
      .Message(5, field("y", 4, kFloat32))
      .Message(5, field("z", 8, kFloat32))
      .Message(5, field("red", 12, kUint8))
      .Message(5, field("green", 13, kUint8))
      .Message(5, field("blue", 14, kUint8))
      .Message(5, field("alpha", 15, kUint8))
      .Message(5, field("state", 16, kUint8))
      .Bytes(6, data)
      .Take();
}

std::string EncodePlan(std::uint64_t time_ns, const StepTrace& trace) {
  ProtoMessage plan = Entity(time_ns, "plan");
  const Rgb8 white{255, 255, 255};
  for (const CandidateTrace& c : trace.candidates) {
    const double size_m = c.is_target ? 0.35 : 0.2;
    const auto colour = Colour(ColourOfKind(c.kind), c.is_reachable ? 0.9 : 0.35);
    plan.Message(9, Solid(c.p_nav_world, Vector3d::Constant(size_m), colour));
  }
  if (!trace.path_world.empty()) {
    plan.Message(11, Line(trace.path_world, 0.05, Colour({18, 184, 134}, 1)));
  }
  for (const CandidateTrace& c : trace.candidates) {
    if (!c.is_target) continue;
    plan.Message(13, Label(c.p_nav_world + Vector3d(0, 0, 0.4), c.kind, Colour(white, 1)));
  }
  return ProtoMessage().Message(2, plan).Take();
}

std::string EncodeFlights(std::uint64_t time_ns,
                          const std::vector<geometry::StairFlight>& flights) {
  ProtoMessage entity = Entity(time_ns, "flights");
  const Rgb8 brown{95, 58, 18};
  for (const geometry::StairFlight& flight : flights) {
    const bool is_walked = flight.IsWalked();
    entity.Message(
        11, Line(flight.steps_world, is_walked ? 0.06 : 0.02, Colour(brown, is_walked ? 1 : 0.7)));
  }
  for (const geometry::StairFlight& flight : flights) {
    const std::string text =
        "flight " + std::to_string(flight.id) + (flight.IsWalked() ? ", walked" : ", seen");
    entity.Message(
        13, Label(flight.p_top_world + Vector3d(0, 0, 0.4), text, Colour({255, 255, 255}, 1)));
  }
  return ProtoMessage().Message(2, entity).Take();
}

std::string EncodeGoals(std::uint64_t time_ns, const std::vector<GoalInstance>& goals) {
  ProtoMessage entity = Entity(time_ns, "goals");
  const auto colour = Colour({47, 158, 68}, 0.25);
  for (const GoalInstance& g : goals) {
    entity.Message(8, Solid(g.box.Center(), g.box.max - g.box.min, colour));
  }
  for (const GoalInstance& g : goals) {
    const Vector3d top(g.box.Center().x(), g.box.Center().y(), g.box.max.z() + 0.1);
    entity.Message(13, Label(top, g.goal, Colour({255, 255, 255}, 1)));
  }
  return ProtoMessage().Message(2, entity).Take();
}

std::string EncodeBoxes(std::uint64_t time_ns, std::string_view name,
                        const std::vector<LabelledBox>& boxes,
                        const std::vector<PlaceLine>& lines) {
  ProtoMessage entity = Entity(time_ns, name);
  for (const LabelledBox& b : boxes)
    entity.Message(8, Solid(b.box.Center(), b.box.max - b.box.min, Colour(b.colour, b.alpha)));
  for (const PlaceLine& line : lines)
    entity.Message(11, Line({line.from, line.to}, 0.03, Colour(line.colour, 1)));
  for (const LabelledBox& b : boxes) {
    const Vector3d top(b.box.Center().x(), b.box.Center().y(), b.box.max.z() + 0.1);
    if (!b.label.empty()) entity.Message(13, Label(top, b.label, Colour({255, 255, 255}, 1)));
  }
  return ProtoMessage().Message(2, entity).Take();
}

std::string EncodeVoxelChanges(std::uint64_t time_ns, double voxel_m, std::size_t count,
                               std::string_view runs) {
  return ProtoMessage()
      .Message(1, Time(time_ns))
      .Double(2, voxel_m)
      .Varint(3, count)
      .Bytes(4, runs)
      .Take();
}

}  // namespace crossnav::trace
