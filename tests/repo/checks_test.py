#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The checks of the tree find faults that are planted, and pass a small tree that has none."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
SPDX = "// SPDX-License-Identifier: MIT\n"
GOOD = {
    "crossnav/core/pose.h": SPDX + "#include <Eigen/Core>\n#include <vector>\n",
    "crossnav/core/result.h": SPDX + "#include <tl/expected.hpp>\n",
    "crossnav/agent/agent.cpp": SPDX + '#include "crossnav/core/pose.h"\n// eq:known\n',
    "crossnav/agent/CMakeLists.txt": "# SPDX-License-Identifier: MIT\n"
                                     "crossnav_library(agent SOURCES agent.cpp DEPS core)\n",
    "apps/crossnav/main.cpp": SPDX + '#include "crossnav/agent/agent.h"\n',
    "docs/paper_map.md": "[link](../crossnav)\n| `eq:known` | what | `crossnav/agent/agent.cpp` | |\n",
}


class Checks(unittest.TestCase):
    def run_check(self, name, changed):
        """(exit status, output) of a check on the good tree with some files changed."""
        with tempfile.TemporaryDirectory() as folder:
            for relative, text in {**GOOD, **changed}.items():
                path = pathlib.Path(folder) / relative
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, str(SCRIPTS / f"check_{name}.py"), folder],
                                  capture_output=True, text=True, check=False)
            return done.returncode, done.stdout + done.stderr

    def assert_found(self, check, changed, expected):
        status, output = self.run_check(check, changed)
        self.assertEqual(status, 1, output)
        self.assertIn(expected, output)

    def test_a_good_tree_passes(self):
        for check in ("includes", "budgets", "docs", "draws"):
            status, output = self.run_check(check, {})
            self.assertEqual(status, 0, output)

    def test_two_random_numbers_in_one_call_are_found_and_lists_pass(self):
        for call in ("Vector2d p(rng.Uniform(0, 1), rng.Uniform(0, 1));", "Add(Make(rng), rng_.Int(1, 2));"):
            self.assert_found("draws", {"crossnav/core/pose.cpp": SPDX + call + "\n"},
                              "pose.cpp:2: two random numbers")
        listed = "Vector2d p{rng.Uniform(0, 1), rng.Uniform(0, 1)}; Add(a, Make(rng, 3));\n"
        status, output = self.run_check("draws", {"crossnav/core/pose.cpp": SPDX + listed})
        self.assertEqual(status, 0, output)

    def test_the_agent_including_the_simulator_is_found(self):
        self.assert_found("includes", {"crossnav/agent/agent.cpp":
                                       SPDX + '#include "crossnav/sim/scene/scene.h"\n'},
                          "agent may not include sim")

    def test_a_folder_of_a_room_including_a_higher_one_is_found(self):
        self.assert_found("includes", {"crossnav/world/mesh/rect.cpp":
                                       SPDX + '#include "crossnav/world/house/house_file.h"\n'},
                          "world/mesh may not include world/house")

    def test_a_folder_of_a_room_including_a_lower_one_passes(self):
        status, output = self.run_check("includes", {"crossnav/world/house/house_file.cpp":
                                        SPDX + '#include "crossnav/world/mesh/rect.h"\n'})
        self.assertEqual(status, 0, output)

    def test_a_loose_file_in_a_room_with_folders_is_found(self):
        self.assert_found("includes", {"crossnav/world/rect.cpp": SPDX},
                          "crossnav/world/rect.cpp: world has the folders")

    def test_the_agent_linking_the_evaluator_is_found(self):
        self.assert_found("includes", {"crossnav/agent/CMakeLists.txt":
                                       "crossnav_library(agent SOURCES agent.cpp DEPS core evaluation)\n"},
                          "agent may not link evaluation")

    def test_a_third_party_header_outside_its_adapter_is_found(self):
        self.assert_found("includes", {"crossnav/core/pose.h": SPDX + "#include <tl/expected.hpp>\n"},
                          "belongs behind crossnav/core/result.h")

    def test_an_unknown_library_is_found(self):
        self.assert_found("includes", {"crossnav/core/pose.h": SPDX + "#include <boost/any.hpp>\n"},
                          "unknown third-party header")

    def test_an_unknown_room_is_found(self):
        self.assert_found("includes", {"crossnav/utils/misc.h": SPDX}, "crossnav/utils")

    def test_a_missing_licence_line_is_found(self):
        self.assert_found("budgets", {"crossnav/core/pose.h": "#pragma once\n"}, "pose.h:1")

    def test_a_file_over_the_budget_is_found(self):
        self.assert_found("budgets", {"crossnav/core/pose.h": SPDX + "\n" * 400}, "401 lines")

    def test_a_citation_without_a_row_is_found(self):
        self.assert_found("docs", {"crossnav/core/pose.h": SPDX + "// tab:nowhere\n"}, "tab:nowhere")

    def test_a_row_that_names_a_missing_test_is_found(self):
        row = "| `eq:known` | what | `crossnav/agent/agent.cpp` | `crossnav/core/pose.h` `NoSuch` |\n"
        self.assert_found("docs", {"docs/paper_map.md": row}, "NoSuch is not in")

    def test_a_broken_link_is_found(self):
        self.assert_found("docs", {"README.md": "a line\n" * 91}, "91 lines, at most 90")
        self.assert_found("docs", {"README.md": "see [this](docs/gone.md)\n"}, "docs/gone.md")

    def test_a_path_that_is_not_there_is_found(self):
        self.assert_found("docs", {"docs/page.md": "the room `crossnav/bench`\n"}, "names crossnav/bench")
        self.assertEqual(self.run_check("docs", {"docs/page.md": "the room `crossnav/core/*.h`\n"})[0], 0)


class Makefile(unittest.TestCase):
    def test_its_groups_of_packages_exist_in_setup(self):
        groups = set(re.findall(r"^  \[(\w+)\]=", (SCRIPTS / "setup.sh").read_text("utf-8"), re.M))
        makefile = (SCRIPTS.parent / "Makefile").read_text("utf-8")
        asked = {group for line in re.findall(r"scripts/setup\.sh((?: \w+)*)", makefile) for group in line.split()}
        self.assertIn("viewer", asked)
        self.assertEqual(asked - groups, set())


if __name__ == "__main__":
    unittest.main()
