// SPDX-License-Identifier: MIT
// The agent in a custom loop: goals in order, an observation in, an action out, and the memory
// saved at the end. The robot is simulated, in the house that ships with crossnav.
//   agent_loop FOLDER [MAP]     FOLDER: receives the house
#include <cstdio>

#include "crossnav/agent/agent.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/store/map_file.h"
#include "crossnav/world/house/embedded_house.h"

namespace sim = crossnav::sim;

namespace {

int Complain(const crossnav::Error& error) {
  std::fprintf(stderr, "%s\n", error.Message().c_str());
  return 1;
}

/// Searches until the agent stops; false if it gave up.
crossnav::Result<bool> Search(crossnav::agent::Agent& agent, sim::Simulator& robot,
                              const std::string& goal) {
  if (auto ok = agent.SetGoal(goal); !ok) return tl::unexpected(ok.error());
  for (int step = 1; step <= 500; ++step) {
    auto decided = agent.Step(robot.Observe());
    if (!decided) return tl::unexpected(decided.error());
    if (decided->all_explored) break;
    if (decided->action == crossnav::Action::kStop) {
      const auto p = decided->p_claimed_world.value_or(robot.agent().p_world);
      std::printf("%s: claimed at %.2f %.2f %.2f after %d steps\n", goal.c_str(), p.x(), p.y(),
                  p.z(), step);
      return true;
    }
    robot.Step(decided->action);
  }
  std::printf("%s: not found\n", goal.c_str());
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "agent_loop FOLDER [MAP]\n");
    return 1;
  }
  auto folder = crossnav::world::WriteEmbeddedHouse(argv[1]);
  if (!folder) return Complain(folder.error());
  auto scene = sim::LoadScene(*folder);
  if (!scene) return Complain(scene.error());
  auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return Complain(navmesh.error());
  const sim::RayCaster caster(*scene);

  crossnav::agent::Config config;
  config.sensor.width_px = config.sensor.height_px = 320;
  sim::Simulator robot(*scene, *navmesh, caster, config.sensor, config.action);
  crossnav::Rng rng(1);
  crossnav::AgentPose start;
  start.p_world = navmesh->RandomPoint(rng).value_or(crossnav::Vector3d::Zero());
  if (auto ok = robot.Reset(start); !ok) return Complain(ok.error());

  const sim::GroundTruthConfig truth;
  auto perception = sim::GroundTruthPerception(robot, truth);  // or your own: own_perception.cpp
  if (!perception) return Complain(perception.error());
  crossnav::agent::Agent agent(config, std::move(*perception));
  for (const char* goal : {"chair", "bed"}) {
    auto found = Search(agent, robot, goal);
    if (!found) return Complain(found.error());
  }

  if (argc > 2) {
    crossnav::store::SaveInfo info;
    info.encoder_name = sim::EncoderName(truth);
    info.flights = agent.flights();
    info.seen_stairs = agent.seen_stairs();
    auto saved = crossnav::store::SaveMemory(argv[2], agent.map(), agent.memory(), info);
    if (!saved) return Complain(saved.error());
  }
  return 0;
}
