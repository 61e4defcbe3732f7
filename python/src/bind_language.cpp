// SPDX-License-Identifier: MIT
// Questions in words about saved maps: ask.
#include <algorithm>

#include "crossnav/language/answer.h"
#include "crossnav/language/map_home.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "crossnav/store/map_file.h"
#include "map_handle.h"

namespace crossnav::python {
namespace {

using language::KnownHome;

template <class T>
nb::object OrNone(const std::optional<T>& value) {
  return value ? nb::cast(*value) : nb::none();
}

nb::dict RoomDict(int room, const KnownHome& home) {
  nb::dict out;
  out["id"] = room;
  out["type"] = language::TextOf(home.rooms[room].fits);
  out["floor"] = home.rooms[room].floor;
  out["looked_at"] = home.rooms[room].looked_at;
  return out;
}

nb::list RoomList(const std::vector<int>& rooms, const KnownHome& home) {
  nb::list out;
  for (const int room : rooms) out.append(RoomDict(room, home));
  return out;
}

nb::dict ThingDict(const language::Thing& thing, const KnownHome& home,
                   const std::vector<objects::ObjectRecord>& records) {
  nb::dict out;
  out["category"] = thing.category;
  out["center"] = ToArray(thing.p_center_world);
  out["floor"] = OrNone(thing.floor);
  out["floor_name"] = thing.floor ? language::FloorText(*thing.floor, home) : "";
  out["room"] = thing.room ? nb::object(RoomDict(*thing.room, home)) : nb::none();
  out["confidence"] = thing.confidence;
  out["certain"] = thing.is_certain;
  out["last_seen"] = nb::none();
  if (thing.last_seen) {
    nb::dict seen;
    seen["day"] = thing.last_seen->day + 1;
    seen["step"] = thing.last_seen->step;
    out["last_seen"] = seen;
  }
  out["picture_png"] = nb::none();
  if (thing.record >= 0 && !records[thing.record].picture_png.empty()) {
    const auto& png = records[thing.record].picture_png;
    out["picture_png"] = nb::bytes(png.data(), png.size());
  }
  return out;
}

/// The texts of the map's features: `encode` of the user, else ground truth's.
language::EncodeText EncoderOf(const nb::object& encode, const store::MapHeader& header,
                               const evaluation::RunConfig& config,
                               std::unique_ptr<perception::DenseEncoder>& truth) {
  if (!encode.is_none())
    return [encode](const std::string& text) -> Result<std::vector<float>> {
      const nb::object vector =
          nb::module_::import_("numpy").attr("ascontiguousarray")(encode(text), "float32");
      VectorIn array;
      if (!nb::try_cast(vector, array))
        return Fail(ErrorCode::kInvalid, "must return a vector of numbers", "encode");
      return std::vector<float>(array.data(), array.data() + array.size());
    };
  sim::GroundTruthConfig texts = config.ground_truth;
  if (!header.encoder_name.empty() && header.encoder_name != sim::EncoderName(texts))
    Raise(ErrorCode::kMismatch,
          "its features are of " + header.encoder_name + "; give encode=, a text's vector in them",
          "ask");
  if (header.feature_dim > 0) texts.feature_dim = header.feature_dim;
  truth = Unwrap(sim::MakeGroundTruthTexts(texts));
  return [&truth](const std::string& text) { return truth->EncodeText(text); };
}

nb::dict Ask(const PathIn& path, const std::string& question_text, const Settings& settings,
             const nb::object& encode, const std::optional<Point>& from, int ground_floor,
             bool skip_damaged) {
  const auto question = Unwrap(language::ParseQuestion(question_text));
  const evaluation::RunConfig config = ConfigOf(settings);
  const auto header = Unwrap(store::ReadMapHeader(path.path));
  store::LoadOptions load;
  load.map = config.agent.map;
  load.map->voxel_m = header.voxel_m;
  load.map->clearing = header.clearing;
  load.fusion = config.agent.fusion;
  load.skip_damaged = skip_damaged;
  const auto loaded = Unwrap(store::LoadMemory(path.path, load));
  std::unique_ptr<perception::DenseEncoder> truth;
  const auto encoder = EncoderOf(encode, header, config, truth);
  KnownHome home =
      Unwrap(language::HomeOf({loaded.map, loaded.memory, loaded.flights, loaded.objects,
                               memory::ThresholdsOf(header.encoder_name)},
                              language::NamesFor(question), encoder, config.agent.query));
  if (ground_floor < 0 || ground_floor >= std::max<int>(1, static_cast<int>(home.floors.size())))
    Raise(ErrorCode::kInvalid, "the map has no such floor", "ground_floor");
  home.ground_floor = ground_floor;
  if (from) home.p_robot_world = ToPoint(*from, "from_");
  const language::Answer answer = AnswerTo(question, home);
  nb::dict out;
  out["kind"] = std::string(language::NameOf(question.kind));
  out["answer"] = answer.text;
  out["known"] = answer.is_known;
  out["yes"] = OrNone(answer.is_true);
  out["count"] = OrNone(answer.count);
  nb::list things;
  for (const int i : answer.things) things.append(ThingDict(home.things[i], home, loaded.objects));
  out["things"] = things;
  out["rooms"] = RoomList(answer.rooms, home);
  out["not_looked_at"] = RoomList(answer.unseen, home);
  return out;
}

}  // namespace

void BindLanguage(nb::module_& m) {
  m.def("ask", &Ask, "path"_a, "question"_a, "config"_a = nb::none(), nb::kw_only(),
        "encode"_a = nb::none(), "from_"_a = nb::none(), "ground_floor"_a = 0,
        "skip_damaged"_a = false,
        nb::sig("def ask(path: str | os.PathLike[str], question: str, config: "
                "crossnav._config.Settings = None, *, encode: "
                "collections.abc.Callable[[str], typing.Any] | None = None, from_: "
                "collections.abc.Sequence[float] | None = None, ground_floor: int = 0, "
                "skip_damaged: bool = False) -> dict[str, typing.Any]"),
        "Answers a question in words about a saved map, as `crossnav ask` does. `encode` gives a "
        "text's vector in the space of the map's features; ground truth's without it. `from_` is "
        "the foot point of who asks. The key `known` says whether the map can tell.");
}

}  // namespace crossnav::python
