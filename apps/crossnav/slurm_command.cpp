// SPDX-License-Identifier: MIT
// `crossnav slurm`: runs eval's checks, writes the scripts and submits them to sbatch.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "perception_source.h"
#include "session.h"
#include "shell.h"
#include "slurm_scripts.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

/// Arguments of eval, unchanged, because the tasks run in the same folder.
std::vector<std::string> EvalArguments(const EvalOptions& eval, const CommonOptions& common) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.push_back(std::string(option) + "=" + value);
  };
  add("--scenes", eval.scenes);
  add("--episodes", eval.episodes);
  add("--variant", eval.variant);
  add("--success", eval.success);
  add("--budget-scope", eval.budget_scope);
  add("--perception", eval.perception);
  add("--keep-replays", eval.keep_replays);
  add("--config", common.config_file);
  for (const std::string& override : common.overrides) add("--set", override);
  return arguments;
}

/// A value on a #SBATCH line ends at a space, and the line at a line feed.
Result<void> CheckWord(const std::string& option, const std::string& value) {
  const auto is_bad = [](char c) {
    return std::isspace(static_cast<unsigned char>(c)) || c == '#';
  };
  if (std::none_of(value.begin(), value.end(), is_bad)) return {};
  return Fail(ErrorCode::kInvalid,
              "\"" + value + "\" has a blank or # in it; sbatch takes one word", option);
}

Result<void> CheckWords(const SlurmOptions& options) {
  if (auto ok = CheckWord("--partition", options.partition); !ok) return ok;
  if (auto ok = CheckWord("--time", options.time); !ok) return ok;
  if (auto ok = CheckWord("--memory", options.memory); !ok) return ok;
  if (auto ok = CheckWord("--account", options.account); !ok) return ok;
  for (const std::string& line : options.sbatch) {
    if (auto ok = CheckWord("--sbatch", line); !ok) return ok;
  }
  return {};
}

/// Existing shards of another division would duplicate episodes.
Result<void> CheckDivision(const SlurmJob& job) {
  const std::string suffix = fmt::format("-of-{}.jsonl", job.tasks);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(job.out + "/shards", ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("results") || !name.ends_with(".jsonl")) continue;
    if (job.tasks == 1 ? name == "results.jsonl" : name.ends_with(suffix)) continue;
    return Fail(
        ErrorCode::kMismatch,
        fmt::format("is not of {} tasks; give --tasks as before, or another --out", job.tasks),
        entry.path().string());
  }
  return {};
}

/// Runs eval's checks here, so that the tasks of the array do not all fail with the same message.
Result<void> CheckEval(const SlurmOptions& options, const CommonOptions& common) {
  const EvalOptions& eval = options.eval;
  const auto config =
      LoadRunConfig(common, {eval.variant, eval.success, eval.budget_scope, eval.perception});
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  const auto file = evaluation::ReadEpisodes(eval.episodes);
  if (!file) return tl::unexpected(file.error());
  if (static_cast<std::size_t>(options.tasks) > file->episodes.size()) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} tasks for {} episodes; at most one task an episode", options.tasks,
                            file->episodes.size()),
                "--tasks");
  }
  std::error_code ignored;
  if (!fs::is_directory(eval.scenes, ignored)) {
    return Fail(ErrorCode::kNotFound, "no such folder", eval.scenes);
  }
  return {};
}

Result<SlurmJob> MakeJob(const SlurmOptions& options, const CommonOptions& common) {
  SlurmJob job;
  std::error_code error;
  job.program = fs::read_symlink("/proc/self/exe", error).string();
  if (error) return Fail(ErrorCode::kIo, error.message(), "/proc/self/exe");
  job.folder = fs::current_path(error).string();
  if (error) return Fail(ErrorCode::kIo, error.message(), "the current folder");
  job.eval_arguments = EvalArguments(options.eval, common);
  fs::path out = options.eval.out;
  if (!out.has_filename()) out = out.parent_path();
  job.out = out.string();
  job.name = "crossnav-" + options.eval.variant;
  job.tasks = options.tasks;
  job.cpus = options.cpus;
  job.partition = options.partition;
  job.time = options.time;
  job.memory = options.memory;
  job.account = options.account;
  for (const std::string& line : options.sbatch) {
    job.extra.push_back(line.starts_with('-') ? line : "--" + line);
  }
  return job;
}

/// "array 12\nmerge 13" of submit.sh.
Result<std::string> Submit(const std::string& script) {
  auto answer = RunInShell("bash " + ShellQuoted(script));
  if (!answer) return tl::unexpected(answer.error());
  if (answer->exit_status == 0) return std::move(answer->text);
  if (answer->exit_status == 127) {
    return Fail(ErrorCode::kNotFound, "there is no sbatch here; run this script where there is one",
                script);
  }
  return Fail(ErrorCode::kIo,
              "was not submitted: " + answer->text.substr(answer->text.rfind('\n') + 1) +
                  "; correct the options, or the scripts beside it, and run it",
              script);
}

/// The number after `word`, as text; empty if absent.
std::string IdOf(const std::string& answer, const std::string& word) {
  const std::size_t at = answer.rfind(word + " ");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + word.size() + 1;
  return answer.substr(begin, answer.find('\n', begin) - begin);
}

}  // namespace

Result<void> Slurm(const SlurmOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = CheckWords(options); !ok) return ok;
  if (auto ok = CheckEval(options, common); !ok) return ok;
  const auto job = MakeJob(options, common);
  if (!job) return tl::unexpected(job.error());
  if (auto ok = CheckDivision(*job); !ok) return ok;
  const std::string folder = job->out + "/slurm";
  for (const std::string& place : {folder, job->out + "/shards"}) {
    if (auto ok = evaluation::CheckOutputFolder(place, "--out"); !ok) return ok;
  }
  const std::pair<const char*, std::string> files[] = {{"shards.sbatch", ShardScript(*job)},
                                                       {"merge.sbatch", MergeScript(*job)},
                                                       {"submit.sh", SubmitScript()}};
  for (const auto& [name, text] : files) {
    if (auto ok = evaluation::WriteTextFile(folder + "/" + name, text); !ok) return ok;
    console.Print(folder + "/" + name + "\n");
  }
  nlohmann::ordered_json document = {{"folder", folder}, {"tasks", job->tasks}};
  if (!options.dry_run) {
    const auto answer = Submit(folder + "/submit.sh");
    if (!answer) return tl::unexpected(answer.error());
    document["array"] = IdOf(*answer, "array");
    document["merge"] = IdOf(*answer, "merge");
    console.Print(fmt::format("submitted: array {} of {} tasks, then merge {}\n",
                              IdOf(*answer, "array"), job->tasks, IdOf(*answer, "merge")));
  }
  console.Document(document);
  return {};
}

}  // namespace crossnav::app
