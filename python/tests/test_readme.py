# SPDX-License-Identifier: MIT
"""The command that makes the moving picture of the README; its Python lines are in test_documents.py."""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(os.environ.get("CROSSNAV_ROOT", pathlib.Path(__file__).parents[2]))


def test_moving_picture_is_made(tmp_path):
    out = tmp_path / "episode.webp"
    done = subprocess.run([sys.executable, ROOT / "scripts/episode_picture.py", out], text=True,
                          capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "found tv, bed" in done.stdout
    assert out.read_bytes()[8:12] == b"WEBP"
