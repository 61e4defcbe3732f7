#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that no call draws two random numbers in its arguments.

    scripts/check_draws.py [ROOT]

C++ leaves the order of arguments open, and compilers differ in it: a seed would give another house
with each of them. Lists in braces have an order, and so have declarations with commas.
"""
import pathlib
import re
import sys

DRAW = re.compile(r"\w(\.|->)(Uniform|Normal|Int|Below|Chance|Next)\(")
HANDED = re.compile(r"\(([^()]*,\s*)?\w*rng_?\s*(,[^()]*)?\)")
PAIRS = {")": "(", "]": "[", "}": "{"}


def calls(text):
    """(line, arguments) of each pair of parentheses."""
    open_lists = []
    for at, char in enumerate(text):
        if char in "([{":
            open_lists.append((char, at, [at]))
        elif char == "," and open_lists:
            open_lists[-1][2].append(at)
        elif char in PAIRS and open_lists and open_lists[-1][0] == PAIRS[char]:
            kind, start, commas = open_lists.pop()
            if kind == "(":
                ends = commas[1:] + [at]
                yield text.count("\n", 0, start) + 1, [text[a + 1:b] for a, b in zip(commas, ends)]


def problems(path):
    text = re.sub(r'//[^\n]*|"(\\.|[^"\\\n])*"', "", path.read_text(encoding="utf-8"))
    for line, arguments in calls(text):
        if sum(bool(DRAW.search(part) or HANDED.search(part)) for part in arguments) > 1:
            yield line


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found, count = [], 0
    for folder in ("crossnav", "apps"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            count += 1
            found += [f"{path.relative_to(root)}:{line}: two random numbers in the arguments of one call"
                      for line in problems(path)]
    print("\n".join(found) if found else f"{count} files, no call draws two random numbers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
