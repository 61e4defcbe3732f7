# SPDX-License-Identifier: MIT
"""The HTML report, of records that the runner made here."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

import crossnav

pytest.importorskip("pandas")
image = pytest.importorskip("matplotlib.image")

from crossnav.report import write_report  # noqa: E402

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
PLOTS = ["conditional_by_goal", "global_by_goal", "floor_change", "budget", "distance",
         "category_outcomes", "scene_outcomes", "causes", "timing"]
PROGRAM = os.environ.get("CROSSNAV_PROGRAM", "")
CHECKS = """
<script>
const visible = () => [...document.querySelectorAll("#episode-table tbody tr")]
  .filter(row => !row.hidden);
const actions = [...document.querySelectorAll("#episode-table th")]
  .findIndex(head => head.textContent.trim() === "actions");
document.querySelectorAll("#episode-table th button")[actions].click();
const sorted = visible().map(row => Number(row.cells[actions].textContent));
const field = document.querySelector("#filter");
field.value = "out_of_time";
field.dispatchEvent(new Event("input"));
document.title = "CHECKS" + JSON.stringify({
  sorted, filtered: visible().length, shown: document.querySelector("#shown").textContent,
  pictures: [...document.images].every(picture => picture.naturalWidth > 100),
  width: [document.documentElement.scrollWidth, window.innerWidth]});
</script></body>"""


@pytest.fixture(scope="module")
def runs(scene: crossnav.Scene, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Two runs of three episodes, the second with a budget that is too small for most."""
    folders = []
    for name, budget in (("full", 400), ("hasty", 40)):
        config = crossnav.Config({**scene.config.to_dict(), "eval": {"action_budget": budget}})
        folder = tmp_path_factory.mktemp("runs") / name
        folder.mkdir()
        lines = ""
        for goals, floor, seed in ((["sofa", "chair"], 0, 1), (["bed", "toilet"], 1, 2),
                                   (["plant", "bed"], 0, 3)):
            episode = crossnav.make_episode(scene, goals, start_floor=floor, seed=seed)
            record, _ = crossnav.run_episode(scene, episode, config)
            lines += json.dumps(record) + "\n"
        (folder / "results.jsonl").write_text(lines, encoding="utf-8")
        folders.append(folder)
    return folders


@pytest.fixture(scope="module")
def page(runs: list[Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "report.html"
    written = write_report(runs, out)
    assert all(path.is_file() for path in written)
    return out


def test_the_page_holds_everything_and_needs_no_network(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for plot in PLOTS:
        assert f'<section id="{plot}">' in text
    assert len(re.findall(r'<img alt="[^"]+" src="data:image/svg\+xml;base64,', text)) == len(PLOTS)
    for link in re.findall(r'(?:src|href)="([^"]*)"', text):
        assert link.startswith(("data:", "#")), link
    assert "http:" not in re.sub(r"base64,[^\"]*", "", text)
    assert text.count("<tr>") > 6


def test_every_plot_and_table_is_a_file_too(page: Path) -> None:
    folder = page.with_name("report_files")
    for plot in PLOTS:
        assert (folder / f"{plot}.png").read_bytes().startswith(b"\x89PNG")
        assert (folder / f"{plot}.pdf").read_bytes().startswith(b"%PDF")
    for table in ("figures", "episodes", "stages", "timing", "causes", "differences", "flips"):
        with open(folder / f"{table}.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == len(json.loads((folder / f"{table}.json").read_text(encoding="utf-8")))
        assert rows or table in ("causes", "flips")


def test_the_figures_are_those_of_the_program(page: Path, runs: list[Path]) -> None:
    figures = json.loads((page.with_name("report_files") / "figures.json").read_text("utf-8"))
    for run in runs:
        wanted = crossnav.metrics(run / "results.jsonl")["metrics"]
        found = {f["metric"]: f for f in figures if f["run"] == run.name and f["group"] == "all"}
        for metric in ("SR", "SPL", "PR", "SR_cond_1", "SPL_global_2"):
            assert found[metric]["value"] == pytest.approx(wanted[metric]["value"])
            assert found[metric]["low"] == pytest.approx(wanted[metric]["low"])


@pytest.mark.skipif(not PROGRAM, reason="the program is not built")
def test_the_program_writes_the_page_too(runs: list[Path], tmp_path: Path) -> None:
    done = subprocess.run([PROGRAM, "report", str(runs[0]), "--out", str(tmp_path), "--page"],
                          env={**os.environ, "CROSSNAV_PYTHON": sys.executable},
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == str(tmp_path / "report.html")
    assert len(list((tmp_path / "report_files").glob("*.png"))) == len(PLOTS)


def test_one_run_is_enough(runs: list[Path], tmp_path: Path) -> None:
    assert len(write_report(runs[:1], tmp_path / "one.html")) == 1 + 2 * len(PLOTS) + 2 * 7


def run_module(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "crossnav.report", *arguments],
                          capture_output=True, text=True, check=False)


@pytest.mark.parametrize(("content", "message"), [
    (None, "holds no results"), ("", "holds no episode"), ("{]\n{}\n", "results.jsonl"),
    ('{"kind": "episode", "goals": ["bed"]}\n{}\n', "results.jsonl")])
def test_bad_runs_end_in_one_line(content: str | None, message: str, tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    if content is not None:
        (run / "results.jsonl").write_text(content, encoding="utf-8")
    done = run_module(str(run), "--out", str(tmp_path / "r.html"))
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1 and message in done.stderr and str(run) in done.stderr
    assert not (tmp_path / "r.html").exists() and not (tmp_path / "r_files").exists()


def test_the_page_must_be_one(runs: list[Path]) -> None:
    for out, message in (("report.txt", ".html"), ("/proc/none/r.html", "cannot be written")):
        done = run_module(str(runs[0]), "--out", out)
        assert done.returncode == 1 and message in done.stderr and "--out" in done.stderr
    assert run_module(str(runs[0])).returncode == 2


def chromium(page: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A browser of its own, without a network."""
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(
            [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
             "--host-resolver-rules=MAP * ~NOTFOUND", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             f"--user-data-dir={profile}", "--virtual-time-budget=5000", *arguments,
             page.as_uri()], capture_output=True, text=True, check=False, timeout=300)


def screenshot(page: Path, name: str, width: int, height: int, tmp_path: Path) -> np.ndarray:
    """Pixels of the page; kept in CROSSNAV_SCREENSHOTS, where that is a folder."""
    picture = Path(os.environ.get("CROSSNAV_SCREENSHOTS", tmp_path)) / f"{name}_{width}.png"
    chromium(page, f"--window-size={width},{height}", f"--screenshot={picture}")
    pixels = image.imread(picture)
    assert pixels.shape[1] == width
    return pixels[:, :, :3].mean(axis=2)


@pytest.mark.skipif(not CHROMIUM, reason="no Chromium here")
@pytest.mark.parametrize("width", [1400, 800])
def test_it_opens_in_a_browser_without_a_network(page: Path, width: int, tmp_path: Path) -> None:
    grey = screenshot(page, "report", width, 6000, tmp_path)
    assert 0.02 < (grey < 0.9).mean() < 0.6  # neither empty nor black

    checked = tmp_path / "checked.html"
    checked.write_text(page.read_text(encoding="utf-8").replace("</body>", CHECKS),
                       encoding="utf-8")
    text = chromium(checked, f"--window-size={width},2000", "--dump-dom").stdout
    found = re.search(r"<title>CHECKS(.*?)</title>", text)
    assert found, text[:300]
    checks = json.loads(found.group(1))
    assert len(checks["sorted"]) == 6 and checks["sorted"] == sorted(checks["sorted"])
    assert 0 < checks["filtered"] < 6 and checks["shown"] == str(checks["filtered"])
    assert checks["pictures"]
    assert checks["width"][0] <= checks["width"][1], "the page is wider than its window"


@pytest.fixture(scope="module")
def evaluated(scenes_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page about two runs of the program, one of which kept the replays of its failures."""
    program = os.environ.get("CROSSNAV_PROGRAM", "")
    if not program:
        pytest.skip("scripts/test_python.sh names the program, where it is built")
    folder = tmp_path_factory.mktemp("evaluated")
    small = ["--set", "sensor.width_px=160", "--set", "sensor.height_px=160",
             "--set", "ground_truth.min_visible_px=20", "--set", "ground_truth.feature_dim=64",
             "--set", "eval.action_budget=600"]

    def run(*arguments: str) -> None:
        subprocess.run([program, *arguments, "--quiet"], cwd=folder, check=True,
                       capture_output=True, text=True)

    run("episodes", "generate", "--scenes", str(scenes_dir), "--count", "3", "--seed", "2",
        "--cross-floor", "0.67", "--out", "e.json")
    for variant in ("full", "planar"):  # planar cannot climb
        run("eval", "--scenes", str(scenes_dir), "--episodes", "e.json", "--out", f"runs/{variant}",
            "--variant", variant, "--keep-replays", "failures", *small)
    write_report([folder / "runs/full", folder / "runs/planar"], folder / "report.html")
    return folder / "report.html"


def test_flips_and_episodes_link_to_the_replays_that_a_run_kept(evaluated: Path) -> None:
    kept = sorted(path.stem for path in (evaluated.parent / "runs").glob("*/replays/*.mcap"))
    text = evaluated.read_text(encoding="utf-8")
    links = re.findall(r'<a href="(report_files/replays/[^"]+)">replay</a>', text)
    assert kept and sorted(Path(link).stem for link in set(links)) == kept  # a page a run
    for link in links:
        assert (evaluated.parent / link).is_file()
    flips = json.loads((evaluated.parent / "report_files/flips.json").read_text(encoding="utf-8"))
    assert flips and all(flip["replay"] in links and flip["cause"] for flip in flips)
    assert "policy.planar: false and true" in text


@pytest.mark.skipif(not CHROMIUM, reason="no Chromium here")
def test_a_click_on_a_link_opens_the_replay_without_a_network(
        evaluated: Path, tmp_path: Path) -> None:
    clicked = evaluated.with_name("clicked.html")
    clicked.write_text(evaluated.read_text(encoding="utf-8").replace(
        "</body>", '<script>document.querySelector("#episode-table td a").click();</script></body>'),
        encoding="utf-8")
    opened = chromium(clicked, "--dump-dom").stdout
    assert "crossnav report" not in opened and "<canvas" in opened, opened[:300]
    link = re.search(r'href="(report_files/replays/[^"]+)"', evaluated.read_text("utf-8"))
    assert link
    for width in (1400, 800):
        screenshot(evaluated, "compared", width, 9000, tmp_path)
        grey = screenshot(evaluated.parent / link.group(1), "replay", width, 1200, tmp_path)
        assert 0.02 < (grey < 0.9).mean()
