# SPDX-License-Identifier: MIT
"""Commands in Markdown: blocks of code and inline code, as argument lists that bash itself made.

Blocks without a language, or with `sh`, are commands. All blocks of a page are one script, run by bash with
every program replaced by a record of its arguments, so that variables, loops and quotes mean what they mean.
"""
import pathlib
import re
import subprocess
import tempfile
from typing import NamedTuple

SHELL = {"", "sh", "bash"}
FENCE = re.compile(r"^ *```(\w*)")
INLINE = re.compile(r"`((?:crossnav|make|ctest|cmake|pip|python3?|apt|scripts/[\w.]+|\.ci/\w+) [^`]+)`")
PATH_WORD = re.compile(r"(?:^|[\s;(])((?:[\w.~$-]+/)+[\w.-]+)", re.M)
TRACER = r"""
set -u
HOME=/home/me
PATH=/nonexistent
record() {  # in one write: both sides of a pipe record at once
  local line
  printf -v line '%s\x1f' "$@"
  printf '%s\x1e' "$line" >>"$RECORDS"
}
command_not_found_handle() { record "$@"; }
cd() { record cd "$@"; }
.() { record . "$@"; }
"""


class Block(NamedTuple):
    """Code between two fences; `line` is that of the first fence."""
    page: str
    line: int
    language: str
    text: str


class Command(NamedTuple):
    """A command as bash would run it. Inline code may omit the value of an option."""
    page: str
    words: list
    is_inline: bool


def pages(root):
    """Markdown files with commands for users."""
    names = ["README.md", "CONTRIBUTING.md", "BENCHMARKS.md"]
    return [path for path in [root / name for name in names] + sorted((root / "docs").rglob("*.md"))
            if path.exists()]


def blocks_of(path, root):
    """Fenced blocks of a page."""
    found, opened = [], None
    for number, line in enumerate(path.read_text("utf-8").splitlines(), 1):
        fence = FENCE.match(line)
        if fence and opened is None:
            opened = (number, fence.group(1), [])
        elif fence:
            found.append(Block(str(path.relative_to(root)), opened[0], opened[1],
                               "\n".join(opened[2]) + "\n"))
            opened = None
        elif opened is not None:
            opened[2].append(line)
    return found


def inline_of(path):
    """Inline code that begins with a program's name and has an argument."""
    text = re.sub(r"^ *```.*?^ *```", "", path.read_text("utf-8"), flags=re.S | re.M)
    return [" ".join(code.split()) for code in INLINE.findall(text)]


def trace(script):
    """(argument lists, messages of bash) of a script; no program is run."""
    stubs = {word for word in PATH_WORD.findall(script) if re.fullmatch(r"[\w./-]+", word)}
    functions = "".join(f"function {word} {{ record {word} \"$@\"; }}\n" for word in sorted(stubs))
    with tempfile.TemporaryDirectory() as folder:
        records = pathlib.Path(folder, "records")
        done = subprocess.run(["/bin/bash", "-c", TRACER + functions + script], cwd=folder, text=True,
                              env={"RECORDS": str(records)}, capture_output=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=120)
        said = "\n".join(line for line in done.stderr.splitlines()
                         if line and not re.match(r"(real|user|sys)\t", line))
        text = records.read_text("utf-8") if records.exists() else ""
    return [record.split("\x1f")[:-1] for record in text.split("\x1e")[:-1]], said


def commands_of(path, root):
    """(commands, problems) of a page."""
    name = str(path.relative_to(root))
    script = "".join(block.text for block in blocks_of(path, root) if block.language in SHELL)
    found, said = trace(script)
    problems = [f"{name}: bash says of its blocks: {said}"] if said else []
    commands = [Command(name, words, False) for words in found]
    for code in inline_of(path):
        # Variables of the page, or of nothing: PX of an example's settings.
        words, said = trace("set +u\n" + re.sub(r"\s\.\.\.$|\|", "", code))
        if said:
            problems.append(f"{name}: bash says of `{code}`: {said}")
        commands += [Command(name, one, True) for one in words]
    return commands, problems
