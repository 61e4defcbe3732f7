# SPDX-License-Identifier: MIT
"""One HTML page about one or more runs, with its plots and tables as files beside it.

`python -m crossnav.report RUN... --out report.html`; needs `pip install "crossnav[report]"`. The
figures are those of `crossnav report`: they are computed once, in C++.
"""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Union

from crossnav._errors import Error

PathLike = Union[str, "os.PathLike[str]"]


def write_report(runs: Sequence[PathLike], out: PathLike, partial: bool = False) -> list[Path]:
    """Writes the page `out` and the folder `<out without .html>_files`; returns all files.

    `runs` are folders that `crossnav eval` wrote, or result files. `partial` takes runs that are
    not finished.
    """
    page = Path(out)
    if page.suffix != ".html":
        raise Error("must end in .html", f"--out {page}")
    try:
        from crossnav.report import data, page as pages, plots
    except ImportError as error:
        raise Error(f'needs {error.name}: pip install "crossnav[report]"', "crossnav.report",
                    "not_found") from None
    report = data.read(runs, partial)
    folder = page.with_name(page.stem + "_files")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        page.touch()
    except OSError as error:
        raise Error(f"cannot be written: {error.strerror}", f"--out {page}", "io") from None
    drawn = plots.draw_all(report)
    written = [page]
    for plot in drawn:
        for suffix, content in (("png", plot.png), ("pdf", plot.pdf)):
            written.append(folder / f"{plot.name}.{suffix}")
            written[-1].write_bytes(content)
    written += data.export_replays(report, runs, folder / "replays")
    for name, table in report.tables().items():
        written += [folder / f"{name}.csv", folder / f"{name}.json"]
        written[-2].write_text(table.to_csv(index=False), encoding="utf-8")
        written[-1].write_text(table.to_json(orient="records", indent=1) + "\n", encoding="utf-8")
    page.write_text(pages.page(report, drawn), encoding="utf-8")
    return written
