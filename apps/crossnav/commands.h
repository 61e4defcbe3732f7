// SPDX-License-Identifier: MIT
// A struct of options and a function per verb of the program; `crossnav VERB --help` describes
// them. main.cpp fills the structs from the command line.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/layout/house_params.h"

namespace crossnav::app {

/// Options common to all verbs.
struct CommonOptions {
  bool json = false, quiet = false;
  std::string config_file;
  std::vector<std::string> overrides;  ///< key=value
};

/// The paper's defaults, then the file, then the variant, then the overrides. `warnings` gets a
/// line for each old key of a renamed setting; main() prints them once for every verb.
Result<evaluation::RunConfig> LoadConfig(const CommonOptions& options,
                                         const std::string& variant = "full",
                                         std::vector<std::string>* warnings = nullptr);

struct WorldOptions {
  std::uint64_t seed = 1;
  int edition = 1;            ///< of the generator
  int count = 1, floors = 2;  ///< floors 0 = drawn from the seed
  double area_m2 = 0;         ///< of one floor; 0 = drawn from the seed
  world::Building building = world::Building::kDrawn;
  std::string out;
  std::string furniture;      ///< pack folder, "none", or empty = the default folder
  std::string contact_sheet;  ///< .png; empty = none
  bool embedded = false, scan = false;
  bool varied = false;

  /// Parameters of house `i` of the set.
  world::HouseParams ParamsOf(int i) const {
    world::HouseParams params;
    params.seed = seed + static_cast<std::uint64_t>(i);
    params.edition = edition;
    params.building = building;
    params.floors = floors;
    params.area_m2 = area_m2;
    params.is_scan = scan;
    params.is_varied = varied;
    return params;
  }
};
Result<void> WorldGenerate(const WorldOptions& options, const CommonOptions& common,
                           Console& console);

struct ChangeOptions {
  std::string house, out;  ///< folders; out empty = the folder that holds the house
  std::uint64_t seed = 1;
  int days = 1;
  std::vector<std::string> kinds;  ///< empty = each once
};
/// The same house on later days.
Result<void> WorldChange(const ChangeOptions& options, const CommonOptions& common,
                         Console& console);

/// Generates houses without keeping them, and prints their statistics.
Result<void> WorldStats(const WorldOptions& options, const CommonOptions& common, Console& console);

struct AssetsOptions {
  std::string libraries;  ///< folder of .sh3f files or of the unpacked package; empty = installed
  std::string out;        ///< pack folder; empty = DefaultFurniture()
};
Result<void> AssetsImport(const AssetsOptions& options, const CommonOptions& common,
                          Console& console);

/// $XDG_DATA_HOME/crossnav/furniture, the generator's default pack.
std::string DefaultFurniture();
/// The requested pack: a folder, "none", or empty = the default folder. Without a default pack:
/// empty, with a notice.
Result<std::optional<world::FurniturePack>> OpenFurniture(const std::string& wish,
                                                          Console& console);

struct SceneOptions {
  std::string scene;  ///< folder
  std::string at;     ///< "x,y,z,yaw_deg,pitch_deg"
  std::string out;
  std::string view = "colour";  ///< colour | depth | semantic
  bool top_down = false;
  int floor = -1;  ///< of the top-down view; -1 = lowest
  double px_per_m = 50;
};
Result<void> SceneInfo(const SceneOptions& options, const CommonOptions& common, Console& console);
Result<void> SceneRender(const SceneOptions& options, const CommonOptions& common,
                         Console& console);

struct ViewsOptions {
  std::string scene;  ///< folder
  std::string out;    ///< folder for views.json and the pictures
  int per_object = 4;
};
Result<void> SceneViews(const ViewsOptions& options, const CommonOptions& common, Console& console);

struct FramesOptions {
  std::string scene, out;
  int count = 100, size_px = 256;
  std::uint64_t seed = 1;
};
Result<void> SceneFrames(const FramesOptions& options, const CommonOptions& common,
                         Console& console);

struct SceneImportOptions {
  std::string input, out, name, home, objects;
  std::optional<std::uint64_t> furnish;  ///< seed
  std::string furniture;                 ///< as of WorldOptions
  int seconds = 18;                      ///< of an IFC import; chosen: ends within 20 s
};
Result<void> SceneImport(const SceneImportOptions& options, const CommonOptions& common,
                         Console& console);

struct EpisodesOptions {
  std::string scenes, file, out;
  int count = 10, goals = 0;
  double cross_floor = 0.3;
  double alternate = 0;  ///< share of these that changes floors at every stage
  std::uint64_t seed = 1;
  bool repeats = false;
  std::string certify;                ///< coverage or detection; empty = as configured
  std::string track;                  ///< origin of the buildings; empty = none
  std::string scene_list;             ///< file of names, one a line; empty = every scene
  std::vector<int> first;             ///< episodes with their first transition at stage 1, 2, ...
  bool by_scene = false;              ///< one scene in memory at a time
  std::string goals_as = "category";  ///< category, description, picture, or mixed
};
Result<void> EpisodesGenerate(const EpisodesOptions& options, const CommonOptions& common,
                              Console& console);
Result<void> EpisodesCheck(const EpisodesOptions& options, const CommonOptions& common,
                           Console& console);

struct ChooseOptions {
  std::string scenes, out;
  int floors = 1;                       ///< minimum number
  std::vector<std::string> categories;  ///< each must be observable
};
/// Scenes with at least this many floors and these categories, as a list for EpisodesGenerate.
Result<void> SceneChoose(const ChooseOptions& options, const CommonOptions& common,
                         Console& console);

/// --watch and --watch-port; a port alone asks for it, too.
struct WatchOptions {
  bool is_on = false;
  int port = -1;  ///< 0 = any that is free
};

struct RunOptions {
  std::string scenes, episodes, episode;
  std::string variant = "full";
  std::string out;       ///< folder for pictures, record and trace
  std::string replay;    ///< .mcap; empty = none
  std::string save_map;  ///< map file to save the memory to; empty = none
  std::string memory;    ///< map file to start from; empty = none
  std::string pose;      ///< unknown = to be found in that map; empty = given
  std::string success, budget_scope, perception;
  WatchOptions watch;
};
Result<void> Run(const RunOptions& options, const CommonOptions& common, Console& console);

struct DemoOptions {
  std::string name = "1";  ///< 1 climbs, 2 descends; lifelong: two days
  std::string out = "out/demo";
  std::string perception;  ///< oracle or networks; empty = as configured
  WatchOptions watch;
};
Result<void> Demo(const DemoOptions& options, const CommonOptions& common, Console& console);

struct EvalOptions {
  std::string scenes, episodes, out;
  std::string variant = "full";
  std::string success, budget_scope, perception;
  std::string shard = "0/1";
  std::string keep_replays = "none";  ///< none | failures
  int jobs = 1;
  bool resume = false;  ///< the default; documents the intention in scripts
  // Expected hashes of the files; empty = any.
  std::string episodes_hash;
  std::map<std::string, std::string> mesh_hashes;  ///< name of the scene: hash
};
Result<void> Eval(const EvalOptions& options, const CommonOptions& common, Console& console);

struct SlurmOptions {
  EvalOptions eval;  ///< of the tasks; shard and jobs are set per task
  int tasks = 0, cpus = 1;
  std::string partition, time, memory, account;  ///< passed to sbatch; empty = the cluster's
  std::vector<std::string> sbatch;               ///< more options of sbatch
  bool dry_run = false;
};
/// Writes the scripts of a job array into OUT/slurm and submits them.
Result<void> Slurm(const SlurmOptions& options, const CommonOptions& common, Console& console);

struct MergeOptions {
  std::vector<std::string> runs;  ///< folders or result files
  std::string out;
  bool partial = false;  ///< accept missing episodes
};
Result<void> Merge(const MergeOptions& options, const CommonOptions& common, Console& console);

struct SuiteOptions {
  std::string name, out = "out/suites";
  std::string homes = "/usr/share/sweethome3d/sweethome3d.jar";  ///< of the track drawn
  std::string buildings;  ///< folder of imported scenes, for the track bim
  std::string furniture;  ///< as in WorldOptions, for suites that use a pack
  std::string variant = "full", keep_replays = "none";
  int jobs = 1;
  int first_goals = 0;  ///< goals of each visit that a report counts; 0 = all
  bool partial = false, force = false, page = false;  ///< as in ReportOptions
  std::vector<std::string> to;                        ///< of SuiteExport: form and folder
};
/// Exports an existing suite in the format of another simulator.
Result<void> SuiteExport(const SuiteOptions& options, const CommonOptions& common,
                         Console& console);
/// Makes the suite, unless it exists.
Result<void> SuiteMake(const SuiteOptions& options, const CommonOptions& common, Console& console);
/// SuiteMake, then runs the suite to its end.
Result<void> SuiteRun(const SuiteOptions& options, const CommonOptions& common, Console& console);
/// SuiteRun, then reports on all its runs.
Result<void> SuiteReport(const SuiteOptions& options, const CommonOptions& common,
                         Console& console);

struct ReportOptions {
  std::vector<std::string> runs;
  std::string out;
  bool partial = false;  ///< accept runs with missing episodes
  bool force = false;    ///< compare runs of different tasks
  bool page = false;     ///< OUT/report.html, too, by the Python package
};
Result<void> Report(const ReportOptions& options, const CommonOptions& common, Console& console);

struct GapsOptions {
  std::vector<std::string> runs;
};
/// Attribution of the missing SPL, from runs of full, known-map and known-objects.
Result<void> ShowGaps(const GapsOptions& options, const CommonOptions& common, Console& console);

struct MetricsOptions {
  std::vector<std::string> files;
};
Result<void> ShowMetrics(const MetricsOptions& options, const CommonOptions& common,
                         Console& console);

struct ReplayOptions {
  std::string file, out, compare;
};
Result<void> ReplayExport(const ReplayOptions& options, const CommonOptions& common,
                          Console& console);

struct MapOptions {
  std::string file, text, out;
  int top = 4;
  std::vector<double> from;  ///< foot point of the asker, world [m]; empty = the best view's place
  bool with_voxels = false;
  bool surfaces_only = false, skip_damaged = false;
  std::vector<std::string> objects;  ///< of the graph: categories to look for
  std::string pictures;              ///< of the graph: folder; empty = none
  std::string picture;               ///< of the query, instead of `text`: PNG
  std::vector<int> box;              ///< about the object in it; empty = in the middle
};
Result<void> MapInfo(const MapOptions& options, const CommonOptions& common, Console& console);
Result<void> MapQuery(const MapOptions& options, const CommonOptions& common, Console& console);
/// Building, floors, rooms and objects, as JSON or GraphML by the ending of `out`.
Result<void> MapGraph(const MapOptions& options, const CommonOptions& common, Console& console);
Result<void> MapExport(const MapOptions& options, const CommonOptions& common, Console& console);

struct BenchOptions {
  std::string scenes, episodes, episode;
  std::string perception;  ///< as in DemoOptions
  int repeat = 1;
};
Result<void> Bench(const BenchOptions& options, const CommonOptions& common, Console& console);

struct NetworksOptions {
  std::vector<std::string> cards;  ///< to check; empty = all
  std::string image, depth, text, out;
  std::string network;  ///< card of a single network; empty = networks of the settings
  std::string scenes;   ///< development houses
};
Result<void> NetworksList(const NetworksOptions& options, const CommonOptions& common,
                          Console& console);
Result<void> NetworksCheck(const NetworksOptions& options, const CommonOptions& common,
                           Console& console);
Result<void> NetworksCalibrate(const NetworksOptions& options, const CommonOptions& common,
                               Console& console);
Result<void> NetworksLook(const NetworksOptions& options, const CommonOptions& common,
                          Console& console);

struct StairsOptions {
  int count = 40;    ///< attempts a kind and direction
  int budget = 400;  ///< actions of an attempt
  std::uint64_t seed = 1;
  std::vector<std::string> kinds;  ///< empty = all
  std::string keep;                ///< folder for worlds and episodes of failed attempts
};
/// Valid names in StairsOptions::kinds.
std::vector<std::string> StairTrialKinds();
Result<void> BenchStairs(const StairsOptions& options, const CommonOptions& common,
                         Console& console);

struct GraphBenchOptions {
  int count = 10, edition = 1;
  std::uint64_t seed = 1;
  std::string pictures;    ///< folder; empty = none
  std::string perception;  ///< of the objects: oracle | networks; empty = eval.perception
};
Result<void> BenchGraph(const GraphBenchOptions& options, const CommonOptions& common,
                        Console& console);

struct DaysBenchOptions {
  std::string house, map;  ///< folder; file to keep, empty = none
  int days = 30, goals = 5;
  std::uint64_t seed = 1;
};
/// One memory kept through days of change.
Result<void> BenchDays(const DaysBenchOptions& options, const CommonOptions& common,
                       Console& console);

struct LocalizeBenchOptions {
  std::string scenes;
  std::string twins;  ///< same | own: houses whose floors are one plan, instead of scenes
  std::uint64_t house_seed = 1;
  std::string recording;  ///< instead of scenes: frames of a real sensor
  int houses = 10;        ///< twins
  int count = 100;
  int views = 12;  ///< of a recording, per robot
  std::uint64_t seed = 1;
};
Result<void> BenchLocalize(const LocalizeBenchOptions& options, const CommonOptions& common,
                           Console& console);

struct SensorTrialOptions {
  std::string data;        ///< folder
  std::string perception;  ///< none | networks; empty = networks if the files of `real` exist
  std::string networks;    ///< preset, as in LoadWithNetworks
};

Result<void> Doctor(const CommonOptions& common, Console& console);

}  // namespace crossnav::app
