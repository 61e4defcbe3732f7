# SPDX-License-Identifier: MIT
"""Replays and live steps as Rerun recordings, read back with Rerun's own reader."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossnav

rr = pytest.importorskip("rerun")
chunk = pytest.importorskip("rerun.chunk")
pytest.importorskip("mcap")

from crossnav.rerun import draw, log, log_replay, write_recording  # noqa: E402
from crossnav.rerun.replay import INFLATED, Camera, decode_runs

Rows = dict[str, list[tuple[int | None, dict[str, Any]]]]


def run_module(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "crossnav.rerun", *arguments],
                          capture_output=True, text=True, check=False)


def read_rows(path: Path) -> Rows:
    """Entity -> its (step, components) in order of step; step None is static."""
    rows: Rows = {}
    for part in chunk.RrdReader(path).stream().to_chunks():
        for row in part.to_record_batch().to_pylist():
            rows.setdefault(part.entity_path, []).append((row.get("step"), row))
    for entity in rows.values():
        entity.sort(key=lambda row: -1 if row[0] is None else row[0])
    return rows


@pytest.fixture(scope="module")
def traced(replay: Path) -> list[dict[str, Any]]:
    """The program's own record of every step, beside the replay."""
    lines = replay.with_name("trace.jsonl").read_text("utf-8").splitlines()
    return [json.loads(line) for line in lines if '"step":' in line[:10]]


@pytest.fixture(scope="module")
def recording(replay: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("rerun") / "r.rrd"
    done = run_module(str(replay), "--to", str(out), "--map-every", "5")
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"{out}: 30 steps; open it with: rerun {out}\n"
    assert [p.name for p in out.parent.iterdir()] == ["r.rrd"]
    return out


@pytest.fixture(scope="module")
def rows(recording: Path) -> Rows:
    return read_rows(recording)


def test_the_program_writes_the_same(replay: Path, rows: Rows, tmp_path: Path) -> None:
    out = tmp_path / "r.rrd"
    done = subprocess.run(
        [os.environ["CROSSNAV_PROGRAM"], "replay", "export", str(replay), "--to", str(out)],
        env={**os.environ, "CROSSNAV_PYTHON": sys.executable}, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, f"{out}\n"), done.stderr
    assert set(read_rows(out)) == set(rows)


def test_rerun_finds_the_file_sound(recording: Path) -> None:
    done = subprocess.run([sys.executable, "-m", "rerun", "rrd", "verify", str(recording)],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "1 file verified without error" in done.stdout + done.stderr
    stored = chunk.RrdReader(recording)
    assert len(stored.recordings()) == 1 and len(stored.blueprints()) == 1


def test_every_step_is_there_on_both_timelines(rows: Rows, traced: list[dict[str, Any]]) -> None:
    poses = [row for row in rows["/world/agent"]]
    assert [step for step, _ in poses] == [record["step"] for record in traced]
    for (step, row), record in zip(poses, traced, strict=True):
        assert step is not None
        assert row["sim_time"].total_seconds() == pytest.approx(0.1 * step)
        [found] = row["Transform3D:translation"]
        assert found == pytest.approx(record["agent"]["p_world"], abs=1e-5)
    for entity in ("image", "depth"):
        assert len(rows[f"/world/camera/{entity}"]) >= len(traced)
    assert rows["/world/camera/image/boxes"] and rows["/world/camera/image/masks"]


def test_path_candidates_and_scores_are_the_records(rows: Rows,
                                                    traced: list[dict[str, Any]]) -> None:
    scores = {step: row["Scalars:scalars"][0] for step, row in rows["/scores/target"]}
    candidates = dict(rows["/world/plan/candidates"])
    paths = dict(rows["/world/plan/path"])
    for record in traced:
        wanted = record["candidates"]
        assert len(candidates[record["step"]]["Points3D:positions"] or []) == len(wanted)
        for c in wanted:
            if c["is_target"] and c["score"] is not None:
                assert scores[record["step"]] == pytest.approx(c["score"])
        found = paths[record["step"]]["LineStrips3D:strips"]
        if len(record["path_world"]) > 1:
            assert np.array(found[0]) == pytest.approx(np.array(record["path_world"]), abs=1e-5)
        else:
            assert not found
    assert scores


def test_the_trail_shows_the_whole_way_at_every_step() -> None:
    """A viewer's picture at a step: the last drawing of each piece."""
    feet = [[0.25 * step, 0.0, 1.0] for step in range(2 * draw.TRAIL_PIECE + 8)]
    stream = rr.RecordingStream("test")
    memory = stream.memory_recording()
    for step in range(len(feet)):
        stream.set_time("step", sequence=step)
        draw.trail(stream, feet[:step + 1])
    with tempfile.NamedTemporaryFile(suffix=".rrd") as file:
        file.write(memory.drain_as_bytes())
        file.flush()
        drawn = read_rows(Path(file.name))
    for last in (1, draw.TRAIL_PIECE, draw.TRAIL_PIECE + 1, len(feet) - 1):
        way: list[list[float]] = []
        for entity in sorted(drawn):
            shown = [row for step, row in drawn[entity] if step is not None and step <= last]
            if entity.startswith("/world/trail") and shown:
                [strip] = shown[-1]["LineStrips3D:strips"]
                assert not way or way[-1] == strip[0]
                way += strip[1:] if way else strip
        assert [x for x, _, _ in way] == [x for x, _, _ in feet[:last + 1]]


def test_the_map_at_the_end_is_the_cloud_of_the_replay(rows: Rows, replay: Path) -> None:
    """Against /map/voxels, which the writer encodes apart from the changes: surface voxels."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory
    with open(replay, "rb") as file:
        cloud = [m.decoded_message for m in make_reader(
            file, decoder_factories=[DecoderFactory()]).iter_decoded_messages("/map/voxels")][-1]
    raw = np.frombuffer(cloud.data, np.uint8).reshape(-1, cloud.point_stride)
    offsets = {f.name: f.offset for f in cloud.fields}
    points = raw[:, :12].copy().view("<f4")
    states = raw[:, offsets["state"]]
    assert len(points) > 500
    assert set(states.tolist()) <= {1, 5, 6, 7} and (states == 1).any()
    for state, name in ((1, "occupied"), (5, "stair"), (6, "stair_expanded"), (7, "fake_stair")):
        drawn = rows.get(f"/world/map/{name}", [(None, {"Points3D:positions": []})])[-1][1]
        found = {tuple(np.round(p, 3)) for p in drawn["Points3D:positions"] or []}
        assert found == {tuple(np.round(p, 3)) for p in points[states == state].tolist()}


def test_the_example_of_the_format_page() -> None:
    keys, values = decode_runs(bytes.fromhex("02010402010002030 10a".replace(" ", "")), 3)
    assert keys.tolist() == [[1, -1, 2], [1, -1, 3], [1, 0, 0]]
    assert values.tolist() == [1, 1, 2 + INFLATED]
    for data, count in ((b"\x02", 1), (b"\x80", 1), (bytes.fromhex("0201040201"), 3),
                        (b"\xff" * 12, 1)):
        with pytest.raises(ValueError, match="voxel|bits"):
            decode_runs(data, count)


def test_a_smaller_picture_sees_the_same_view() -> None:
    camera = Camera(320, 240, np.array([[160.0, 0, 159.5], [0, 160, 119.5], [0, 0, 1]]))
    half = camera.resized(160, 120)
    assert np.allclose(half.K, [[80, 0, 79.5], [0, 80, 59.5], [0, 0, 1]])


def test_steps_are_logged_live(agent: crossnav.Agent, simulator: crossnav.Simulator,
                               tmp_path: Path) -> None:
    with pytest.raises(crossnav.Error, match="no recording"):
        log_replay(tmp_path / "none.mcap")
    stream = rr.RecordingStream("crossnav-test")
    stream.save(tmp_path / "live.rrd")
    agent.set_goal("sofa")
    for _ in range(4):
        observation = simulator.observe()
        result = agent.step(observation)
        log(result, observation, agent, recording=stream, map_every=2)
        simulator.step(result.action)
    stream.flush()
    stream.disconnect()
    rows = read_rows(tmp_path / "live.rrd")
    assert [step for step, _ in rows["/world/agent"]] == [0, 1, 2, 3]
    assert [step for step, _ in rows["/world/map/occupied"]] == [0, 2]
    assert len(rows["/world/changes"]) == 4 and rows["/world/camera/depth"]


def test_colour_of_another_camera_is_logged_where_the_boxes_lie(
        agent: crossnav.Agent, simulator: crossnav.Simulator,
        monkeypatch: pytest.MonkeyPatch) -> None:
    from crossnav.rerun import draw
    shapes = []
    monkeypatch.setattr(draw, "image", lambda stream, rgb, camera: shapes.append(rgb.shape))
    view = simulator.observe()
    observation = crossnav.Observation(
        view.depth_m, view.camera, view.T_world_camera, np.ones((30, 40, 3), np.uint8),
        rgb_camera=crossnav.CameraIntrinsics.from_hfov(40, 30, 60))
    agent.set_goal("sofa")
    log(agent.step(observation), observation, recording=rr.RecordingStream("crossnav-test"))
    assert shapes == [(*view.depth_m.shape, 3)]


@pytest.mark.parametrize("kind", ["missing", "torn", "flipped", "other", "empty"])
def test_bad_replays_end_in_one_line(kind: str, replay: Path, tmp_path: Path) -> None:
    bad, data = tmp_path / "bad.mcap", replay.read_bytes()
    middle = len(data) // 2
    contents = {"torn": data[:middle], "other": b"PK\3\4 not a replay", "empty": b"",
                "flipped": data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1:]}
    if kind in contents:
        bad.write_bytes(contents[kind])
    done = run_module(str(bad), "--to", str(tmp_path / "r.rrd"))
    assert done.returncode == 1 and done.stderr.count("\n") == 1, done.stderr
    assert done.stderr.startswith(f"crossnav.rerun: {bad}: ")
    assert [p.name for p in tmp_path.iterdir() if p.suffix != ".mcap"] == []


def test_bad_outputs_end_in_one_line(replay: Path, tmp_path: Path) -> None:
    for out, message in (("r.txt", ".rrd"), ("/proc/none/r.rrd", "cannot be written")):
        done = run_module(str(replay), "--to", out)
        assert done.returncode == 1 and message in done.stderr and done.stderr.count("\n") == 1
    assert run_module(str(replay)).returncode == 2


def test_without_rerun_it_says_how_to_get_it(replay: Path, tmp_path: Path,
                                             monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(crossnav.Error, match=r'pip install "crossnav\[rerun\]"'):
        write_recording(replay, tmp_path / "r.rrd")
