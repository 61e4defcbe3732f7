# SPDX-License-Identifier: MIT
"""Content of the README: its Python lines, and the command that makes its moving picture."""
import os
import pathlib
import re
import subprocess
import sys

import crossnav

ROOT = pathlib.Path(os.environ.get("CROSSNAV_ROOT", pathlib.Path(__file__).parents[2]))


def test_python_lines_of_the_readme_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    crossnav.write_embedded_house("houses")
    lines = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.S).group(1)
    names = {}
    exec(lines, names)  # noqa: S102: our own README
    assert isinstance(names["action"], crossnav.Action)


def test_moving_picture_is_made(tmp_path):
    out = tmp_path / "episode.webp"
    done = subprocess.run([sys.executable, ROOT / "scripts/episode_picture.py", out], text=True,
                          capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "found tv, bed" in done.stdout
    assert out.read_bytes()[8:12] == b"WEBP"
