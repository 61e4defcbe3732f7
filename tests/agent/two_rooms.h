// SPDX-License-Identifier: MIT
// The world of the agent's tests: rooms of boxes, a couch, and all that the agent knows of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/trace/trace_json.h"
#include "support/box_walker.h"
#include "support/fake_perception.h"

namespace crossnav::agent::testing {

using crossnav::testing::BoxOf;
using test::BoxWalker;
using test::FakeSight;
using test::FakeSuite;

inline Config SmallConfig() {
  Config config;
  config.sensor.width_px = config.sensor.height_px = 64;
  return config;
}

/// A room of 4 x 4 m.
inline BoxWalker ClosedRoom() {
  BoxWalker walker;
  walker.sensor = SmallConfig().sensor;
  walker.rooms.shell = BoxOf(0, 0, 0, 4, 4, 2.6);
  walker.pose.p_world = Vector3d(1.5, 1.5, 0);
  return walker;
}

inline const Box3 kCouch = BoxOf(6.6, 2.9, 0, 7.5, 3.7, 0.8);

/// Two rooms of 4 x 4 m side by side; a door of 1 m at y in [0.4, 1.4], a couch in the far corner.
inline BoxWalker TwoRooms() {
  BoxWalker walker = ClosedRoom();
  walker.rooms.shell = BoxOf(0, 0, 0, 8, 4, 2.6);
  walker.rooms.solids = {BoxOf(4, 0, 0, 4.12, 0.4, 2.6), BoxOf(4, 1.4, 0, 4.12, 4, 2.6),
                         BoxOf(4, 0.4, 2.05, 4.12, 1.4, 2.6), kCouch};
  walker.pose.p_world = Vector3d(1.0, 3.0, 0);
  walker.pose.yaw_rad = DegToRad(90);
  return walker;
}

/// Surfaces within 5 cm of `box`, between the heights, with the features `cell`; others as before.
inline void PaintFeatures(const Box3& box, double from_m, double to_m, std::array<float, 4> cell,
                          FakeSight* sight) {
  sight->features = [=, before = sight->features](const Observation& obs) {
    perception::FeatureGrid grid = before(obs);
    for (int row = 0; row < grid.rows; ++row)
      for (int col = 0; col < grid.cols; ++col) {
        const int u = col * obs.rgb.width / grid.cols, v = row * obs.rgb.height / grid.rows;
        const Vector3d p =
            obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
        if (box.HorizontalDistance(p) < 0.05 && p.z() >= from_m && p.z() < to_m)
          std::copy(cell.begin(), cell.end(), grid.data.begin() + 4 * (grid.cols * row + col));
      }
    return grid;
  };
}

/// `sight`, and the object in `box` under the name `name`.
inline FakeSight AndBox(const FakeSight& sight, const Box3& box, const std::string& name) {
  FakeSight both = sight, other;
  test::SeeBox(box, name, &other);
  both.detect = [sight, other, name](const Observation& obs, std::string_view asked) {
    return asked == name ? other.detect(obs, asked) : sight.detect(obs, asked);
  };
  both.segment = [sight, other, name](const Observation& obs, perception::Detection& detection) {
    const auto seen = other.detect(obs, name);
    const bool is_other = !seen.empty() && seen.front().box.u0 == detection.box.u0 &&
                          seen.front().box.v0 == detection.box.v0;
    (is_other ? other : sight).segment(obs, detection);
  };
  return both;
}

/// Features tell the couch from the rest of the house; "couch" is its text.
inline FakeSight CouchSight(const Box3& couch = kCouch) {
  FakeSight sight;
  test::SeeBox(couch, "couch", &sight);
  sight.features = [](const Observation& /*obs*/) {
    perception::FeatureGrid grid{8, 8, 4, {}};
    for (int i = 0; i < 8 * 8; ++i)
      for (const float value : {0.0F, 0.8F, 0.6F, 0.0F}) grid.data.push_back(value);
    return grid;
  };
  PaintFeatures(couch, -1e9, 0.9, {1, 0, 0, 0}, &sight);
  sight.text = [](std::string_view text) {
    return text == "couch" ? std::vector<float>{1, 0, 0, 0} : std::vector<float>{0, 0, 0, 1};
  };
  return sight;
}

struct Walk {
  std::vector<std::string> traces;
  Action last_action = Action::kTurnLeft;
  bool all_explored = false;
  std::optional<Vector3d> p_claimed_world;
};

inline bool Tells(const Walk& walk, const std::string& text) {
  return std::any_of(walk.traces.begin(), walk.traces.end(),
                     [&](const std::string& step) { return step.find(text) != std::string::npos; });
}

/// Steps until STOP, "all explored" or `limit` steps.
inline Walk RunAgent(Agent& agent, BoxWalker& walker, int limit) {
  Walk walk;
  for (int i = 0; i < limit; ++i) {
    const auto result = agent.Step(walker.Look());
    if (!result) {
      ADD_FAILURE() << result.error().Message();
      return walk;
    }
    walk.traces.push_back(ToJson(result->trace));
    walk.last_action = result->action;
    walk.all_explored = result->all_explored;
    walk.p_claimed_world = result->p_claimed_world;
    if (walk.all_explored || walk.last_action == Action::kStop) break;
    walker.Do(result->action);
  }
  return walk;
}

/// All that outlives a goal.
struct WorldBytes {
  std::vector<geometry::MapBlock> blocks;  ///< evidence and stair marks
  std::vector<std::pair<geometry::VoxelKey, geometry::Voxel>> states;
  std::vector<memory::MemoryRow> rows;  ///< features, weights, best views
  friend bool operator==(const WorldBytes&, const WorldBytes&) = default;
};

inline WorldBytes BytesOf(const Agent& agent) {
  WorldBytes bytes;
  bytes.blocks = ExportBlocks(agent.map());
  agent.map().ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    bytes.states.emplace_back(key, voxel);
  });
  for (std::int64_t row = 0; row < agent.memory().Size(); ++row)
    bytes.rows.push_back(agent.memory().RowAt(row));
  return bytes;
}

/// Whether a claimed point lies on the object in the box.
inline bool IsOn(const Box3& box, const Vector3d& p) {
  return box.HorizontalDistance(p) < 0.05 && p.z() < box.max.z() + 0.05 && p.z() > 0.05;
}

}  // namespace crossnav::agent::testing
