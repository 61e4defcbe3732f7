// SPDX-License-Identifier: MIT
// The program's verbs and their options, for CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "ask_command.h"
#include "commands.h"
#include "map_build.h"
#include "noise_command.h"
#include "serve_command.h"

namespace crossnav::app {

inline constexpr const char* kPoseHelp =
    "unknown: the robot has to find itself in --memory; default: given";

using Command = std::function<Result<void>(Console&)>;

/// Options of every verb, filled in by CLI11.
struct Options {
  CommonOptions common;
  WorldOptions world;
  ChangeOptions change;
  AskOptions ask;
  AssetsOptions assets;
  SceneOptions scene;
  ViewsOptions views;
  FramesOptions frames;
  SceneImportOptions scene_import;
  EpisodesOptions episodes;
  ChooseOptions choose;
  RunOptions run;
  DemoOptions demo;
  EvalOptions eval;
  SlurmOptions slurm;
  MergeOptions merge;
  SuiteOptions suite;
  ReportOptions report;
  GapsOptions gaps;
  MetricsOptions metrics;
  ReplayOptions replay;
  MapOptions map;
  MapBuildOptions map_build;
  BenchOptions bench;
  NetworksOptions networks;
  StairsOptions stairs;
  NoiseSweepOptions noise;
  GraphBenchOptions graph_bench;
  DaysBenchOptions days_bench;
  LocalizeBenchOptions localize_bench;
  SensorTrialOptions sensor_trials;
  WordBenchOptions word_bench;
  PictureBenchOptions picture_bench;
  ServeOptions serve;
  Command command;
};

/// Adds a verb with the common options.
CLI::App* AddVerb(CLI::App& parent, Options& options, const char* name, const char* what,
                  const char* example, Command command);

/// Houses, scenes and episodes.
void AddSceneVerbs(CLI::App& app, Options& options);
/// Runs, their results, maps, networks and tools.
void AddRunVerbs(CLI::App& app, Options& options);

/// `serve`.
void AddServe(CLI::App& app, Options& options);
/// --watch and --watch-port.
void AddWatch(CLI::App* verb, WatchOptions& watch);
/// `networks`.
void AddNetworks(CLI::App& app, Options& options);
/// `replay`.
void AddReplay(CLI::App& app, Options& options);
/// `bench days`.
void AddDaysBench(CLI::App& bench, Options& options);
/// `bench localize`.
void AddLocalizeBench(CLI::App& bench, Options& options);
/// `ask`.
void AddAsk(CLI::App& app, Options& options);
/// `bench words`.
void AddWordTrials(CLI::App& bench, Options& options);
/// `bench sensors`.
void AddSensorTrials(CLI::App& bench, Options& options);

}  // namespace crossnav::app
