// SPDX-License-Identifier: MIT
// Custom perception: the four interfaces, here answered by "is it red?". With them the agent
// searches a room for "red box", in a loop that moves a custom robot.
//   own_perception
#include <cstdio>
#include <memory>

#include "box_room.h"
#include "crossnav/agent/agent.h"

namespace {

using crossnav::Observation;
using crossnav::Result;

bool IsRed(const crossnav::Rgb8& c) {
  return c.r > 2 * c.g && c.r > 2 * c.b;
}

class RedDetector : public crossnav::perception::Detector {
 public:
  Result<std::vector<crossnav::perception::Detection>> Detect(const Observation& obs,
                                                              std::string_view goal) override {
    crossnav::perception::Detection found;
    found.box = {obs.rgb.width, obs.rgb.height, 0, 0};
    for (int v = 0; v < obs.rgb.height; ++v) {
      for (int u = 0; u < obs.rgb.width; ++u) {
        if (!IsRed(obs.rgb.At(u, v))) continue;
        found.box = {std::min(found.box.u0, u), std::min(found.box.v0, v),
                     std::max(found.box.u1, u + 1), std::max(found.box.v1, v + 1)};
      }
    }
    found.confidence = 0.9f;
    if (goal != "red box" || found.box.u1 == 0) return {};
    return std::vector{found};
  }
};

class RedSegmenter : public crossnav::perception::Segmenter {
 public:
  Result<void> Segment(const Observation& obs,
                       crossnav::perception::Detection& detection) override {
    detection.mask = crossnav::MaskImage(obs.rgb.width, obs.rgb.height);
    for (std::size_t i = 0; i < obs.rgb.data.size(); ++i) {
      detection.mask.data[i] = IsRed(obs.rgb.data[i]) ? 1 : 0;
    }
    detection.mask_quality = 1;
    return {};
  }
};

class NoStairs : public crossnav::perception::StairSegmenter {
 public:
  Result<crossnav::Image<float>> SegmentStairs(const Observation& obs) override {
    return crossnav::Image<float>(obs.rgb.width, obs.rgb.height, 0.0f);
  }
};

/// Two dimensions: red, and everything else.
class RedEncoder : public crossnav::perception::DenseEncoder {
 public:
  int Dim() const override { return 2; }
  std::string Name() const override { return "red"; }
  Result<crossnav::perception::FeatureGrid> EncodeImage(const Observation& obs) override {
    crossnav::perception::FeatureGrid grid{24, 24, 2, {}};
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.cols; ++col) {
        const bool red = IsRed(obs.rgb.At((2 * col + 1) * obs.rgb.width / (2 * grid.cols),
                                          (2 * row + 1) * obs.rgb.height / (2 * grid.rows)));
        grid.data.insert(grid.data.end(), {red ? 1.0f : 0.0f, red ? 0.0f : 1.0f});
      }
    }
    return grid;
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    const bool red = text == "red box";
    return std::vector<float>{red ? 1.0f : 0.0f, red ? 0.0f : 1.0f};
  }
};

int Complain(const crossnav::Error& error) {
  std::fprintf(stderr, "%s\n", error.Message().c_str());
  return 1;
}

}  // namespace

int main() {
  crossnav::agent::Config config;
  config.sensor.width_px = config.sensor.height_px = 160;
  crossnav::perception::PerceptionSuite perception;
  perception.detector = std::make_unique<RedDetector>();
  perception.segmenter = std::make_unique<RedSegmenter>();
  perception.stairs = std::make_unique<NoStairs>();
  perception.encoder = std::make_unique<RedEncoder>();
  crossnav::agent::Agent agent(config, std::move(perception));
  if (auto ok = agent.SetGoal("red box"); !ok) return Complain(ok.error());

  const BoxRoom room;
  crossnav::AgentPose robot;
  robot.p_world = {-2, 1, 0};
  robot.yaw_rad = crossnav::DegToRad(180);
  for (int step = 1; step <= 200; ++step) {
    auto decided = agent.Step(Look(room, robot, config.sensor));
    if (!decided) return Complain(decided.error());
    if (decided->all_explored) break;
    if (decided->action == crossnav::Action::kStop) {
      const auto p = decided->p_claimed_world.value_or(robot.p_world);
      std::printf("red box: claimed at %.1f %.1f %.1f after %d steps\n", p.x(), p.y(), p.z(), step);
      return 0;
    }
    Move(room, robot, decided->action);
  }
  std::printf("red box: not found\n");
  return 1;
}
