// SPDX-License-Identifier: MIT
#include "network_choice.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

constexpr const char* kPageHelp = "Also report.html, one page with plots, by the Python package";

constexpr const char* kVariantHelp =
    "full; no-history-poi (inspected ground is forgotten at each goal, too), no-history-poi-pure "
    "(History POIs alone off); planar; onemap (the paper's baseline); paper, paper-no-history-poi "
    "(the literal method); told by "
    "ground truth: known-map, known-objects";

void AddPerception(CLI::App* verb, std::string& perception) {
  verb->add_option("--perception", perception,
                   "oracle (ground truth), or networks; default: eval.perception")
      ->check(CLI::IsMember({"oracle", "networks"}));
}

void AddNetworksPreset(CLI::App* verb, std::string& preset) {
  verb->add_option("--networks", preset, kNetworksHelp)->check(CLI::IsMember({"own", "real"}));
}

/// --variant, --success, --budget-scope and --perception.
template <class T>
void AddProtocol(CLI::App* verb, T& options) {
  verb->add_option("--variant", options.variant, kVariantHelp);
  verb->add_option("--success", options.success,
                   "Success rule of a STOP: near the box, or near a viewpoint (box, viewpoint)");
  verb->add_option("--budget-scope", options.budget_scope, "Action budget per episode or goal");
  AddPerception(verb, options.perception);
}

/// Options common to `eval` and `slurm`.
void AddEvaluation(CLI::App* verb, EvalOptions& eval) {
  verb->add_option("--scenes", eval.scenes, "Folder of scenes")->required();
  verb->add_option("--episodes", eval.episodes, "Episode file")->required();
  verb->add_option("--out", eval.out, "Folder of the run")->required();
  verb->add_option("--keep-replays", eval.keep_replays,
                   "none, or failures: of episodes that did not complete, in RUN/replays")
      ->check(CLI::IsMember({"none", "failures"}));
  AddProtocol(verb, eval);
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
  run->add_option("--pose", o.run.pose, kPoseHelp)->check(CLI::IsMember({"given", "unknown"}));
  run->add_option("--out", o.run.out, "Folder for pictures, record and trace; default: out/run");
  AddWatch(run, o.run.watch);
  AddProtocol(run, o.run);

  CLI::App* demo =
      AddVerb(app, o, "demo", "An episode in the house that comes with the program",
              "crossnav demo 2", [&o](Console& c) { return Demo(o.demo, o.common, c); });
  demo->add_option("NAME", o.demo.name,
                   "1 climbs to the upper floor, 2 descends; lifelong: two days with one memory, "
                   "and a night that carries the goal upstairs")
      ->check(CLI::IsMember({"1", "2", "lifelong"}));
  demo->add_option("--out", o.demo.out, "Folder to write to; default: out/demo");
  AddWatch(demo, o.demo.watch);
  AddPerception(demo, o.demo.perception);

  CLI::App* eval =
      AddVerb(app, o, "eval", "Many episodes",
              "crossnav eval --scenes scenes --episodes episodes.json.gz --out runs/full "
              "--jobs 4",
              [&o](Console& c) { return Eval(o.eval, o.common, c); });
  AddEvaluation(eval, o.eval);
  eval->add_option("--jobs", o.eval.jobs, "Processes")->check(CLI::Range(1, 1024));
  eval->add_option("--shard", o.eval.shard, "Part I of N of the episodes, I from 0")
      ->type_name("I/N");
  eval->add_flag("--resume", o.eval.resume, "Go on where the run stopped (the default)");
}

void AddCluster(CLI::App& app, Options& o) {
  CLI::App* slurm =
      AddVerb(app, o, "slurm", "An evaluation as a job array of Slurm, then merge and report",
              "crossnav slurm --scenes scenes --episodes episodes.json.gz --out runs/full "
              "--tasks 60 --cpus 4 --time 2:00:00 --memory 4G",
              [&o](Console& c) { return Slurm(o.slurm, o.common, c); });
  AddEvaluation(slurm, o.slurm.eval);
  slurm->add_option("--tasks", o.slurm.tasks, "Tasks of the array; each evaluates one shard")
      ->required()
      ->check(CLI::Range(1, 100000));
  slurm->add_option("--cpus", o.slurm.cpus, "Processors of a task; as many processes evaluate")
      ->check(CLI::Range(1, 1024));
  slurm->add_option("--partition", o.slurm.partition, "Partition; default: the cluster's");
  slurm->add_option("--time", o.slurm.time,
                    "Time limit of a task, as sbatch takes it; it requeues itself a minute before");
  slurm->add_option("--memory", o.slurm.memory, "Memory of a task, as sbatch's --mem: 4G");
  slurm->add_option("--account", o.slurm.account, "Account to charge");
  slurm
      ->add_option("--sbatch", o.slurm.sbatch,
                   "One more option of sbatch; may be repeated: --sbatch=--qos=low")
      ->type_name("OPTION")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  slurm->add_flag("--dry-run", o.slurm.dry_run, "Write OUT/slurm/*, submit nothing");
  CLI::App* merge = AddVerb(app, o, "merge", "The shards of a run as one result file",
                            "crossnav merge runs/full/shards --out runs/full/results.jsonl",
                            [&o](Console& c) { return Merge(o.merge, o.common, c); });
  merge->add_option("RUN", o.merge.runs, "Run folders or result files")->required();
  merge->add_option("--out", o.merge.out, "Result file to write (.jsonl)")->required();
  merge->add_flag("--partial", o.merge.partial, "Accept missing episodes");
}

void AddSuites(CLI::App& app, Options& o) {
  CLI::App* suite = app.add_subcommand("suite", "Named benchmarks, the same files anywhere");
  suite->require_subcommand(1);
  CLI::App* make = AddVerb(*suite, o, "make", "Houses and episodes of a suite, with their hash",
                           "crossnav suite make crossnav-mfmon-1-mini --jobs 4",
                           [&o](Console& c) { return SuiteMake(o.suite, o.common, c); });
  CLI::App* run = AddVerb(*suite, o, "run", "Makes the missing parts and runs the episodes",
                          "crossnav suite run crossnav-mfmon-1-mini --variant planar --jobs 4",
                          [&o](Console& c) { return SuiteRun(o.suite, o.common, c); });
  CLI::App* report = AddVerb(*suite, o, "report", "From nothing to a report over all its runs",
                             "crossnav suite report crossnav-mfmon-1-mini --jobs 4",
                             [&o](Console& c) { return SuiteReport(o.suite, o.common, c); });
  CLI::App* exported = AddVerb(*suite, o, "export", "A suite as Habitat loads it",
                               "crossnav suite export crossnav-mfmon-1-mini --to habitat exported",
                               [&o](Console& c) { return SuiteExport(o.suite, o.common, c); });
  exported->add_option("--to", o.suite.to, "Form (habitat) and folder to write to")
      ->required()
      ->type_name("FORM DIR")
      ->expected(2);
  for (CLI::App* verb : {make, run, report, exported}) {
    verb->add_option("NAME", o.suite.name,
                     "crossnav-mfmon-1, -mini or -val, crossnav-goat-1 (goals of three kinds), "
                     "-mini or -val, with -pack behind it for furniture of a pack; "
                     "crossnav-lifelong-1, -week, -drawn, -bim, -classes, -val, -dev or -mini; "
                     "crossnav-mfmon-2, or one of its tracks: "
                     "crossnav-mfmon-2/generated, /drawn or /bim")
        ->required();
    verb->add_option("--out", o.suite.out, "Folder of suites; default: out/suites");
    verb->add_option("--homes", o.suite.homes,
                     "Archive of Sweet Home 3D, for drawn homes; default: the installed one")
        ->type_name("JAR");
    verb->add_option("--buildings", o.suite.buildings,
                     "Folder of imported scenes, for the track bim and crossnav-lifelong-1-bim")
        ->type_name("DIR");
    verb->add_option("--furniture", o.suite.furniture, "Furniture pack of a -pack suite")
        ->type_name("DIR");
    verb->add_option("--jobs", o.suite.jobs, "Processes")->check(CLI::Range(1, 1024));
  }
  for (CLI::App* verb : {run, report}) {
    verb->add_option("--variant", o.suite.variant,
                     std::string(kVariantHelp) +
                         "; of crossnav-lifelong-1 the memory: none, keep (default) or revise");
    verb->add_option("--keep-replays", o.suite.keep_replays, "none or failures")
        ->check(CLI::IsMember({"none", "failures"}));
  }
  report
      ->add_option("--first-goals", o.suite.first_goals,
                   "Of crossnav-lifelong-1: only the first N goals of each visit count")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  report->add_flag("--partial", o.suite.partial, "Accept other runs that are not finished");
  report->add_flag("--force", o.suite.force, "Compare runs that differ in their task");
  report->add_flag("--page", o.suite.page, kPageHelp);
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
  report->add_flag("--page", o.report.page, kPageHelp);
  CLI::App* metrics = AddVerb(app, o, "metrics", "The metrics of result records alone",
                              "crossnav metrics runs/full/results.jsonl --json",
                              [&o](Console& c) { return ShowMetrics(o.metrics, o.common, c); });
  metrics->add_option("RESULTS", o.metrics.files, "Result files (.jsonl)")->required();

  CLI::App* gaps = AddVerb(
      app, o, "gaps", "Attribution of the missing SPL: geometry, search order, detours, approach",
      "crossnav gaps runs/full runs/known-map runs/known-objects",
      [&o](Console& c) { return ShowGaps(o.gaps, o.common, c); });
  gaps->add_option("RUN", o.gaps.runs,
                   "Run folders or result files of different variants on the same episodes")
      ->required();

  AddReplay(app, o);
}

/// Parameters that a recording lacks, or states wrongly.
void AddSensor(CLI::App* verb, MapBuildOptions& o) {
  verb->add_option("--intrinsics", o.intrinsics,
                   "Colour camera [px], and the depth camera's where it has none of its own")
      ->type_name("FX,FY,CX,CY")
      ->delimiter(',')
      ->expected(4);
  verb->add_option("--depth-intrinsics", o.depth_intrinsics, "Depth camera [px]")
      ->type_name("FX,FY,CX,CY")
      ->delimiter(',')
      ->expected(4);
  verb->add_option("--extrinsics", o.extrinsics,
                   "Pose of the depth camera in the colour camera [m]")
      ->type_name("X,Y,Z,QX,QY,QZ,QW")
      ->delimiter(',')
      ->expected(7);
  verb->add_option("--mount", o.mount, "Pose of the colour camera in the frame of the poses [m]")
      ->type_name("X,Y,Z,QX,QY,QZ,QW")
      ->delimiter(',')
      ->expected(7);
  verb->add_option("--up", o.recording.up, "Axis of the recording's world that points up")
      ->check(CLI::IsMember({"z", "y", "-y"}));
  verb->add_option("--depth-unit", o.recording.depth_unit_m, "Metres of one step of integer depth")
      ->check(CLI::Range(1e-6, 1.0));
}

void AddMapBuild(CLI::App& map, Options& o) {
  MapBuildOptions& b = o.map_build;
  CLI::App* build =
      AddVerb(map, o, "build", "A map and memory of a sensor's recording",
              "crossnav map build --from bag.mcap --networks real --goal chair --out home.map",
              [&o](Console& c) { return MapBuild(o.map_build, o.common, c); });
  build
      ->add_option("--from", b.from,
                   "Folder of TUM RGB-D, 7-Scenes or numbered frames, or ROS 2 bag (MCAP)")
      ->required()
      ->type_name("PATH");
  build->add_option("--out", b.out, "Map file to write")->required()->type_name("MAP");
  build
      ->add_option("--perception", b.perception,
                   "none (geometry alone), or networks: features that can be asked for; default: "
                   "networks with --goal or --networks, else none")
      ->check(CLI::IsMember({"none", "networks"}));
  AddNetworksPreset(build, b.networks);
  build
      ->add_option("--goal", b.goal,
                   "Then list the places of this text, or report that there is none")
      ->type_name("TEXT");
  build->add_option("--top", b.top, "Places at most")->check(CLI::Range(1, 1000));
  AddSensor(build, b);
  build->add_option("--match", b.recording.match_s, "Colour and depth are a pair within [s]")
      ->check(CLI::Range(0.0, 10.0));
  build->add_option("--pose-gap", b.pose_gap_s, "Longest time between two poses [s]")
      ->check(CLI::Range(0.0, 60.0));
  build
      ->add_option("--max-speed", b.recording.poses.speed_mps,
                   "A pose that moves faster is a jump [m/s]")
      ->check(CLI::Range(0.01, 1000.0));
  build->add_option("--colour-topic", b.recording.bag.colour_topic, "Of a bag's images");
  build->add_option("--depth-topic", b.recording.bag.depth_topic, "Likewise");
  build->add_option("--pose-topic", b.recording.bag.pose_topic, "nav_msgs/Odometry of a bag");
  build->add_option("--world-frame", b.recording.bag.world_frame,
                    "Frame of a bag's transforms; default: the root above the camera");
  build->add_flag("--skip-damaged", b.recording.skip_damaged,
                  "Leave out images that cannot be read, and take a bag that has no end");
}

void AddMap(CLI::App& app, Options& o) {
  CLI::App* map = app.add_subcommand("map", "Make a memory of a recording, look into a saved one");
  map->require_subcommand(1);
  AddMapBuild(*map, o);
  CLI::App* info = AddVerb(*map, o, "info", "Content of a map file", "crossnav map info home.map",
                           [&o](Console& c) { return MapInfo(o.map, o.common, c); });
  CLI::App* query =
      AddVerb(*map, o, "query",
              "Whether a text is in a map (match: 0 chance, 1 the name itself), and where",
              "crossnav map query home.map \"potted plant\" --top 4",
              [&o](Console& c) { return MapQuery(o.map, o.common, c); });
  CLI::App* points = AddVerb(*map, o, "export", "Voxels as a coloured point cloud (PLY)",
                             "crossnav map export home.map --out home.ply",
                             [&o](Console& c) { return MapExport(o.map, o.common, c); });
  CLI::App* graph = AddVerb(*map, o, "graph", "Floors, rooms and objects of a map as a graph",
                            "crossnav map graph home.map --to graph.json --objects chair,bed",
                            [&o](Console& c) { return MapGraph(o.map, o.common, c); });
  graph
      ->add_option("--to", o.map.out,
                   "File to write: .json, .graphml, .mcap, or .rrd by the Python package")
      ->required();
  graph
      ->add_option("--objects", o.map.objects,
                   "Categories to look for in the memory; default: none")
      ->type_name("A,B,...")
      ->delimiter(',');
  graph->add_option("--pictures", o.map.pictures, "Folder for a picture of each floor");
  for (CLI::App* verb : {info, query, points, graph}) {
    verb->add_option("MAP", o.map.file, "Map file")->required();
    verb->add_flag("--skip-damaged", o.map.skip_damaged, "Skip damaged parts");
  }
  query->add_option("TEXT", o.map.text, "Text to search for");
  query->add_option("--picture", o.map.picture,
                    "Instead: a picture (PNG) of the object, by the networks");
  query->add_option("--box", o.map.box, "About the object in the picture; default: its middle")
      ->type_name("U0,V0,U1,V1")
      ->delimiter(',')
      ->expected(4);
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

void AddTools(CLI::App& app, Options& o) {
  AddVerb(app, o, "doctor", "Versions and optional parts found here, and missing parts",
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
      AddVerb(*bench, o, "stairs", "Attempts at each kind of stair, and at false entrances",
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
  CLI::App* graph =
      AddVerb(*bench, o, "graph", "Rooms and floors of generated houses' maps against their plans",
              "crossnav bench graph --seed 7001 --count 10",
              [&o](Console& c) { return BenchGraph(o.graph_bench, o.common, c); });
  graph->add_option("--seed", o.graph_bench.seed, "Of the first house");
  graph->add_option("--count", o.graph_bench.count, "Houses")->check(CLI::Range(1, 100000));
  graph->add_option("--edition", o.graph_bench.edition, "Of the generator")
      ->check(CLI::Range(1, 2));
  graph->add_option("--pictures", o.graph_bench.pictures, "Folder for a picture of each floor");
  AddPerception(graph, o.graph_bench.perception);
  AddDaysBench(*bench, o);
  AddLocalizeBench(*bench, o);
  CLI::App* noise = AddVerb(*bench, o, "noise", "Success and map error under each kind of noise",
                            "crossnav bench noise --scenes scenes --episodes e.json --count 12",
                            [&o](Console& c) { return BenchNoise(o.noise, o.common, c); });
  noise->add_option("--scenes", o.noise.scenes, "Folder of scenes")->required();
  noise->add_option("--episodes", o.noise.episodes, "Episode file")->required();
  noise->add_option("--count", o.noise.count, "Episodes of it, spread over the scenes")
      ->check(CLI::Range(1, 100000));
  noise->add_option("--jobs", o.noise.jobs, "Processes")->check(CLI::Range(1, 1024));
  noise->add_option("--kind", o.noise.kinds, "Only this kind; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::IsMember(NoiseKinds()));
  noise->add_option("--out", o.noise.out, "JSON to write, for scripts/plot_noise.py");
  AddSensorTrials(*bench, o);
  AddWordTrials(*bench, o);
}

}  // namespace

void AddRunVerbs(CLI::App& app, Options& options) {
  AddRuns(app, options);
  AddCluster(app, options);
  AddSuites(app, options);
  AddResults(app, options);
  AddMap(app, options);
  AddAsk(app, options);
  AddServe(app, options);
  AddNetworks(app, options);
  AddTools(app, options);
}

}  // namespace crossnav::app
