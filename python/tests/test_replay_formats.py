# SPDX-License-Identifier: MIT
"""Replays of the program, read by others: the official packages of MCAP and of Foxglove."""

import json
import zlib
from pathlib import Path
from typing import Any

import pytest

reader = pytest.importorskip("mcap.reader")
messages = pytest.importorskip("foxglove.messages")
pytest.importorskip("google.protobuf")

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory  # noqa: E402
from mcap.stream_reader import StreamReader  # noqa: E402

LAYOUT = "foxglove_layout.json"
Messages = list[tuple[Any, Any, Any]]


@pytest.fixture(scope="module")
def everything(replay: Path) -> Messages:
    """(schema, channel, message) of the whole file, its CRCs checked."""
    with open(replay, "rb") as file:
        return list(reader.make_reader(file, validate_crcs=True).iter_messages())


def message_class(files: bytes, name: str) -> Any:
    """The class `name` out of a serialised FileDescriptorSet alone."""
    described = descriptor_pb2.FileDescriptorSet.FromString(files)
    pool = descriptor_pool.DescriptorPool()
    waiting = list(described.file)
    while waiting:  # in any order: a file needs those that it imports first
        ready = [f for f in waiting if not any(d in {w.name for w in waiting}
                                               for d in f.dependency)]
        assert ready, "files that import each other"
        for file in ready:
            pool.Add(file)
            waiting.remove(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def official(name: str) -> Any:
    schema = getattr(messages, name.removeprefix("foxglove.")).get_schema()
    return message_class(schema.data, name)


def fields(descriptor: Any, seen: dict[str, Any]) -> dict[str, Any]:
    """name -> (number, type, repeated) of each field of a message and of those inside it."""
    if descriptor.full_name not in seen:
        seen[descriptor.full_name] = {f.name: (f.number, f.type, f.is_repeated)
                                      for f in descriptor.fields}
        for field in descriptor.fields:
            if field.message_type:
                fields(field.message_type, seen)
    return seen


def has_unknown(message: Any) -> bool:
    """Whether bytes were kept that no field of the class takes: dropping them shortens it."""
    whole = message.ByteSize()
    message.DiscardUnknownFields()
    return bool(message.ByteSize() != whole)


def test_every_message_decodes_with_the_schema_that_it_names(everything: Messages) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    classes: dict[str, Any] = {}
    validators: dict[str, Any] = {}
    for schema, channel, message in everything:
        if schema.encoding == "jsonschema":
            assert channel.message_encoding == "json"
            if schema.name not in validators:
                kind = jsonschema.validators.validator_for(json.loads(schema.data))
                validators[schema.name] = kind(json.loads(schema.data))
            validators[schema.name].validate(json.loads(message.data))
            continue
        assert schema.encoding == channel.message_encoding == "protobuf"
        if schema.name not in classes:
            classes[schema.name] = message_class(schema.data, schema.name)
        decoded = classes[schema.name].FromString(message.data)
        stamp = getattr(decoded, "timestamp", None)
        if stamp is not None:
            assert stamp.ToNanoseconds() == message.log_time, channel.topic
        assert not has_unknown(decoded), channel.topic
    assert len(classes) == 9 and len(validators) >= 2


def test_foxglove_messages_are_those_of_the_official_schemas(everything: Messages) -> None:
    classes: dict[str, Any] = {}
    for schema, channel, message in everything:
        if not schema.name.startswith("foxglove."):
            continue
        if schema.name not in classes:
            classes[schema.name] = official(schema.name)
            wanted = fields(classes[schema.name].DESCRIPTOR, {})
            for name, ours in fields(message_class(schema.data, schema.name).DESCRIPTOR,
                                     {}).items():
                assert ours.items() <= wanted[name].items(), name
        assert not has_unknown(classes[schema.name].FromString(message.data)), channel.topic
    assert len(classes) == 8


def test_the_records_hold_together(replay: Path, everything: Messages) -> None:
    """Statistics, CRCs of chunks and of the data, by hand beside the reader's own check."""
    with open(replay, "rb") as file:
        records = list(StreamReader(file, emit_chunks=True, validate_crcs=True).records)
    with open(replay, "rb") as file:
        summary = reader.make_reader(file).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count == len(everything)
    assert [c.topic for c in summary.channels.values()] and summary.chunk_indexes
    chunks = [r for r in records if type(r).__name__ == "Chunk"]
    assert len(chunks) == summary.statistics.chunk_count
    zstandard = pytest.importorskip("zstandard")
    for chunk in chunks:
        data = zstandard.ZstdDecompressor().decompress(chunk.data, chunk.uncompressed_size)
        assert chunk.uncompressed_crc == zlib.crc32(data) != 0
    times = [message.log_time for _, _, message in everything]
    assert times == sorted(times)


def test_one_changed_byte_is_found(replay: Path, tmp_path: Path) -> None:
    data = bytearray(replay.read_bytes())
    data[len(data) // 2] ^= 1
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(data)
    with open(torn, "rb") as file, pytest.raises(Exception, match=r"(?i)crc|corrupt|decompress"):
        list(reader.make_reader(file, validate_crcs=True).iter_messages())


def test_the_layout_for_foxglove_shows_topics_that_exist(everything: Messages) -> None:
    import crossnav
    layout = json.loads((Path(crossnav.__file__).parent / "data" / LAYOUT).read_text("utf-8"))
    topics = {channel.topic for _, channel, _ in everything} | {"/episode/stage", "/map/flights"}  # not in a short episode

    def named(value: Any) -> set[str]:
        if isinstance(value, dict):
            keys = {k for k in value.get("topics", {}) if isinstance(k, str)}
            return keys.union(*map(named, value.values()))
        if isinstance(value, list):
            return set().union(*map(named, value))
        if isinstance(value, str) and value.startswith("/"):
            return {value.split(".")[0].split("[")[0].split("{")[0]}
        return set()

    shown = named(layout)
    assert {"/camera/image", "/map/voxels", "/agent/plan", "/agent/step"} <= shown <= topics

    def panels(value: Any) -> set[str]:
        if isinstance(value, str):
            return {value}
        return panels(value["first"]) | panels(value["second"])

    assert panels(layout["layout"]) == set(layout["configById"])
