#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
""".ci/nightly continues after a failure, sums up, and its exit status reports it."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / ".ci" / "nightly"
MAKE = """#!/bin/sh
echo "made $*"
[ "$1" = lint ] && { echo "a.cpp:1: error: planted"; exit 2; }
echo "100% tests passed, 0 tests failed out of 7"
"""


class Nightly(unittest.TestCase):
    def run_nightly(self, *parts, **settings):
        """(exit status, output) of a copy of the script with a `make` that fails at `lint`."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / ".ci").mkdir()
            shutil.copy(SCRIPT, root / ".ci" / "nightly")
            make = root / "make"
            make.write_text(MAKE)
            make.chmod(0o755)
            done = subprocess.run([str(root / ".ci" / "nightly"), *parts], text=True, check=False,
                                  env={**os.environ, "PATH": f"{root}:{os.environ['PATH']}", **settings},
                                  capture_output=True)
            return done.returncode, done.stdout + done.stderr

    def test_a_failure_stops_nothing_and_is_told(self):
        status, output = self.run_nightly(SECONDS_PER_TARGET="5")
        self.assertEqual(status, 1)
        self.assertIn("made fuzz SECONDS=5", output)
        summary = output[output.rindex("\n\n"):]
        self.assertRegex(summary, r"lint +failed\(2\) +\d+ s +a.cpp:1: error: planted")
        for part in ("asan", "tsan", "docs", "fuzz", "test-long"):
            self.assertRegex(summary, part + r" +passed +\d+ s +100% tests passed")

    def test_one_part_alone_passes(self):
        status, output = self.run_nightly("asan", JOBS="1")
        self.assertEqual(status, 0, output)
        self.assertIn("made asan JOBS=1", output)
        self.assertNotIn("lint", output)

    def test_an_unknown_part_is_named_before_anything_runs(self):
        status, output = self.run_nightly("asan", "bench")
        self.assertEqual(status, 2)
        self.assertIn("no part 'bench'", output)
        self.assertNotIn("made", output)


if __name__ == "__main__":
    unittest.main()
