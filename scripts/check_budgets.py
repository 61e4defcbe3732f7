#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the budgets of CONTRIBUTING.md: licence line and file length.

    scripts/check_budgets.py [ROOT]

A broken budget is an error (exit status 1). Functions over 60 lines and lines over 100 columns are
warnings: `make lint` (clang-tidy, clang-format) has the exact word on them.
"""
import pathlib
import re
import sys

FOLDERS = ("crossnav", "apps", "tests", "benchmarks", "cmake", "scripts", "tools", "viewer",
           "python", "examples", "networks", ".ci")
SUFFIXES = {".h", ".cpp", ".py", ".sh", ".cmake", ".js", ".mjs", ".proto"}
MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60
MAX_COLUMNS = 100
SPDX = "SPDX-License-Identifier: MIT"


def sources(root):
    """Every file that the budgets hold for, sorted."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if not path.is_file() or "node_modules" in path.parts:
                continue
            if path.suffix in SUFFIXES or path.name in ("CMakeLists.txt", "run"):
                yield path
    yield from (root / name for name in ("CMakeLists.txt", "Makefile") if (root / name).exists())


def check_file(relative, lines):
    """Problems of one file, as text."""
    head = [line for line in lines[:3] if not line.startswith(("#!", "<!DOCTYPE"))]
    if not head or SPDX not in head[0]:
        yield f"{relative}:1: the first line must hold '{SPDX}'"
    if len(lines) > MAX_FILE_LINES:
        yield f"{relative}: {len(lines)} lines, at most {MAX_FILE_LINES}"


def long_lines(lines):
    """Numbers of the lines over the column budget; links and includes cannot be broken."""
    return [number for number, line in enumerate(lines, 1)
            if len(line) > MAX_COLUMNS and "http" not in line and "#include" not in line]


def long_functions(lines):
    """(line, length) of every C++ function body over the budget, by indentation."""
    opener = re.compile(r"^\s*(?!namespace|struct|class|enum|union|extern).*\)[^;]*\{\s*$")
    start, closers = None, ()
    for number, line in enumerate(lines, 1):
        indent = len(line) - len(line.lstrip())
        if start is None and indent <= 2 and opener.match(line):
            start, closers = number, (" " * indent + "}", " " * indent + "};")
        elif start is not None and line.rstrip() in closers:
            if number - start - 1 > MAX_FUNCTION_LINES:
                yield start, number - start - 1
            start = None


def warnings_of(relative, lines):
    """Warnings of one C++ file, as text."""
    for start, length in long_functions(lines):
        yield f"{relative}:{start}: warning: {length} lines in a function, aim for at most " \
              f"{MAX_FUNCTION_LINES}"
    wide = long_lines(lines)
    if wide:
        yield f"{relative}: warning: over {MAX_COLUMNS} columns in line " \
              f"{', '.join(map(str, wide[:8]))}{' ...' if len(wide) > 8 else ''}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    if root.is_file():
        root = root.parent.parent
    problems, warnings, count = [], [], 0
    for path in sources(root):
        relative = path.relative_to(root).as_posix()
        lines = path.read_text(encoding="utf-8").splitlines()
        count += 1
        problems += check_file(relative, lines)
        if path.suffix in (".h", ".cpp"):
            warnings += warnings_of(relative, lines)
    print("\n".join(problems + warnings + [f"budgets: {count} files, {len(problems)} problems, "
                                           f"{len(warnings)} warnings"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
