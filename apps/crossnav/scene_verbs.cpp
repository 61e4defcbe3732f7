// SPDX-License-Identifier: MIT
#include <map>

#include "crossnav/world/change/changes.h"
#include "crossnav/world/layout/edition.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

/// Parameters of generated houses.
void AddHouses(CLI::App* verb, WorldOptions& world) {
  verb->add_option("--seed", world.seed, "First seed");
  verb->add_option("--count", world.count, "Number of houses")->check(CLI::Range(1, 100000));
  verb->add_option("--floors", world.floors, "Floors per house; 0 = by the seed")
      ->check(CLI::Range(0, 4));
  verb->add_option("--area", world.area_m2, "Area of a floor [m2], 60 to 400; default: by the seed")
      ->check(CLI::Range(60.0, 400.0));
  verb->add_option("--edition", world.edition,
                   "Edition of the generator: 1, of which the suites are made, or 2, which builds "
                   "what others build; default: 1")
      ->check(CLI::Range(1, world::kEditions));
  verb->add_option("--building", world.building,
                   "home, or office: corridors with many small rooms (edition 2); default: by the "
                   "seed")
      ->transform(CLI::CheckedTransformer(std::map<std::string, world::Building>{
          {"home", world::Building::kHome}, {"office", world::Building::kOffice}}));
  verb->add_option("--furniture", world.furniture,
                   "Furniture pack, or none for simple shapes; default: the one that assets import "
                   "made, where there is one")
      ->type_name("DIR|none");
  verb->add_flag("--scan", world.scan, "With the faults of a real scan, drawn from the seed");
  verb->add_flag("--varied", world.varied,
                 "Furniture of uncommon sizes in uncommon places: houses to train networks in");
}

void AddChange(CLI::App& world, Options& o) {
  CLI::App* change =
      AddVerb(world, o, "change", "The same house on later days: things moved, ways barred",
              "crossnav world change scenes/00001-House1 --seed 1 --days 3",
              [&o](Console& c) { return WorldChange(o.change, o.common, c); });
  change->add_option("HOUSE", o.change.house, "Scene folder")->required();
  change->add_option("--seed", o.change.seed, "Seed of the changes");
  change->add_option("--days", o.change.days, "Days after the first")->check(CLI::Range(1, 1000));
  change->add_option("--out", o.change.out,
                     "Folder to write HOUSE-day1 ... to; default: the folder that holds HOUSE");
  change
      ->add_option("--kinds", o.change.kinds,
                   "Changes of each night: same_furniture, other_furniture, other_room, "
                   "other_floor, removed, added, door_closed, passage_blocked, flight_barred; "
                   "default: each once, where the house has a place for it")
      ->delimiter(',')
      ->check(CLI::IsMember(
          std::vector<std::string>(world::kChangeNames.begin(), world::kChangeNames.end())));
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
  AddChange(*world, o);
  CLI::App* stats =
      AddVerb(*world, o, "stats", "Statistics of a set of generated houses; keeps none of them",
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
                   "Folder of .sh3f libraries or of the unpacked package, or one library: a .sh3f, "
                   "or sweethome3d.jar with the program's own catalogue; default: the installed "
                   "package");
  verb->add_option(
      "--out", o.assets.out,
      "Pack to write; default: $XDG_DATA_HOME/crossnav/furniture, where world generate "
      "looks");
}

void AddFrames(CLI::App& scene, Options& o) {
  CLI::App* frames = AddVerb(scene, o, "frames", "Frames with ground truth, to train networks on",
                             "crossnav scene frames scenes/00001-House --count 100 --out frames",
                             [&o](Console& c) { return SceneFrames(o.frames, o.common, c); });
  frames->add_option("SCENE", o.frames.scene, "Scene folder")->required();
  frames->add_option("--count", o.frames.count, "Frames")->check(CLI::Range(1, 60000));
  frames->add_option("--size", o.frames.size_px, "Width and height [px]")
      ->check(CLI::Range(16, 1024));
  frames->add_option("--seed", o.frames.seed, "Seed of the places");
  frames->add_option("--out", o.frames.out, "Folder for frames.json and the arrays")->required();
}

void AddChoose(CLI::App& scene, Options& o) {
  CLI::App* choose = AddVerb(scene, o, "choose", "Scenes by floors and categories, as a list",
                             "crossnav scene choose --scenes hm3d/val --floors 2 --categories "
                             "bed,chair,plant,sofa,toilet,tv_monitor --out scenes.txt",
                             [&o](Console& c) { return SceneChoose(o.choose, o.common, c); });
  choose->add_option("--scenes", o.choose.scenes, "Folder of scenes")->required();
  choose->add_option("--floors", o.choose.floors, "Floors at least; default: 1")
      ->check(CLI::Range(1, 100));
  choose
      ->add_option("--categories", o.choose.categories,
                   "Goal categories that can be observed from somewhere; default: any")
      ->delimiter(',');
  choose->add_option("--out", o.choose.out, "List to write: a name a line, for --scene-list");
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
  render
      ->add_option(
          "--at", o.scene.at,
          "Foot point [m], yaw and pitch [deg], world frame; default: a place that shows much")
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
  AddFrames(*scene, o);
  AddChoose(*scene, o);
  CLI::App* import = AddVerb(*scene, o, "import",
                             "A home, a building or a 3D model becomes a scene in HM3D layout",
                             "crossnav scene import MyHome.sh3d --out scenes",
                             [&o](Console& c) { return SceneImport(o.scene_import, o.common, c); });
  import
      ->add_option(
          "INPUT", o.scene_import.input,
          "Home of Sweet Home 3D (.sh3d), archive of homes (.jar), building (.ifc), or 3D model "
          "(.obj, .glb, .gltf)")
      ->required();
  import->add_option("--out", o.scene_import.out, "Folder to write the scene to")->required();
  import->add_option("--objects", o.scene_import.objects,
                     "File that names the objects of a 3D model (JSON)");
  import->add_option("--name", o.scene_import.name, "Name of the scene; default: the input's");
  import->add_option("--home", o.scene_import.home, "Which home of an archive that holds several");
  import
      ->add_option("--furnish", o.scene_import.furnish,
                   "Furnish the rooms of a home or building by their names")
      ->type_name("SEED");
  import
      ->add_option("--furniture", o.scene_import.furniture,
                   "Furniture pack for --furnish, or none for simple shapes; default: the one that "
                   "assets import made, where there is one")
      ->type_name("DIR|none");
  import
      ->add_option(
          "--seconds", o.scene_import.seconds,
          "Most seconds that importing an .ifc may take, by the clock and of processor time")
      ->check(CLI::Range(1, 86400));
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
  generate
      ->add_option("--alternate", o.episodes.alternate,
                   "Share of those that requires a floor change at every stage: down, up, down; "
                   "default: 0")
      ->check(CLI::Range(0.0, 1.0));
  generate->add_option("--seed", o.episodes.seed, "Seed");
  generate
      ->add_option("--certify", o.episodes.certify,
                   "By what an instance certifies a stage: coverage (a viewpoint), or detection (a "
                   "viewpoint from where the agent would confirm it); default: dataset.certificate")
      ->check(CLI::IsMember({"coverage", "detection"}));
  generate->add_option(
      "--track", o.episodes.track,
      "Origin of the buildings, by which results are given: generated, drawn, bim, "
      "scan or a word of yours");
  generate->add_option("--scene-list", o.episodes.scene_list,
                       "File that names the scenes, one a line (scene choose); default: all");
  generate
      ->add_option("--first", o.episodes.first,
                   "How many episodes have their first floor change at stage 1, 2, ...; the others "
                   "require none; instead of --cross-floor")
      ->delimiter(',')
      ->check(CLI::Range(0, 1000000))
      ->type_name("N,N,N");
  generate->add_flag("--by-scene", o.episodes.by_scene,
                     "Keep one scene in memory at a time; draws other episodes than without");
  generate
      ->add_option("--goals-as", o.episodes.goals_as,
                   "category; description: of one object each; picture: of one object each; mixed: "
                   "the three in equal parts, as GOAT-Bench")
      ->check(CLI::IsMember({"category", "description", "picture", "mixed"}));
  generate->add_flag("--repeats", o.episodes.repeats, "Allow a category twice in an episode");
  generate->add_option("--out", o.episodes.out, "Episode file (.json or .json.gz)")->required();
  CLI::App* check = AddVerb(*episodes, o, "check", "Proves every certificate again",
                            "crossnav episodes check episodes.json.gz --scenes scenes",
                            [&o](Console& c) { return EpisodesCheck(o.episodes, o.common, c); });
  check->add_option("EPISODES", o.episodes.file, "Episode file")->required();
  check->add_option("--scenes", o.episodes.scenes, "Folder of scenes")->required();
}

}  // namespace

void AddSceneVerbs(CLI::App& app, Options& options) {
  AddWorld(app, options);
  AddAssets(app, options);
  AddScene(app, options);
  AddEpisodes(app, options);
}

}  // namespace crossnav::app
