// SPDX-License-Identifier: MIT
#include "serve_command.h"

#include <fmt/format.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "crossnav/core/categories.h"
#include "crossnav/core/version.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/serve/blind.h"
#include "crossnav/serve/server.h"
#include "memory_files.h"
#include "network_choice.h"
#include "perception_source.h"
#include "watch_log.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

/// Readable after the first SIGINT or SIGTERM, which no longer end the process. Call before any
/// thread exists.
Result<serve::Descriptor> EndSignals() {
  sigset_t ends;
  ::sigemptyset(&ends);
  ::sigaddset(&ends, SIGINT);
  ::sigaddset(&ends, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &ends, nullptr);
  serve::Descriptor descriptor(::signalfd(-1, &ends, SFD_CLOEXEC));
  if (!descriptor.is_open()) return Fail(ErrorCode::kIo, "no signals can be received");
  return descriptor;
}

/// python/crossnav/live.py uses the same path.
std::string DefaultSocket() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0') return std::string(runtime) + "/crossnav.sock";
  return fmt::format("/tmp/crossnav-{}.sock", ::getuid());
}

serve::Address AddressOf(const ServeOptions& options) {
  if (options.port >= 0) return {"", options.port};
  return {options.socket.empty() ? DefaultSocket() : options.socket, 0};
}

Result<evaluation::RunConfig> ConfigOf(const ServeOptions& options, const CommonOptions& common) {
  CommonOptions all = common;
  if (options.perception == "networks") all.overrides.push_back("eval.perception=networks");
  auto config =
      options.perception == "networks" ? LoadWithNetworks(all, options.networks) : LoadConfig(all);
  if (config && config->serve.watchdog_s <= config->serve.period_s)
    return Fail(ErrorCode::kInvalid,
                "must be longer than serve.period_s, or it fires in the midst of an action",
                "serve.watchdog_s");
  return config;
}

/// Creates agents according to the settings.
class AgentMaker {
 public:
  AgentMaker(evaluation::RunConfig& config, const PerceptionSource& source,
             const ServeOptions& options, WatchFeed& watch)
      : config_(config), source_(source), options_(options), watch_(watch) {}

  Result<agent::Agent> Make(double camera_height_m, bool restore) {
    config_.agent.sensor.camera_height_m = camera_height_m;  // also for the networks
    Result<perception::PerceptionSuite> suite =
        IsBlind() ? serve::BlindPerception() : source_.MakeSuite().value();
    if (!suite) return tl::unexpected(suite.error());
    agent::Agent agent(config_.agent, std::move(*suite));
    if (restore) {
      if (auto ok = RestoreMemory(options_.memory, config_, EncoderName(), agent); !ok)
        return tl::unexpected(ok.error());
    }
    watch_.Start(Info(), agent);
    return agent;
  }
  /// The saved memory as a map to be lost in.
  Result<localization::Awakening> WakeUp(double camera_height_m) const {
    const auto saved = ReadMemory(options_.memory, config_, EncoderName());
    if (!saved) return tl::unexpected(saved.error());
    return localization::Awakening::In(saved->map,
                                       {camera_height_m, config_.agent.action, config_.agent.map});
  }
  bool IsBlind() const { return options_.perception == "none"; }
  std::string EncoderName() const { return IsBlind() ? "none" : source_.EncoderName(); }

 private:
  /// Goals are the client's: the page takes them from the steps.
  trace::ReplayInfo Info() const {
    trace::ReplayInfo info;
    info.scene_id = "live";
    info.perception = options_.perception;
    info.version = CROSSNAV_VERSION;
    info.config_hash = evaluation::ConfigHash(config_);
    info.voxel_m = config_.agent.map.voxel_m;
    return info;
  }

  evaluation::RunConfig& config_;
  const PerceptionSource& source_;
  const ServeOptions& options_;
  WatchFeed& watch_;
};

serve::PilotOptions PilotOf(const evaluation::RunConfig& config, const ServeOptions& options,
                            AgentMaker& maker, WatchFeed& watch) {
  serve::PilotOptions pilot;
  pilot.version = CROSSNAV_VERSION;
  pilot.perception = options.perception;
  if (!maker.IsBlind()) pilot.goals.assign(kCategories.begin(), kCategories.end());
  pilot.serve = config.serve;
  pilot.action = config.agent.action;
  pilot.camera_height_m = config.agent.sensor.camera_height_m;
  pilot.has_saved_memory = !options.memory.empty();
  pilot.make_agent = [&maker](double camera_height_m, bool restore) {
    return maker.Make(camera_height_m, restore);
  };
  if (options.pose == "unknown")
    pilot.wake_up = [&maker](double camera_height_m) { return maker.WakeUp(camera_height_m); };
  pilot.on_step = [&watch](const Observation& obs, const agent::StepResult& result,
                           const agent::Agent& agent) {
    watch.Add(obs, result.trace, result.percept, agent);
  };
  return pilot;
}

void Report(const serve::Counters& counters, const std::string& saved, Console& console) {
  Json document = Json::object();
  std::string text;
  Visit(
      [&](const char* name, std::uint64_t count) {
        document["counts"][name] = count;
        text += fmt::format("{:<13}{}\n", name, count);
      },
      counters);
  if (!saved.empty()) {
    document["map"] = saved;
    text += fmt::format("{:<13}{}\n", "map", saved);
  }
  console.Print(text);
  console.Document(document.dump(1));
}

}  // namespace

Result<void> ServeLive(const ServeOptions& options, const CommonOptions& common, Console& console) {
  auto config = ConfigOf(options, common);
  if (!config) return tl::unexpected(config.error());
  if (auto ok = evaluation::CheckOutputFile(options.save_map, "--save-map"); !ok) return ok;
  if (options.pose == "unknown" && options.memory.empty())
    return Fail(ErrorCode::kInvalid, "a robot can only be lost in a map: give --memory", "--pose");
  if (!options.memory.empty()) {
    if (const auto header = store::ReadMapHeader(options.memory); !header)
      return tl::unexpected(header.error());
  }
  const auto ends = EndSignals();
  if (!ends) return tl::unexpected(ends.error());
  const auto source = PerceptionSource::Read(*config);
  if (!source) return tl::unexpected(source.error());
  const auto watch = OpenWatch(options.watch, console);
  if (!watch) return tl::unexpected(watch.error());
  WatchFeed feed(watch->get(), console);
  AgentMaker maker(*config, *source, options, feed);
  serve::Pilot pilot(PilotOf(*config, options, maker, feed));
  const auto listener = serve::Listener::Open(AddressOf(options));
  if (!listener) return tl::unexpected(listener.error());
  if (!maker.IsBlind()) console.Log(NetworksText(config->networks));
  console.Log(fmt::format("listening on {}, perception: {}", listener->name(), options.perception));
  const auto log = [&console](const std::string& line) { console.Log(line); };
  if (auto ok = serve::Serve(*listener, pilot, {ends->value(), log}); !ok) return ok;
  feed.Close();
  const bool is_saved = !options.save_map.empty() && pilot.agent() != nullptr;
  if (is_saved) {
    const auto saved = SaveMemoryOf(*pilot.agent(), options.save_map, maker.EncoderName(), "live");
    if (!saved) return tl::unexpected(saved.error());
  }
  Report(pilot.counters(), is_saved ? options.save_map : "", console);
  return {};
}

}  // namespace crossnav::app
