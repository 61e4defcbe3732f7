// SPDX-License-Identifier: MIT
#include "crossnav/trace/sight.h"

#include <algorithm>
#include <cmath>

#include "crossnav/trace/json_reader.h"
#include "crossnav/trace/json_text.h"
#include "crossnav/trace/preview.h"

namespace crossnav::trace {
namespace {

using Element = JsonReader::Element;

void ReadBox(JsonReader& in, const Element& e, SightBox& box) {
  in.Field(e, "u0", box.u0);
  in.Field(e, "v0", box.v0);
  in.Field(e, "u1", box.u1);
  in.Field(e, "v1", box.v1);
  in.Field(e, "confidence", box.confidence);
  in.Field(e, "mask_quality", box.mask_quality);
}

/// [0, 1] in `steps` even steps as a byte: few distinct values keep files small.
std::uint8_t Quantized(double share, int steps) {
  const double step = std::lround(std::clamp(share, 0.0, 1.0) * (steps - 1));
  return static_cast<std::uint8_t>(std::lround(255 * step / (steps - 1)));
}

/// Value of an image of any size over the same frame; 0 where there is none.
template <class T>
double ValueAt(const Image<T>& image, double u_share, double v_share) {
  if (image.empty()) return 0;
  const auto u = static_cast<int>(u_share * image.width);
  const auto v = static_cast<int>(v_share * image.height);
  return static_cast<double>(image.At(std::min(u, image.width - 1), std::min(v, image.height - 1)));
}

void ReadNote(JsonReader& in, const Element& e, SightNote& note) {
  in.Field(e, "width_px", note.width_px);
  in.Field(e, "height_px", note.height_px);
  in.Field(e, "similarity_min", note.similarity_min);
  in.Field(e, "similarity_max", note.similarity_max);
  in.ListField(e, "boxes", note.boxes, ReadBox);
}

}  // namespace

SightNote NoteOf(const Sight& sight) {
  SightNote note{sight.width_px, sight.height_px, sight.boxes};
  const auto& cells = sight.similarity.data;
  if (cells.empty()) return note;
  const auto [least, most] = std::minmax_element(cells.begin(), cells.end());
  note.similarity_min = *least;
  note.similarity_max = *most;
  return note;
}

std::string ToJson(const SightNote& note) {
  JsonText json;
  json.BeginObject()
      .Field("width_px", note.width_px)
      .Field("height_px", note.height_px)
      .Field("similarity_min", note.similarity_min)
      .Field("similarity_max", note.similarity_max)
      .Key("boxes")
      .BeginArray();
  for (const SightBox& box : note.boxes) {
    json.BeginObject()
        .Field("u0", box.u0)
        .Field("v0", box.v0)
        .Field("u1", box.u1)
        .Field("v1", box.v1)
        .Field("confidence", box.confidence)
        .Field("mask_quality", box.mask_quality)
        .EndObject();
  }
  json.EndArray().EndObject();
  return json.Take();
}

Result<SightNote> SightNoteFromJson(std::string_view json) {
  return ParseJson<SightNote>(json, "sight", ReadNote);
}

RgbImage MapsOf(const Sight& sight, int max_px) {
  const int factor = ShrinkFactor(std::max(sight.width_px, sight.height_px), max_px);
  const SightNote note = NoteOf(sight);
  const double span = note.similarity_max - note.similarity_min;
  RgbImage maps(std::max(1, sight.width_px / factor), std::max(1, sight.height_px / factor));
  for (int v = 0; v < maps.height; ++v)
    for (int u = 0; u < maps.width; ++u) {
      const double x = (u + 0.5) / maps.width, y = (v + 0.5) / maps.height;
      const double similarity = ValueAt(sight.similarity, x, y) - note.similarity_min;
      maps.At(u, v) = {Quantized(ValueAt(sight.masks, x, y), 2),
                       Quantized(ValueAt(sight.stair_probability, x, y), 16),
                       Quantized(span > 0 ? similarity / span : 0, 32)};
    }
  return maps;
}

}  // namespace crossnav::trace
