// SPDX-License-Identifier: MIT
#include "crossnav/trace/graph_note.h"

#include <cmath>

#include "crossnav/trace/json_reader.h"
#include "crossnav/trace/json_text.h"

namespace crossnav::trace {
namespace {

using Element = JsonReader::Element;

double Rounded(double value) {
  return std::round(value * 1000) / 1000;
}

Vector3d Rounded(const Vector3d& p) {
  return {Rounded(p.x()), Rounded(p.y()), Rounded(p.z())};
}

void AppendRoom(JsonText& json, const GraphNote::Room& room) {
  json.BeginObject().Field("id", room.id).Field("height_m", Rounded(room.height_m));
  json.Field("area_m2", Rounded(room.area_m2)).Field("center", Rounded(room.p_center_world));
  json.Key("outline").BeginArray();
  for (const auto& line : room.outline) {
    json.BeginArray();
    for (const double at : line) json.Value(Rounded(at));
    json.EndArray();
  }
  json.EndArray().EndObject();
}

void AppendObject(JsonText& json, const GraphNote::Object& object) {
  json.BeginObject().Field("id", object.id).Field("category", std::string_view(object.category));
  json.Field("room", object.room).Field("box_min", Rounded(object.box.min));
  json.Field("box_max", Rounded(object.box.max)).EndObject();
}

void ReadRoom(JsonReader& reader, const Element& e, GraphNote::Room& room) {
  reader.Field(e, "id", room.id);
  reader.Field(e, "height_m", room.height_m);
  reader.Field(e, "area_m2", room.area_m2);
  reader.Field(e, "center", room.p_center_world);
  reader.ListField(e, "outline", room.outline,
                   [](JsonReader& r, const Element& item, std::array<double, 4>& line) {
                     r.Numbers(item, line.data(), line.size());
                   });
}

void ReadObject(JsonReader& reader, const Element& e, GraphNote::Object& object) {
  reader.Field(e, "id", object.id);
  reader.Field(e, "category", object.category);
  reader.Field(e, "room", object.room);
  reader.Field(e, "box_min", object.box.min);
  reader.Field(e, "box_max", object.box.max);
}

void ReadRelation(JsonReader& reader, const Element& e, GraphNote::Relation& relation) {
  reader.Field(e, "kind", relation.kind);
  reader.Field(e, "from", relation.from);
  reader.Field(e, "to", relation.to);
}

void ReadGraphNote(JsonReader& reader, const Element& e, GraphNote& note) {
  reader.ListField(
      e, "floors_m", note.floors_m,
      [](JsonReader& r, const Element& item, double& height) { r.Read(item, height); });
  reader.ListField(e, "rooms", note.rooms, ReadRoom);
  reader.ListField(e, "objects", note.objects, ReadObject);
  reader.ListField(e, "relations", note.relations, ReadRelation);
}

}  // namespace

std::string ToJson(const GraphNote& note) {
  JsonText json;
  json.BeginObject().Key("floors_m").BeginArray();
  for (const double height_m : note.floors_m) json.Value(Rounded(height_m));
  json.EndArray().Key("rooms").BeginArray();
  for (const GraphNote::Room& room : note.rooms) AppendRoom(json, room);
  json.EndArray().Key("objects").BeginArray();
  for (const GraphNote::Object& object : note.objects) AppendObject(json, object);
  json.EndArray().Key("relations").BeginArray();
  for (const GraphNote::Relation& relation : note.relations)
    json.BeginObject()
        .Field("kind", std::string_view(relation.kind))
        .Field("from", relation.from)
        .Field("to", relation.to)
        .EndObject();
  json.EndArray().EndObject();
  return json.Take();
}

Result<GraphNote> GraphNoteFromJson(std::string_view json) {
  return ParseJson<GraphNote>(json, "graph", ReadGraphNote);
}

}  // namespace crossnav::trace
