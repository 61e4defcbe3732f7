// SPDX-License-Identifier: MIT
#include "graph_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "crossnav/core/write_file.h"
#include "crossnav/trace/labelled_boxes.h"
#include "crossnav/trace/mcap_writer.h"
#include "crossnav/trace/replay_schemas.h"
#include "graph_text.h"
#include "shell.h"

namespace crossnav::app {
namespace {

using scenegraph::SceneGraph;
using trace::LabelledBox;
using trace::PlaceLine;

constexpr Rgb8 kRoom{28, 126, 214}, kObject{214, 51, 108}, kPassage{47, 158, 68},
    kRelation{245, 159, 0};
constexpr double kFlat_m = 0.05;  // a room is drawn as its ground
constexpr std::array kEndings = {".json", ".graphml", ".mcap", ".rrd"};

bool EndsWith(const std::string& text, const char* ending) {
  return text.ends_with(ending);
}

std::string Boxes(const SceneGraph& graph) {
  std::vector<LabelledBox> boxes;
  std::vector<PlaceLine> lines;
  for (const auto& room : graph.rooms) {
    Box3 ground = room.box;
    ground.max.z() = ground.min.z() + kFlat_m;
    boxes.push_back({ground, fmt::format("room {}", room.id), kRoom, 0.15});
  }
  for (const auto& object : graph.objects)
    boxes.push_back({object.box, object.category, kObject, 0.4});
  for (const auto& passage : graph.passages) {
    lines.push_back({graph.rooms[passage.room_a].p_center_world, passage.p_world, kPassage});
    lines.push_back({passage.p_world, graph.rooms[passage.room_b].p_center_world, kPassage});
  }
  for (const auto& relation : graph.relations)
    lines.push_back({graph.objects[relation.from].box.Center(),
                     graph.objects[relation.to].box.Center(), kRelation});
  return trace::EncodeBoxes(0, "graph", boxes, lines);
}

Result<void> WriteMcap(const SceneGraph& graph, const std::string& path) {
  auto mcap = trace::McapWriter::Open(path, {});
  if (!mcap) return tl::unexpected(mcap.error());
  const auto scene =
      mcap->AddSchema("foxglove.SceneUpdate", "protobuf", std::string(trace::ReplayDescriptors()));
  const auto shown = mcap->AddChannel("/graph/scene", scene, "protobuf");
  const auto schema = mcap->AddSchema("crossnav.SceneGraph", "jsonschema", R"({"type":"object"})");
  const auto text = mcap->AddChannel("/graph", schema, "json");
  mcap->Write(shown, 0, Boxes(graph));
  mcap->Write(text, 0, GraphJson(graph));
  if (auto ok = mcap->EndGroup(); !ok) return ok;
  return mcap->Close();
}

Result<void> WriteRerun(const SceneGraph& graph, const std::string& path) {
  const std::string json = fmt::format("{}.{}.json", path, getpid());
  if (auto ok = WriteFileAtomically(json, GraphJson(graph)); !ok) return ok;
  auto done = RunPythonModule("crossnav.rerun", "rerun", {json, "--to", path});
  std::error_code ignored;
  std::filesystem::remove(json, ignored);
  return done;
}

}  // namespace

Result<void> CheckGraphFile(const std::string& path) {
  for (const char* ending : kEndings)
    if (EndsWith(path, ending)) return {};
  return Fail(ErrorCode::kUnsupported, "a graph is written as .json, .graphml, .mcap or .rrd",
              "--to");
}

Result<void> WriteGraphFile(const SceneGraph& graph, const std::string& path) {
  if (EndsWith(path, ".mcap")) return WriteMcap(graph, path);
  if (EndsWith(path, ".rrd")) return WriteRerun(graph, path);
  return WriteFileAtomically(path, EndsWith(path, ".graphml") ? GraphXml(graph) : GraphJson(graph));
}

}  // namespace crossnav::app
