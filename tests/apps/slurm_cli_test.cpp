// SPDX-License-Identifier: MIT
// The scripts that `crossnav slurm` writes, run by bash without a Slurm; tests/slurm has a real
// one.
#include <gtest/gtest.h>

#include <sstream>

#include "apps/cli_fixture.h"

namespace crossnav {
namespace {

using SlurmCli = test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;
using test::ReadText;
using test::WriteText;
namespace fs = std::filesystem;

const std::string kEval = std::string("--scenes scenes --episodes e.json") + kSmall;

void ExpectParts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
  }
}

/// A stand-in executable for one of Slurm's commands, in `bin`.
void Fake(const fs::path& bin, const std::string& name, const std::string& body) {
  fs::create_directories(bin);
  WriteText(bin / name, "#!/bin/bash\n" + body + "\n");
  fs::permissions(bin / name, fs::perms::owner_all);
}

/// Header and records of a result file, without timings, sorted.
std::vector<Json> Records(const fs::path& path) {
  std::istringstream stream(ReadText(path));
  std::vector<Json> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(Json::parse(line));
    lines.back().erase("wall_s");
    lines.back().erase("timing_ms");
  }
  std::sort(lines.begin() + 1, lines.end());
  return lines;
}

TEST_F(SlurmCli, TheScriptsContainTheRequestedOptions) {
  const Outcome outcome =
      Run("slurm " + kEval +
          " --out run --tasks 3 --cpus 2 --time 2:00:00 --memory 4G --partition cpu --account lab "
          "--sbatch=--qos=low --sbatch exclude=n1 --variant planar --set eval.seed=7 "
          "--keep-replays failures --dry-run --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["tasks"], 3);
  EXPECT_FALSE(Json::parse(outcome.out).contains("array"));
  const std::string shards = ReadText(At("run/slurm/shards.sbatch"));
  ExpectParts(shards,
              {"#!/bin/bash\n", "#SBATCH --array=0-2\n", "#SBATCH --cpus-per-task=2\n",
               "#SBATCH --time=2:00:00\n", "#SBATCH --mem=4G\n", "#SBATCH --partition=cpu\n",
               "#SBATCH --account=lab\n", "#SBATCH --qos=low\n", "#SBATCH --exclude=n1\n",
               "#SBATCH --requeue\n", "#SBATCH --open-mode=append\n", "'--variant=planar'",
               "'--set=eval.seed=7'", "'--keep-replays=failures'", "--shard \"$task/3\" --jobs 2"});
  const std::string merge = ReadText(At("run/slurm/merge.sbatch"));
  ExpectParts(merge, {"merge 'run/shards' --out 'run/results.jsonl'",
                      "report 'run' --out 'run/report'", "#SBATCH --partition=cpu\n"});
  EXPECT_EQ(merge.find("--array"), std::string::npos);
  for (const char* name : {"shards.sbatch", "merge.sbatch", "submit.sh"}) {
    EXPECT_EQ(std::system(("bash -n '" + At("run/slurm").string() + "/" + name + "'").c_str()), 0);
  }
}

TEST_F(SlurmCli, OptionsThatWereNotGivenAreLeftToTheCluster) {
  ASSERT_EQ(Run("slurm " + kEval + " --out run --tasks 2 --dry-run").exit_code, 0);
  const std::string shards = ReadText(At("run/slurm/shards.sbatch"));
  for (const char* option : {"--time", "--mem", "--partition", "--account", "--signal"}) {
    EXPECT_EQ(shards.find(std::string("#SBATCH ") + option), std::string::npos) << option;
  }
}

TEST_F(SlurmCli, TheTasksRunByHandAreTheRunOfOneProcess) {
  const std::string folder = "it's a \"$run\" folder";  // quoted rightly, or nothing is found
  ASSERT_EQ(Run("eval --quiet " + kEval + " --out single").exit_code, 0);
  ASSERT_EQ(
      Run("slurm " + kEval + " --out 'it'\\''s a \"$run\" folder' --tasks 2 --dry-run").exit_code,
      0);
  const std::string scripts = "cd / && export SLURM_ARRAY_JOB_ID=1 && cd \"$SCRIPTS\" && ";
  ::setenv("SCRIPTS", At(folder + "/slurm").c_str(), 1);
  const auto bash = [&](const std::string& line) {
    return std::system((scripts + line + " >>log 2>&1").c_str());
  };
  ASSERT_EQ(bash("SLURM_ARRAY_TASK_ID=0 bash shards.sbatch"), 0);
  EXPECT_NE(bash("bash merge.sbatch"), 0);  // names the missing episodes
  ExpectParts(ReadText(At(folder + "/slurm/log")), {"2 of 4 episodes are missing"});
  EXPECT_FALSE(fs::exists(At(folder + "/results.jsonl")));
  ASSERT_EQ(bash("SLURM_ARRAY_TASK_ID=1 bash shards.sbatch"), 0);
  ASSERT_EQ(bash("SLURM_ARRAY_TASK_ID=1 bash shards.sbatch"), 0);  // requeued after its end
  ASSERT_EQ(bash("bash merge.sbatch"), 0) << ReadText(At(folder + "/slurm/log"));
  EXPECT_EQ(Records(At(folder + "/results.jsonl")), Records(At("single/results.jsonl")));
  EXPECT_TRUE(fs::exists(At(folder + "/report/report.md")));
}

TEST_F(SlurmCli, ATaskThatFailsHasTheStatusOfTheEvaluation) {
  ASSERT_EQ(Run("slurm " + kEval + " --out run --tasks 2 --dry-run").exit_code, 0);
  fs::remove_all(At("scenes"));
  const int status = std::system(("SLURM_ARRAY_JOB_ID=1 SLURM_ARRAY_TASK_ID=0 bash '" +
                                  At("run/slurm/shards.sbatch").string() + "' >/dev/null 2>&1")
                                     .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST_F(SlurmCli, SubmitsTheArrayAndAMergeThatWaitsForIt) {
  Fake(At("bin"), "sbatch", "echo \"$@\" >>../../calls; wc -l <../../calls");
  ::setenv("PATH", (At("bin").string() + ":" + ::getenv("PATH")).c_str(), 1);
  const Outcome outcome = Run("slurm " + kEval + " --out run --tasks 2 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["array"], "1");
  EXPECT_EQ(Json::parse(outcome.out)["merge"], "2");
  EXPECT_EQ(ReadText(At("calls")),
            "--parsable shards.sbatch\n--parsable --dependency=afterany:1 merge.sbatch\n");
}

TEST_F(SlurmCli, ARefusalOfSlurmIsTheMessageAndNoHalfOfItStays) {
  Fake(At("bin"), "sbatch",
       "[[ $* == *merge* ]] && { echo 'sbatch: error: invalid account' >&2; exit 1; }; echo 5");
  Fake(At("bin"), "scancel", "echo \"$@\" >../../cancelled");
  ::setenv("PATH", (At("bin").string() + ":" + ::getenv("PATH")).c_str(), 1);
  const Outcome outcome = Run("slurm " + kEval + " --out run --tasks 2");
  EXPECT_EQ(outcome.exit_code, 1);
  ExpectParts(outcome.err, {"run/slurm/submit.sh", "invalid account"});
  EXPECT_EQ(ReadText(At("cancelled")), "5\n");
}

TEST_F(SlurmCli, BadInputIsRefusedBeforeAnythingIsWritten) {
  const std::string slurm = "slurm --dry-run --out run " + kEval;
  ExpectFailure(slurm + " --tasks 5", {"--tasks", "4 episodes"});
  ExpectFailure(slurm + " --tasks 2 --partition 'a b'", {"--partition", "a b"});
  ExpectFailure(slurm + " --tasks 2 --sbatch='--qos=x #y'", {"--sbatch"});
  ExpectFailure(slurm + " --tasks 2 --set evil.seed=1", {"evil.seed"});
  ExpectFailure("slurm --dry-run --out run --episodes e.json --scenes nowhere --tasks 2",
                {"nowhere"});
  ExpectFailure("slurm --dry-run --out e.json/x --tasks 2 " + kEval, {"e.json/x", "--out"});
  EXPECT_EQ(Run(slurm).exit_code, 2);
  EXPECT_EQ(Run(slurm + " --tasks 0").exit_code, 2);
}

TEST_F(SlurmCli, AnotherDivisionOfTheSameRunIsRefused) {
  fs::create_directories(At("run/shards"));
  WriteText(At("run/shards/results.0-of-4.jsonl"), "");
  const Outcome outcome = Run("slurm --dry-run --out run --tasks 2 " + kEval);
  EXPECT_EQ(outcome.exit_code, 1);
  ExpectParts(outcome.err, {"results.0-of-4.jsonl", "--tasks"});
  EXPECT_EQ(Run("slurm --dry-run --out run --tasks 4 " + kEval).exit_code, 0);
}

TEST_F(SlurmCli, MergeRefusesMissingEpisodesUnlessPartial) {
  ASSERT_EQ(Run("eval --quiet --out run/shards --shard 0/2 " + kEval).exit_code, 0);
  const Outcome outcome = Run("merge run/shards --out merged.jsonl");
  EXPECT_EQ(outcome.exit_code, 1);
  ExpectParts(outcome.err, {"2 of 4 episodes are missing"});
  EXPECT_FALSE(fs::exists(At("merged.jsonl")));
  EXPECT_EQ(Run("merge run/shards --out merged.jsonl --partial").exit_code, 0);
  // eval can resume the merged run.
  fs::create_directories(At("rest"));
  fs::rename(At("merged.jsonl"), At("rest/results.jsonl"));
  EXPECT_EQ(Run("eval --quiet --out rest " + kEval).exit_code, 0);
  EXPECT_EQ(Records(At("rest/results.jsonl")).size(), 5u);
}

}  // namespace
}  // namespace crossnav
