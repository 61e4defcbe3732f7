# SPDX-License-Identifier: MIT
"""A client of `crossnav serve` (docs/live.md). Needs the extra ``live``: protobuf.

    with crossnav.live.Client(camera, camera_height_m=0.6) as client:
        client.set_goal("chair")
        answer = client.step(observation)        # answer.action, answer.command
"""

import enum
import functools
import importlib.resources
import os
import select
import socket
import struct
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from google.protobuf import (  # type: ignore[import-untyped]
    descriptor_pb2,
    descriptor_pool,
    message_factory,
)
from google.protobuf.message import DecodeError  # type: ignore[import-untyped]
from numpy.typing import NDArray

from crossnav._core import Action, CameraIntrinsics, Observation
from crossnav._errors import Error

PROTOCOL = 1
_LENGTH = struct.Struct("<I")
_ACTIONS = (None, Action.MOVE_FORWARD, Action.TURN_LEFT, Action.TURN_RIGHT, Action.LOOK_UP,
            Action.LOOK_DOWN, Action.STOP)


class Phase(enum.IntEnum):
    """State of the search for the current goal."""

    NO_GOAL = 0
    SEARCHING = 1
    CLAIMED = 2
    """STOP: the agent says that the goal is here."""
    EXPLORED = 3
    """Nothing is left where it could be."""


class PoseState(enum.IntEnum):
    """Whether the agent knows where it is in its saved map (``serve --pose unknown``)."""

    GIVEN = 0
    LOCALISING = 1
    """Actions are for finding out."""
    KNOWN = 2
    UNKNOWN = 3
    """It could not be found out: the agent goes on with an empty memory."""


@dataclass(frozen=True)
class State:
    """Of the agent, which outlives connections."""

    phase: Phase
    goal: str
    goals: int
    """Set so far."""
    steps: int
    last_sequence: int
    """Number of the last observation that was answered; 0 = none."""
    pose: PoseState = PoseState.GIVEN
    T_map_world: NDArray[np.float64] | None = None
    """(4, 4), with PoseState.KNOWN: from the world of the poses that are sent to the saved map."""


@dataclass(frozen=True)
class Command:
    """Speeds to hold for `duration_s`; then stand still and look. All zero: stand still now."""

    v_mps: float = 0.0
    w_radps: float = 0.0
    """Counter-clockwise seen from above."""
    pitch_radps: float = 0.0
    """Of the camera, up."""
    duration_s: float = 0.0


@dataclass(frozen=True)
class Answer:
    """Answer to one observation."""

    sequence: int
    time_ns: int
    action: Action | None
    """None: stay, as there is no goal or nothing left to explore."""
    command: Command
    state: State
    mode: str
    reason: str
    p_claimed_world: NDArray[np.float64] | None
    """(3,) [m] in Phase.CLAIMED."""


@dataclass(frozen=True)
class Welcome:
    """Description of the server."""

    version: str
    perception: str
    goals: tuple[str, ...]
    """Names that perception is made for; others may be refused."""
    forward_m: float
    turn_rad: float
    pitch_rad: float
    period_s: float
    watchdog_s: float
    max_frame_bytes: int
    state: State
    """State left by an earlier client."""


class Refused(Error):
    """The server answered with an error; the connection stays open unless `fault` is busy or replaced."""

    fault: str
    """malformed, late, busy, replaced, refused, failed or unknown."""

    def __init__(self, what: str, fault: str) -> None:
        super().__init__(what, "crossnav serve", "invalid")
        self.fault = fault


@functools.cache
def _schema() -> tuple[Any, Any, dict[int, str]]:
    """(class of requests, class of replies, names of faults) out of live.proto."""
    packed = importlib.resources.files("crossnav").joinpath("data/live.desc").read_bytes()
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(packed).file:
        pool.AddSerializedFile(file.SerializeToString())

    def message(name: str) -> Any:
        return message_factory.GetMessageClass(pool.FindMessageTypeByName(f"crossnav.live.{name}"))

    faults = pool.FindEnumTypeByName("crossnav.live.Fault").values
    names = {value.number: value.name.removeprefix("FAULT_").lower() for value in faults}
    return message("Request"), message("Reply"), names


def default_socket() -> str:
    """Where `crossnav serve` listens unless told otherwise."""
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    return f"{runtime}/crossnav.sock" if runtime else f"/tmp/crossnav-{os.getuid()}.sock"


def _command_of(message: Any) -> Command:
    return Command(message.v_mps, message.w_radps, message.pitch_radps, message.duration_s)


def _state_of(message: Any) -> State:
    return State(Phase(message.phase), message.goal, message.goals, message.steps,
                 message.last_sequence, PoseState(message.pose),
                 np.array(message.T_map_world).reshape(4, 4) if message.T_map_world else None)


def _fill_camera(camera: CameraIntrinsics, message: Any) -> None:
    for field in ("width_px", "height_px", "fx", "fy", "cx", "cy"):
        setattr(message, field, getattr(camera, field))


class Client:
    """One connection, one request at a time. Not for two threads."""

    def __init__(self, camera: CameraIntrinsics, camera_height_m: float = 0.0,
                 address: str | int | None = None, timeout_s: float = 60.0,
                 on_stop: Callable[[float], None] | None = None) -> None:
        """`camera`: of depth in all observations, and of colour where they have no `rgb_camera`.
        `camera_height_m`: above the ground, where they have no `T_base_camera`; 0 = the server's
        setting. `address`: path of a Unix domain socket, or a TCP port on this machine.
        `on_stop(silent_s)` is called when the watchdog has said stop: see `poll`."""
        self._on_stop = on_stop
        self._request, self._reply, self._faults = _schema()
        self.address = default_socket() if address is None else address
        self._socket = self._connect(timeout_s)
        self.stops = 0
        try:
            self.welcome = self._hello(camera, camera_height_m)
        except BaseException:
            self.close()
            raise
        self.sequence = self.welcome.state.last_sequence
        """Number of the last answered observation; raise it for a lost observation."""

    def _connect(self, timeout_s: float) -> socket.socket:
        try:
            if isinstance(self.address, int):
                return socket.create_connection(("127.0.0.1", self.address), timeout_s)
            made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            made.settimeout(timeout_s)
            made.connect(self.address)
            return made
        except OSError as error:
            raise Error(f"{error.strerror or error}: is `crossnav serve` running?",
                        str(self.address), "io") from error

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """The agent is unchanged, for the next client."""
        self._socket.close()

    def set_goal(self, goal: str) -> State:
        """Looks for something else; the map stays."""
        request = self._request()
        request.set_goal.goal = goal
        return _state_of(self._ask(request).state)

    def reset(self, restore: bool = False) -> State:
        """Forgets map, memory and goal; `restore` starts from the server's saved memory."""
        request = self._request()
        request.reset.restore = restore
        state = _state_of(self._ask(request).state)
        self.sequence = state.last_sequence
        return state

    def stats(self) -> dict[str, int]:
        """Counts since the server started."""
        request = self._request()
        request.get_stats.SetInParent()
        stats = self._ask(request).stats
        return {field.name: getattr(stats, field.name) for field in stats.DESCRIPTOR.fields}

    def step(self, observation: Observation, has_collided: bool = False) -> Answer:
        """One observation, numbered after the last one; its answer."""
        request = self._request()
        message = request.observation
        message.sequence = self.sequence + 1
        message.time_ns = observation.time_ns
        message.rgb = observation.rgb.tobytes()
        message.depth_m = observation.depth_m.tobytes()
        message.T_world_camera.extend(observation.T_world_camera.reshape(-1).tolist())
        message.has_collided = has_collided
        if observation.rgb_camera is not None:
            _fill_camera(observation.rgb_camera, message.rgb_camera)
            message.T_camera_rgb.extend(observation.T_camera_rgb.reshape(-1).tolist())
        if observation.T_base_camera is not None:
            message.T_base_camera.extend(observation.T_base_camera.reshape(-1).tolist())
        answer = self._ask(request).answer
        self.sequence = answer.sequence
        return Answer(
            answer.sequence, answer.time_ns, _ACTIONS[answer.action], _command_of(answer.command),
            _state_of(answer.state), answer.mode, answer.reason,
            np.array(answer.p_claimed_world) if answer.p_claimed_world else None)

    def poll(self, timeout_s: float = 0.0) -> bool:
        """Waits so long for the watchdog; true when it has said stop."""
        before, end = self.stops, time.monotonic() + timeout_s
        while select.select([self._socket], [], [], max(0.0, end - time.monotonic()))[0]:
            self._receive()
            if self.stops > before:
                return True
        return False

    def _hello(self, camera: CameraIntrinsics, camera_height_m: float) -> Welcome:
        request = self._request()
        hello = request.hello
        hello.protocol, hello.camera_height_m = PROTOCOL, camera_height_m
        _fill_camera(camera, hello.camera)
        w = self._ask(request).welcome
        return Welcome(w.version, w.perception, tuple(w.goals), w.forward_m, w.turn_rad,
                       w.pitch_rad, w.period_s, w.watchdog_s, w.max_frame_bytes,
                       _state_of(w.state))

    def _ask(self, request: Any) -> Any:
        """The reply to a request; a stop that arrives before it is noted."""
        payload = request.SerializeToString()
        try:
            self._socket.sendall(_LENGTH.pack(len(payload)) + payload)
        except OSError as error:
            self._read_what_is_left()
            raise self._lost(error) from error
        while True:
            reply = self._receive()
            if reply is not None:
                return reply

    def _read_what_is_left(self) -> None:
        """A server that closes the connection says why before; raises that."""
        while select.select([self._socket], [], [], 0)[0]:
            self._receive()

    def _receive(self) -> Any:
        """The next reply; None for a stop. An error is raised."""
        reply = self._reply()
        try:
            (size,) = _LENGTH.unpack(self._read(_LENGTH.size))
            reply.ParseFromString(self._read(size))
        except (OSError, DecodeError) as error:
            raise self._lost(error) from error
        kind = reply.WhichOneof("kind")
        if kind == "error":
            raise Refused(reply.error.text, self._faults.get(reply.error.fault, "unknown"))
        if kind != "stop":
            return reply
        self.stops += 1
        if self._on_stop is not None:
            self._on_stop(reply.stop.silent_s)
        return None

    def _read(self, size: int) -> bytes:
        data = bytearray()
        while len(data) < size:
            part = self._socket.recv(size - len(data))
            if not part:
                raise OSError("the server closed the connection")
            data += part
        return bytes(data)

    def _lost(self, error: Exception) -> Error:
        self.close()
        return Error(f"{error}; connect again, the agent continues", str(self.address), "io")
