#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every command in README.md, CONTRIBUTING.md, BENCHMARKS.md and docs/ is one that exists.

    scripts/check_commands.py PROGRAM [ROOT]

The program's own verbs, options and settings are asked of PROGRAM, which gets a setting that it does not
know and so runs nothing. Targets of make, presets, scripts and their options, tests of ctest, extras of pip
are looked up in the tree. A program that no rule here knows is a problem, too. Exit status 1 if anything fails.
"""
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from doc_commands import commands_of, pages

PLANTED = "planted.by_the_check"
REFUSED = f'crossnav: --set: unknown key "{PLANTED}"'
# Programs of the system; their options are not checked.
SYSTEM = {"apt", "apt-get", "basename", "cd", ".", "cp", "dpkg-deb", "mkdir", "rerun", "tar"}
MODULES = {"venv", "zipfile"}


def check_crossnav(command, root, program):
    """By the program itself. Inline code may omit required parts, but must name existing parts only."""
    words = [word.replace("/home/me/crossnav", str(root)) for word in command.words[1:] if word != "..."]
    if words[:1] == ["--version"] or "VERB" in words or re.fullmatch(r"[A-Z]+|\d.*", words[0]):
        return None
    done = subprocess.run([program, *words, "--set", PLANTED + "=1"], cwd=root, text=True, check=False,
                          capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
    said = done.stderr.strip().splitlines()
    said = [line for line in said if "warning:" not in line] or [""]
    if said == [REFUSED]:
        return None
    is_partial = command.is_inline or "..." in command.words
    if is_partial and done.returncode == 2 and is_left_open(said[0], words):
        return None
    return said[0]


def is_left_open(said, words):
    """Whether the program reports a part that a partial command omits or has a placeholder for."""
    if re.search(r" is required|requires? ", said):
        return True
    if '"--set"' in said and "--set" not in words:  # a verb that has verbs of its own
        return True
    return any(re.search(rf"\b{word}\b", said) for word in words if re.fullmatch(r"[A-Z]+", word))


def check_make(command, root, _):
    makefile = (root / "Makefile").read_text("utf-8")
    for word in command.words[1:]:
        name, is_setting, _ = word.partition("=")
        pattern = rf"^{re.escape(name)} \?=" if is_setting else rf"^{re.escape(name)}:"
        if not re.search(pattern, makefile, re.M):
            return f"the Makefile has no {name}"
    return None


def text_of_script(root, word):
    """(text of a script of the tree, None) or (None, why not)."""
    if (root / word).is_file():
        return (root / word).read_text("utf-8"), None
    folder = root / "networks/paper"  # in PATH there, and a table of networks beside it
    if (folder / word).is_file():
        return "".join(path.read_text("utf-8") for path in sorted(folder.glob("*.py"))), None
    return None, f"no file {word}"


def check_script(command, root, program):
    """A script of ours: it exists, and names each option that it is given or hands it to `crossnav eval`."""
    text, problem = text_of_script(root, command.words[0].removeprefix("./"))
    if problem:
        return problem
    words = command.words[1:]
    if "EVAL OPTION" in text or "parse_known_args" in text:
        handed = words[words.index("--set"):] if "--set" in words else []
        words = words[:len(words) - len(handed)]
        for option in ("--perception", "--variant", "--shard"):
            if option in words:
                handed, words = words[words.index(option):] + handed, words[:words.index(option)]
        problem = check_crossnav(command._replace(words=[
            "crossnav", "eval", "--scenes", "S", "--episodes", "E", "--out", "O", *handed]), root, program)
        if problem:
            return problem
    for word in words:
        if re.match(r"--\w", word) and word != "--help" and not re.search(rf"{re.escape(word.split('=')[0])}\b", text):
            return f"{command.words[0]} has no {word}"
    # Names that the script chooses by: sets, groups of packages, networks.
    if words and re.fullmatch(r"[a-z]+[a-z0-9_-]*", words[0]) and words[0] not in text:
        return f"{command.words[0]} knows no {words[0]}"
    return None


def check_python(command, root, program):
    words = command.words[1:]
    if words[0] == "-m":
        name, _, module = words[1].partition(".")
        ours = root / "python/crossnav" / module
        is_ours = name == "crossnav" and (ours.with_suffix(".py").is_file() or (ours / "__main__.py").is_file())
        return None if is_ours or words[1] in MODULES else f"no module {words[1]}"
    return check_script(command._replace(words=words), root, program)


def check_pip(command, root, _):
    project = (root / "pyproject.toml").read_text("utf-8")
    version = re.search(r'CROSSNAV_VERSION "([\d.]+)"',
                        (root / "crossnav/core/version.h").read_text("utf-8")).group(1)
    for at, word in enumerate(command.words):
        if command.words[at - 1] == "-r" and not (root / word).is_file():
            return f"no file {word}"
        for extra in re.findall(r"^(?:crossnav.*|FILE)\[(\w+)\]", word):
            if not re.search(rf"^{extra} = \[", project, re.M):
                return f"pyproject.toml has no extra {extra}"
        if re.match(r"crossnav-\d", word) and not word.startswith(f"crossnav-{version}-"):
            return f"{word} is not of version {version}"
    return None


def check_presets(command, root, _):
    presets = (root / "CMakePresets.json").read_text("utf-8")
    for option, word in zip(command.words, command.words[1:]):
        if option == "--preset" and f'"name": "{word}"' not in presets:
            return f"no preset {word}"
        if option == "-S" and not (root / word / "CMakeLists.txt").is_file():
            return f"no project in {word}"
        if option == "-R" and not tests_match(root, word):
            return f"no test is called {word}"
    return None


def tests_match(root, pattern):
    """Whether a suite of gtest or a test of CMake is called like that."""
    name = re.compile(r"TEST(?:_F|_P)?\((\w+)|add_test\(NAME ([\w.]+)")
    for path in (root / "tests").rglob("*"):
        if path.name == "CMakeLists.txt" or path.suffix == ".cpp":
            for match in name.finditer(path.read_text("utf-8")):
                if re.search(pattern, match.group(1) or match.group(2)):
                    return True
    return False


RULES = {"crossnav": check_crossnav, "make": check_make, "ctest": check_presets, "cmake": check_presets,
         "pip": check_pip, "python": check_python, "python3": check_python}


def check(command, root, program):
    """The problem of a command; None if it has none."""
    if len(command.words) == 1 and command.words[0] in RULES:
        return None
    first = command.words[0].rpartition("/")[2]
    if first in RULES:
        return RULES[first](command, root, program)
    if re.search(r"\.(sh|py)$", first) or command.words[0].startswith(".ci/"):
        return check_script(command, root, program)
    return None if first in SYSTEM else "no rule of scripts/check_commands.py knows this program"


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    root = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else __file__).resolve()
    if root.is_file():
        root = root.parent.parent
    problems, commands = [], []
    with ThreadPoolExecutor(2) as pool:
        for found, wrong in pool.map(lambda page: commands_of(page, root), pages(root)):
            commands += found
            problems += wrong
        answers = list(pool.map(lambda command: check(command, root, program), commands))
    problems += [f"{command.page}: `{' '.join(command.words)}`: {answer}"
                 for command, answer in zip(commands, answers) if answer]
    print("\n".join(problems) if problems else f"docs: {len(commands)} commands are what the tree has")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
