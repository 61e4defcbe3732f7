# SPDX-License-Identifier: MIT
"""The command line of crossnav.rerun. Exit 0 done, 1 bad data, 2 usage."""

import argparse
import sys

from crossnav._errors import Error
from crossnav.rerun import MAP_EVERY, write_graph, write_recording


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m crossnav.rerun",
        description="A replay, or a map's graph, as a recording for the Rerun viewer.",
        epilog="Example: python -m crossnav.rerun out/demo/2/replay.mcap --to r.rrd; rerun r.rrd")
    parser.add_argument("replay", metavar="REPLAY.mcap | GRAPH.json")
    parser.add_argument("--to", required=True, metavar="FILE.rrd", help="recording to write")
    parser.add_argument("--map-every", type=int, default=MAP_EVERY, metavar="STEPS",
                        help="steps between drawings of the whole map (default: %(default)s)")
    arguments = parser.parse_args()
    try:
        if arguments.replay.endswith(".json"):
            objects = write_graph(arguments.replay, arguments.to)
            print(f"{arguments.to}: {objects} objects; open it with: rerun {arguments.to}")
            return 0
        steps = write_recording(arguments.replay, arguments.to, arguments.map_every)
    except Error as error:
        print(f"crossnav.rerun: {error}", file=sys.stderr)
        return 1
    print(f"{arguments.to}: {steps} steps; open it with: rerun {arguments.to}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
