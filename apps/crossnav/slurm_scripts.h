// SPDX-License-Identifier: MIT
// Scripts of an evaluation as a Slurm job array: one shard a task, then a job that merges and
// reports. Pure text; slurm_command.cpp checks, writes and submits.
#pragma once

#include <string>
#include <vector>

namespace crossnav::app {

/// Parameters of the scripts. Paths may be relative to `folder`.
struct SlurmJob {
  std::string program;                      ///< absolute
  std::string folder;                       ///< working directory of the commands, absolute
  std::vector<std::string> eval_arguments;  ///< without --out, --shard and --jobs
  std::string out;                          ///< of the run: results.jsonl, report/, shards/, slurm/
  std::string name;                         ///< of the jobs
  int tasks = 1;                            ///< shards
  int cpus = 1;                             ///< of a task; as many processes play its episodes
  std::string partition, time, memory, account;  ///< passed to sbatch; empty = the cluster's
  std::vector<std::string> extra;                ///< more options of sbatch, "--qos=low"
};

/// Results of task `index`, relative like `job.out`.
std::string ShardFile(const SlurmJob& job, int index);

/// The array. A task that is killed, requeued or resubmitted continues after its last finished
/// episode. Near its time limit it requeues itself, unless it finished no episode.
std::string ShardScript(const SlurmJob& job);

/// Merges the shards into OUT/results.jsonl and reports into OUT/report.
std::string MergeScript(const SlurmJob& job);

/// Submits the array, then the dependent merge; prints "array ID" and "merge ID". May be run from
/// anywhere, repeatedly.
std::string SubmitScript();

}  // namespace crossnav::app
