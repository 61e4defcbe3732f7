// SPDX-License-Identifier: MIT
// The replay file, read by somebody else's reader through its index.
import assert from "node:assert/strict";
import { open, readFile } from "node:fs/promises";
import { test } from "node:test";

import { optional, samplePath } from "./sample.mjs";

const core = await optional("@mcap/core"), fzstd = await optional("fzstd");
const path = samplePath("sample.mcap");
const skip = !core || !fzstd ? "@mcap/core and fzstd are not installed" : !path && "no sample";
const decompressHandlers = { zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))) };

async function indexed() {
  const file = await open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  return { reader: await core.McapIndexedReader.Initialize({ readable, decompressHandlers }), file };
}

test("the index, the statistics and the messages agree", { skip }, async () => {
  const { reader, file } = await indexed();
  const counts = new Map();
  let last = 0n;
  for await (const message of reader.readMessages()) {
    assert.ok(message.logTime >= last);
    last = message.logTime;
    counts.set(message.channelId, (counts.get(message.channelId) || 0n) + 1n);
  }
  const statistics = reader.statistics;
  assert.equal(statistics.messageEndTime, last);
  for (const [id, count] of statistics.channelMessageCounts) assert.equal(counts.get(id) || 0n, count);
  assert.ok(reader.chunkIndexes.length > 3);
  assert.equal(Number(statistics.chunkCount), reader.chunkIndexes.length);
  await file.close();
});

test("every topic has the schema that its viewers look for", { skip }, async () => {
  const { reader, file } = await indexed();
  const schemas = Object.fromEntries([...reader.channelsById.values()].map((channel) => {
    const schema = reader.schemasById.get(channel.schemaId);
    return [channel.topic, `${schema.name} ${schema.encoding} ${channel.messageEncoding}`];
  }));
  assert.deepEqual(schemas, {
    "/tf": "foxglove.FrameTransform protobuf protobuf",
    "/agent/pose": "foxglove.PoseInFrame protobuf protobuf",
    "/camera/image": "foxglove.CompressedImage protobuf protobuf",
    "/camera/calibration": "foxglove.CameraCalibration protobuf protobuf",
    "/camera/depth": "foxglove.RawImage protobuf protobuf",
    "/agent/step": "crossnav.Step jsonschema json",
    "/map/voxel_changes": "crossnav.VoxelChanges protobuf protobuf",
    "/map/voxels": "foxglove.PointCloud protobuf protobuf",
    "/map/flights": "foxglove.SceneUpdate protobuf protobuf",
    "/map/graph": "crossnav.Graph jsonschema json",
    "/perception/boxes": "crossnav.Sight jsonschema json",
    "/perception/maps": "foxglove.CompressedImage protobuf protobuf",
    "/agent/plan": "foxglove.SceneUpdate protobuf protobuf",
    "/episode/goals": "foxglove.SceneUpdate protobuf protobuf",
    "/log": "foxglove.Log protobuf protobuf",
    "/episode/stage": "crossnav.Stage jsonschema json",
  });
  await file.close();
});

test("seeking by time finds the steps of that time", { skip }, async () => {
  const { reader, file } = await indexed();
  const range = { topics: ["/agent/step"], startTime: 4_000_000_000n, endTime: 6_000_000_000n };
  const steps = [];
  for await (const message of reader.readMessages(range)) {
    steps.push(JSON.parse(new TextDecoder().decode(message.data)).step);
  }
  assert.deepEqual(steps, [...Array(21).keys()].map((i) => 40 + i));
  await file.close();
});

test("the head is found through the metadata index", { skip }, async () => {
  const { reader, file } = await indexed();
  const found = [];
  for await (const metadata of reader.readMetadata({ name: "crossnav.replay" })) found.push(metadata);
  assert.equal(found.length, 1);
  assert.deepEqual(JSON.parse(found[0].metadata.get("info")).goals, ["sofa", "bed", "plant"]);
  await file.close();
});

test("a torn file can be streamed up to the tear", { skip }, async () => {
  const reader = new core.McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(await readFile(samplePath("torn.mcap")));
  let messages = 0;
  for (let record; (record = reader.nextRecord()); ) messages += record.type === "Message" ? 1 : 0;
  assert.ok(messages > 100, String(messages));
});
