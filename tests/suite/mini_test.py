#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""crossnav-mfmon-1-mini from nothing to a report, 320 x 320 px: how each stage of each episode ends
must be what tests/suite/mini_golden.json says.

    CROSSNAV_LONG_TESTS=1 tests/suite/mini_test.py PROGRAM
    tests/suite/mini_test.py PROGRAM --update      writes the golden file (make golden)
"""
import json
import os
import pathlib
import resource
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from program import records, run, skip_unless_long  # noqa: E402

GOLDEN = HERE / "mini_golden.json"
SUITE = "crossnav-mfmon-1-mini"
SMALLER = ["--set", "sensor.width_px=320", "--set", "sensor.height_px=320"]


def outcomes_of(record):
    """"chair success, bed out_of_time" """
    if "failed" in record:
        return "failed: " + record["failed"]["reason"]
    return ", ".join(f"{stage['goal']} {stage['outcome']}" for stage in record["stages"])


def play(program):
    """The suite's hash and the ending of each episode."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = run(program, "suite", "make", SUITE, folder=folder)
        run(program, "suite", "report", SUITE, "--jobs", os.cpu_count(), *SMALLER, folder=folder)
        place = folder / "out/suites" / SUITE
        assert (place / "report/report.md").stat().st_size > 1000
        _, episodes = records(place / "runs/full/results.jsonl")
        return {"hash": made["hash"],
                "episodes": {r["episode_id"]: outcomes_of(r) for r in episodes}}


def differences(golden, found):
    lines = []
    if golden["hash"] != found["hash"]:
        lines.append(f"hash is {found['hash']}, not {golden['hash']}: another generator")
    old, new = golden["episodes"], found["episodes"]
    for episode in sorted(old.keys() | new.keys()):
        if old.get(episode) != new.get(episode):
            lines.append(f"{episode}: {new.get(episode)}, was {old.get(episode)}")
    return lines


def main():
    program, is_update = os.path.abspath(sys.argv[1]), "--update" in sys.argv[2:]
    if not is_update:
        skip_unless_long()
    found = play(program)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    if is_update:
        GOLDEN.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        print(f"written: {GOLDEN}")
    lines = differences(json.loads(GOLDEN.read_text(encoding="utf-8")), found)
    print("\n".join(lines))
    whole = sum("success" in text and text.count(",") == 2 and text.count("success") == 3
                for text in found["episodes"].values())
    print(f"{len(found['episodes'])} episodes, {whole} completed, {len(lines)} differences from "
          f"the golden file; {spent.ru_utime + spent.ru_stime:.0f} CPU s")
    if lines:
        sys.exit("another navigator? `make golden` writes what it does now")


if __name__ == "__main__":
    main()
