// SPDX-License-Identifier: MIT
// The agent's whole configuration. Every default is at its field, beside the code that uses it. An
// empty config file means the paper's numbers and our navigator (policy.profile = full); the
// paper's method to the letter is policy.profile = paper.
#pragma once

#include <string>

#include "crossnav/agent/memory_config.h"
#include "crossnav/core/action.h"
#include "crossnav/core/camera.h"
#include "crossnav/geometry/map_config.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/planner/planner_config.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::agent {

struct Config {
  SensorConfig sensor;
  ActionConfig action;
  geometry::MapConfig map;
  memory::FusionConfig fusion;
  memory::QueryConfig query;
  planner::PlannerConfig planner;
  policy::PolicyConfig policy;
  policy::VerifyConfig verify;
  MemoryConfig memory;
};

/// Visits every field as visit(name, field[, range]); sections through visit.Section(name, struct).
template <class V>
void Visit(V& visit, Config& c) {
  visit.Section("sensor", c.sensor);
  visit.Section("action", c.action);
  visit.Section("map", c.map);
  visit.Section("fusion", c.fusion);
  visit.Section("query", c.query);
  visit.Section("planner", c.planner);
  visit.Section("policy", c.policy);
  visit.Section("verify", c.verify);
  visit.Section("memory", c.memory);
}

}  // namespace crossnav::agent
