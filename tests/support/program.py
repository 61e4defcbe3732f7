# SPDX-License-Identifier: MIT
"""Starts the program for Python tests, and reads its output."""
import json
import os
import pathlib
import subprocess
import sys

SMALL = ["--set", "sensor.width_px=160", "--set", "sensor.height_px=160",
         "--set", "ground_truth.min_visible_px=20", "--set", "ground_truth.feature_dim=64"]


def run(program, *arguments, folder, environment=None):
    """Runs crossnav in `folder`; standard output as a document."""
    done = subprocess.run([program, *map(str, arguments), "--json"], cwd=folder, env=environment,
                          check=False, capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}\n{done.stderr}"
    return json.loads(done.stdout)


def records(path):
    """Header and episodes of a result file, without timings, episodes sorted."""
    header, *lines = [json.loads(line) for line in path.read_text().splitlines()]
    for line in lines:
        line.pop("wall_s")
        line.pop("timing_ms")
    return header, sorted(lines, key=lambda line: line["episode_id"])


def children(pid):
    """Processes that `pid` has started and that live."""
    try:
        found = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return []
    return [int(child) for child in found if is_alive(int(child))]


def is_alive(pid):
    """False also for a zombie process."""
    try:
        stat = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return stat[stat.rindex(")") + 2] not in "ZX"


def cpu_s(pid):
    """CPU time of a process so far; 0 where it is gone."""
    try:
        stat = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return 0
    fields = stat[stat.rindex(")") + 2:].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def rss_mb(pid):
    """Memory of a process; 0 where it is gone."""
    try:
        pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def skip_unless_long():
    """Exit status 77: skipped."""
    if not os.environ.get("CROSSNAV_LONG_TESTS"):
        print("skipped: minutes long; `make test-long`, or CROSSNAV_LONG_TESTS=1")
        sys.exit(77)
