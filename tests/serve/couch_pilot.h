// SPDX-License-Identifier: MIT
// A pilot whose agent sees the couch of the agent's tests.
#pragma once

#include "agent/two_rooms.h"
#include "crossnav/serve/pilot.h"

namespace crossnav::test {

inline Result<agent::Agent> MakeCouchAgent(double camera_height_m) {
  agent::Config config = agent::testing::SmallConfig();
  config.sensor.camera_height_m = camera_height_m;
  return agent::Agent(config, FakeSuite(agent::testing::CouchSight()));
}

inline serve::PilotOptions CouchPilot() {
  serve::PilotOptions options;
  options.version = "0";
  options.perception = "test";
  options.goals = {"couch"};
  options.camera_height_m = agent::testing::SmallConfig().sensor.camera_height_m;
  options.make_agent = [](double camera_height_m, bool) { return MakeCouchAgent(camera_height_m); };
  return options;
}

}  // namespace crossnav::test
