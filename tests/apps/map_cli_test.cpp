// SPDX-License-Identifier: MIT
// Saved memories on the command line: a limit, words of CLIP, places to stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/cli_fixture.h"
#include "support/places.h"

namespace crossnav {
namespace {

using test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;

class MapCli : public Cli {
 protected:
  std::string RunCommand() {
    return "run --quiet --json --scenes scenes --episodes e.json --episode " + FirstId() + kSmall;
  }
  /// Makes more episodes; the first that starts by looking for `goal`.
  std::string IdOfEpisodeFor(const std::string& goal) {
    EXPECT_EQ(Run("episodes generate --scenes scenes --count 16 --seed 3 --out e.json").exit_code,
              0);
    const Json file = Episodes();
    for (const Json& episode : file["episodes"])
      if (episode["goals"][0] == goal) return episode["episode_id"];
    ADD_FAILURE() << "no episode starts with " << goal;
    return "";
  }
  Json Query(const std::string& arguments) {
    const Outcome outcome = Run("map query --json " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json();
  }
};

TEST_F(MapCli, QueryTellsBestViewAndAReachablePlaceToStand) {
  ASSERT_EQ(Run(RunCommand() + " --save-map m.map --set eval.action_budget=120").exit_code, 0);
  const Json places = Query("m.map sofa --voxels")["places"];
  ASSERT_FALSE(places.empty());
  int reachable = 0;
  for (const Json& place : places) {
    EXPECT_EQ(place["best_view"].size(), 3u);
    EXPECT_TRUE(place["best_view_yaw_deg"].is_number());
    EXPECT_EQ(place["voxel_centers"].size(), place["voxels"].get<std::size_t>());
    EXPECT_GT(place["similarity"], 0);
    if (place["observation"].is_null()) continue;
    ++reachable;
    const auto at = place["observation"]["position"].get<std::vector<double>>();
    const auto center = place["center"].get<std::vector<double>>();
    EXPECT_LT(std::hypot(at[0] - center[0], at[1] - center[1]), 4.0);
    EXPECT_GE(place["observation"]["path_m"], 0);
  }
  EXPECT_GT(reachable, 0);
  // The same place from elsewhere: an equally good view, another path.
  const auto at = places[0]["observation"]["position"].get<std::vector<double>>();
  const Json here = Query("m.map sofa --from " + std::to_string(at[0]) + "," +
                          std::to_string(at[1]) + "," + std::to_string(at[2]))["places"];
  EXPECT_LT(here[0]["observation"]["path_m"], 0.5);
  EXPECT_TRUE(Query("m.map sofa --from 90,90,0")["places"][0]["observation"].is_null());
  EXPECT_EQ(Run("map query m.map sofa --from 1,2").exit_code, 2);
}

TEST_F(MapCli, AGraphHasTheRunsObjectsAndIsWrittenAsItsNameSays) {
  const std::string id = IdOfEpisodeFor("sofa");
  ASSERT_EQ(Run("run --quiet --scenes scenes --episodes e.json --episode " + id + kSmall +
                " --save-map m.map --set eval.action_budget=200")
                .exit_code,
            0);
  for (const char* name : {"g.json", "g.graphml", "g.mcap"}) {
    const Outcome outcome = Run(std::string("map graph --json m.map --to ") + name);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Json graph = Json::parse(outcome.out);
    EXPECT_FALSE(graph["rooms"].empty());
    const auto& objects = graph["objects"];  // the goal, and things met in passing
    const auto sofa = std::find_if(objects.begin(), objects.end(),
                                   [](const Json& o) { return o["category"] == "sofa"; });
    ASSERT_NE(sofa, objects.end());
    EXPECT_GE((*sofa)["confidence"], 0.5);
    EXPECT_TRUE(std::filesystem::exists(At(name)));
  }
  EXPECT_NE(Run("map graph m.map --to g.txt").exit_code, 0);
}

TEST_F(MapCli, ContrastiveRelevancyIsOffUnlessAskedFor) {
  ASSERT_EQ(Run(RunCommand() + " --save-map m.map --set eval.action_budget=120").exit_code, 0);
  const Json cosine = Query("m.map sofa")["places"];
  EXPECT_EQ(Query("m.map sofa --set query.relevancy=cosine")["places"], cosine);
  const Json contrastive = Query("m.map sofa --set query.relevancy=contrastive")["places"];
  ASSERT_FALSE(contrastive.empty());
  EXPECT_NE(contrastive[0]["score"], cosine[0]["score"]);
  EXPECT_EQ(Run("map export m.map --query sofa --out a.ply").exit_code, 0);
  const Outcome other =
      Run("map export m.map --query sofa --out b.ply --set query.relevancy=contrastive");
  EXPECT_EQ(other.exit_code, 0);
  EXPECT_NE(test::ReadText(At("a.ply")), test::ReadText(At("b.ply")));
}

TEST_F(MapCli, UnknownObjectsAreAbsentAndKnownObjectsHaveAMatch) {
  ASSERT_EQ(Run(RunCommand() + " --save-map m.map --set eval.action_budget=120").exit_code, 0);
  const Json sofa = Query("m.map sofa");
  EXPECT_EQ(sofa["verdict"], "present");
  EXPECT_GT(sofa["match"], sofa["present_from"]);
  EXPECT_LE(sofa["match"], 1);
  EXPECT_GT(sofa["places"][0]["match"], 0);
  for (const char* word : {"zebra", "airplane", "traffic light"}) {
    const Json none = Query(std::string("m.map '") + word + "'");
    EXPECT_EQ(none["verdict"], "absent") << word << " matches " << none["match"];
    EXPECT_LT(none["match"], none["present_from"]);
    EXPECT_TRUE(none["places"].empty());
  }
  const Outcome said = Run("map query m.map zebra");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_EQ(said.out.find("\"zebra\" is absent"), 0U) << said.out;
}

TEST_F(MapCli, ALimitOfRowsIsKeptAndReportedEverywhere) {
  const Outcome run = Run(RunCommand() + " --out run --save-map m.map --set fusion.max_rows=6000");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json memory = Json::parse(run.out)["memory"];
  const int rows = memory["feature_rows"], compacted = memory["compacted_rows"];
  EXPECT_GT(compacted, 0);
  EXPECT_LE(2 * rows - compacted, 2 * 6000);
  EXPECT_GT(memory["bytes"], 0);
  const Json info = Json::parse(Run("map info m.map --json").out);
  for (const char* key : {"feature_rows", "compacted_rows", "dropped_rows"})
    EXPECT_EQ(info[key], memory[key]) << key;
  // The last step of the trace says the same.
  std::istringstream lines(test::ReadText(At("run/trace.jsonl")));
  Json last;
  for (std::string line; std::getline(lines, line);) last = Json::parse(line);
  EXPECT_EQ(last["memory"]["rows"], rows);
  EXPECT_EQ(last["memory"]["compacted_rows"], compacted);
  EXPECT_EQ(last["memory"]["dropped_rows"], memory["dropped_rows"]);
  EXPECT_FALSE(Query("m.map sofa").is_null());
}

TEST_F(MapCli, RealClipVectorsFindASofaByAnyOfItsNames) {
  const std::string clip = test::SharedPath("data/clip");
  if (!std::filesystem::exists(clip)) GTEST_SKIP() << "no CLIP vectors beside the project";
  const std::string set = " --set ground_truth.clip_dir='" + clip + "'";
  const std::string look = "run --quiet --json --scenes scenes --episodes e.json --episode " +
                           IdOfEpisodeFor("sofa") + kSmall + " --set eval.action_budget=300";
  const Outcome run = Run(look + set + " --save-map m.map");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_TRUE(Json::parse(run.out)["record"]["stages"][0]["success"]) << "the sofa was not seen";
  const auto center_of = [&](const std::string& word) {
    const Json places = Query("m.map '" + word + "'" + set)["places"];
    EXPECT_FALSE(places.empty()) << word;
    return places.empty() ? std::vector<double>(3, 1e9)
                          : places[0]["center"].get<std::vector<double>>();
  };
  const Outcome scene = Run("scene info scenes/00001-CrossnavHouse --json");
  const Json sofas = Json::parse(scene.out)["instances"]["sofa"];
  for (const char* word : {"sofa", "couch", "loveseat"}) {
    const std::vector<double> p = center_of(word);
    bool is_at_sofa = false;
    for (const Json& sofa : sofas) {
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis)
        inside = inside && p[axis] > sofa["box_min"][axis].get<double>() - 0.2 &&
                 p[axis] < sofa["box_max"][axis].get<double>() + 0.2;
      is_at_sofa = is_at_sofa || inside;
    }
    EXPECT_TRUE(is_at_sofa) << word;
  }
  for (const char* word : {"Zebra", "Airplane", "fire hydrant"}) {
    const Json none = Query("m.map '" + std::string(word) + "'" + set);
    EXPECT_EQ(none["verdict"], "absent") << word << " matches " << none["match"];
    EXPECT_TRUE(none["places"].empty());
  }
  EXPECT_EQ(Query("m.map couch" + set)["verdict"], "present");
  EXPECT_EQ(Query("m.map couch" + set + " --set query.relevancy=contrastive")["verdict"],
            "present");
  // Without them the map's features mean nothing; the message names file and remedy.
  for (const std::string& command :
       {std::string("map query m.map couch"), look + " --memory m.map"}) {
    const Outcome other = Run(command);
    EXPECT_EQ(other.exit_code, 1) << command;
    const std::string said = other.out + other.err;
    for (const char* part : {"m.map", "ground-truth-clip", "set ground_truth.clip_dir"})
      EXPECT_NE(said.find(part), std::string::npos) << part << " in " << said;
  }
  const Outcome eval = Run("eval --quiet --scenes scenes --episodes e.json --out all" +
                           std::string(kSmall) + set + " --set eval.action_budget=2 --shard 0/16");
  EXPECT_EQ(eval.exit_code, 0) << eval.err;
}

TEST_F(MapCli, AFolderWithoutVectorsIsNamed) {
  ExpectFailure("eval --quiet --scenes scenes --episodes e.json --out run" + std::string(kSmall) +
                    " --set ground_truth.clip_dir=nowhere",
                {"nowhere/oid_names.txt", "ground_truth.clip_dir"});
}

}  // namespace
}  // namespace crossnav
