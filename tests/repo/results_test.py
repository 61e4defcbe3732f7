#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/results.py runs every row of every table, and its page holds them; a stand-in plays the
program, which logs its calls and answers with canned figures."""
import gzip
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/results.py"
PROGRAM = '''#!{python}
import gzip, json, pathlib, sys
words = sys.argv[1:]
with open("calls.txt", "a") as log:
    log.write(" ".join(words) + "\\n")
figure = dict(value=.5, low=.4, high=.6)
metrics = dict(SR=figure, SPL=figure, PR=figure, PPL=figure)
if words[:2] == ["suite", "run"] and "tracks" in words[2]:
    for name in ("bim", "drawn"):
        place = pathlib.Path("out/suites") / words[2] / name
        place.mkdir(parents=True, exist_ok=True)
        (place / "manifest.json").write_text("{}")
if words[:2] == ["suite", "make"]:
    place = pathlib.Path("out/suites") / words[2]
    place.mkdir(parents=True)
    episodes = [dict(episode_id=str(i), scene_id="ab"[i % 2]) for i in range(10)]
    document = json.dumps(dict(episodes=episodes)).encode()
    (place / "episodes.json.gz").write_bytes(gzip.compress(document))
if words[0] == "metrics":
    print(json.dumps(dict(episodes=24, goals=3, metrics=metrics,
                          groups=dict(cfr=dict(episodes=8, metrics=metrics)))))
if words[0] == "report":
    out = pathlib.Path(words[words.index("--out") + 1])
    out.mkdir(parents=True)
    names = [pathlib.Path(w).name for w in words[1:words.index("--out")]]
    is_single = "single" in words[1]
    text = "# Report\\n\\n" + ("## Single-object navigation\\n\\nsingle rows\\n" if is_single
                               else "## All episodes\\n\\noverall rows\\n")
    text += "\\n## a against b, paired\\n\\ntwice\\n\\n## Plots\\n\\n![x](x.svg)\\n"
    for name in names:
        text += "\\n## " + name + "\\n\\nof it\\n\\n### Outcomes\\n\\nrows of " + name
        text += "\\n\\n### Causes of failure\\n\\nnone\\n"
    (out / "report.md").write_text(text)
    difference = dict(difference=.1, low=0, high=.2)
    print(json.dumps(dict(comparisons=[dict(before=names[0], after=n,
                          differences=dict(SR=difference, SPL=difference)) for n in names[1:]])))
'''


def run(root: pathlib.Path, suite: str, *options: str):
    """(calls, page) of scripts/results.py for `suite`."""
    program = root / "crossnav"
    program.write_text(PROGRAM.replace("{python}", sys.executable))
    program.chmod(0o755)
    subprocess.run([sys.executable, str(SCRIPT), suite, "--jobs", "3", "--commit", "abc",
                    "--out", "page.md", *options, "--set", "a=1"], cwd=root, check=True,
                   env={**os.environ, "CROSSNAV": str(program)}, capture_output=True)
    return (root / "calls.txt").read_text(), (root / "page.md").read_text()


class Results(unittest.TestCase):
    def test_each_track_has_a_section_and_no_figure_is_pooled(self):
        with tempfile.TemporaryDirectory() as folder:
            calls, page = run(pathlib.Path(folder), "suite-tracks")
        head, bim, drawn = re.split("\n## Track (?:bim|drawn)\n", page)
        self.assertNotIn("SR", head)
        for name, part in (("bim", bim), ("drawn", drawn)):
            self.assertIn("| `full` | 50.0", part)
            self.assertIn("### The paper's tables", part)
            self.assertIn(f"metrics out/suites/suite-tracks/{name}/runs/full/results.jsonl", calls)
            self.assertIn(f"--scenes out/suites/suite-tracks/{name}/scenes", calls)
        self.assertEqual(calls.count("suite run"), 7)

    def test_every_row_of_every_table_is_run_and_written(self):
        with tempfile.TemporaryDirectory() as folder:
            calls, page = run(pathlib.Path(folder), "suite-x")
        for variant in ("full", "no-history-poi", "no-history-poi-pure", "planar", "onemap",
                        "paper-no-history-poi", "paper"):
            self.assertIn(f"suite run suite-x --variant {variant} --jobs 3 --set a=1\n", calls)
            self.assertIn(f"| `{variant}` | 50.0 [40.0, 60.0] |", page)
        self.assertIn("--goals 1", calls)
        for variant in ("onemap", "paper"):
            self.assertRegex(calls, "eval --config .*/config/objectnav_paper.toml .*--variant "
                                    f"{variant} .*--set a=1\n")
        for part in ("### All episodes\n\noverall rows", "### Outcomes of `paper`\n\nrows of paper\n",
                     "### Outcomes of `paper-no-history-poi`\n", "### Outcomes of `onemap`\n",
                     "### Single-object navigation\n\n24 episodes of one goal",
                     "- `onemap` to `paper`: SR 10.0",
                     "- `no-history-poi-pure` to `full`", "Measured at `abc`"):
            self.assertIn(part, page)
        self.assertRegex(page, r"`config/objectnav_paper.toml`.\n\nsingle rows")
        for part in ("Causes of failure", "Plots", ".svg", ", paired"):
            self.assertNotIn(part, page)

    def test_a_part_of_a_suite_has_episodes_of_each_house_and_the_page_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            calls, page = run(root, "suite-x", "--every", "2", "--furniture", "pack")
            file = root / "out/suites/suite-x/every-2/episodes.json.gz"
            document = json.loads(gzip.decompress(file.read_bytes()))
        self.assertEqual([e["episode_id"] for e in document["episodes"]], list("014589"))
        self.assertIn("suite make suite-x --jobs 3 --furniture pack\n", calls)
        self.assertNotIn("suite run", calls)
        scenes, part = "out/suites/suite-x/scenes", "out/suites/suite-x/every-2"
        for variant in ("full", "onemap"):
            self.assertIn(f"eval --scenes {scenes} --episodes {part}/episodes.json.gz --variant "
                          f"{variant} --out {part}/runs/{variant} --jobs 3 --set a=1\n", calls)
        self.assertIn(f"--scenes {scenes} --episodes {part}/single/episodes", calls)
        self.assertIn("`suite-x`, one of every 2 episodes of a house.", page)
        self.assertIn("results.py suite-x --every 2 --furniture pack --set a=1\n", page)

    def test_single_object_runs_get_no_option_that_eval_lacks(self):
        with tempfile.TemporaryDirectory() as folder:
            calls, _ = run(pathlib.Path(folder), "suite-x", "--homes", "a.jar", "--furniture=pack",
                           "--config", "mine.toml")
        for line in calls.splitlines():
            if line.startswith("suite run"):
                self.assertIn("--homes a.jar --furniture=pack --config mine.toml", line)
            if line.startswith("eval"):
                self.assertTrue(line.endswith("--jobs 3 --set a=1"), line)
                self.assertEqual(line.count("--config"), 1)


if __name__ == "__main__":
    unittest.main()
