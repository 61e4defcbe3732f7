# SPDX-License-Identifier: MIT
"""Reads a replay (docs/formats/replay.md) with the official `mcap` package, step by step."""

import io
import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError  # type: ignore[import-untyped]
from mcap.exceptions import McapError
from mcap.reader import McapReader, make_reader
from mcap_protobuf.decoder import DecoderFactory
from numpy.typing import NDArray

from crossnav._errors import Error

FORMAT = 1
INFLATED = 8
"""Bit of a voxel's value beside its state."""


@dataclass
class Camera:
    """Pinhole of pictures `width_px` x `height_px`; pixel centres have integer coordinates."""

    width_px: int
    height_px: int
    K: NDArray[np.float64]
    """(3, 3) [px]"""

    def resized(self, width_px: int, height_px: int) -> "Camera":
        """The same camera with other pixels."""
        scale = np.diag([width_px / self.width_px, height_px / self.height_px, 1.0])
        centre = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])  # from pixel centres to edges
        return Camera(width_px, height_px, np.linalg.inv(centre) @ scale @ centre @ self.K)


@dataclass
class Frame:
    """All messages of one time: usually one step."""

    time_s: float
    step: dict[str, Any] | None = None
    """The step record."""
    jpeg: bytes | None = None
    camera: Camera | None = None
    """Of the JPEG."""
    depth_mm: NDArray[np.uint16] | None = None
    """H x W, planar, 0 = invalid."""
    sight: dict[str, Any] | None = None
    maps_png: bytes | None = None
    changes: tuple[NDArray[np.int32], NDArray[np.uint8]] | None = None
    """Keys (N, 3) and values (N,): the state, plus INFLATED."""
    stages: list[dict[str, Any]] = field(default_factory=list)
    logs: list[tuple[str, str]] = field(default_factory=list)
    """(level, message)"""


def _varints(data: bytes) -> Iterator[int]:
    value = shift = 0
    for byte in data:
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            yield value
            value = shift = 0
        elif shift > 63:
            raise ValueError("a number of more than 64 bits in the runs of voxels")
    if shift:
        raise ValueError("the runs of voxels end within a number")


def decode_runs(data: bytes, count: int) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Keys (N, 3) and values (N,) of the field `runs`; ValueError where it is not `count` voxels."""
    numbers = np.fromiter(_varints(data), np.uint64)
    if numbers.size % 5:
        raise ValueError("the runs of voxels end within a run")
    runs = numbers.reshape(-1, 5)
    lengths, values = runs[:, 3].astype(np.int64), runs[:, 4]
    if (runs[:, 3] > count).any() or lengths.sum() != count or (values > 15).any():
        raise ValueError(f"the runs of voxels are not {count} voxels")
    zigzag = runs[:, :3].astype(np.int64)
    firsts = np.cumsum((zigzag >> 1) ^ -(zigzag & 1), axis=0)
    keys = np.repeat(firsts, lengths, axis=0)
    keys[:, 2] += np.arange(count) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    return keys.astype(np.int32), np.repeat(values, lengths).astype(np.uint8)


def _calibration(message: Any) -> Camera:
    return Camera(message.width, message.height, np.array(message.K).reshape(3, 3))


def _depth(message: Any) -> NDArray[np.uint16]:
    if message.encoding != "16UC1":
        raise ValueError(f'depth in the encoding "{message.encoding}"')
    rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    return rows[:, :2 * message.width].copy().view("<u2")


def _take(frame: Frame, topic: str, message: Any) -> None:
    """Puts one decoded message into its place; other topics are derived from these."""
    if topic == "/agent/step":
        frame.step = message
    elif topic == "/map/voxel_changes":
        frame.changes = decode_runs(message.runs, message.count)
    elif topic == "/camera/image":
        frame.jpeg = message.data
    elif topic == "/camera/calibration":
        frame.camera = _calibration(message)
    elif topic == "/camera/depth":
        frame.depth_mm = _depth(message)
    elif topic == "/perception/boxes":
        frame.sight = message
    elif topic == "/perception/maps":
        frame.maps_png = message.data
    elif topic == "/episode/stage":
        frame.stages.append(message)
    elif topic == "/log":
        level = message.DESCRIPTOR.fields_by_name["level"].enum_type.values_by_number
        known = level.get(message.level)
        frame.logs.append((known.name if known else "UNKNOWN", message.message))


TOPICS = ("/agent/step", "/map/voxel_changes", "/camera/image", "/camera/calibration",
          "/camera/depth", "/perception/boxes", "/perception/maps", "/episode/stage", "/log")


class Replay:
    """An open replay; a context manager. Checks every CRC.

    Raises crossnav.Error, on opening and while frames are read: the file is missing, no MCAP, cut
    off, damaged, no replay of crossnav, or of a later format.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._decoders: dict[int, Any] = {}
        self._factory = DecoderFactory()
        try:
            # In memory: the readers of `mcap` seek back and forth.
            self._file = io.BytesIO(path.read_bytes())
        except OSError as error:
            raise Error(error.strerror or str(error), str(path),
                        "not_found" if isinstance(error, FileNotFoundError) else "io") from None
        with self._errors():
            self._reader: McapReader = make_reader(self._file, validate_crcs=True)
            if self._reader.get_summary() is None:
                raise ValueError("it has no summary")
            self.info = self._info()

    def _info(self) -> dict[str, Any]:
        """The metadata record crossnav.replay."""
        for record in self._reader.iter_metadata():
            if record.name == "crossnav.replay":
                info: dict[str, Any] = json.loads(record.metadata["info"])
                if info["format"] != FORMAT:
                    raise Error(f"format {info['format']}; this version reads {FORMAT}",
                                str(self.path), "unsupported")
                return info
        raise Error("is not a replay of crossnav: it has no metadata record crossnav.replay",
                    str(self.path), "unsupported")

    @contextmanager
    def _errors(self) -> Iterator[None]:
        try:
            yield
        except (McapError, DecodeError, ValueError, KeyError, TypeError, AttributeError,
                struct.error, EOFError) as error:
            what = str(error) or type(error).__name__
            raise Error(f"is cut off, damaged or no MCAP file: {what}", str(self.path),
                        "malformed") from None
        except Exception as error:  # zstandard and lz4 raise their own types, without a common base
            if type(error).__module__.split(".")[0] not in ("zstandard", "zstd", "lz4"):
                raise
            raise Error(f"is damaged: {error}", str(self.path), "malformed") from None

    def frames(self) -> Iterator[Frame]:
        """In order of time."""
        with self._errors():
            frame: Frame | None = None
            for schema, channel, message in self._reader.iter_messages(topics=TOPICS):
                if frame is None or message.log_time != round(frame.time_s * 1e9):
                    if frame is not None:
                        yield frame
                    frame = Frame(message.log_time * 1e-9)
                _take(frame, channel.topic, self._decoded(schema, channel, message))
            if frame is not None:
                yield frame

    def _decoded(self, schema: Any, channel: Any, message: Any) -> Any:
        if channel.message_encoding == "json":
            return json.loads(message.data)
        if channel.id not in self._decoders:
            self._decoders[channel.id] = self._factory.decoder_for(
                channel.message_encoding, schema)
        return self._decoders[channel.id](message.data)

    def __enter__(self) -> "Replay":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()
