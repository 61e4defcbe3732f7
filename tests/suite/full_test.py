#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""crossnav-mfmon-1, made from nothing: its counts, its hash, every certificate; 10,000 episodes
more in its houses; the memory of an evaluation over all of its episodes.

    CROSSNAV_LONG_TESTS=1 tests/suite/full_test.py PROGRAM [SUITE]      SUITE: one that is made
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import SMALL, children, rss_mb, run, skip_unless_long  # noqa: E402

SUITE = "crossnav-mfmon-1"
HASH = "27df13e17780c352"
DRAWN = 10000
QUIET_S = 60  # the longest that progress may be silent
GROWTH_MB = 60  # between the first and the last third of an evaluation, houses being of any size


class FullSuite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        if READY:
            (cls.folder / "suites").mkdir()
            (cls.folder / "suites" / SUITE).symlink_to(READY)
        cls.made = run(PROGRAM, "suite", "make", SUITE, "--jobs", os.cpu_count(), "--out", "suites",
                       folder=cls.folder)
        cls.place = cls.folder / "suites" / SUITE
        cls.scenes, cls.episodes = cls.place / "scenes", cls.place / "episodes.json.gz"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_it_has_the_papers_counts_and_its_hash(self):
        self.assertEqual((self.made["houses"], self.made["episodes"]), (36, 927))
        self.assertEqual(self.made["first_transition_stage"], [102, 101, 85])
        self.assertEqual(self.made["furniture"], "simple shapes")
        self.assertEqual(self.made["hash"], HASH)
        print(f"{SUITE}: 36 houses, 927 episodes, 102/101/85, hash {HASH}")

    def test_every_certificate_is_proven_again(self):
        proven = run(PROGRAM, "episodes", "check", self.episodes, "--scenes", self.scenes,
                     folder=self.folder)
        self.assertEqual((proven["episodes"], proven["failures"]), (927, []))
        print("927 certificates hold")

    def watch(self, *arguments):
        """Runs the program and returns the lines of its progress."""
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        lines, last = [], time.monotonic()
        with process.stderr:
            for line in process.stderr:
                self.assertLess(time.monotonic() - last, QUIET_S, f"silent before: {line}")
                last = time.monotonic()
                lines.append(line)
        self.assertEqual(process.wait(), 0, "".join(lines[-3:]))
        return [line for line in lines if re.search(r"\d+ of \d+ .* left", line)]

    def test_ten_thousand_episodes_pass_with_progress_all_the_time(self):
        drawn = self.watch("episodes", "generate", "--scenes", self.scenes, "--count", DRAWN,
                           "--seed", 4, "--out", "many.json.gz")
        proven = self.watch("episodes", "check", "many.json.gz", "--scenes", self.scenes)
        self.assertGreater(min(len(drawn), len(proven)), 0)
        print(f"{DRAWN} episodes drawn and proven; {len(drawn)} and {len(proven)} lines of progress")

    def test_memory_does_not_grow_over_all_episodes(self):
        process = subprocess.Popen(
            [PROGRAM, "eval", "--quiet", "--scenes", self.scenes, "--episodes", self.episodes,
             "--out", "run", *SMALL, "--set", "eval.action_budget=30"], cwd=self.folder,
            stdout=subprocess.DEVNULL)
        results, taken = self.folder / "run/results.jsonl", []
        while process.poll() is None:
            if results.exists():
                taken.append((rss_mb(process.pid), max(map(rss_mb, children(process.pid)),
                                                       default=0)))
            time.sleep(0.2)
        self.assertEqual(process.returncode, 0)
        lines = results.read_text().splitlines()
        self.assertEqual(len(lines), 928)
        self.assertFalse([line for line in lines if "failed" in json.loads(line)])
        third = len(taken) // 3
        for who, k in (("program", 0), ("worker", 1)):
            first, last = (max(t[k] for t in part) for part in (taken[:third], taken[-third:]))
            print(f"memory of the {who} over 927 episodes: at most {first:.0f} MB in the first "
                  f"third, {last:.0f} MB in the last")
            self.assertLess(last, first + GROWTH_MB)


if __name__ == "__main__":
    skip_unless_long()
    PROGRAM = os.path.abspath(sys.argv[1])
    READY = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else None
    unittest.main(argv=sys.argv[:1])
