// SPDX-License-Identifier: MIT
// An evaluation as a Slurm job array, as the text of its scripts: one shard a task, then one job
// that merges and reports. Pure text; slurm_command.cpp checks, writes and submits.
#pragma once

#include <string>
#include <vector>

namespace crossnav::app {

/// Everything that the scripts say. Paths may be relative to `folder`.
struct SlurmJob {
  std::string program;                      ///< absolute
  std::string folder;                       ///< where the commands are run, absolute
  std::vector<std::string> eval_arguments;  ///< without --out, --shard and --jobs
  std::string out;                          ///< of the run: results.jsonl, report/, shards/, slurm/
  std::string name;                         ///< of the jobs
  int tasks = 1;                            ///< shards
  int cpus = 1;                             ///< of a task; as many processes play its episodes
  std::string partition, time, memory, account;  ///< as sbatch takes them; empty = the cluster's
  std::vector<std::string> extra;                ///< more options of sbatch, "--qos=low"
};

/// Results of task `index`, relative like `job.out`.
std::string ShardFile(const SlurmJob& job, int index);

/// The array. A task that is killed, requeued or submitted again goes on behind the last episode
/// that it finished. Near the end of its time it requeues itself, unless it finished no episode.
std::string ShardScript(const SlurmJob& job);

/// Merges the shards into OUT/results.jsonl and reports into OUT/report.
std::string MergeScript(const SlurmJob& job);

/// Submits the array, then the merge, which waits for it; prints "array ID" and "merge ID". To be
/// run from anywhere, as often as wanted.
std::string SubmitScript();

}  // namespace crossnav::app
