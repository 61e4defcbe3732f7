#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Commands of the documents: cheap ones run on small inputs, and the check of all others finds planted faults.

    commands_test.py PROGRAM
"""
import gzip
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
sys.path.insert(0, str(SCRIPTS))
from doc_commands import commands_of, pages  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SMALL = ["--set", "sensor.width_px=96", "--set", "sensor.height_px=96", "--set", "eval.action_budget=10",
         "--set", "ground_truth.min_visible_px=8", "--set", "ground_truth.feature_dim=32"]

# Commands that are not run here, by how they begin, and why. The check asks the program about them.
NOT_RUN = {
    "assets import": "fetches the furniture pack", "scene import": "needs a building: tests/homes, tests/apps",
    "map build": "needs a recording: tests/apps", "serve": "waits for a robot: tests/serve",
    "bench": "minutes", "world stats": "minutes", "suite": "hours: tests/suite", "networks": "tests/apps",
    "replay export out/demo": "needs rerun-sdk: python/tests",
    "demo": "whole episodes: tests/apps", "slurm": "needs sbatch: tests/apps",
}
# Words of the documents that stand for something of the reader's.
STANDS_FOR = {"SCENE": "scenes/00001-CrossnavHouse", "DIR": "scenes", "RUN...": "run",
              "RUN_FULL": "run", "RUN_KNOWN_MAP": "run", "RUN_KNOWN_OBJECTS": "run", "N": "1",
              "out/houses/0*/": "scenes/00001-CrossnavHouse"}
FEW = {"--count": "1", "--jobs": "1", "--tasks": "2", "--furniture": "none", "--area": "60", "--time": "0:10:00"}


def crossnav(folder, *words):
    """(exit status, output) of the program in a folder."""
    done = subprocess.run([PROGRAM, *words], cwd=folder, text=True, stdout=subprocess.PIPE, check=False,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, timeout=200)
    return done.returncode, done.stdout


def prepare(folder):
    """A house, episodes, a run, a map and a replay, as the documents call them."""
    steps = [["world", "generate", "--embedded", "--out", "scenes"],
             ["episodes", "generate", "--scenes", "scenes", "--count", "2", "--goals", "1", "--out", "e.json.gz", *SMALL],
             ["eval", "--scenes", "scenes", "--episodes", "e.json.gz", "--out", "run", *SMALL]]
    for step in steps:
        status, said = crossnav(folder, *step)
        assert status == 0, said
    crossnav(folder, "demo", "2", "--quiet", "--out", "demo", *SMALL)
    shutil.copy(folder / "demo/2/replay.mcap", folder / "r.mcap")


def first_episode(path):
    """Id of the first episode of a file."""
    return json.loads(gzip.decompress(path.read_bytes()))["episodes"][0]["episode_id"]


def small(words):
    """The command with small inputs; None where it is not run."""
    line = " ".join(words[1:])
    if any(line.startswith(begin) for begin in NOT_RUN) or "--perception networks" in line or "hm3d" in line or "..." in words:
        return None
    words = [STANDS_FOR.get(word, word) for word in words[1:]]
    for at in range(1, len(words)):
        words[at] = FEW.get(words[at - 1], words[at])
    if words[:2] == ["world", "generate"] and "--embedded" not in words:
        words += [] if "--furniture" in words else ["--furniture", "none"]
    if words[0] in ("eval", "run") or words[:2] in (["episodes", "generate"], ["episodes", "check"]):
        words += SMALL
    return words


class CheapCommands(unittest.TestCase):
    """Each page's commands in their order, in a folder of its own."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="crossnav-docs-"))
        (cls.folder / "prepared").mkdir()
        prepare(cls.folder / "prepared")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def run_page(self, name):
        """(count of a page's commands that were run, failed commands)."""
        folder = self.folder / name.replace("/", "_")
        shutil.copytree(self.folder / "prepared", folder)
        ran, failed = 0, []
        for command in commands_of(ROOT / name, ROOT)[0]:
            words = small(command.words) if command.words[0] == "crossnav" and not command.is_inline else None
            if words:
                words = [first_episode(folder / "e.json.gz") if word == "ID" else word for word in words]
                if words[0] == "eval":  # not one that goes on
                    shutil.rmtree(folder / words[words.index("--out") + 1], ignore_errors=True)
                status, said = crossnav(folder, *words)
                if "holds no results" in said or "cannot be opened" in said:
                    continue  # of a command that takes hours
                if status and words[0] != "run":  # an episode of ten steps finds nothing
                    failed.append(f"{name}: {' '.join(words)}\n{said}")
                ran += 1
        return ran, failed

    def test_commands_of_every_page_run(self):
        names = [str(page.relative_to(ROOT)) for page in pages(ROOT) if page.name != "hm3d.md"]  # tests/hm3d
        with ThreadPoolExecutor(2) as pool:
            done = dict(zip(names, pool.map(self.run_page, names)))
        self.assertFalse("".join(line for _, failed in done.values() for line in failed))
        self.assertGreaterEqual(done["docs/cli.md"][0], 11)
        self.assertGreaterEqual(done["docs/reproduce.md"][0], 8)


class PlantedFaults(unittest.TestCase):
    """Pages with one wrong command each, beside the files of the tree that the check looks into."""

    def said_of(self, text):
        """(exit status, output) of the check of a tree whose README is `text`."""
        with tempfile.TemporaryDirectory() as name:
            for part in ("Makefile", "CMakePresets.json", "pyproject.toml", "scripts", "config", "crossnav", "tests"):
                pathlib.Path(name, part).symlink_to(ROOT / part)
            pathlib.Path(name, "docs").mkdir()
            pathlib.Path(name, "README.md").write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, SCRIPTS / "check_commands.py", PROGRAM, name], text=True,
                                  capture_output=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_a_page_without_faults_passes(self):
        status, said = self.said_of("```\nmake test\ncrossnav demo 2 | tee log\n```\n`crossnav eval --scenes DIR`\n")
        self.assertEqual(status, 1, said)  # tee: a program that no rule knows
        self.assertIn("`tee log`: no rule", said)
        status, said = self.said_of("```\nfor n in 1 2; do crossnav demo $n; done\n```\n`crossnav eval --scenes DIR`\n")
        self.assertEqual((status, "3 commands" in said), (0, True), said)

    def test_each_planted_fault_is_found(self):
        faults = {
            "```\ncrossnav demmo\n```": 'unknown verb "demmo"',
            "```sh\ncrossnav demo --sett a=1\n```": 'unknown option "--sett"',
            "```\nX=noise.profil\ncrossnav demo --set $X=kinect\n```": 'unknown key "noise.profil"',
            "```\ncrossnav eval --scenes DIR\n```": "--episodes is required",
            "see `crossnav eval --epochs 3`": 'unknown option "--epochs"',
            "```\nmake tests\n```": "the Makefile has no tests",
            "```\nmake demo DEMOS=2\n```": "the Makefile has no DEMOS",
            "```\nscripts/set_up.sh\n```": "no file scripts/set_up.sh",
            "```\nscripts/fuzz_table.sh --wite\n```": "has no --wite",
            "```\nscripts/navigation_figures.sh held-in out\n```": "knows no held-in",
            "```\nctest --preset releas\n```": "no preset releas",
            "```\nctest --preset release -R NoSuchSuite\n```": "no test is called NoSuchSuite",
            "```\npip install 'crossnav[gin]'\n```": "no extra gin",
            "```\nrm -r build\n```": "no rule of scripts/check_commands.py",
            "```\ncrossnav demo $UNSET\n```": "unbound variable",
        }
        for text, expected in faults.items():
            status, said = self.said_of(text + "\n")
            self.assertEqual((status, expected in said), (1, True), f"{text}\n{said}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
