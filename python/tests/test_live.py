# SPDX-License-Identifier: MIT
"""crossnav.live against `crossnav serve`, as a robot would use it."""

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import crossnav
from crossnav import live

ROOT = Path(os.environ.get("CROSSNAV_ROOT", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("CROSSNAV_PROGRAM", ROOT / "build/release/apps/crossnav/crossnav"))
pytestmark = pytest.mark.skipif(not PROGRAM.is_file(), reason="the program is not built")

SMALL_SETS = [f"{section}.{key}={value}" for section, keys in SMALL.items()
              for key, value in keys.items()]
HEIGHT_M = 0.88


class Server:
    """`crossnav serve` in a folder of its own."""

    def __init__(self, folder: Path, *arguments: str, is_elsewhere: bool = False) -> None:
        self.socket = str(folder / "s.sock")
        where = [] if is_elsewhere else ["--socket", self.socket]
        sets = [word for setting in SMALL_SETS for word in ("--set", setting)]
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "--json", *where, *arguments, *sets],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stderr is not None
        self.first_line = self.process.stderr.readline()

    def client(self, camera: crossnav.CameraIntrinsics, **options: Any) -> live.Client:
        return live.Client(camera, HEIGHT_M, self.socket, **options)

    def end(self, how: signal.Signals = signal.SIGTERM) -> dict[str, Any]:
        """Its output at a clean end."""
        self.process.send_signal(how)
        out, err = self.process.communicate(timeout=60)
        assert self.process.returncode == 0, err
        document: dict[str, Any] = json.loads(out)
        return document


Start = Callable[..., Server]


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Start]:
    servers: list[Server] = []

    def start(*arguments: str, **options: bool) -> Server:
        servers.append(Server(tmp_path, *arguments, **options))
        return servers[-1]

    yield start
    for server in servers:
        server.process.kill()
        server.process.communicate()


class BlindDetector(crossnav.Detector):
    def detect(self, observation: crossnav.Observation, goal: str) -> list[crossnav.Detection]:
        return []


class BlindSegmenter(crossnav.Segmenter):
    def segment(self, observation: crossnav.Observation, box: Any) -> Any:
        raise AssertionError("there is no box")


class BlindStairs(crossnav.StairSegmenter):
    def segment_stairs(self, observation: crossnav.Observation) -> Any:
        return np.zeros(observation.depth_m.shape, np.float32)


class BlindEncoder(crossnav.DenseEncoder):
    def dim(self) -> int:
        return 2

    def name(self) -> str:
        return "none"

    def encode_image(self, observation: crossnav.Observation) -> Any:
        return np.array([[[0, 1]]], np.float32)

    def encode_text(self, text: str) -> Any:
        return np.array([1, 0], np.float32)


def make_blind_agent(scene: crossnav.Scene) -> crossnav.Agent:
    """Blind, as `--perception none`."""
    perception = crossnav.Perception(BlindDetector(), BlindSegmenter(), BlindStairs(),
                                     BlindEncoder())
    return crossnav.Agent(perception, scene.config)


@pytest.fixture
def blind_agent(scene: crossnav.Scene) -> crossnav.Agent:
    return make_blind_agent(scene)


def camera_of(simulator: crossnav.Simulator) -> crossnav.CameraIntrinsics:
    return simulator.observe().camera


def test_actions_and_map_are_those_of_an_agent_without_a_server(
        serve: Start, simulator: crossnav.Simulator, blind_agent: crossnav.Agent,
        tmp_path: Path) -> None:
    server = serve("--perception", "none", "--save-map", str(tmp_path / "a.map"))
    blind_agent.set_goal("bed")
    with server.client(camera_of(simulator)) as client:
        assert client.welcome.perception == "none"
        assert client.set_goal("bed").phase == live.Phase.SEARCHING
        for number in range(1, 41):
            obs = simulator.observe()
            obs.time_ns = number * 10**9
            expected = blind_agent.step(obs)
            answer = client.step(obs)
            assert (answer.sequence, answer.time_ns) == (number, number * 10**9)
            assert answer.action == expected.action
            assert answer.reason == expected.trace["reason"]
            simulator.step(expected.action)
    counts = server.end()["counts"]
    assert counts["answered"] == counts["observations"] == 40
    saved = crossnav.load_map(tmp_path / "a.map")[0]
    for ours, theirs in zip(saved.voxels(), blind_agent.map.voxels(), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_mounting_and_colour_camera_reach_the_servers_agent(
        serve: Start, scene: crossnav.Scene, simulator: crossnav.Simulator,
        blind_agent: crossnav.Agent, tmp_path: Path) -> None:
    server = serve("--perception", "none", "--save-map", str(tmp_path / "a.map"))
    blind_agent.set_goal("bed")
    view = simulator.observe()
    obs = crossnav.Observation(
        view.depth_m, view.camera, view.T_world_camera, np.ones((30, 40, 3), np.uint8),
        rgb_camera=crossnav.CameraIntrinsics.from_hfov(40, 30, 60),
        T_base_camera=crossnav.AgentPose((0.2, 0, 0), 0.3).camera_pose(0.6))
    with server.client(view.camera) as client:
        client.set_goal("bed")
        expected = blind_agent.step(obs)
        answer = client.step(obs)
        assert (answer.action, answer.reason) == (expected.action, expected.trace["reason"])
        bad = crossnav.Observation(view.depth_m, view.camera, view.T_world_camera, view.rgb,
                                   T_base_camera=np.eye(4))
        with pytest.raises(live.Refused, match="T_base_camera") as malformed:
            client.step(bad)
        assert malformed.value.fault == "malformed"
    server.end()
    saved = crossnav.load_map(tmp_path / "a.map")[0]
    for ours, theirs in zip(saved.voxels(), blind_agent.map.voxels(), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    plain = make_blind_agent(scene)
    plain.set_goal("bed")
    plain.step(view)
    assert plain.map.stats() != blind_agent.map.stats()  # the body stood elsewhere


def test_from_pixels_actions_are_those_of_crossnav_run(
        serve: Start, scenes_dir: Path, tmp_path: Path) -> None:
    made = tmp_path / "e.json"
    subprocess.run([PROGRAM, "episodes", "generate", "--quiet", "--scenes", scenes_dir, "--count",
                    "1", "--seed", "2", "--out", made], check=True)
    episode = json.loads(made.read_text())["episodes"][0]["episode_id"]
    sets = [word for setting in [*SMALL_SETS, "eval.action_budget=25"]
            for word in ("--set", setting)]
    done = subprocess.run(
        [PROGRAM, "run", "--quiet", "--scenes", scenes_dir, "--episodes", made, "--episode",
         episode, "--perception", "networks", "--out", tmp_path / "run", *sets],
        capture_output=True, text=True, check=False)
    if done.returncode != 0 and "networks" in done.stderr:
        pytest.skip(f"no networks here: {done.stderr}")
    lines = (tmp_path / "run/trace.jsonl").read_text().splitlines()
    steps = [json.loads(line) for line in lines]
    assert len(steps) >= 10

    scene = crossnav.Scene(scenes_dir, config=SMALL)
    simulator = crossnav.Simulator(scene)
    simulator.reset(crossnav.read_episodes(made)[0].start)
    server = serve("--networks", "own")  # `run` never takes a preset by itself
    with server.client(camera_of(simulator)) as client:
        assert "sofa" in client.welcome.goals
        goal = ""
        for step in steps:
            if step["goal"] != goal:
                goal = client.set_goal(step["goal"]).goal
            answer = client.step(simulator.observe())
            assert answer.action is not None
            assert answer.action.name.lower() == step["action"], answer
            simulator.step(answer.action)


def test_server_and_client_look_in_the_same_place(
        serve: Start, simulator: crossnav.Simulator, tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    serve("--perception", "none", is_elsewhere=True)
    with live.Client(camera_of(simulator)) as client:
        assert client.stats()["connections"] == 1
    over_tcp = serve("--perception", "none", "--port", "0", is_elsewhere=True)
    port = int(over_tcp.first_line.split(",")[0].rpartition(":")[2])
    with live.Client(camera_of(simulator), address=port) as client:
        assert client.stats()["connections"] == 1


def test_faults_are_survived_and_counted(serve: Start, simulator: crossnav.Simulator) -> None:
    server = serve("--perception", "none")
    obs = simulator.observe()
    with server.client(obs.camera) as client:
        client.set_goal("bed")
        answers = [client.step(obs) for _ in range(3)]
        client.sequence = 0
        with pytest.raises(live.Refused, match="older") as late:
            client.step(obs)
        assert late.value.fault == "late"
        client.sequence = 2
        assert client.step(obs).reason == answers[2].reason  # the third again
        client.sequence = 5
        assert client.step(obs, has_collided=True).sequence == 6
        other = crossnav.Observation(np.ones((9, 9), np.float32),
                                     crossnav.CameraIntrinsics.from_hfov(9, 9, 90), np.eye(4))
        with pytest.raises(live.Refused, match="rgb") as malformed:
            client.step(other)
        assert malformed.value.fault == "malformed"
        assert client.step(obs).sequence == 7
        with pytest.raises(live.Refused, match="another client") as busy:
            server.client(obs.camera)
        assert busy.value.fault == "busy"
        stats = client.stats()
        expected = {"answered": 5, "late": 1, "repeated": 1, "dropped": 2, "malformed": 1,
                    "collisions": 1, "refused": 1}
        assert {name: stats[name] for name in expected} == expected
    assert server.end(signal.SIGINT)["counts"]["answered"] == 5


def test_a_new_client_goes_on_and_may_start_anew(
        serve: Start, simulator: crossnav.Simulator) -> None:
    server = serve("--perception", "none")
    obs = simulator.observe()
    with server.client(obs.camera) as client:
        client.set_goal("bed")
        client.step(obs)
    with server.client(obs.camera) as client:
        assert client.welcome.state.goal == "bed"
        assert client.step(obs).sequence == 2
        with pytest.raises(live.Refused, match="--memory"):
            client.reset(restore=True)
        assert client.reset().phase == live.Phase.NO_GOAL
        answer = client.step(obs)
        assert (answer.sequence, answer.action, answer.command) == (1, None, live.Command())


def test_a_saved_memory_is_where_a_server_starts(
        serve: Start, simulator: crossnav.Simulator, tmp_path: Path) -> None:
    saved = str(tmp_path / "a.map")
    server = serve("--perception", "none", "--save-map", saved)
    obs = simulator.observe()
    with server.client(obs.camera) as client:
        client.set_goal("bed")
        client.step(obs)
    assert server.end()["map"] == saved
    known = crossnav.load_map(saved)[0].stats()["known"]
    assert known > 1000
    again = str(tmp_path / "b.map")
    server = serve("--perception", "none", "--memory", saved, "--save-map", again)
    with server.client(obs.camera) as client:
        assert client.welcome.state.steps == 0
    server.end()
    assert crossnav.load_map(again)[0].stats()["known"] == known


def test_the_watchdog_is_heard(serve: Start, simulator: crossnav.Simulator) -> None:
    server = serve("--perception", "none", "--set", "serve.period_s=0.1", "--set",
                   "serve.watchdog_s=0.3")
    obs = simulator.observe()
    heard: list[float] = []
    with server.client(obs.camera, on_stop=heard.append) as client:
        client.set_goal("bed")
        answer = client.step(obs)
        assert answer.command.duration_s == 0.1
        started = time.monotonic()
        assert client.poll(20)
        assert time.monotonic() - started < 10
        assert len(heard) == 1 and heard[0] >= 0.3
        assert client.step(obs).sequence == 2  # and on it goes
    assert server.end()["counts"]["stops"] >= 1


def test_errors_say_what_helps(serve: Start, simulator: crossnav.Simulator,
                               tmp_path: Path) -> None:
    camera = camera_of(simulator)
    with pytest.raises(crossnav.Error, match="is `crossnav serve` running"):
        live.Client(camera, address=str(tmp_path / "nobody.sock"))
    server = serve("--perception", "none")
    client = server.client(camera)
    server.process.kill()
    server.process.wait()
    with pytest.raises(crossnav.Error, match="connect again"):
        client.stats()


def test_the_program_refuses_what_cannot_work(tmp_path: Path) -> None:
    def refusal(*arguments: str) -> tuple[int, str]:
        done = subprocess.run([PROGRAM, "serve", "--perception", "none", *arguments], check=False,
                              capture_output=True, text=True, cwd=tmp_path, timeout=60)
        assert done.stdout == ""
        return done.returncode, done.stderr

    status, text = refusal("--set", "serve.watchdog_s=0.5")
    assert status == 1 and "serve.watchdog_s" in text and "serve.period_s" in text
    status, text = refusal("--memory", "none.map")
    assert status == 1 and "none.map" in text
    status, text = refusal("--socket", "no/folder/s.sock")
    assert status == 1 and "no/folder/s.sock" in text
    assert refusal("--socket", "a", "--port", "1")[0] == 2
