#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Evaluations that are killed at random moments and resumed, that run in shards, and whose episodes
hang, crash and err: the program itself, whole episodes, small pictures.

    CROSSNAV_LONG_TESTS=1 tests/suite/kills_test.py PROGRAM [TEST...]
"""
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import SMALL, children, cpu_s, is_alive, records, run, skip_unless_long  # noqa: E402

EVAL = ["--scenes", "scenes", "--episodes", "e.json", *SMALL]
EPISODES = 12
KILLS = 50
ORPHANS_S = 1.0  # how long a worker may outlive the program
JOBS = ["--jobs", "2"]
SPEED_UP = 1.8  # at least, of two jobs on two cores


class Kills(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        run(PROGRAM, "world", "generate", "--embedded", "--out", "scenes", folder=cls.folder)
        run(PROGRAM, "episodes", "generate", "--scenes", "scenes", "--count", EPISODES, "--seed", 2,
            "--cross-floor", 0.5, "--out", "e.json", folder=cls.folder)
        start = time.monotonic()
        run(PROGRAM, "eval", *EVAL, "--out", "whole", "--jobs", 2, folder=cls.folder)
        cls.whole_s = time.monotonic() - start
        cls.whole = cls.of("whole")

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    @classmethod
    def of(cls, name):
        return records(cls.folder / name / "results.jsonl")[1]

    def start(self, out, *more):
        return subprocess.Popen([PROGRAM, "eval", *EVAL, "--quiet", "--out", out, *(more or JOBS)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)

    def kill(self, process):
        """Kills the program alone; its workers have to end by themselves."""
        workers = children(process.pid)
        process.kill()
        process.communicate()
        end = time.monotonic() + ORPHANS_S
        while any(map(is_alive, workers)) and time.monotonic() < end:
            time.sleep(0.01)
        self.assertFalse([pid for pid in workers if is_alive(pid)], "orphans")
        return len(workers)

    def test_killed_at_random_moments_and_resumed_the_records_are_the_same(self):
        rng = random.Random(12)
        kills = runs = 0
        at_work = 0
        while kills < KILLS:
            process = self.start(f"killed{runs}")
            try:
                _, err = process.communicate(timeout=rng.uniform(0, self.whole_s / 3))
            except subprocess.TimeoutExpired:
                at_work += self.kill(process) > 0
                kills += 1
                continue
            self.assertEqual(process.returncode, 0, err)
            self.assertEqual(self.of(f"killed{runs}"), self.whole)
            runs += 1
        run(PROGRAM, "eval", *EVAL, "--out", f"killed{runs}", "--jobs", 2, folder=self.folder)
        self.assertEqual(self.of(f"killed{runs}"), self.whole)
        self.assertGreater(at_work, kills // 3)
        print(f"{kills} kills, {at_work} of them with workers at work, in {runs + 1} runs of "
              f"{EPISODES} episodes: records identical, no orphan after {ORPHANS_S:g} s")

    def test_any_number_of_shards_merges_to_the_same_records(self):
        for count in (1, 2, 7):
            out = f"shards{count}"
            for index in range(count):
                run(PROGRAM, "eval", *EVAL, "--out", out, "--shard", f"{index}/{count}",
                    folder=self.folder)
            run(PROGRAM, "merge", out, "--out", f"{out}/results.jsonl", folder=self.folder)
            self.assertEqual(self.of(out), self.whole, count)
        print(f"1, 2 and 7 shards of {EPISODES} episodes: records identical")


    def cpu_of_workers(self, jobs):
        """CPU seconds of all workers of a whole evaluation."""
        process = self.start(f"cpu{jobs}", "--jobs", str(jobs))
        spent = {}
        while process.poll() is None:
            for worker in children(process.pid):
                spent[worker] = max(spent.get(worker, 0), cpu_s(worker))
            time.sleep(0.02)
        self.assertEqual(process.returncode, 0, process.stderr.read())
        process.stderr.close()
        return sum(spent.values())

    def test_two_jobs_share_the_work(self):
        """By CPU time: other work on the machine does not matter. Idle is a worker at the end
        only, while the other plays its last episode."""
        one, two = self.cpu_of_workers(1), self.cpu_of_workers(2)
        speed_up = one / (two / 2)
        print(f"{EPISODES} episodes: {one:.1f} CPU s in one worker, {two:.1f} in two: {speed_up:.2f} "
              "times as fast on two free cores, but for the last episode")
        self.assertGreater(speed_up, SPEED_UP)


class BadEpisodes(unittest.TestCase):
    def test_one_hangs_one_crashes_one_errs_and_the_rest_is_unharmed(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            run(PROGRAM, "world", "generate", "--seed", 1, "--count", 3, "--floors", 1,
                "--furniture", "none", "--out", "scenes", folder=folder)
            run(PROGRAM, "episodes", "generate", "--scenes", "scenes", "--count", 7, "--seed", 1,
                "--cross-floor", 0, "--out", "e.json", folder=folder)
            run(PROGRAM, "eval", *EVAL, "--out", "plain", folder=folder)
            # Houses 2 and 3 have two episodes each, house 1 three: the third house comes last.
            last = sorted((folder / "scenes").iterdir())[2]
            process = subprocess.Popen(
                [PROGRAM, "eval", *EVAL, "--quiet", "--out", "bad", "--jobs", "2", "--set",
                 "eval.episode_seconds=30"], cwd=folder, stdout=subprocess.DEVNULL)
            results = folder / "bad/results.jsonl"
            while not results.exists() or len(children(process.pid)) < 2:
                self.assertIsNone(process.poll())
                time.sleep(0.005)
            last.rename(folder / "gone")  # checked before, not there when it is played
            hanging, crashing = children(process.pid)
            os.kill(hanging, signal.SIGSTOP)
            os.kill(crashing, signal.SIGSEGV)
            self.assertEqual(process.wait(), 0)
            self.check(records(folder / "plain/results.jsonl")[1], records(results)[1], last.name)
            run(PROGRAM, "report", "bad", "--out", "report", folder=folder)

    def check(self, plain, bad, gone):
        reasons = []
        for good, record in zip(plain, bad, strict=True):
            if "failed" not in record:
                self.assertEqual(record, good)
                continue
            reasons.append(record["failed"]["reason"])
            self.assertEqual(record["failed"]["reason"] == "error", gone in record["scene_id"])
            self.assertEqual(record["stages"], [])
            self.assertEqual(record["goals"], good["goals"])
        lost = sum(gone in record["scene_id"] for record in bad)
        self.assertEqual(sorted(reasons), ["crash"] + ["error"] * lost + ["time"])
        print(f"failed: {', '.join(sorted(reasons))}; the other {len(bad) - len(reasons)} of "
              f"{len(bad)} records are those of an undisturbed run")


if __name__ == "__main__":
    skip_unless_long()
    PROGRAM = os.path.abspath(sys.argv[1])
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
