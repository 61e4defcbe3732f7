// SPDX-License-Identifier: MIT
#include "crossnav/language/parse_description.h"

#include "crossnav/core/nearest.h"

namespace crossnav::language {
namespace {

template <class T>
void AddWords(const WordTable<T>& table, std::vector<std::string>& words) {
  for (const auto& [said, meaning] : table) words.push_back(said);
}

/// All words of descriptions.
const std::vector<std::string>& KnownWords() {
  static const std::vector<std::string> known = [] {
    std::vector<std::string> words;
    AddWords(ThingWords(), words);
    AddWords(ColourWords(), words);
    AddWords(SizeWords(), words);
    AddWords(OrdinalWords(), words);
    AddWords(RelationWords(), words);
    AddWords(RoomWords(), words);
    AddWords(FloorWords(), words);
    return words;
  }();
  return known;
}

enum class Article { kNone, kA, kThe };

Article TakeArticle(WordStream& words) {
  if (words.Take({"the", "my", "our", "that", "this"})) return Article::kThe;
  if (words.Take({"a", "an", "any", "some", "another"})) return Article::kA;
  return Article::kNone;
}

/// "the first floor" after a preposition, but not "the first floor lamp".
std::optional<FloorPhrase> TakeFloor(WordStream& words) {
  (void)TakeArticle(words);
  const std::size_t mark = words.Mark();
  if (words.TakeFrom(OrdinalWords()) && words.TakeFrom(ThingWords())) return std::nullopt;
  words.Return(mark);
  return words.TakeFrom(FloorWords());
}

/// A room's name before a noun: "the kitchen chair". A noun may begin with a room's name.
bool TakeRoomBefore(WordStream& words, Description& d) {
  const std::size_t mark = words.Mark();
  if (words.TakeFrom(ThingWords())) {
    words.Return(mark);
    return false;
  }
  const auto room = words.TakeFrom(RoomWords());
  if (!room || d.room || words.IsAtEnd()) {
    words.Return(mark);
    return false;
  }
  d.room = room;
  return true;
}

/// Colour, size, room or floor before the noun.
bool TakeAdjective(WordStream& words, Description& d) {
  const std::size_t mark = words.Mark();
  if (const auto colour = words.TakeFrom(ColourWords())) {
    if (!d.colour) return d.colour = colour, true;
  } else if (const auto size = words.TakeFrom(SizeWords())) {
    if (!d.size) return d.size = size, true;
  } else if (const auto floor = words.TakeFrom(FloorWords())) {
    if (!d.floor) return d.floor = floor, true;
  } else {
    return TakeRoomBefore(words, d);
  }
  words.Return(mark);
  return false;
}

/// Description up to its noun.
Result<Description> ParseHead(WordStream& words) {
  Description d;
  d.is_definite = TakeArticle(words) == Article::kThe;
  // "the first floor lamp" is a lamp: nouns take precedence over floors.
  const std::size_t mark = words.Mark();
  if (const auto order = words.TakeFrom(OrdinalWords())) {
    d.order = *order;
    d.is_definite = true;
    const std::size_t after = words.Mark();
    const bool is_thing = words.TakeFrom(ThingWords()).has_value();
    words.Return(is_thing ? after : mark);
    if (!is_thing && words.TakeFrom(FloorWords())) d.order = 0;
    words.Return(d.order == 0 ? mark : after);
  }
  while (TakeAdjective(words, d)) {
  }
  const auto thing = words.TakeFrom(ThingWords());
  if (!thing) return tl::unexpected(NotUnderstood(words, "a thing, a colour or a size"));
  d.noun = *thing;
  return d;
}

/// Moves room and floor of a landmark's head ("the kitchen table") to the whole.
Result<void> GiveToWhole(const WordStream& words, Description& landmark, Description& whole) {
  if ((landmark.room && whole.room) || (landmark.floor && whole.floor))
    return Fail(ErrorCode::kInvalid, "two rooms or two floors are named", words.Quoted());
  if (landmark.room) whole.room = std::exchange(landmark.room, std::nullopt);
  if (landmark.floor) whole.floor = std::exchange(landmark.floor, std::nullopt);
  return {};
}

/// "in the kitchen", but not "in the kitchen cabinet".
std::optional<RoomType> TakeRoom(WordStream& words) {
  if (!words.Take({"in", "at", "inside", "of", "from"})) return std::nullopt;
  (void)TakeArticle(words);
  if (words.Take({"toilet", "toilets"})) return RoomType::kWc;  // the fixture contains no things
  const std::size_t mark = words.Mark();
  if (words.TakeFrom(ThingWords())) return std::nullopt;
  words.Return(mark);
  return words.TakeFrom(RoomWords());
}

}  // namespace

Error NotUnderstood(const WordStream& words, std::string_view wanted) {
  const std::string next(words.Next());
  std::string what = next.empty()
                         ? "the sentence ends where " + std::string(wanted) + " is expected"
                         : "\"" + next + "\" is not understood here; expected " +
                               std::string(wanted) + DidYouMean(next, KnownWords());
  return {ErrorCode::kInvalid, std::move(what), words.Quoted()};
}

bool ParsePlace(WordStream& words, Description* whole) {
  const std::size_t mark = words.Mark();
  if (words.Take({"up the stairs", "up there"})) {
    if (!whole->floor) return whole->floor = FloorPhrase{FloorWord::kUpstairs, 0}, true;
  } else if (const auto floor = words.TakeFrom(FloorWords())) {
    if (!whole->floor) return whole->floor = floor, true;
  } else if (words.Take({"on", "in", "at", "inside", "of", "from"})) {
    const std::size_t after = words.Mark();
    if (const auto on = TakeFloor(words); on && !whole->floor) return whole->floor = on, true;
    words.Return(mark);
    if (const auto room = TakeRoom(words); room && !whole->room) return whole->room = room, true;
    words.Return(after);
  }
  words.Return(mark);
  return false;
}

Result<void> ParsePlaces(WordStream& words, Description* whole) {
  // Nested landmarks, each with its relation. They are joined from the innermost outward at "and"
  // and at the end, because pointers into a growing vector would dangle.
  std::vector<RelationPhrase> chain;
  const auto close = [&] {
    while (chain.size() > 1) {
      RelationPhrase inner = std::move(chain.back());
      chain.pop_back();
      chain.back().landmark.relations.push_back(std::move(inner));
    }
    if (!chain.empty()) whole->relations.push_back(std::move(chain.front()));
    chain.clear();
  };
  while (!words.IsAtEnd()) {
    const bool is_and = words.Take({"and"});
    (void)words.Take({"that is", "which is", "that are", "which are", "thats", "standing",
                      "located", "hanging", "lying"});
    if (is_and) close();
    if (ParsePlace(words, whole)) continue;
    const auto relation = words.TakeFrom(RelationWords());
    if (!relation)
      return tl::unexpected(NotUnderstood(words, "a place (on, next to, in, upstairs)"));
    auto landmark = ParseHead(words);
    if (!landmark) return tl::unexpected(landmark.error());
    if (auto ok = GiveToWhole(words, *landmark, *whole); !ok) return ok;
    chain.push_back({*relation, std::move(*landmark)});
  }
  close();
  return {};
}

Result<Description> ParseDescription(WordStream& words) {
  auto whole = ParseHead(words);
  if (!whole) return whole;
  if (auto ok = ParsePlaces(words, &*whole); !ok) return tl::unexpected(ok.error());
  return whole;
}

Result<Description> ParseDescription(std::string_view text) {
  auto words = WordStream::Of(text);
  if (!words) return tl::unexpected(words.error());
  return ParseDescription(*words);
}

bool IsDescription(std::string_view text) {
  auto words = WordStream::Of(text);
  return words && TakeArticle(*words) != Article::kNone;
}

}  // namespace crossnav::language
