// SPDX-License-Identifier: MIT
// A day of steps in one process: one agent in the embedded house looks for one goal after the
// other, as a robot that lives there does. Prints memory and time at intervals; exit status 1 if
// more than 5 % was added after the first fifth. Usage: soak [--steps N] [--every N]      default:
// 200000, 5000
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/core/categories.h"
#include "crossnav/sim/ground_truth.h"
#include "crossnav/sim/navmesh.h"
#include "crossnav/sim/ray_caster.h"
#include "crossnav/sim/scene.h"
#include "crossnav/sim/simulator.h"
#include "crossnav/world/house/embedded_house.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header

constexpr int kSide_px = 64;
constexpr int kStepsPerGoal = 500;  // then the next goal's turn, found or not
constexpr double kMostGrowth = 1.05;

struct Options {
  long steps = 200'000, every = 5000;
};

double ResidentMb() {
  std::ifstream file("/proc/self/statm");
  long all = 0, resident = 0;
  file >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double CpuMs() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Steps on until all are done; the memory in use at each interval's end, or what failed.
Result<std::vector<double>> Live(agent::Agent& agent, sim::Simulator& simulator,
                                 const Options& options) {
  std::vector<double> resident_mb;
  std::size_t goal = 0;
  int left = 0;
  double start_ms = CpuMs();
  for (long step = 1; step <= options.steps; ++step) {
    if (left-- == 0) {
      if (auto ok = agent.SetGoal(std::string(kCategories[goal++ % kCategories.size()])); !ok)
        return tl::unexpected(ok.error());
      left = kStepsPerGoal;
    }
    const auto done = agent.Step(simulator.Observe());
    if (!done) return tl::unexpected(done.error());
    if (done->all_explored || done->action == Action::kStop) {
      left = 0;
    } else {
      simulator.Step(done->action);
    }
    if (step % options.every != 0) continue;
    resident_mb.push_back(ResidentMb());
    std::printf("step %7ld  goal %5zu  %7.1f MB  %8lld feature rows  %6.2f ms a step\n", step, goal,
                resident_mb.back(), static_cast<long long>(agent.memory().Size()),
                (CpuMs() - start_ms) / static_cast<double>(options.every));
    std::fflush(stdout);
    start_ms = CpuMs();
  }
  return resident_mb;
}

Result<std::vector<double>> Soak(const Options& options) {
  const auto scratch = std::filesystem::temp_directory_path() / "crossnav_soak";
  const auto folder = world::WriteEmbeddedHouse(scratch);
  if (!folder) return tl::unexpected(folder.error());
  const auto scene = sim::LoadScene(*folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  agent::Config config;
  config.sensor.width_px = config.sensor.height_px = kSide_px;
  sim::Simulator simulator(*scene, *navmesh, caster, config.sensor, config.action);
  sim::GroundTruthConfig truth;
  truth.min_visible_px = 5;
  truth.feature_dim = 32;
  auto perception = sim::GroundTruthPerception(simulator, truth);
  if (!perception) return tl::unexpected(perception.error());
  agent::Agent agent(config, std::move(*perception));
  Rng rng(1);
  const auto start = navmesh->RandomPoint(rng);
  if (!start || !simulator.Reset({*start, 0, 0}))
    return Fail(ErrorCode::kInvalid, "no place to start from");
  return Live(agent, simulator, options);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i];
    const long value = std::atol(argv[i + 1]);
    if (value < 1) continue;
    if (word == "--steps") options.steps = value;
    if (word == "--every") options.every = value;
  }
  const auto resident_mb = Soak(options);
  if (!resident_mb) {
    std::fprintf(stderr, "%s\n", resident_mb.error().Message().c_str());
    return 1;
  }
  if (resident_mb->empty()) return 0;
  const double early = (*resident_mb)[resident_mb->size() / 5], late = resident_mb->back();
  std::printf("%.1f MB after a fifth, %.1f MB at the end: %s\n", early, late,
              late <= kMostGrowth * early ? "flat" : "it grows");
  return late <= kMostGrowth * early ? 0 : 1;
}
