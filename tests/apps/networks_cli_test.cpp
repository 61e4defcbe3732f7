// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cli_fixture.h"
#include "inference/small_network.h"

namespace crossnav::test {
namespace {

/// A folder `nets` with one small network, and the options that make it answer everything.
class NetworksCli : public Cli {
 protected:
  void SetUp() override {
    if (!inference::test::HasBackend()) GTEST_SKIP() << "no inference library is built in";
    Cli::SetUp();
    fs::create_directory(At("nets"));
    inference::test::WriteSmallNetwork(At("nets"));
  }
  const std::string use_ =
      " --set networks.dir=nets --set networks.detector=small --set networks.segmenter=small"
      " --set networks.stairs=small --set networks.encoder=small";
};

TEST_F(NetworksCli, ListAndCheckReportTheNetworks) {
  const Outcome list = Run("networks list --json" + use_);
  ASSERT_EQ(list.exit_code, 0) << list.err;
  const Json json = Json::parse(list.out);
  EXPECT_EQ(json["networks"].size(), 1U);
  EXPECT_EQ(json["networks"][0]["found"], true);
  EXPECT_EQ(json["networks"][0]["parts"], "detector segmenter stairs encoder");
  const Outcome check = Run("networks check small --json" + use_);
  ASSERT_EQ(check.exit_code, 0) << check.err;
  EXPECT_GT(Json::parse(check.out)["networks"][0]["ms"], 0);
  std::ofstream(At("nets/small.onnx")) << "damaged";
  EXPECT_EQ(Run("networks check --quiet" + use_).exit_code, 1);
}

TEST_F(NetworksCli, CalibrateWritesRetrievalThresholdsThatLaterRunsUse) {
  const Outcome run = Run("networks calibrate small --scenes scenes --json" + use_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_GT(json["queries"].size(), 0U);
  EXPECT_GE(json["best"]["f1"], json["defaults"]["f1"]);
  EXPECT_NE(ReadText(At("nets/small.toml")).find("[retrieval]"), std::string::npos);
  EXPECT_EQ(Run("networks check small" + use_).exit_code, 0);
  ExpectFailure("networks calibrate none --scenes scenes" + use_, {"none.toml"});
  ExpectFailure("networks calibrate small --scenes nowhere" + use_, {"nowhere"});
}

TEST_F(NetworksCli, LookDrawsWhatTheySee) {
  ASSERT_EQ(
      Run("scene render scenes/00001-CrossnavHouse --out view.png" + std::string(kSmall)).exit_code,
      0);
  const Outcome look = Run("networks look view.png --text bed --out panel.png --json" + use_);
  ASSERT_EQ(look.exit_code, 0) << look.err;
  const Json json = Json::parse(look.out);
  EXPECT_EQ(json["similarity"]["cells"].size(), 16U);
  EXPECT_TRUE(json.contains("stairs"));
  EXPECT_TRUE(fs::exists(At("panel.png")));
  ExpectFailure("networks look none.png --out p.png" + use_, {"none.png"});
  ExpectFailure("networks look view.png --out p.png --network none" + use_, {"none.toml"});
}

TEST_F(NetworksCli, AnEpisodeFromPixelsSaysSoAndNamesTheFiles) {
  const Outcome run = Run("run --quiet --scenes scenes --episodes e.json --episode " + FirstId() +
                          " --perception networks --save-map m.map" + kSmall + use_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string file = ReadText(At("out/run/" + FirstId() + "/results.jsonl"));
  const Json header = Json::parse(file.substr(0, file.find('\n')));
  EXPECT_EQ(header["perception"], "networks-perception");
  EXPECT_EQ(header["networks"]["small"].get<std::string>().size(), 64U);
  // Its memory speaks the network's language, and no other.
  EXPECT_EQ(Run("map query m.map bed --set eval.perception=networks" + use_).exit_code, 0);
  ExpectFailure("map query m.map bed", {"m.map", "small-"});
}

TEST_F(NetworksCli, ClaimsAreJudgedByViewsWhereTheDetectorsCardHasTheirNumbers) {
  const auto verify = [&](const std::string& out, const std::string& more) {
    const Outcome run = Run("run --quiet --scenes scenes --episodes e.json --episode " + FirstId() +
                            " --perception networks --set eval.action_budget=1 --out " + out +
                            kSmall + use_ + more);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string file = ReadText(At(out + "/results.jsonl"));
    return Json::parse(file.substr(0, file.find('\n')))["config"]["verify"];
  };
  EXPECT_EQ(verify("before", "")["evidence"], "auto");
  const std::string section =
      "\n[evidence]\noffset = -4\nslope = 3\nmissed = -1.5\nfound = 2\ntoo_short = -1\n";
  WriteText(At("nets/small.toml"), ReadText(At("nets/small.toml")) + section);
  const Json measured = verify("after", "");
  EXPECT_EQ(measured["evidence"], "views");
  EXPECT_EQ(measured["view_missed"], -1.5);
  const Json chosen = verify("chosen", " --set verify.evidence=frame --set verify.view_missed=-3");
  EXPECT_EQ(chosen["evidence"], "frame");
  EXPECT_EQ(chosen["view_missed"], -3);
}

TEST_F(NetworksCli, AFolderWithoutOpenVinoIsNamed) {
  const auto all = inference::test::BuiltBackends();
  if (std::find(all.begin(), all.end(), "openvino") == all.end()) GTEST_SKIP() << "no OpenVINO";
  const Outcome check =
      RunIn(folder_, "networks check small --set networks.backend=openvino" + use_,
            "CROSSNAV_OPENVINO=/nowhere");
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_NE(
      (check.out + check.err).find("openvino is not available; CROSSNAV_OPENVINO names /nowhere"),
      std::string::npos)
      << check.out << check.err;
}

TEST_F(NetworksCli, AMissingLibraryIsNamedOnceBeforeAnythingRuns) {
  const auto all = inference::test::BuiltBackends();
  if (std::find(all.begin(), all.end(), "openvino") == all.end()) GTEST_SKIP() << "no OpenVINO";
  const Outcome eval =
      RunIn(folder_,
            "eval --quiet --scenes scenes --episodes e.json --out run --perception networks"
            " --set networks.backend=openvino" +
                std::string(kSmall) + use_,
            "CROSSNAV_OPENVINO=/nowhere");
  EXPECT_EQ(eval.exit_code, 1);
  EXPECT_NE(eval.err.find("CROSSNAV_OPENVINO names /nowhere"), std::string::npos) << eval.err;
  EXPECT_FALSE(fs::exists(At("run")));
}

TEST_F(NetworksCli, AMissingNetworkIsNamedBeforeAnythingRuns) {
  fs::remove(At("nets/small.onnx"));
  ExpectFailure("eval --quiet --scenes scenes --episodes e.json --out run --perception networks" +
                    std::string(kSmall) + use_,
                {"small.onnx", "is not there"});
}

}  // namespace
}  // namespace crossnav::test
