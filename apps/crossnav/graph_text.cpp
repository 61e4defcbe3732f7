// SPDX-License-Identifier: MIT
#include "graph_text.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "json_parts.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json ObjectJson(const scenegraph::GraphObject& object) {
  return {{"id", object.id},
          {"category", object.category},
          {"floor", OrNull(object.floor)},
          {"room", OrNull(object.room)},
          {"center", PointJson(object.p_center_world)},
          {"box_min", PointJson(object.box.min)},
          {"box_max", PointJson(object.box.max)},
          {"match", object.match},
          {"certain", object.is_certain},
          {"record", object.record >= 0 ? Json(object.record) : Json()},
          {"confidence", OrNull(object.confidence)}};
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    if (c == '<') out += "&lt;";
    if (c == '"') out += "&quot;";
    if (c != '&' && c != '<' && c != '"') out += c;
  }
  return out;
}

std::string Node(const std::string& id, const std::string& kind, const std::string& name,
                 const Vector3d& p) {
  return fmt::format(
      "<node id=\"{}\"><data key=\"kind\">{}</data><data key=\"name\">{}</data>"
      "<data key=\"x\">{:.3f}</data><data key=\"y\">{:.3f}</data><data key=\"z\">{:.3f}</data>"
      "</node>\n",
      id, kind, Escaped(name), p.x(), p.y(), p.z());
}

std::string Edge(const std::string& from, const std::string& to, std::string_view relation) {
  return fmt::format("<edge source=\"{}\" target=\"{}\"><data key=\"relation\">{}</data></edge>\n",
                     from, to, relation);
}

std::string Nodes(const scenegraph::SceneGraph& graph) {
  std::string text = Node("building", "building", "building", Vector3d::Zero());
  for (const auto& f : graph.floors)
    text += Node(fmt::format("floor{}", f.id), "floor", fmt::format("floor {}", f.id),
                 {0, 0, f.height_m});
  for (const auto& r : graph.rooms)
    text +=
        Node(fmt::format("room{}", r.id), "room", fmt::format("room {}", r.id), r.p_center_world);
  for (const auto& o : graph.objects)
    text += Node(fmt::format("object{}", o.id), "object", o.category, o.p_center_world);
  return text;
}

std::string Edges(const scenegraph::SceneGraph& graph) {
  std::string text;
  for (const auto& f : graph.floors) text += Edge(fmt::format("floor{}", f.id), "building", "in");
  for (const auto& r : graph.rooms)
    text += Edge(fmt::format("room{}", r.id), fmt::format("floor{}", r.floor), "in");
  for (const auto& o : graph.objects)
    if (o.room) text += Edge(fmt::format("object{}", o.id), fmt::format("room{}", *o.room), "in");
  for (const auto& p : graph.passages)
    text += Edge(fmt::format("room{}", p.room_a), fmt::format("room{}", p.room_b), "passage");
  for (const auto& s : graph.stairs)
    if (s.lower_floor && s.upper_floor)
      text += Edge(fmt::format("floor{}", *s.lower_floor), fmt::format("floor{}", *s.upper_floor),
                   "stair");
  for (const auto& r : graph.relations)
    text += Edge(fmt::format("object{}", r.from), fmt::format("object{}", r.to),
                 scenegraph::NameOf(r.kind));
  return text;
}

}  // namespace

std::string GraphJson(const scenegraph::SceneGraph& graph) {
  Json floors = Json::array(), rooms = Json::array(), passages = Json::array(),
       stairs = Json::array(), objects = Json::array(), relations = Json::array();
  for (const auto& f : graph.floors)
    floors.push_back({{"id", f.id},
                      {"height_m", f.height_m},
                      {"area_m2", f.area_m2},
                      {"ceiling_m", OrNull(f.ceiling_m)}});
  for (const auto& r : graph.rooms)
    rooms.push_back({{"id", r.id},
                     {"floor", r.floor},
                     {"area_m2", r.area_m2},
                     {"center", PointJson(r.p_center_world)},
                     {"box_min", PointJson(r.box.min)},
                     {"box_max", PointJson(r.box.max)},
                     {"looked_at", r.looked_at}});
  for (const auto& p : graph.passages)
    passages.push_back({{"rooms", {p.room_a, p.room_b}},
                        {"position", PointJson(p.p_world)},
                        {"width_m", p.width_m}});
  for (const auto& s : graph.stairs)
    stairs.push_back({{"flight", s.flight},
                      {"lower_floor", OrNull(s.lower_floor)},
                      {"upper_floor", OrNull(s.upper_floor)}});
  for (const auto& o : graph.objects) objects.push_back(ObjectJson(o));
  for (const auto& r : graph.relations)
    relations.push_back({{"relation", scenegraph::NameOf(r.kind)}, {"from", r.from}, {"to", r.to}});
  return Json({{"voxel_m", graph.voxel_m},
               {"floors", floors},
               {"rooms", rooms},
               {"passages", passages},
               {"stairs", stairs},
               {"asked", graph.asked},
               {"objects", objects},
               {"relations", relations}})
             .dump(1) +
         "\n";
}

std::string GraphXml(const scenegraph::SceneGraph& graph) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
  for (const char* key : {"kind", "name"})
    text +=
        fmt::format("<key id=\"{0}\" for=\"node\" attr.name=\"{0}\" attr.type=\"string\"/>\n", key);
  for (const char* key : {"x", "y", "z"})
    text +=
        fmt::format("<key id=\"{0}\" for=\"node\" attr.name=\"{0}\" attr.type=\"double\"/>\n", key);
  text += "<key id=\"relation\" for=\"edge\" attr.name=\"relation\" attr.type=\"string\"/>\n";
  return text + "<graph id=\"home\" edgedefault=\"directed\">\n" + Nodes(graph) + Edges(graph) +
         "</graph>\n</graphml>\n";
}

std::string GraphSummary(const scenegraph::SceneGraph& graph) {
  std::string text;
  for (const auto& f : graph.floors) {
    text += fmt::format("floor {} at {:.2f} m\n", f.id, f.height_m);
    for (const auto& r : graph.rooms) {
      if (r.floor != f.id) continue;
      text += fmt::format("  room {}: {:.1f} m2", r.id, r.area_m2);
      std::map<std::string, int> counts;
      for (const auto& o : graph.objects)
        if (o.room == r.id) ++counts[o.category];
      for (const auto& [name, count] : counts) text += fmt::format(", {} {}", count, name);
      text += "\n";
    }
  }
  return text;
}

}  // namespace crossnav::app
