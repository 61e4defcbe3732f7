// SPDX-License-Identifier: MIT
// Every command against paths that cannot be read or written: one message that names the place, the
// right exit status, before any work, and nothing changed or left behind.
#include <sys/stat.h>

#include <set>

#include "apps/cli_fixture.h"
#include "support/places.h"
#include "support/zip_archive.h"

namespace crossnav {
namespace {

namespace fs = std::filesystem;
using test::Json;
using test::kSmall;
using test::Outcome;
using test::ReadText;
using test::WriteText;

constexpr const char* kScene = " scenes/00001-CrossnavHouse";
constexpr const char* kEpisodes = " --scenes scenes --episodes e.json";
constexpr const char* kOneRoomHome =
    "world generate --seed 5 --floors 1 --area 60 --furniture none --out houses";

/// The program in a folder that also has a run, a replay, a map and small inputs of other kinds.
class Paths : public test::Cli {
 protected:
  static void SetUpTestSuite() {
    test::Cli::SetUpTestSuite();
    const Outcome run = RunIn(
        *shared_, std::string("run --quiet") + kEpisodes + " --episode " +
                      Json::parse(ReadText(shared_->path() / "e.json"))["episodes"][0]["episode_id"]
                          .get<std::string>() +
                      " --out run --replay r.mcap --save-map m.map" + kSmall);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  void SetUp() override {
    test::Cli::SetUp();
    for (const char* name : {"run", "r.mcap", "m.map"})
      fs::copy(shared_->path() / name, At(name), fs::copy_options::recursive);
    WriteText(At("objects.json"), "{\"objects\":[]}");
    WriteText(At("file"), "in the way");
    fs::create_directory(At("folder"));
    fs::create_symlink("/dev/null", At("link_to_device"));
    ::mkfifo(At("pipe").c_str(), 0600);
    before_ = Files();
  }

  std::set<fs::path> Files() const {
    std::set<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.path().extension() != ".navmesh") files.insert(entry.path());
    return files;
  }

  /// One line on stderr that names all `parts`, nothing on stdout, nothing made and nothing gone.
  void ExpectRefused(const std::string& arguments, const std::vector<std::string>& parts,
                     int exit_code = 1) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
    EXPECT_EQ(lines, exit_code == 2 ? 2 : 1) << outcome.err;
    for (const std::string& part : parts)
      EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
    for (const char* raw : {"json.exception", "what():", "std::", "filesystem error"})
      EXPECT_EQ(outcome.err.find(raw), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(Files(), before_);
    EXPECT_TRUE(fs::is_fifo(At("pipe")));
    EXPECT_TRUE(fs::is_symlink(At("link_to_device")));
    EXPECT_TRUE(fs::is_character_file("/dev/null") && fs::is_character_file("/dev/full"));
  }

  std::string RunOf() { return std::string("run --quiet") + kEpisodes + " --episode " + FirstId(); }

  /// Commands with one output file: the text before the path, and the option.
  std::vector<std::pair<std::string, std::string>> FileOutputs() {
    return {{std::string(kOneRoomHome), "--contact-sheet"},
            {std::string("scene render --top-down") + kScene, "--out"},
            {"episodes generate --scenes scenes --count 1", "--out"},
            {RunOf() + " --out new", "--replay"},
            {RunOf() + " --out new", "--save-map"},
            {"merge run --partial", "--out"},
            {"replay export r.mcap", "--out"},
            {"map export m.map", "--out"},
            {std::string("bench noise --count 1") + kEpisodes, "--out"}};
  }
  /// Commands that write into a folder.
  std::vector<std::pair<std::string, std::string>> FolderOutputs() {
    return {{"world generate --embedded", "--out"},
            {std::string("scene views") + kScene, "--out"},
            {std::string("scene frames --count 1") + kScene, "--out"},
            {"scene import home.sh3d", "--out"},
            {RunOf(), "--out"},
            {"demo 1 --quiet", "--out"},
            {std::string("eval --quiet") + kEpisodes, "--out"},
            {std::string("slurm --dry-run --tasks 1") + kEpisodes, "--out"},
            {"suite make crossnav-mfmon-1-mini", "--out"},
            {"report run --partial", "--out"},
            {"bench stairs --count 1", "--keep"}};
  }

  std::set<fs::path> before_;
};

TEST_F(Paths, AnOutputFileThatCannotBeWrittenIsRefusedBeforeWorkBegins) {
  for (const auto& [command, option] : FileOutputs()) {
    for (const char* path :
         {"folder", "pipe", "link_to_device", "/dev/full", "file/below", "/proc/none/below"}) {
      ExpectRefused(command + " " + option + " " + path, {option, path, "choose another path"});
    }
  }
}

TEST_F(Paths, AnOutputFolderThatCannotBeWrittenIsRefusedBeforeWorkBegins) {
  for (const auto& [command, option] : FolderOutputs()) {
    for (const char* path : {"file", "pipe", "/dev/full", "file/below", "/proc/none"})
      ExpectRefused(command + " " + option + " " + path, {option, path, "choose another path"});
  }
}

TEST_F(Paths, AReadOnlyFolderIsRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(At("folder"), fs::perms::owner_read | fs::perms::owner_exec);
  for (const auto& [command, option] : FileOutputs())
    ExpectRefused(command + " " + option + " folder/new", {option, "folder/new"});
  for (const auto& [command, option] : FolderOutputs())
    ExpectRefused(command + " " + option + " folder", {option, "folder"});
}

TEST_F(Paths, AnInputThatIsMissingAFolderADeviceOrAnEmptyFileIsNamed) {
  WriteText(At("empty"), "");
  before_ = Files();
  const std::string scenes = " --scenes scenes";
  const std::vector<std::string> files = {
      "episodes check" + scenes + " @",
      "eval --quiet --out new" + scenes + " --episodes @",
      "run --out new --episode x" + scenes + " --episodes @",
      "slurm --dry-run --tasks 1 --out new" + scenes + " --episodes @",
      "bench noise" + scenes + " --episodes @",
      "metrics @",
      "merge --out new @",
      "report --out new @",
      "replay export --out new @",
      "map info @",
      "map query @ bed",
      "map export --out new @",
      "map build --out new --from @",
      "scene import --out new @",
      "scene import --out new model.obj --objects @",
      RunOf() + " --out new --memory @",
      "doctor --config @",
      "metrics run --config @"};
  for (const std::string& command : files) {
    for (const char* path : {"nowhere", "folder", "/dev/zero", "pipe", "empty"}) {
      if (command.find("--config") != std::string::npos && path == std::string("empty")) continue;
      std::string arguments = command;
      arguments.replace(arguments.find('@'), 1, path);
      ExpectRefused(arguments, {path});
    }
  }
}

TEST_F(Paths, ASceneThatIsMissingOrAFileIsNamed) {
  for (const char* command : {"scene info @", "scene render --out new @", "scene views --out new @",
                              "scene frames --out new @", "episodes generate --out new --scenes @",
                              "bench --scenes @ --episodes e.json"}) {
    for (const char* path : {"nowhere", "file", "folder", "/dev/zero"}) {
      std::string arguments = command;
      arguments.replace(arguments.find('@'), 1, path);
      ExpectRefused(arguments, {path});
    }
  }
}

TEST_F(Paths, AFullDiskLeavesNoHalfWrittenFileAndNoFalseSuccess) {
  for (const auto& [command, option] : FileOutputs()) {
    if (option == "--contact-sheet" || command.find("bench") == 0) continue;  // minutes of work
    const std::string arguments =
        command + " " + option + " new_file" + (command.find("run ") == 0 ? kSmall : "");
    SCOPED_TRACE(arguments);
    const Outcome outcome = RunIn(folder_, arguments, "trap '' XFSZ; ulimit -f 1;");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("crossnav: "), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(At("new_file")) && fs::file_size(At("new_file")) > 0);
    if (option != "--replay") {  // which keeps the written part
      EXPECT_FALSE(fs::exists(At("new_file.part")));
    }
    for (const fs::path& path : Files())
      EXPECT_TRUE(path.filename() == "new_file.part" ||
                  path.string().find(".part") == path.string().npos)
          << path;
    fs::remove_all(At("new"));
    fs::remove(At("new_file"));
    fs::remove(At("new_file.part"));
  }
}

TEST_F(Paths, StdoutThatTakesNothingIsAFailure) {
  const std::string command = "cd '" + folder_.path().string() + "' && '" + test::ProgramPath() +
                              "' scene info --json" + kScene + " >/dev/full 2>seen";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_NE(ReadText(At("seen")).find("stdout: cannot be written"), std::string::npos);
}

TEST_F(Paths, NamesThatAreNotUtf8AreReadAndWritten) {
  fs::create_directory(At("caf\xe9"));
  fs::copy(At("scenes"), At("caf\xe9/scenes"), fs::copy_options::recursive);
  fs::copy(At("r.mcap"), At("caf\xe9/r.mcap"));
  for (const char* command : {"scene info --json caf\xe9/scenes/00001-CrossnavHouse",
                              "replay export --json caf\xe9/r.mcap --out caf\xe9/r.html",
                              "map export --json m.map --out caf\xe9/m.ply",
                              "merge --json --partial run --out caf\xe9/merged.jsonl",
                              "report --json --partial caf\xe9/merged.jsonl --out caf\xe9/report",
                              ("episodes generate --json --scenes caf\xe9/scenes --count 1 --out "
                               "caf\xe9/e.json.gz")}) {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.err;
    EXPECT_TRUE(Json::accept(outcome.out)) << command << "\n" << outcome.out;
  }
  const Outcome missing = Run("metrics --json nowher\xe9");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_TRUE(Json::accept(missing.out));
  fs::rename(At("scenes/00001-CrossnavHouse"), At("scenes/00001-Caf\xe9"));
  before_ = Files();
  ExpectRefused("scene info scenes/00001-Caf\xe9", {"not UTF-8", "rename"});
}

TEST_F(Paths, TheSameInputTwiceIsRefusedUnderAnyNames) {
  fs::create_symlink("run", At("again"));
  before_ = Files();
  ExpectRefused("merge run again --out new", {"again", "given twice"});
  ExpectRefused("report run ./run --out new", {"./run", "given twice"});
  ExpectRefused("metrics run/results.jsonl again/results.jsonl", {"given twice"});
}

TEST_F(Paths, AnInputIsNotOverwrittenByTheOutput) {
  ExpectRefused("replay export r.mcap --out ./r.mcap", {"--out", "input itself"});
  ExpectRefused("map export m.map --out m.map", {"--out", "input itself"});
}

TEST_F(Paths, MistypedNamesNameTheirNeighbour) {
  ExpectRefused("evl", {"unknown verb \"evl\"", "\"eval\""}, 2);
  ExpectRefused("scene inf", {"unknown verb \"inf\"", "\"info\""}, 2);
  ExpectRefused("eval --scens scenes", {"unknown option \"--scens\"", "\"--scenes\""}, 2);
  const std::string eval = std::string("eval --out new") + kEpisodes;
  ExpectRefused(eval + " --variant planr", {"planr", "\"planar\""});
  ExpectRefused(eval + " --set map.voxl_m=0.1", {"map.voxl_m", "\"map.voxel_m\""});
  ExpectRefused("metrics run --set map.voxl_m=0.1", {"map.voxl_m", "\"map.voxel_m\""});
  ExpectRefused(eval + " --set noise.profile=realsens", {"noise.profile", "\"realsense\""});
  ExpectRefused("suite make crossnav-mfmon-1-min", {"\"crossnav-mfmon-1-mini\""});
}

TEST_F(Paths, NonsenseOnTheCommandLineIsRefused) {
  const std::string eval = std::string("eval --out new") + kEpisodes;
  for (const char* shard : {"7/2", "-1/2", "0/0", "1", "1/2/3", "99999999999/2"})
    ExpectRefused(eval + " --shard=" + shard, {"--shard", shard});
  for (const char* voxel : {"0", "-1", "1e300", "nan"})
    ExpectRefused(eval + " --set map.voxel_m=" + voxel, {"map.voxel_m", "[0.02, 0.5]"});
  ExpectRefused(eval + " --set eval.action_budget=-5", {"eval.action_budget"});
  ExpectRefused("world generate --out new --count -1", {"--count"}, 2);
  ExpectRefused("demo 3", {"3"}, 2);
}

}  // namespace
}  // namespace crossnav
