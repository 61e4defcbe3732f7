#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Installs the build tree into a new folder, moves it, builds examples/ against it and runs them.

    install_test.py SOURCE_DIR BUILD_DIR CMAKE COMPILER
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = (pathlib.Path(path) for path in sys.argv[1:3])
CMAKE, COMPILER = sys.argv[3:5]


def run(*command, check=True):
    """Output of a command, stdout and stderr together."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    if check and done.returncode:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


class Installed(unittest.TestCase):
    """One installation for all tests; they run in the order of their names."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="crossnav-install-"))
        first = cls.folder / "first"
        for component in ("development", "program"):
            run(CMAKE, "--install", BUILD, "--prefix", first, "--component", component)
        cls.prefix = cls.folder / "moved"  # a package may be moved as a whole
        first.rename(cls.prefix)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def configure(self, *more, check=True):
        launcher = shutil.which("ccache")
        return run(CMAKE, "-G", "Ninja", "-S", SOURCE / "examples", "-B", self.folder / "build",
                   f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}",
                   f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher or ''}", *more, check=check)

    def example(self, name, *arguments):
        return run(self.folder / "build" / name, *arguments)

    def test_1_headers_include_installed_headers_only(self):
        include = self.prefix / "include"
        headers = sorted(include.rglob("*.h"))
        self.assertGreater(len(headers), 100)
        for header in headers:
            for name in re.findall(r'#include "(crossnav/[^"]+)"', header.read_text("utf-8")):
                self.assertTrue((include / name).is_file(), f"{header.name} includes {name}")

    def test_2_package_names_no_path_of_the_checkout(self):
        files = sorted(self.prefix.rglob("*.cmake"))
        self.assertGreater(len(files), 3)
        for path in files:
            text = path.read_text("utf-8")
            self.assertNotIn(str(SOURCE), text, path.name)
            self.assertNotIn(str(BUILD), text, path.name)

    def test_3_program_and_header_agree_on_the_version(self):
        header = (self.prefix / "include/crossnav/core/version.h").read_text("utf-8")
        version = re.search(r'CROSSNAV_VERSION "([0-9.]+)"', header).group(1)
        parts = re.findall(r"CROSSNAV_VERSION_[A-Z]+ (\d+)", header)
        self.assertEqual(".".join(parts), version)
        self.assertEqual(run(self.prefix / "bin/crossnav", "--version").strip(), version)

    def test_4_an_unknown_room_is_refused_by_name(self):
        said = self.configure("-DCMAKE_PROJECT_INCLUDE=" + str(self.wants("cellar")), check=False)
        self.assertIn("cellar", said)
        self.assertNotIn("Configuring done", said)

    def wants(self, room):
        path = self.folder / "wants.cmake"
        path.write_text(f"find_package(crossnav REQUIRED COMPONENTS {room})\n", encoding="utf-8")
        return path

    def test_5_examples_build_and_answer(self):
        shutil.rmtree(self.folder / "build", ignore_errors=True)
        self.configure()
        run(CMAKE, "--build", self.folder / "build")
        points = self.folder / "room.ply"
        said = self.example("map_from_depth", points)
        self.assertRegex(said, r"[1-9]\d* surface voxels, [1-9]\d* to walk through")
        self.assertIn("out of sight", said)
        self.assertTrue(points.read_bytes().startswith(b"ply"))
        self.assertRegex(self.example("own_perception"), r"red box: claimed at (1\.\d|2\.0) ")
        home = self.folder / "home.map"
        said = self.example("agent_loop", self.folder / "house", home)
        claim = re.search(r"bed: claimed at (\S+) (\S+) (\S+)", said)
        self.assertTrue(claim, said)
        self.check_answer(home, claim.groups())

    def test_6_the_loop_of_the_readme_compiles(self):
        readme = (SOURCE / "README.md").read_text("utf-8")
        loop = re.search(r"```cpp\n(.*?)```", readme, re.S).group(1)
        program = self.folder / "build" / "readme.cpp"
        program.write_text(loop + """
struct Robot {
  crossnav::Observation Observe() { return {}; }
  void Act(crossnav::Action) {}
};
template crossnav::Result<void> Find(Robot&, crossnav::agent::Agent&, const std::string&);
""", encoding="utf-8")
        run(COMPILER, "-std=c++20", "-fsyntax-only", "-isystem", "/usr/include/eigen3", "-I",
            self.prefix / "include", program)

    def check_answer(self, home, point):
        """A query with the claimed point finds a place near it."""
        places = re.findall(r"at (\S+) (\S+) \S+, similarity", self.example("ask_map", home, *point))
        near = [place for place in places if all(
            abs(float(a) - float(b)) < 1.5 for a, b in zip(place, point))]
        self.assertTrue(near, places)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
