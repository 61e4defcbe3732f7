// SPDX-License-Identifier: MIT
// Our hand-written encoding, read by Google's library through the descriptors that a replay
// carries: a message that parses without unknown fields has the right numbers and wire types.
#include "crossnav/trace/foxglove.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/trace/proto_wire.h"
#include "crossnav/trace/replay_schemas.h"

namespace crossnav::trace {
namespace {

namespace pb = google::protobuf;

class Foxglove : public testing::Test {
 protected:
  void SetUp() override {
    pb::FileDescriptorSet files;
    const std::string_view bytes = ReplayDescriptors();
    ASSERT_TRUE(files.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
    for (const auto& file : files.file()) ASSERT_NE(pool_.BuildFile(file), nullptr);
  }

  /// Text form of the message, or its error.
  std::string Parse(const std::string& type, const std::string& bytes) {
    const pb::Descriptor* descriptor = pool_.FindMessageTypeByName(type);
    if (descriptor == nullptr) return "no type " + type;
    message_.reset(factory_.GetPrototype(descriptor)->New());
    if (!message_->ParseFromString(bytes)) return "does not parse";
    return HasUnknown(*message_) ? "has unknown fields" : message_->ShortDebugString();
  }

  static bool HasUnknown(const pb::Message& message) {
    const pb::Reflection* reflection = message.GetReflection();
    if (!reflection->GetUnknownFields(message).empty()) return true;
    std::vector<const pb::FieldDescriptor*> fields;
    reflection->ListFields(message, &fields);
    for (const auto* field : fields) {
      if (field->cpp_type() != pb::FieldDescriptor::CPPTYPE_MESSAGE) continue;
      const int n = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
      for (int i = 0; i < n; ++i) {
        const pb::Message& inner = field->is_repeated()
                                       ? reflection->GetRepeatedMessage(message, field, i)
                                       : reflection->GetMessage(message, field);
        if (HasUnknown(inner)) return true;
      }
    }
    return false;
  }

  const pb::FieldDescriptor* Field(const char* name) const {
    return message_->GetDescriptor()->FindFieldByName(name);
  }

  pb::DescriptorPool pool_;
  pb::DynamicMessageFactory factory_{&pool_};
  std::unique_ptr<pb::Message> message_;
};

TEST_F(Foxglove, TransformAndPoseParse) {
  Pose T = Pose::Identity();
  T.translation() = Vector3d(1, 2, 3);
  EXPECT_EQ(Parse("foxglove.FrameTransform", EncodeTransform(1'500'000'000, "camera", T)),
            R"(timestamp { seconds: 1 nanos: 500000000 } parent_frame_id: "world" )"
            R"(child_frame_id: "camera" translation { x: 1 y: 2 z: 3 } )"
            R"(rotation { w: 1 })");
  AgentPose agent;
  agent.p_world = {4, 5, 0.5};
  EXPECT_EQ(Parse("foxglove.PoseInFrame", EncodePose(0, agent)),
            R"(timestamp { } frame_id: "world" pose { position { x: 4 y: 5 z: 0.5 } )"
            R"(orientation { w: 1 } })");
}

TEST_F(Foxglove, CameraRotationIsTheCamerasOwn) {
  AgentPose agent;
  agent.yaw_rad = 2.5;
  agent.pitch_rad = -0.4;
  const Pose T = CameraPose(agent, 0.88);
  Parse("foxglove.FrameTransform", EncodeTransform(0, "camera", T));
  const pb::Message& q = message_->GetReflection()->GetMessage(*message_, Field("rotation"));
  const auto part = [&](const char* name) {
    return q.GetReflection()->GetDouble(q, q.GetDescriptor()->FindFieldByName(name));
  };
  const Eigen::Quaterniond rotation(part("w"), part("x"), part("y"), part("z"));
  EXPECT_LT((rotation.toRotationMatrix() - T.linear()).norm(), 1e-12);
  EXPECT_GE(rotation.w(), 0);
}

TEST_F(Foxglove, FlightsAreLinesWithLabels) {
  geometry::StairFlight walked, seen;
  walked.steps_world = {{0, 0, 0}, {1, 0, 0.5}};
  walked.id = 0;
  walked.walked_up = 1;
  seen.steps_world = {{5, 0, 0}, {6, 0, 0.5}, {7, 0, 1}};
  seen.id = 3;
  const std::string text = Parse("foxglove.SceneUpdate", EncodeFlights(0, {walked, seen}));
  EXPECT_NE(text.find(R"(id: "flights")"), std::string::npos) << text;
  EXPECT_NE(text.find("thickness: 0.06 points { } points { x: 1 z: 0.5 }"), std::string::npos)
      << text;
  EXPECT_NE(text.find("points { x: 7 z: 1 }"), std::string::npos);
  EXPECT_NE(text.find(R"(text: "flight 0, walked")"), std::string::npos);
  EXPECT_NE(text.find(R"(text: "flight 3, seen")"), std::string::npos);
}

TEST_F(Foxglove, ImagesParse) {
  EXPECT_EQ(Parse("foxglove.CompressedImage", EncodeImage(0, "JPEG!", "jpeg")),
            R"(timestamp { } data: "JPEG!" format: "jpeg" frame_id: "camera")");
  Image<std::uint16_t> depth(2, 1);
  depth.data = {0x0102, 0xFFFF};
  EXPECT_EQ(Parse("foxglove.RawImage", EncodeDepth(0, depth)),
            R"(timestamp { } width: 2 height: 1 encoding: "16UC1" step: 4 )"
            R"(data: "\002\001\377\377" frame_id: "camera")");
}

TEST_F(Foxglove, CalibrationFollowsTheShrunkImage) {
  const CameraIntrinsics camera{640, 480, 320, 320, 319.5, 239.5};
  const std::string text = Parse("foxglove.CameraCalibration", EncodeCalibration(0, camera, 2));
  EXPECT_NE(text.find("width: 320 height: 240"), std::string::npos) << text;
  // The principal point stays in the middle, (W - 1) / 2.
  EXPECT_NE(text.find("K: 160 K: 0 K: 159.5 K: 0 K: 160 K: 119.5 K: 0 K: 0 K: 1"),
            std::string::npos)
      << text;
}

TEST_F(Foxglove, CloudHasItsLayout) {
  const std::vector<ColouredVoxel> voxels = {{{0, 1, -1}, geometry::VoxelState::kStair},
                                             {{5, 5, 5}, geometry::VoxelState::kOccupied}};
  const std::string text = Parse("foxglove.PointCloud", EncodeCloud(0, voxels, 0.1));
  EXPECT_NE(
      text.find(
          R"(point_stride: 17 fields { name: "x" type: FLOAT32 } fields { name: "y" offset: 4)"),
      std::string::npos)
      << text;
  std::string scratch;
  const std::string& data =
      message_->GetReflection()->GetStringReference(*message_, Field("data"), &scratch);
  ASSERT_EQ(data.size(), 34U);
  float p[3];
  std::memcpy(p, data.data(), sizeof p);
  EXPECT_FLOAT_EQ(p[0], 0.05F);
  EXPECT_FLOAT_EQ(p[1], 0.15F);
  EXPECT_FLOAT_EQ(p[2], -0.05F);
  EXPECT_EQ(data[16], 5);  // STAIR
  EXPECT_EQ(static_cast<std::uint8_t>(data[12]), ColourOf(geometry::VoxelState::kStair).r);
}

TEST_F(Foxglove, PlanGoalsLogAndChangesParse) {
  StepTrace step;
  step.candidates.push_back({"live_poi", {1, 2, 3}, {4, 5, 6}, 0.25, -1, 7, true, true});
  step.path_world = {{0, 0, 0}, {1, 0, 0}};
  const std::string plan = Parse("foxglove.SceneUpdate", EncodePlan(100, step));
  EXPECT_NE(plan.find(R"(id: "plan" spheres)"), std::string::npos) << plan;
  EXPECT_NE(plan.find(R"(text: "live_poi")"), std::string::npos);
  EXPECT_NE(plan.find("points { } points { x: 1 }"), std::string::npos);

  GoalInstance instance;
  instance.goal = "bed";
  instance.box.Add({0, 0, 0});
  instance.box.Add({2, 1, 0.5});
  const std::string goals = Parse("foxglove.SceneUpdate", EncodeGoals(0, {instance}));
  EXPECT_NE(goals.find("size { x: 2 y: 1 z: 0.5 }"), std::string::npos) << goals;

  EXPECT_EQ(Parse("foxglove.Log", EncodeLog(0, "event", "hello")),
            R"(timestamp { } level: INFO message: "hello" name: "event")");
  EXPECT_EQ(Parse("crossnav.VoxelChanges", EncodeVoxelChanges(0, 0.1, 300, "abc")),
            R"(timestamp { } voxel_m: 0.1 count: 300 runs: "abc")");
}

TEST(ProtoWire, VarintsComeBack) {
  for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128},
                                    std::uint64_t{300}, ~std::uint64_t{0}}) {
    std::string bytes;
    AppendVarint(bytes, value);
    std::string_view rest = bytes;
    EXPECT_EQ(TakeVarint(rest), value);
    EXPECT_TRUE(rest.empty());
    rest = std::string_view(bytes).substr(0, bytes.size() - 1);
    EXPECT_EQ(TakeVarint(rest), std::nullopt);
  }
  std::string_view too_long("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x7F", 10);
  EXPECT_EQ(TakeVarint(too_long), std::nullopt);
}

TEST(ProtoWire, FieldsComeBackAndDamageIsSeen) {
  const std::string bytes =
      ProtoMessage().Varint(1, 7).Fixed32(2, 9).Double(3, -0.5).Bytes(4, "abc").Take();
  std::string_view rest = bytes;
  EXPECT_EQ(TakeField(rest)->number, 7U);
  EXPECT_EQ(TakeField(rest)->number, 9U);
  EXPECT_EQ(TakeField(rest)->AsDouble(), -0.5);
  EXPECT_EQ(TakeField(rest)->bytes, "abc");
  EXPECT_EQ(TakeField(rest), std::nullopt);
  EXPECT_TRUE(rest.empty());
  rest = std::string_view(bytes).substr(0, bytes.size() - 1);
  while (TakeField(rest)) {
  }
  EXPECT_FALSE(rest.empty());
}

}  // namespace
}  // namespace crossnav::trace
