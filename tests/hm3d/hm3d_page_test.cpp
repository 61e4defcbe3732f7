// SPDX-License-Identifier: MIT
// Runs the commands of docs/hm3d.md, in order, on a stand-in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "crossnav/world/house/house_generator.h"
#include "hm3d/stand_in.h"
#include "support/places.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHash = "TEEsavR23oF";

/// Blocks of commands of the page, in their order.
std::vector<std::string> BlocksOf(const std::string& page) {
  std::vector<std::string> blocks;
  for (std::size_t at = page.find("```sh\n"); at != std::string::npos;) {
    const std::size_t end = page.find("```", at + 6);
    blocks.push_back(page.substr(at + 6, end - at - 6));
    at = page.find("```sh\n", end);
  }
  return blocks;
}

class Hm3dPage : public testing::Test {
 protected:
  fs::path At(const std::string& name) const { return folder_.path() / name; }

  int Bash(const std::string& script) const {
    WriteText(At("script.sh"), "set -eu\ncd '" + folder_.path().string() + "'\n" + script);
    return std::system(
        ("bash '" + At("script.sh").string() + "' >'" + At("log.txt").string() + "' 2>&1").c_str());
  }

  /// Small pictures, few actions: a wrapper for the page's commands, before the real program in
  /// PATH.
  void MakeWrapper() const {
    fs::create_directories(At("bin"));
    WriteText(At("bin/crossnav"),
              "#!/bin/bash\n"
              "case \"$1 $2\" in eval*|bench*|episodes*|'scene choose'|'scene info')\n"
              "  set -- \"$@\" --set sensor.width_px=160 --set sensor.height_px=160 "
              "--set ground_truth.min_visible_px=20 --set ground_truth.feature_dim=64;;\n"
              "esac\n"
              "if [[ $1 = eval ]]; then set -- \"$@\" --set eval.action_budget=20; fi\n"
              "exec '" +
                  ProgramPath() + "' \"$@\"\n");
    fs::permissions(At("bin/crossnav"), fs::perms::owner_all);
  }

  /// The archives in their download format. Each holds a file that the other lacks.
  void MakeArchives() const {
    world::HouseParams params;
    params.seed = 3;
    params.floors = 2;
    params.area_m2 = 60;
    const auto house = world::GenerateHouse(params, At("generated"));
    ASSERT_TRUE(house.has_value()) << house.error().Message();
    const auto scene = sim::LoadScene(house->folder);
    ASSERT_TRUE(scene.has_value()) << scene.error().Message();
    WriteAsHm3d(*scene, kHash, At(std::string("00800-") + kHash));
    ASSERT_EQ(Bash("bin/crossnav episodes generate --scenes generated --count 2 --goals 1 --seed 4 "
                   "--out single.json"),
              0)
        << ReadText(At("log.txt"));
    WriteAsObjectNavV2(At("single.json"), kHash, At("objectnav_hm3d_v2/val"));
    ASSERT_EQ(Bash("scene=00800-TEEsavR23oF/TEEsavR23oF\n"
                   "tar -cf hm3d-val-habitat-v0.2.tar $scene.basis.glb $scene.basis.navmesh\n"
                   "tar -cf hm3d-val-glb-v0.2.tar $scene.glb\n"
                   "tar -cf hm3d-val-semantic-annots-v0.2.tar $scene.semantic.glb "
                   "$scene.semantic.txt\n"
                   "python3 -m zipfile -c objectnav_hm3d_v2.zip objectnav_hm3d_v2\n"
                   "rm -r 00800-* objectnav_hm3d_v2 generated single.json\n"),
              0)
        << ReadText(At("log.txt"));
  }

  TempFolder folder_;
};

TEST_F(Hm3dPage, EveryCommandRunsOnAStandIn) {
  if (std::system("python3 -c '' && tar --version >/dev/null") != 0) {
    GTEST_SKIP() << "needs python3 and tar";
  }
  MakeWrapper();
  MakeArchives();
  const auto blocks = BlocksOf(ReadText(SourcePath("docs/hm3d.md")));
  ASSERT_GE(blocks.size(), 6U);
  EXPECT_NE(blocks[0].find("EPISODES=927 FIRST=102,101,85"), std::string::npos) << blocks[0];
  std::string script = "CROSSNAV='" + SourcePath("") +
                       "'\nPATH=$PWD/bin:$PATH\n"
                       "EPISODES=3 FIRST=1,1,0 JOBS=1 PARTS=2\n";
  const bool has_networks = Bash("bin/crossnav networks check") == 0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    if (!has_networks && blocks[i].find("--perception networks") != std::string::npos) continue;
    script += blocks[i];
  }
  ASSERT_EQ(Bash(script), 0) << ReadText(At("log.txt"));

  const auto Records = [&](const std::string& run) {
    const std::string text = ReadText(At("runs/" + run + "/results.jsonl"));
    return std::count(text.begin(), text.end(), '\n') - 1;  // the first line is the header
  };
  for (const char* run : {"onemap", "paper-no-history-poi", "paper", "full"}) {
    EXPECT_EQ(Records(run), 3) << run;
  }
  EXPECT_EQ(Records("single-paper"), 2);
  EXPECT_EQ(ReadText(At("scenes.txt")), "00800-TEEsavR23oF\n");
  EXPECT_NE(ReadText(At("report/report.md")).find("paper-no-history-poi"), std::string::npos);
  EXPECT_EQ(ReadText(At("log.txt")).find("left out"), std::string::npos) << ReadText(At("log.txt"));
}

}  // namespace
}  // namespace crossnav::test
