// SPDX-License-Identifier: MIT
// A day of steps in one process: one agent in a house searches one goal after the other. Prints
// memory and time at intervals, and at the end the cost of each stage of a step at step 100, 1000,
// 5000 and 50000 side by side; the cost must not grow with the number of steps. Exit status 1 if
// more than 5 % of memory was added after the first fifth. Usage:
//
//   soak [--steps N] [--every N] [--px N] [--dim N] [--scene FOLDER]
//
// Defaults: 200000, 5000, 64 pixels a side, 32 features, the embedded house.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/core/categories.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/house/embedded_house.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header

constexpr int kStepsPerGoal = 500;  // then the next goal, found or not
constexpr double kMostGrowth = 1.05;

struct Options {
  long steps = 200'000, every = 5000, px = 64, dim = 32;
  std::filesystem::path scene;  ///< empty: the embedded house
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

/// Cost of a step's stages over the hundred steps before some ages.
class Ages {
 public:
  void Add(long step, const std::vector<trace::StageTime>& stages) {
    const auto age = std::find_if(kAges.begin(), kAges.end(),
                                  [step](long a) { return step > a - kMeanOf && step <= a; });
    if (age == kAges.end()) return;
    const auto column = static_cast<std::size_t>(age - kAges.begin());
    columns_ = std::max(columns_, column + 1);
    for (const trace::StageTime& stage : stages) {
      if (!sums_.contains(stage.stage)) order_.push_back(stage.stage);
      sums_[stage.stage][column] += stage.ms;
    }
  }

  void Print() const {
    std::printf("CPU ms of a stage, means of the %ld steps up to step\n%-16s", kMeanOf, "");
    for (std::size_t i = 0; i < columns_; ++i) std::printf("%9ld", kAges[i]);
    for (const std::string& stage : order_) {
      std::printf("\n%-16s", stage.c_str());
      for (std::size_t i = 0; i < columns_; ++i)
        std::printf("%9.2f", sums_.at(stage)[i] / static_cast<double>(kMeanOf));
    }
    std::printf("\n");
  }

 private:
  static constexpr long kMeanOf = 100;
  static constexpr std::array<long, 4> kAges{100, 1000, 5000, 50000};

  std::map<std::string, std::array<double, kAges.size()>> sums_;
  std::vector<std::string> order_;
  std::size_t columns_ = 0;
};

/// Steps on until all are done; the memory in use at each interval's end, or the error.
Result<std::vector<double>> Live(agent::Agent& agent, sim::Simulator& simulator,
                                 const Options& options) {
  std::vector<double> resident_mb;
  Ages ages;
  std::size_t goal = 0;
  int left = 0;
  double start_ms = CpuMs();
  for (long step = 1; step <= options.steps; ++step) {
    if (left-- == 0) {
      if (auto ok = agent.SetGoal(std::string(kCategories[goal++ % kCategories.size()])); !ok)
        return tl::unexpected(ok.error());
      left = kStepsPerGoal;
    }
    const double before_ms = CpuMs();
    const Observation observation = simulator.Observe();
    const double observed_ms = CpuMs();
    const auto done = agent.Step(observation);
    if (!done) return tl::unexpected(done.error());
    std::vector<trace::StageTime> stages = done->timing;
    stages.push_back({"simulator", observed_ms - before_ms});
    stages.push_back({"step", CpuMs() - before_ms});
    ages.Add(step, stages);
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
  ages.Print();
  return resident_mb;
}

Result<std::vector<double>> Soak(const Options& options) {
  const auto scratch = std::filesystem::temp_directory_path() / "crossnav_soak";
  const auto folder = options.scene.empty() ? world::WriteEmbeddedHouse(scratch)
                                            : Result<std::filesystem::path>(options.scene);
  if (!folder) return tl::unexpected(folder.error());
  const auto scene = sim::LoadScene(*folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  agent::Config config;
  config.sensor.width_px = config.sensor.height_px = static_cast<int>(options.px);
  sim::Simulator simulator(*scene, *navmesh, caster, config.sensor, config.action);
  sim::GroundTruthConfig truth;
  if (options.px < 320) truth.min_visible_px = 5;
  truth.feature_dim = static_cast<int>(options.dim);
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
    if (word == "--scene") options.scene = argv[i + 1];
    const long value = std::atol(argv[i + 1]);
    if (value < 1) continue;
    if (word == "--steps") options.steps = value;
    if (word == "--every") options.every = value;
    if (word == "--px") options.px = value;
    if (word == "--dim") options.dim = value;
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
