# SPDX-License-Identifier: MIT
"""The console command `crossnav`, apart from the package so that it does not load the extension."""

import os
import sys
from importlib import util
from pathlib import Path


def program() -> None:
    """The program in the wheel takes this process over."""
    spec = util.find_spec("crossnav")  # imports nothing
    folder = Path(spec.origin).parent if spec and spec.origin else Path()
    executable = folder / "bin" / "crossnav"
    if not executable.is_file():
        sys.exit(f"crossnav: {executable} is missing; this wheel was built without the program "
                 "(build the target `crossnav` before `make wheel`)")
    os.execv(executable, ["crossnav", *sys.argv[1:]])
