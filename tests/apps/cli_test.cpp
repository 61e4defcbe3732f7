// SPDX-License-Identifier: MIT
// Runs the program: exit codes, one clear message, nothing half written, one JSON document.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <thread>

#include "apps/cli_fixture.h"
#include "crossnav/core/png_image.h"
#include "support/places.h"
#include "support/zip_archive.h"

namespace crossnav {
namespace {

using test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;
using test::ReadText;
using test::WriteText;
namespace fs = std::filesystem;

TEST_F(Cli, UsageErrorsExitWithTwo) {
  EXPECT_EQ(Run("").exit_code, 2);
  EXPECT_EQ(Run("fly").exit_code, 2);
  EXPECT_EQ(Run("eval --scenes scenes").exit_code, 2);
  EXPECT_EQ(Run("demo 3").exit_code, 2);
}

TEST_F(Cli, EveryVerbHasHelpWithAnExample) {
  for (const char* verb : {"doctor",         "assets import",
                           "world generate", "world stats",
                           "scene info",     "scene render",
                           "scene import",   "scene views",
                           "scene frames",   "episodes generate",
                           "episodes check", "run",
                           "eval",           "report",
                           "metrics",        "replay export",
                           "map info",       "map query",
                           "map export",     "bench",
                           "bench stairs",   "demo",
                           "suite make",     "suite run",
                           "suite report",   "networks list",
                           "networks check", "networks look"}) {
    const Outcome outcome = Run(std::string(verb) + " --help");
    EXPECT_EQ(outcome.exit_code, 0) << verb;
    EXPECT_NE(outcome.out.find("Example:"), std::string::npos) << verb;
    for (const char* option : {"--json", "--config", "--set", "--quiet"}) {
      EXPECT_NE(outcome.out.find(option), std::string::npos) << verb << " " << option;
    }
  }
}

TEST_F(Cli, AnOldKeyOfASettingIsReadWithOneWarning) {
  const Outcome outcome = Run("doctor --json --set policy.explore.crumb_m=7");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(Json::parse(outcome.out).contains("version"));
  const std::string start =
      "crossnav: warning: --set: key \"policy.explore.crumb_m\" is now "
      "\"policy.explore.small_frontier_penalty_m\"";
  const std::size_t at = outcome.err.find(start);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(start, at + 1), std::string::npos) << outcome.err;
}

TEST_F(Cli, DoctorPrintsOneJsonDocument) {
  const Outcome outcome = Run("doctor --json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(Json::parse(outcome.out).contains("version"));
}

TEST_F(Cli, BenchStairsPrintsARowPerKindAndDirection) {
  const Outcome outcome =
      Run("bench stairs --json --quiet --count 2 --budget 40 --kind straight --kind \"shelf like "
          "steps\" --keep kept" +
          std::string(kSmall));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  ASSERT_EQ(document["stairs"].size(), 2u);
  EXPECT_EQ(document["stairs"][0]["way"], "up");
  EXPECT_EQ(document["stairs"][1]["way"], "down");
  for (const Json& row : document["stairs"]) EXPECT_EQ(row["attempts"], 2);
  ASSERT_EQ(document["false_entrances"].size(), 1u);
  EXPECT_EQ(document["false_entrances"][0]["kind"], "shelf like steps");
  const auto failures =
      document["stairs"][0]["failures"].size() + document["stairs"][1]["failures"].size();
  ASSERT_GT(failures, 0u);  // 40 actions are too few
  const Json kept = Json::parse(ReadText(At("kept/episodes.json")));
  ASSERT_EQ(kept["episodes"].size(), failures);
  const Outcome again =
      Run("run --quiet --scenes kept --episodes kept/episodes.json --out again --episode " +
          kept["episodes"][0]["episode_id"].get<std::string>() + kSmall);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  ExpectFailure("bench stairs --quiet --count 1 --keep /proc/none", {"--keep"});
}

// Both wrote the house into one folder, and the second removed it from under the first.
TEST_F(Cli, TwoBenchesRunAtOnce) {
  const std::string bench = std::string("bench --quiet") + kSmall;
  for (int round = 0; round < 3; ++round) {
    const Outcome outcome =
        RunIn(folder_, bench,
              "('" + test::ProgramPath() + "' " + bench + " >beside 2>&1; touch ended) &");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (int i = 0; i < 300 && !std::filesystem::exists(At("ended")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_NE(ReadText(At("beside")).find("steps/s"), std::string::npos) << ReadText(At("beside"));
    std::filesystem::remove(At("ended"));
  }
}

TEST_F(Cli, SceneInfoFollowsTheContract) {
  const Outcome outcome = Run("scene info scenes/00001-CrossnavHouse --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json info = Json::parse(outcome.out);
  EXPECT_TRUE(info["navmesh"].contains("settings"));
  EXPECT_TRUE(info["navmesh"]["hash"].is_string());
  EXPECT_GT(info["navmesh"]["area_m2"], 10);
  EXPECT_EQ(info["floors"].size(), 2u);
  EXPECT_EQ(info["connections"][0]["floors"], (std::vector<int>{0, 1}));
  EXPECT_GT(info["connections"][0]["rise_m"], 2);
  const Json bed = info["instances"]["bed"][0];
  for (const char* key : {"id", "name", "floor", "box_min", "box_max", "viewpoints"}) {
    EXPECT_TRUE(bed.contains(key)) << key;
  }
}

TEST_F(Cli, SceneViewsShowsGoalObjectsAndIsTheSameEachTime) {
  const std::string views = "scene views scenes/00001-CrossnavHouse --quiet --per-object 1 --json";
  const Outcome outcome = Run(views + " --out a");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_EQ(document, Json::parse(ReadText(At("a/views.json"))));
  std::set<std::string> categories;
  for (const Json& view : document["views"]) {
    categories.insert(view["category"]);
    EXPECT_GT(fs::file_size(At("a") / view["file"].get<std::string>()), 1000u);
    EXPECT_GE(view["visible_fraction"], 0.7);
    EXPECT_GE(view["distance_m"], 1.0);
    EXPECT_LE(view["distance_m"], 3.0);
    int itself = 0;
    for (const Json& object : view["objects"]) {
      if (object["instance"] != view["instance"]) continue;
      ++itself;
      EXPECT_EQ(object["box"], view["box"]);
    }
    EXPECT_EQ(itself, 1);
  }
  EXPECT_EQ(categories.size(), 6u);
  ASSERT_EQ(Run(views + " --out b").exit_code, 0);
  for (const auto& entry : fs::directory_iterator(At("a"))) {
    EXPECT_EQ(ReadText(entry.path()), ReadText(At("b") / entry.path().filename())) << entry.path();
  }
  WriteText(At("file"), "in the way");
  ExpectFailure("scene views scenes/00001-CrossnavHouse --out file/views", {"file/views"});
}

TEST_F(Cli, SceneFramesAreArraysOfTheAskedSizeAndTheSameEachTime) {
  const std::string frames = "scene frames scenes/00001-CrossnavHouse --quiet --count 6 --size 32";
  const Outcome outcome = Run(frames + " --json --out a");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_EQ(document, Json::parse(ReadText(At("a/frames.json"))));
  EXPECT_EQ(document["frames"].size(), 6u);
  const std::size_t pixels = 6 * 32 * 32;
  for (const auto& [file, bytes] : {std::pair("rgb.npy", 3 * pixels),
                                    {"depth_mm.npy", 2 * pixels},
                                    {"instance.npy", 2 * pixels}}) {
    const std::string array = ReadText(At(std::string("a/") + file));
    EXPECT_EQ(array.compare(1, 5, "NUMPY"), 0) << file;
    EXPECT_EQ((array.size() - bytes) % 64, 0u) << file;
    EXPECT_EQ(array[array.size() - bytes - 1], '\n') << file;
  }
  ASSERT_EQ(Run(frames + " --out b").exit_code, 0);
  for (const auto& entry : fs::directory_iterator(At("a"))) {
    EXPECT_EQ(ReadText(entry.path()), ReadText(At("b") / entry.path().filename())) << entry.path();
  }
}

TEST_F(Cli, RunLeavesRecordTracePicturesReplayMapAndPage) {
  const Outcome outcome =
      Run("run --quiet --json --scenes scenes --episodes e.json --episode " + FirstId() +
          " --out run --replay run/r.mcap --save-map run/m.map" + kSmall);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["record"]["episode_id"], FirstId());
  for (const char* name :
       {"results.jsonl", "trace.jsonl", "floor_0.png", "floor_1.png", "r.mcap"}) {
    EXPECT_GT(fs::file_size(At(std::string("run/") + name)), 100u) << name;
  }
  EXPECT_EQ(Run("replay export run/r.mcap --out run/r.html").exit_code, 0);
  const std::string compare = "replay export run/r.mcap --compare run/r.mcap --out ";
  EXPECT_EQ(Run(compare + "run/two.html").exit_code, 0);
  EXPECT_GT(fs::file_size(At("run/two.html")), fs::file_size(At("run/r.html")));
  const Outcome rerun = Run(compare + "run/two.rrd");
  EXPECT_EQ(rerun.exit_code, 1);
  EXPECT_NE(rerun.err.find("--compare"), std::string::npos) << rerun.err;
  const Outcome missing = Run("replay export run/r.mcap --compare run/no.mcap --out run/none.html");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("no.mcap"), std::string::npos) << missing.err;
  EXPECT_FALSE(fs::exists(At("run/none.html")));
  EXPECT_EQ(Run("metrics run/results.jsonl --json").exit_code, 0);
  const std::string settings = " --set ground_truth.feature_dim=64";
  const Outcome info = Run("map info run/m.map --json" + settings);
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_GT(Json::parse(info.out)["feature_rows"], 0);
  EXPECT_EQ(Run("map query run/m.map sofa --json" + settings).exit_code, 0);
  EXPECT_EQ(Run("map export run/m.map --out m.ply").exit_code, 0);
}

TEST_F(Cli, ARunContinuesFromASavedMemory) {
  const std::string run =
      "run --quiet --json --scenes scenes --episodes e.json --episode " + FirstId() + kSmall;
  ASSERT_EQ(Run(run + " --out first --save-map m.map").exit_code, 0);
  const Outcome second = Run(run + " --out second --memory m.map --save-map n.map");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const std::string settings = " --json --set ground_truth.feature_dim=64";
  const auto rows = [&](const char* map) {
    return Json::parse(Run("map info " + std::string(map) + settings).out)["feature_rows"]
        .get<int>();
  };
  EXPECT_GE(rows("n.map"), rows("m.map"));  // known features stay

  EXPECT_EQ(Run(run + " --out third --memory nowhere.map").exit_code, 1);
  const Outcome other = Run(run + " --out third --memory m.map --set map.voxel_m=0.2");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("voxel"), std::string::npos) << other.err;
}

TEST_F(Cli, MissingMeshIsNamed) {
  fs::remove(SceneFile(".glb"));
  ExpectEvalFailure({"CrossnavHouse"});
  ExpectFailure("scene info scenes/00001-CrossnavHouse", {"CrossnavHouse"});
}

TEST_F(Cli, TruncatedMeshIsNamed) {
  fs::resize_file(SceneFile(".glb"), fs::file_size(SceneFile(".glb")) / 2);
  ExpectEvalFailure({"CrossnavHouse.glb"});
}

TEST_F(Cli, MalformedSemanticLineIsNamedWithItsNumber) {
  std::string text = ReadText(SceneFile(".semantic.txt"));
  const std::size_t third = text.find('\n', text.find('\n') + 1) + 1;
  text.insert(third, "this is no instance\n");
  WriteText(SceneFile(".semantic.txt"), text);
  ExpectEvalFailure({"CrossnavHouse.semantic.txt", "3"});
}

TEST_F(Cli, UnknownConfigKeyIsNamedWithItsNeighbour) {
  WriteText(At("c.toml"), "[policy.poi]\nuse_histroy = true\n");
  ExpectFailure("eval --quiet --scenes scenes --episodes e.json --out run --config c.toml",
                {"c.toml", "policy.poi.use_histroy", "policy.poi.use_history"});
  ExpectFailure("eval --quiet --scenes scenes --episodes e.json --out run --set map.voxels=1",
                {"map.voxels"});
}

TEST_F(Cli, MissingSceneIsNamedWithItsEpisode) {
  Json file = Episodes();
  file["episodes"][1]["scene_id"] = "00099-Nowhere/Nowhere.glb";
  WriteText(At("e.json"), file.dump());
  ExpectEvalFailure({"e.json", "episodes[1]", "scene_id", "Nowhere"});
}

TEST_F(Cli, MissingCategoryIsNamedWithItsEpisode) {
  Json file = Episodes();
  file["episodes"][2]["goals"][1] = "unicorn";
  WriteText(At("e.json"), file.dump());
  ExpectEvalFailure({"e.json", "episodes[2]", "goals", "unicorn"});
}

TEST_F(Cli, NanPoseIsNamedWithFileAndKey) {
  std::string text = ReadText(At("e.json"));
  const std::string key = "\"start_position\":[";
  const std::size_t begin = text.find(key) + key.size();
  text.replace(begin, text.find(',', begin) - begin, "NaN");
  WriteText(At("e.json"), text);
  ExpectEvalFailure({"e.json", "start_position", "NaN"});
}

TEST_F(Cli, ErrorsUnderJsonAreOneDocument) {
  const Outcome outcome = Run("scene info nowhere --json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(Json::parse(outcome.out)["error"]["code"], "not_found");
}

TEST_F(Cli, EpisodesCheckFindsATamperedCertificate) {
  EXPECT_EQ(Run("episodes check e.json --scenes scenes --quiet").exit_code, 0);
  Json file = Episodes();
  file["episodes"][0]["certificate"][0] = {0, 1, 2};
  WriteText(At("e.json"), file.dump());
  const Outcome outcome = Run("episodes check e.json --scenes scenes --quiet");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("certificate[0]"), std::string::npos) << outcome.out;
}

TEST_F(Cli, MissingReplayAndMapAreErrors) {
  ExpectFailure("replay export no.mcap --out no.html", {"no.mcap"});
  ExpectFailure("map info no.map", {"no.map"});
  ExpectFailure("metrics no.jsonl", {"no.jsonl"});
}

constexpr const char* kOneRoom = "world generate --seed 5 --floors 1 --area 60 --json --out houses";

TEST_F(Cli, AssetsImportMakesThePackThatHousesAreFurnishedFrom) {
  fs::create_directories(At("libraries"));
  WriteText(At("libraries/Scopia.sh3f"),
            test::Zip({{"PluginFurnitureCatalog.properties",
                        "version=1.0\nid#1=Scopia#chair\nname#1=Chair\ncreator#1=Ann\n"
                        "model#1=/a.obj\nwidth#1=40\ndepth#1=40\nheight#1=90\n"},
                       {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"}}));
  const Outcome made = Run("assets import libraries --out pack --json");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json pack = Json::parse(made.out);
  EXPECT_EQ(pack["models"], 2);  // also a dining chair
  EXPECT_EQ(pack["per_kind"]["chair"], 1);
  const Outcome house = Run(std::string(kOneRoom) + " --furniture pack");
  ASSERT_EQ(house.exit_code, 0) << house.err;
  EXPECT_EQ(Json::parse(house.out)["furniture_pack"], pack["hash"]);
  EXPECT_EQ(Json::parse(ReadText(At("houses/00005-House5/House5.house.json")))["furniture_pack"],
            pack["hash"]);
}

TEST_F(Cli, ContactSheetAndFloorPlanAreDrawn) {
  const Outcome made = Run(std::string(kOneRoom) + " --furniture none --contact-sheet sheet.png");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(ReadText(At("sheet.png")).substr(1, 3), "PNG");
  EXPECT_EQ(Json::parse(made.out)["contact_sheet"], "sheet.png");
  const std::string render = "scene render houses/00005-House5 --top-down --out ";
  ASSERT_EQ(Run(render + "named.png").exit_code, 0);
  fs::remove(At("houses/00005-House5/House5.house.json"));
  ASSERT_EQ(Run(render + "plain.png").exit_code, 0);  // other scenes know no rooms
  EXPECT_NE(ReadText(At("named.png")), ReadText(At("plain.png")));
}

// At a random place it was often a wall and nothing else.
TEST_F(Cli, APictureWithoutAPlaceShowsMoreThanAWall) {
  for (const int seed : {1, 2, 3, 4, 5, 6}) {
    const Outcome outcome =
        Run("scene render scenes/00001-CrossnavHouse --view semantic --out p.png "
            "--set eval.seed=" +
            std::to_string(seed));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string bytes = ReadText(At("p.png"));
    const auto picture =
        DecodePng({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "p.png");
    ASSERT_TRUE(picture);
    std::map<Rgba8, std::size_t> pixels;
    for (const Rgba8& colour : picture->data) ++pixels[colour];
    const auto seen = std::count_if(pixels.begin(), pixels.end(), [&](const auto& colour) {
      return 100 * colour.second > picture->data.size();
    });
    EXPECT_GE(seen, 7) << seed;
  }
}

// Assimp's Draco has another tinygltf inside, which took the place of ours and crashed the program.
TEST_F(Cli, AGeneratedHouseIsReadWhereAssimpIsInstalled) {
  ASSERT_EQ(Run(std::string(kOneRoom) + " --furniture none").exit_code, 0);
  const Outcome info = Run("scene info houses/00005-House5 --json");
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out)["floors"].size(), 1U);
}

TEST_F(Cli, WorldStatsCountsHousesAndKeepsNone) {
  const Outcome outcome =
      Run("world stats --seed 5 --count 2 --floors 1 --area 60 --furniture none --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json stats = Json::parse(outcome.out);
  EXPECT_EQ(stats["passed"], 2);
  EXPECT_EQ(stats["floors"]["1"], 2);
  EXPECT_GT(stats["instances"]["chair"], 0);
  EXPECT_GT(stats["cpu_s"]["median"], 0);
  EXPECT_LT(stats["largest_file_mb"]["max"], stats["house_mb"]["max"]);
  EXPECT_FALSE(fs::exists(At("houses")));
}

TEST_F(Cli, WithoutAPackTheGeneratorReportsItAndContinues) {
  ::setenv("XDG_DATA_HOME", folder_.path().c_str(), 1);
  const Outcome house = Run(kOneRoom);
  const Outcome wished = Run(std::string(kOneRoom) + " --furniture none");
  ::unsetenv("XDG_DATA_HOME");
  EXPECT_EQ(house.exit_code, 0) << house.err;
  EXPECT_NE(house.err.find("simple shapes"), std::string::npos) << house.err;
  EXPECT_TRUE(Json::parse(house.out)["furniture_pack"].is_null());
  EXPECT_EQ(wished.exit_code, 0) << wished.err;
  EXPECT_EQ(wished.err.find("simple shapes"), std::string::npos) << wished.err;
  ExpectFailure("world generate --out run --furniture here", {"here", "assets import"});
  ExpectFailure("assets import here --out run", {"here", "sweethome3d-furniture"});
}

}  // namespace
}  // namespace crossnav
