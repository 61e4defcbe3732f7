# SPDX-License-Identifier: MIT
"""The command line of the HTML report. Exit 0 done, 1 bad data, 2 usage."""

import argparse
import sys

from crossnav._errors import Error
from crossnav.report import write_report


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m crossnav.report",
        description="One self-contained HTML page about runs of crossnav eval.",
        epilog="Example: python -m crossnav.report runs/full runs/planar --out report.html")
    parser.add_argument("runs", nargs="+", metavar="RUN", help="run folders or result files")
    parser.add_argument("--out", required=True, metavar="FILE.html",
                        help="page to write; plots and tables go into FILE_files beside it")
    parser.add_argument("--partial", action="store_true", help="accept runs that are not finished")
    arguments = parser.parse_args()
    try:
        written = write_report(arguments.runs, arguments.out, arguments.partial)
    except Error as error:
        print(f"crossnav.report: {error}", file=sys.stderr)
        return 1
    print(f"{written[0]}\n{len(written) - 1} plots, tables and replay pages in "
          f"{written[0].with_name(written[0].stem + '_files')}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
