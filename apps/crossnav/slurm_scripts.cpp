// SPDX-License-Identifier: MIT
#include "slurm_scripts.h"

#include <fmt/format.h>

#include "shell.h"

namespace crossnav::app {
namespace {

// chosen: a task requeues itself this many seconds before its time limit; Slurm may signal up to a
// minute earlier
constexpr int kRequeueSeconds = 60;

std::string Option(const char* name, const std::string& value) {
  return value.empty() ? std::string() : fmt::format("#SBATCH --{}={}\n", name, value);
}

/// Common #SBATCH lines of both jobs. Logs are relative to the scripts' folder.
std::string Head(const SlurmJob& job, const std::string& name, const std::string& log) {
  std::string text = "#!/bin/bash\n";
  text += Option("job-name", name);
  text += Option("output", log);
  text += Option("open-mode", "append");  // a requeued task appends to its log
  text += "#SBATCH --requeue\n#SBATCH --nodes=1\n#SBATCH --ntasks=1\n";
  text += Option("partition", job.partition);
  text += Option("account", job.account);
  text += Option("time", job.time);
  text += Option("mem", job.memory);
  for (const std::string& line : job.extra) text += "#SBATCH " + line + "\n";
  return text;
}

std::string Start(const SlurmJob& job) {
  return "set -euo pipefail\ncd " + ShellQuoted(job.folder) + "\n";
}

}  // namespace

std::string ShardFile(const SlurmJob& job, int index) {
  if (job.tasks == 1) return job.out + "/shards/results.jsonl";
  return fmt::format("{}/shards/results.{}-of-{}.jsonl", job.out, index, job.tasks);
}

std::string ShardScript(const SlurmJob& job) {
  std::string text = Head(job, job.name, "shard-%a.log");
  text +=
      fmt::format("#SBATCH --array=0-{}\n#SBATCH --cpus-per-task={}\n", job.tasks - 1, job.cpus);
  if (!job.time.empty()) text += fmt::format("#SBATCH --signal=B:USR1@{}\n", kRequeueSeconds);
  text += "# Shard of an evaluation. A restart continues behind the last finished episode.\n";
  text += Start(job);
  text += "task=$SLURM_ARRAY_TASK_ID\n";
  const std::string shards = ShellQuoted(job.out + "/shards");
  text += "results=" + shards +
          (job.tasks == 1 ? "/results.jsonl\n"
                          : fmt::format("/results.$task-of-{}.jsonl\n", job.tasks));
  text += R"sh(finished() {
  local count
  count=$(grep -c '"kind":"episode"' "$results" 2>/dev/null || true)
  echo "${count:-0}"
}
before=$(finished)
out_of_time() {  # a task that finishes no episode in all its time would never end
  if (( $(finished) > before )); then
    echo "out of time: requeued"
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$task"
  else
    echo "out of time before an episode was finished: more --time is needed"
  fi
}
trap out_of_time USR1
)sh";
  text += "SECONDS=0\n" + ShellQuoted(job.program) + " eval";
  for (const std::string& argument : job.eval_arguments) text += " " + ShellQuoted(argument);
  text += fmt::format(" \\\n  --out {} --shard \"$task/{}\" --jobs {} &\n", shards, job.tasks,
                      job.cpus);
  text += R"sh(eval_pid=$!
status=0
while wait "$eval_pid" || status=$?; do  # a signal ends the wait, not the evaluation
  kill -0 "$eval_pid" 2>/dev/null || break
  status=0
done
echo "task $task: status $status, $(finished) episodes, $SECONDS s"
exit "$status"
)sh";
  return text;
}

std::string MergeScript(const SlurmJob& job) {
  std::string text = Head(job, job.name + "-merge", "merge.log");
  text +=
      "# The shards as one run, and its report. Says what is missing where a task did not end "
      "well.\n";
  text += Start(job);
  const std::string program = ShellQuoted(job.program);
  text += fmt::format("{} merge {} --out {}\n", program, ShellQuoted(job.out + "/shards"),
                      ShellQuoted(job.out + "/results.jsonl"));
  text += fmt::format("{} report {} --out {}\n", program, ShellQuoted(job.out),
                      ShellQuoted(job.out + "/report"));
  return text;
}

std::string SubmitScript() {
  return R"sh(#!/bin/bash
# Submits the array and the merge that waits for it. Again: finished episodes are kept.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
array=$(sbatch --parsable shards.sbatch)
# afterany: where a task failed, the merge says in its log which episodes are missing.
if ! merge=$(sbatch --parsable --dependency="afterany:$array" merge.sbatch); then
  scancel "$array"
  exit 1
fi
echo "array $array"
echo "merge $merge"
)sh";
}

}  // namespace crossnav::app
