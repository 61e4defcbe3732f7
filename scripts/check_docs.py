#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the documents against the tree.

    scripts/check_docs.py [ROOT]

Relative links in Markdown files, paths in inline code and documents named in the code lead somewhere; every label of the
paper that the code cites has a row in docs/paper_map.md; every file and name in such a row exists; README.md has 90 lines at most.
Exit status 1 if anything fails.
"""
import pathlib
import re
import sys

LABEL = re.compile(r"\b(?:eq|tab|alg|sec|fig):[a-z][a-z0-9_]*")
CODE_FOLDERS = ("crossnav", "apps", "tests", "benchmarks")
OUR_PATH = re.compile(r"`((?:crossnav|apps|scripts|python|tests|config|cmake|examples|benchmarks|networks|viewer)"
                      r"/[\w./*-]+)`")
MAX_README_LINES = 90
SKIPPED = {"build", "out", "node_modules", ".git"}


def files(root, folders, suffixes):
    """Files under the folders with one of the suffixes, sorted; build output left out."""
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            inside = path.relative_to(root).parts
            if path.suffix in suffixes and path.is_file() and not SKIPPED.intersection(inside):
                yield path


def check_links(root):
    """Problems with relative links."""
    for path in files(root, ["."], {".md"}):
        text = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.S)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            target = target.split("#")[0]
            if target and "://" not in target and not target.startswith("mailto:"):
                if not (path.parent / target).exists():
                    yield f"{path.relative_to(root)}: broken link to {target}"


def check_citations(root):
    """Documents of ours that the code names, and that are not there."""
    for path in files(root, ("crossnav", "apps"), {".h", ".cpp"}):
        for name in sorted(set(re.findall(r"\bdocs/[\w/]+\.md\b", path.read_text("utf-8")))):
            if not (root / name).exists():
                yield f"{path.relative_to(root)}: names {name}, which is not there"


def check_paths(root):
    """Paths of ours in inline code that are not there. Programs of benchmarks/ are named after their source."""
    pages = [root / name for name in ("README.md", "CONTRIBUTING.md", "BENCHMARKS.md")]
    for path in [*pages, *files(root, ["docs"], {".md"})]:
        for name in OUR_PATH.findall(path.read_text("utf-8")) if path.exists() else []:
            places = (name.rstrip("/"), name + ".cpp", "python/" + name)
            if not any(any(root.glob(place)) for place in places):
                yield f"{path.relative_to(root)}: names {name}, which is not there"


def check_row(root, number, row):
    """Problems with the files and names of one row of the paper map."""
    cells = [cell.strip() for cell in row.strip().strip("|").split("|")]
    for cell in cells[2:]:
        quoted = re.findall(r"`([^`]+)`", cell)
        paths = [q for q in quoted if "/" in q]
        text = ""
        for name in paths:
            if (root / name).is_file():
                text += (root / name).read_text(encoding="utf-8")
            elif not (root / name).is_dir():
                yield f"docs/paper_map.md:{number}: no file {name}"
        for name in quoted:
            if "/" not in name and name not in text:
                where = ", ".join(paths) or "any file"
                yield f"docs/paper_map.md:{number}: {name} is not in {where}"


def check_paper_map(root):
    """Problems between the code's citations and the paper map."""
    lines = (root / "docs/paper_map.md").read_text(encoding="utf-8").splitlines()
    mapped = set()
    for number, line in enumerate(lines, 1):
        labels = LABEL.findall(line.split("|")[1]) if line.startswith("| `") else []
        mapped.update(labels)
        if labels:
            yield from check_row(root, number, line)
    for path in files(root, CODE_FOLDERS, {".h", ".cpp"}):
        text = path.read_text(encoding="utf-8")
        for label in sorted(set(LABEL.findall(text)) - mapped):
            yield f"{path.relative_to(root)}: cites {label}, which docs/paper_map.md lacks"


def check_readme(root):
    """The README is a front door."""
    path = root / "README.md"
    lines = len(path.read_text(encoding="utf-8").splitlines()) if path.exists() else 0
    if lines > MAX_README_LINES:
        yield f"README.md: {lines} lines, at most {MAX_README_LINES}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    if root.is_file():
        root = root.parent.parent
    problems = [*check_links(root), *check_citations(root), *check_paths(root), *check_paper_map(root),
                *check_readme(root)]
    print("\n".join(problems) if problems else "docs: links and paper map hold")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
