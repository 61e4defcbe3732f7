#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`crossnav slurm` on a real Slurm: one task killed midway and requeued, one out of time.

    tests/slurm/cluster_test.py PROGRAM

Exit status 77: skipped, since there is no Slurm here. With CROSSNAV_LONG_TESTS set it is installed
first (scripts/setup.sh slurm).
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from small_cluster import DAEMONS, SmallCluster, path_of

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import SMALL, records, run  # noqa: E402

SETUP = pathlib.Path(__file__).resolve().parents[2] / "scripts/setup.sh"
EVAL = ["--scenes", "scenes", "--episodes", "e.json", "--variant", "no-history-poi", *SMALL,
        "--set", "eval.action_budget=60"]
TASKS = 3


def program(*arguments, folder, environment=None):
    """Runs crossnav in `folder`; standard output as a document."""
    return run(PROGRAM, *arguments, folder=folder, environment=environment)


def episodes_in(path):
    """How many whole episodes a result file holds; 0 where there is none."""
    text = path.read_text() if path.exists() else ""
    return text.count('"kind":"episode"')


class Cluster(unittest.TestCase):
    def wait_for(self, what, is_there, limit_s=300):
        end = time.monotonic() + limit_s
        while not is_there():
            self.assertLess(time.monotonic(), end, f"{what}\n{self.logs()}")
            time.sleep(0.02)

    def logs(self):
        scripts = sorted((self.folder / "run/slurm").glob("*.log"))
        return self.cluster.ask("squeue", "-r") + self.cluster.logs() + "\n".join(
            f"--- {log.name}\n{log.read_text()}" for log in scripts)

    def shard(self, task):
        return self.folder / f"run/shards/results.{task}-of-{TASKS}.jsonl"

    def at_work(self, task, total):
        """Waits until a task is in the midst of its shard."""
        self.wait_for(f"task {task} at work", lambda: episodes_in(self.shard(task)) >= 1)
        self.assertLess(episodes_in(self.shard(task)), total)

    def interrupt(self, array):
        """Kills task 1 with a requeue, tells task 2 that its time is nearly over."""
        self.at_work(1, 4)
        self.cluster.ask("scontrol", "requeue", f"{array}_1")
        self.wait_for("task 1 killed", lambda: self.cluster.job(f"{array}_1")["Restarts"] == "1")
        kept = episodes_in(self.shard(1))
        self.at_work(2, 4)
        self.cluster.ask("scancel", "--batch", "--signal=USR1", f"{array}_2")
        self.wait_for("task 2 requeued", lambda: self.cluster.job(f"{array}_2")["Restarts"] == "1")
        return kept

    def test_a_killed_task_goes_on_and_the_merged_run_is_that_of_one_process(self):
        with tempfile.TemporaryDirectory() as name, SmallCluster() as self.cluster:
            self.folder = folder = pathlib.Path(name)
            program("world", "generate", "--embedded", "--out", "scenes", folder=folder)
            program("episodes", "generate", "--scenes", "scenes", "--count", "12", "--seed", "2",
                    "--cross-floor", "0.5", "--out", "e.json", folder=folder)
            ids = program("slurm", *EVAL, "--out", "run", "--tasks", str(TASKS), "--time", "10",
                          "--memory", "1000", "--partition", "debug", "--sbatch=--nice=1",
                          folder=folder, environment=self.cluster.environment)
            kept = self.interrupt(ids["array"])
            self.assertFalse((folder / "run/results.jsonl").exists())
            self.wait_for("merge", lambda: self.cluster.job(ids["merge"])["JobState"] in
                          ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT"))
            self.assertEqual(self.cluster.job(ids["merge"])["JobState"], "COMPLETED", self.logs())
            log = (folder / "run/slurm/shard-1.log").read_text()
            self.assertIn(f"{kept} episodes are there, {4 - kept} remain", log)
            self.assertIn("out of time: requeued", (folder / "run/slurm/shard-2.log").read_text())
            program("eval", *EVAL, "--out", "single", folder=folder)
            self.assertEqual(records(folder / "run/results.jsonl"),
                             records(folder / "single/results.jsonl"))
            self.assertTrue((folder / "run/report/report.md").exists())
            print(f"task 1 killed after {kept} of 4 episodes; 12 merged episodes are those of one "
                  "process")


def main():
    missing = [name for name in (*DAEMONS, "sbatch") if path_of(name) is None]
    if missing and os.environ.get("CROSSNAV_LONG_TESTS"):
        subprocess.run([SETUP, "slurm"], check=True)
        missing = [name for name in (*DAEMONS, "sbatch") if path_of(name) is None]
    if missing:
        print(f"skipped: there is no {', '.join(missing)} here; `make test-long` installs them, or "
              "scripts/setup.sh slurm")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    main()
