// SPDX-License-Identifier: MIT
#include "ask_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/language/answer.h"
#include "crossnav/language/map_home.h"
#include "json_parts.h"
#include "map_texts.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
using language::KnownHome;

Json RoomJson(int room, const KnownHome& home) {
  return {{"id", room},
          {"type", language::TextOf(home.rooms[room].fits)},
          {"floor", home.rooms[room].floor},
          {"looked_at", home.rooms[room].looked_at}};
}

Json RoomsJson(const std::vector<int>& rooms, const KnownHome& home) {
  Json all = Json::array();
  for (const int room : rooms) all.push_back(RoomJson(room, home));
  return all;
}

Json ThingJson(const language::Thing& thing, const KnownHome& home, const std::string& picture) {
  const Vector3d& p = thing.p_center_world;
  Json json = {{"category", thing.category},
               {"center", {p.x(), p.y(), p.z()}},
               {"floor", OrNull(thing.floor)},
               {"floor_name", thing.floor ? language::FloorText(*thing.floor, home) : ""},
               {"room", thing.room ? RoomJson(*thing.room, home) : Json()},
               {"confidence", thing.confidence},
               {"certain", thing.is_certain},
               {"last_seen", nullptr},
               {"picture", picture.empty() ? Json() : Json(picture)}};
  if (thing.last_seen)
    json["last_seen"] = {{"day", thing.last_seen->day + 1}, {"step", thing.last_seen->step}};
  return json;
}

/// Path of the thing's picture, written; empty where it has none or none is wanted.
Result<std::string> WritePicture(const language::Thing& thing, const AskOptions& options,
                                 const std::vector<objects::ObjectRecord>& records) {
  if (options.pictures.empty() || thing.record < 0) return std::string();
  const objects::ObjectRecord& record = records[thing.record];
  if (record.picture_png.empty()) return std::string();
  std::string name = thing.category;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  const auto path =
      std::filesystem::path(options.pictures) / fmt::format("{}_{}.png", name, record.id);
  const std::string bytes(record.picture_png.begin(), record.picture_png.end());
  if (auto ok = WriteFileAtomically(path, bytes); !ok) return tl::unexpected(ok.error());
  return path.string();
}

Result<KnownHome> HomeIn(const AskOptions& options, const language::Question& question,
                         const store::LoadedMemory& loaded, const evaluation::RunConfig& config) {
  std::unique_ptr<perception::DenseEncoder> encoder;
  if (loaded.memory.Size() > 0) {
    auto made = EncoderFor(options.file, loaded.header, config);
    if (!made) return tl::unexpected(made.error());
    encoder = std::move(*made);
  }
  auto known = language::HomeOf(
      {loaded.map, loaded.memory, loaded.flights, loaded.objects,
       ThresholdsOf(loaded.header.encoder_name, config)},
      language::NamesFor(question),
      [&](const std::string& text) { return encoder->EncodeText(text); }, config.agent.query);
  if (!known) return known;
  KnownHome& home = *known;
  if (options.ground_floor >= static_cast<int>(home.floors.size()) && options.ground_floor > 0)
    return Fail(ErrorCode::kInvalid,
                fmt::format("the map has {} floors, counted from 0", home.floors.size()),
                "--ground-floor");
  home.ground_floor = options.ground_floor;
  if (options.from.size() == 3) home.p_robot_world = Vector3d(options.from.data());
  return known;
}

}  // namespace

Result<void> Ask(const AskOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.pictures, "--pictures"); !ok) return ok;
  const auto question = language::ParseQuestion(options.question);
  if (!question) return tl::unexpected(question.error());
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = LoadMap(options.file, options.skip_damaged, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  const auto home = HomeIn(options, *question, *loaded, *config);
  if (!home) return tl::unexpected(home.error());
  const language::Answer answer = AnswerTo(*question, *home);
  Json things = Json::array();
  for (const int i : answer.things) {
    const auto picture = WritePicture(home->things[i], options, loaded->objects);
    if (!picture) return tl::unexpected(picture.error());
    things.push_back(ThingJson(home->things[i], *home, *picture));
  }
  console.Print(answer.text);
  console.Document(Json({{"question", options.question},
                         {"kind", language::NameOf(question->kind)},
                         {"answer", answer.text},
                         {"known", answer.is_known},
                         {"yes", OrNull(answer.is_true)},
                         {"count", OrNull(answer.count)},
                         {"things", std::move(things)},
                         {"rooms", RoomsJson(answer.rooms, *home)},
                         {"not_looked_at", RoomsJson(answer.unseen, *home)}}));
  return {};
}

}  // namespace crossnav::app
