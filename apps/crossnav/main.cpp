// SPDX-License-Identifier: MIT
// The program's command line. Exit 0 done, 1 bad data or a failed run, 2 usage.
#include <CLI/CLI.hpp>
#include <exception>
#include <functional>

#include "commands.h"

namespace crossnav::app {
namespace {

using Command = std::function<Result<void>(Console&)>;

/// Holds the options of every verb while CLI11 fills them in.
struct Options {
  CommonOptions common;
  WorldOptions world;
  AssetsOptions assets;
  SceneOptions scene;
  ViewsOptions views;
  SceneImportOptions scene_import;
  EpisodesOptions episodes;
  RunOptions run;
  DemoOptions demo;
  EvalOptions eval;
  SuiteOptions suite;
  ReportOptions report;
  MetricsOptions metrics;
  ReplayOptions replay;
  MapOptions map;
  BenchOptions bench;
  NetworksOptions networks;
  StairsOptions stairs;
  Command command;
};

/// Adds a verb with the options that all of them take.
CLI::App* AddVerb(CLI::App& parent, Options& options, const char* name, const char* what,
                  const char* example, Command command) {
  CLI::App* verb = parent.add_subcommand(name, what);
  verb->footer(std::string("Example:\n  ") + example);
  verb->add_flag("--json", options.common.json, "One JSON document on stdout, logs on stderr");
  verb->add_flag("--quiet", options.common.quiet, "No logs and no progress");
  verb->add_option("--config", options.common.config_file, "Settings (TOML); empty = the paper's")
      ->type_name("FILE");
  verb->add_option("--set", options.common.overrides, "Override a setting; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->callback([&options, command = std::move(command)] { options.command = command; });
  return verb;
}

/// What to draw houses from.
void AddHouses(CLI::App* verb, WorldOptions& world) {
  verb->add_option("--seed", world.seed, "First seed");
  verb->add_option("--count", world.count, "Number of houses")->check(CLI::Range(1, 100000));
  verb->add_option("--floors", world.floors, "Floors per house; 0 = by the seed")
      ->check(CLI::Range(0, 4));
  verb->add_option("--area", world.area_m2, "Area of a floor [m2], 60 to 400; default: by the seed")
      ->check(CLI::Range(60.0, 400.0));
  verb->add_option("--furniture", world.furniture,
                   "Furniture pack, or none for simple shapes; default: the one that assets import "
                   "made, where there is one")
      ->type_name("DIR|none");
  verb->add_flag("--scan", world.scan, "With the faults of a real scan, drawn from the seed");
}

void AddWorld(CLI::App& app, Options& o) {
  CLI::App* world = app.add_subcommand("world", "Make scenes");
  world->require_subcommand(1);
  CLI::App* verb = AddVerb(*world, o, "generate", "Furnished multi-floor houses in HM3D layout",
                           "crossnav world generate --seed 1 --count 4 --floors 2 --out scenes",
                           [&o](Console& c) { return WorldGenerate(o.world, o.common, c); });
  AddHouses(verb, o.world);
  verb->add_option("--out", o.world.out, "Folder to write to")->required();
  verb->add_option("--contact-sheet", o.world.contact_sheet,
                   "Picture of all houses: a view from inside and every floor from above")
      ->type_name("FILE.png");
  verb->add_flag("--embedded", o.world.embedded, "Write the house that comes with the program");
  CLI::App* stats =
      AddVerb(*world, o, "stats", "What a set of generated houses amounts to; keeps none of them",
              "crossnav world stats --seed 1 --count 200 --floors 0",
              [&o](Console& c) { return WorldStats(o.world, o.common, c); });
  AddHouses(stats, o.world);
}

void AddAssets(CLI::App& app, Options& o) {
  CLI::App* assets = app.add_subcommand("assets", "Furniture models for generated houses");
  assets->require_subcommand(1);
  CLI::App* verb =
      AddVerb(*assets, o, "import", "A furniture pack from the package sweethome3d-furniture",
              "crossnav assets import --out furniture",
              [&o](Console& c) { return AssetsImport(o.assets, o.common, c); });
  verb->add_option("DIR", o.assets.libraries,
                   "Folder of .sh3f libraries or of the unpacked package; default: the installed "
                   "package");
  verb->add_option(
      "--out", o.assets.out,
      "Pack to write; default: $XDG_DATA_HOME/crossnav/furniture, where world generate "
      "looks");
}

void AddScene(CLI::App& app, Options& o) {
  CLI::App* scene = app.add_subcommand("scene", "Look at a scene, import a home");
  scene->require_subcommand(1);
  CLI::App* info = AddVerb(*scene, o, "info", "Floors, stairs, instances and navmesh of a scene",
                           "crossnav scene info scenes/00001-House --json",
                           [&o](Console& c) { return SceneInfo(o.scene, o.common, c); });
  info->add_option("SCENE", o.scene.scene, "Scene folder")->required();
  CLI::App* render = AddVerb(*scene, o, "render", "A picture of a scene",
                             "crossnav scene render scenes/00001-House --top-down --out floor.png",
                             [&o](Console& c) { return SceneRender(o.scene, o.common, c); });
  render->add_option("SCENE", o.scene.scene, "Scene folder")->required();
  render->add_option("--at", o.scene.at, "Foot point [m], yaw and pitch [deg], world frame")
      ->type_name("X,Y,Z,YAW,PITCH");
  render->add_option("--view", o.scene.view, "colour, depth or semantic")
      ->check(CLI::IsMember({"colour", "depth", "semantic"}));
  render->add_flag("--top-down", o.scene.top_down, "A floor from above");
  render->add_option("--floor", o.scene.floor, "Floor of --top-down; default: the lowest");
  render->add_option("--px-per-m", o.scene.px_per_m, "Scale of --top-down")
      ->check(CLI::Range(1.0, 1000.0));
  render->add_option("--out", o.scene.out, "PNG to write")->required();
  CLI::App* views = AddVerb(*scene, o, "views", "Pictures of the goal objects from good places",
                            "crossnav scene views scenes/00001-House --out views",
                            [&o](Console& c) { return SceneViews(o.views, o.common, c); });
  views->add_option("SCENE", o.views.scene, "Scene folder")->required();
  views->add_option("--per-object", o.views.per_object, "Views of an object at most")
      ->check(CLI::Range(1, 1000));
  views->add_option("--out", o.views.out, "Folder for views.json and the pictures")->required();
  CLI::App* import =
      AddVerb(*scene, o, "import", "A home or a 3D model becomes a scene in HM3D layout",
              "crossnav scene import MyHome.sh3d --out scenes",
              [&o](Console& c) { return SceneImport(o.scene_import, o.common, c); });
  import
      ->add_option(
          "INPUT", o.scene_import.input,
          "Home of Sweet Home 3D (.sh3d), archive of homes (.jar), or 3D model (.obj, .glb, .gltf)")
      ->required();
  import->add_option("--out", o.scene_import.out, "Folder to write the scene to")->required();
  import->add_option("--objects", o.scene_import.objects,
                     "File that names the objects of a 3D model (JSON)");
  import->add_option("--name", o.scene_import.name, "Name of the scene; default: the input's");
  import->add_option("--home", o.scene_import.home, "Which home of an archive that holds several");
}

void AddEpisodes(CLI::App& app, Options& o) {
  CLI::App* episodes = app.add_subcommand("episodes", "Make and check episodes");
  episodes->require_subcommand(1);
  CLI::App* generate =
      AddVerb(*episodes, o, "generate", "Certified episodes",
              "crossnav episodes generate --scenes scenes --count 100 --goals 3 --cross-floor 0.3 "
              "--seed 1 --out episodes.json.gz",
              [&o](Console& c) { return EpisodesGenerate(o.episodes, o.common, c); });
  generate->add_option("--scenes", o.episodes.scenes, "Folder of scenes")->required();
  generate->add_option("--count", o.episodes.count, "Episodes")->check(CLI::Range(1, 1000000));
  generate->add_option("--goals", o.episodes.goals, "Goals per episode; default: dataset.goals")
      ->check(CLI::Range(1, 100));
  generate
      ->add_option("--cross-floor", o.episodes.cross_floor, "Share that requires a floor change")
      ->check(CLI::Range(0.0, 1.0));
  generate->add_option("--seed", o.episodes.seed, "Seed");
  generate->add_flag("--repeats", o.episodes.repeats, "Allow a category twice in an episode");
  generate->add_option("--out", o.episodes.out, "Episode file (.json or .json.gz)")->required();
  CLI::App* check = AddVerb(*episodes, o, "check", "Proves every certificate again",
                            "crossnav episodes check episodes.json.gz --scenes scenes",
                            [&o](Console& c) { return EpisodesCheck(o.episodes, o.common, c); });
  check->add_option("EPISODES", o.episodes.file, "Episode file")->required();
  check->add_option("--scenes", o.episodes.scenes, "Folder of scenes")->required();
}

void AddPerception(CLI::App* verb, std::string& perception) {
  verb->add_option("--perception", perception,
                   "oracle (ground truth), or networks; default: eval.perception")
      ->check(CLI::IsMember({"oracle", "networks"}));
}

/// --variant, --success, --budget-scope and --perception.
template <class T>
void AddProtocol(CLI::App* verb, T& options) {
  verb->add_option("--variant", options.variant, "full, no-history-poi or planar");
  verb->add_option("--success", options.success, "What a STOP must be near: box or viewpoint");
  verb->add_option("--budget-scope", options.budget_scope, "Action budget per episode or goal");
  AddPerception(verb, options.perception);
}

void AddRuns(CLI::App& app, Options& o) {
  CLI::App* run = AddVerb(app, o, "run", "One episode",
                          "crossnav run --scenes scenes --episodes episodes.json.gz --episode ID "
                          "--replay episode.mcap",
                          [&o](Console& c) { return Run(o.run, o.common, c); });
  run->add_option("--scenes", o.run.scenes, "Folder of scenes")->required();
  run->add_option("--episodes", o.run.episodes, "Episode file")->required();
  run->add_option("--episode", o.run.episode, "Its id")->required();
  run->add_option("--replay", o.run.replay, "Replay to write (.mcap)");
  run->add_option("--save-map", o.run.save_map, "Map file to save the memory to");
  run->add_option("--memory", o.run.memory, "Map file to start from, as --save-map wrote it");
  run->add_option("--out", o.run.out, "Folder for pictures, record and trace; default: out/run");
  AddProtocol(run, o.run);

  CLI::App* demo =
      AddVerb(app, o, "demo", "An episode in the house that comes with the program",
              "crossnav demo 2", [&o](Console& c) { return Demo(o.demo, o.common, c); });
  demo->add_option("NUMBER", o.demo.number, "1 climbs to the upper floor, 2 descends")
      ->check(CLI::Range(1, 2));
  demo->add_option("--out", o.demo.out, "Folder to write to; default: out/demo");
  AddPerception(demo, o.demo.perception);

  CLI::App* eval =
      AddVerb(app, o, "eval", "Many episodes",
              "crossnav eval --scenes scenes --episodes episodes.json.gz --out runs/full "
              "--jobs 4",
              [&o](Console& c) { return Eval(o.eval, o.common, c); });
  eval->add_option("--scenes", o.eval.scenes, "Folder of scenes")->required();
  eval->add_option("--episodes", o.eval.episodes, "Episode file")->required();
  eval->add_option("--out", o.eval.out, "Folder of the run")->required();
  eval->add_option("--jobs", o.eval.jobs, "Processes")->check(CLI::Range(1, 1024));
  eval->add_option("--shard", o.eval.shard, "Part I of N of the episodes, I from 0")
      ->type_name("I/N");
  eval->add_option("--keep-replays", o.eval.keep_replays,
                   "none, or failures: of episodes that did not complete, in RUN/replays")
      ->check(CLI::IsMember({"none", "failures"}));
  eval->add_flag("--resume", o.eval.resume, "Go on where the run stopped (the default)");
  AddProtocol(eval, o.eval);
}

void AddSuites(CLI::App& app, Options& o) {
  CLI::App* suite = app.add_subcommand("suite", "Named benchmarks, the same files anywhere");
  suite->require_subcommand(1);
  CLI::App* make = AddVerb(*suite, o, "make", "Houses and episodes of a suite, with their hash",
                           "crossnav suite make crossnav-mfmon-1-mini --jobs 4",
                           [&o](Console& c) { return SuiteMake(o.suite, o.common, c); });
  CLI::App* run = AddVerb(*suite, o, "run", "Makes what is missing and runs the episodes",
                          "crossnav suite run crossnav-mfmon-1-mini --variant planar --jobs 4",
                          [&o](Console& c) { return SuiteRun(o.suite, o.common, c); });
  CLI::App* report = AddVerb(*suite, o, "report", "From nothing to a report over all its runs",
                             "crossnav suite report crossnav-mfmon-1-mini --jobs 4",
                             [&o](Console& c) { return SuiteReport(o.suite, o.common, c); });
  for (CLI::App* verb : {make, run, report}) {
    verb->add_option("NAME", o.suite.name,
                     "crossnav-mfmon-1, crossnav-mfmon-1-mini or crossnav-mfmon-1-val, with -pack "
                     "behind it for furniture of a pack")
        ->required();
    verb->add_option("--out", o.suite.out, "Folder of suites; default: out/suites");
    verb->add_option("--furniture", o.suite.furniture, "Furniture pack of a -pack suite")
        ->type_name("DIR");
    verb->add_option("--jobs", o.suite.jobs, "Processes")->check(CLI::Range(1, 1024));
  }
  for (CLI::App* verb : {run, report}) {
    verb->add_option("--variant", o.suite.variant, "full, no-history-poi or planar");
    verb->add_option("--keep-replays", o.suite.keep_replays, "none or failures")
        ->check(CLI::IsMember({"none", "failures"}));
  }
  report->add_flag("--partial", o.suite.partial, "Accept other runs that are not finished");
  report->add_flag("--force", o.suite.force, "Compare runs that differ in their task");
}

void AddResults(CLI::App& app, Options& o) {
  CLI::App* report = AddVerb(app, o, "report", "Tables and plots, with the paper's numbers beside",
                             "crossnav report runs/full runs/no-history-poi --out report",
                             [&o](Console& c) { return Report(o.report, o.common, c); });
  report->add_option("RUN", o.report.runs, "Run folders or result files")->required();
  report->add_option("--out", o.report.out, "Folder to write to")->required();
  report->add_flag("--partial", o.report.partial, "Accept runs that are not finished");
  report->add_flag("--force", o.report.force,
                   "Compare runs that differ in episodes, scenes, seed, version or task");
  CLI::App* metrics = AddVerb(app, o, "metrics", "The metrics of result records alone",
                              "crossnav metrics runs/full/results.jsonl --json",
                              [&o](Console& c) { return ShowMetrics(o.metrics, o.common, c); });
  metrics->add_option("RESULTS", o.metrics.files, "Result files (.jsonl)")->required();

  CLI::App* replay = app.add_subcommand("replay", "Work with replays");
  replay->require_subcommand(1);
  CLI::App* page = AddVerb(*replay, o, "export", "A self-contained page",
                           "crossnav replay export episode.mcap --out episode.html",
                           [&o](Console& c) { return ReplayExport(o.replay, o.common, c); });
  page->add_option("REPLAY", o.replay.file, "Replay (.mcap)")->required();
  page->add_option("--out", o.replay.out, "Page to write (.html)")->required();
}

void AddMap(CLI::App& app, Options& o) {
  CLI::App* map = app.add_subcommand("map", "Look into a saved memory");
  map->require_subcommand(1);
  CLI::App* info = AddVerb(*map, o, "info", "What a map file holds", "crossnav map info home.map",
                           [&o](Console& c) { return MapInfo(o.map, o.common, c); });
  CLI::App* query = AddVerb(*map, o, "query", "Places that answer a text, best first",
                            "crossnav map query home.map \"potted plant\" --top 4",
                            [&o](Console& c) { return MapQuery(o.map, o.common, c); });
  CLI::App* points = AddVerb(*map, o, "export", "Voxels as a coloured point cloud (PLY)",
                             "crossnav map export home.map --out home.ply",
                             [&o](Console& c) { return MapExport(o.map, o.common, c); });
  for (CLI::App* verb : {info, query, points}) {
    verb->add_option("MAP", o.map.file, "Map file")->required();
    verb->add_flag("--skip-damaged", o.map.skip_damaged, "Go on with what is intact");
  }
  query->add_option("TEXT", o.map.text, "What to look for")->required();
  query->add_option("--top", o.map.top, "Places at most")->check(CLI::Range(1, 1000));
  query
      ->add_option("--from", o.map.from,
                   "Where you stand (foot point [m]); default: where each place was seen best")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  query->add_flag("--voxels", o.map.with_voxels, "List the voxels of each place under --json");
  points->add_option("--out", o.map.out, "PLY to write")->required();
  points->add_option("--query", o.map.text, "Colour by similarity to this text");
  points->add_flag("--surfaces", o.map.surfaces_only, "Leave out the air");
}

void AddNetworks(CLI::App& app, Options& o) {
  CLI::App* networks = app.add_subcommand("networks", "Networks for perception from pixels");
  networks->require_subcommand(1);
  AddVerb(*networks, o, "list", "Which networks there are", "crossnav networks list",
          [&o](Console& c) { return NetworksList(o.networks, o.common, c); });
  CLI::App* check = AddVerb(*networks, o, "check", "Whether files fit their cards, and how fast",
                            "crossnav networks check crossnav_small",
                            [&o](Console& c) { return NetworksCheck(o.networks, o.common, c); });
  check->add_option("CARD", o.networks.cards, "Names or paths of cards; default: all");
  CLI::App* look = AddVerb(*networks, o, "look", "What the networks see in a picture",
                           "crossnav networks look room.png --text sofa --out panel.png",
                           [&o](Console& c) { return NetworksLook(o.networks, o.common, c); });
  look->add_option("IMAGE", o.networks.image, "Picture (PNG or JPEG)")->required();
  look->add_option("--depth", o.networks.depth, "Its depth: PGM of 16 bits [mm], or .npy [m]");
  look->add_option("--text", o.networks.text, "Show how much each place is like this");
  look->add_option("--network", o.networks.network, "Card that answers alone; default: settings");
  look->add_option("--out", o.networks.out, "Picture to write (PNG)")->required();
}

void AddTools(CLI::App& app, Options& o) {
  AddVerb(app, o, "doctor", "What this program finds here, and what is missing",
          "crossnav doctor --json", [&o](Console& c) { return Doctor(o.common, c); });
  CLI::App* bench =
      AddVerb(app, o, "bench", "Timings of the whole step and of its stages",
              "crossnav bench --json", [&o](Console& c) { return Bench(o.bench, o.common, c); });
  bench->add_option("--scenes", o.bench.scenes, "Folder of scenes; default: the embedded house");
  bench->add_option("--episodes", o.bench.episodes, "Episode file");
  bench->add_option("--episode", o.bench.episode, "Its id; default: the first");
  AddPerception(bench, o.bench.perception);
  bench->add_option("--repeat", o.bench.repeat, "Runs of the episode")->check(CLI::Range(1, 1000));
  bench->callback([&o, bench] {
    if (!bench->get_subcommands().empty()) return;
    o.command = [&o](Console& c) { return Bench(o.bench, o.common, c); };
  });
  CLI::App* stairs =
      AddVerb(*bench, o, "stairs", "Attempts at each kind of stair, and at what is none",
              "crossnav bench stairs --count 40",
              [&o](Console& c) { return BenchStairs(o.stairs, o.common, c); });
  stairs->add_option("--count", o.stairs.count, "Attempts a kind and direction")
      ->check(CLI::Range(1, 100000));
  stairs->add_option("--seed", o.stairs.seed, "First seed");
  stairs->add_option("--budget", o.stairs.budget, "Actions of an attempt")
      ->check(CLI::Range(1, 1000000));
  stairs->add_option("--kind", o.stairs.kinds, "Only this kind; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::IsMember(StairTrialKinds()));
  stairs->add_option("--keep", o.stairs.keep,
                     "Folder for worlds and episodes of failed attempts, for crossnav run");
}

int Main(int argc, char** argv) {
  CLI::App app("crossnav: sequential object-goal navigation in multi-floor houses", "crossnav");
  app.set_version_flag("--version", CROSSNAV_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  Options options;
  AddWorld(app, options);
  AddAssets(app, options);
  AddScene(app, options);
  AddEpisodes(app, options);
  AddRuns(app, options);
  AddSuites(app, options);
  AddResults(app, options);
  AddMap(app, options);
  AddNetworks(app, options);
  AddTools(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "crossnav: %s\nSee: crossnav --help\n", error.what());
    return 2;
  }
  Console console(options.common.json, options.common.quiet);
  const auto ok = options.command(console);
  console.EndProgress();
  if (ok) return 0;
  console.Fail(ok.error());
  return 1;
}

}  // namespace
}  // namespace crossnav::app

int main(int argc, char** argv) {
  try {
    return crossnav::app::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crossnav: %s\n", error.what());
    return 1;
  }
}
