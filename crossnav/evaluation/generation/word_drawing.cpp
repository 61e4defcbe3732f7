// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/generation/word_drawing.h"

#include <algorithm>
#include <array>
#include <set>

#include "crossnav/language/box_relation.h"
#include "crossnav/language/resolve.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::evaluation {
namespace {

using language::Description;
using language::Fit;
using language::KnownHome;
using language::Thing;

constexpr double kClearlyNearer_m = 0.7;  // chosen: between the first and the second of an order
constexpr int kTries = 40;                // chosen: a description wanted

enum class Word { kFloor, kRoom, kColour, kRelation, kSize, kOrder };

int Pick(std::size_t count, Rng& rng) {
  return static_cast<int>(rng.Below(static_cast<std::uint32_t>(count)));
}

std::optional<language::FloorPhrase> FloorOf(const KnownHome& home, const Thing& thing, Rng& rng) {
  using language::FloorWord;
  std::vector<language::FloorPhrase> phrases = {
      {FloorWord::kUpstairs, 0},
      {FloorWord::kDownstairs, 0},
      {FloorWord::kTop, 0},
      {FloorWord::kNumber, thing.floor.value_or(0) - home.ground_floor}};
  const bool is_relative_clear = home.p_robot_world || home.floors.size() == 2;
  std::erase_if(phrases, [&](const auto& phrase) {
    if (!is_relative_clear &&
        (phrase.word == FloorWord::kUpstairs || phrase.word == FloorWord::kDownstairs))
      return true;
    const auto floors = FloorsOf(phrase, home);
    return phrase.number < 0 ||
           std::find(floors.begin(), floors.end(), thing.floor) == floors.end();
  });
  if (phrases.empty() || home.floors.size() < 2) return std::nullopt;
  return phrases[Pick(phrases.size(), rng)];
}

/// A relation to something of another kind that surely holds.
std::optional<language::RelationPhrase> RelationOf(const KnownHome& home, const Thing& thing,
                                                   Rng& rng) {
  std::vector<language::RelationPhrase> phrases;
  for (const Thing& other : home.things) {
    if (other.category == thing.category || other.room != thing.room) continue;
    for (int i = 0; i < language::kRelations; ++i) {
      const auto relation = static_cast<language::Relation>(i);
      if (HoldsFor(relation, thing.box, other.box) != Fit::kYes) continue;
      Description landmark;
      landmark.noun = other.category;
      landmark.is_definite = true;
      phrases.push_back({relation, std::move(landmark)});
    }
  }
  if (phrases.empty()) return std::nullopt;
  return phrases[Pick(phrases.size(), rng)];
}

void Say(Word word, const KnownHome& home, const Thing& thing, Description& d, Rng& rng) {
  switch (word) {
    case Word::kFloor:
      d.floor = FloorOf(home, thing, rng);
      return;
    case Word::kRoom:
      if (!thing.room) return;
      for (int i = 0; i < language::kRoomTypes; ++i)
        if (home.rooms[*thing.room].fits[i] == Fit::kYes && (!d.room || rng.Chance(0.5)))
          d.room = static_cast<language::RoomType>(i);
      return;
    case Word::kColour:
      if (thing.colour) d.colour = language::NameColour(*thing.colour);
      return;
    case Word::kRelation:
      if (const auto phrase = RelationOf(home, thing, rng)) d.relations = {*phrase};
      return;
    case Word::kSize:
      d.size = rng.Chance(0.5) ? language::SizeWord::kBig : language::SizeWord::kSmall;
      return;
    case Word::kOrder: {
      const auto all = AllThatFit(d, home, Fit::kYes);
      for (std::size_t i = 0; i < all.size() && i < 3; ++i)
        if (&home.things[all[i]] == &thing) d.order = static_cast<int>(i) + 1;
      return;
    }
  }
}

/// No thing fits by halves.
bool HasMargin(const Description& d, const KnownHome& home) {
  return AllThatFit(d, home, Fit::kYes).size() == AllThatFit(d, home, Fit::kMaybe).size();
}

/// Neighbours in the order are clearly apart, and nobody stands between two floors.
bool IsOrderClear(const Description& d, const KnownHome& home) {
  if (d.order == 0) return true;
  if (!home.p_robot_world) return false;
  const auto all = AllThatFit(d, home, Fit::kYes);
  const auto away = [&](int i) {
    return (home.things[i].p_center_world - *home.p_robot_world).head<2>().norm();
  };
  const auto own = FloorOf(home, *home.p_robot_world);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (home.things[all[i]].floor != own) return static_cast<int>(i) > d.order - 1;
    if (home.things[all[i + 1]].floor == own && away(all[i + 1]) - away(all[i]) < kClearlyNearer_m)
      return false;
  }
  return all.empty() || home.things[all[d.order - 1]].floor == own;
}

bool Means(const Description& d, const KnownHome& home, int thing) {
  if (!HasMargin(d, home) || !IsOrderClear(d, home)) return false;
  const auto resolved = Resolve(d, home);
  return resolved.outcome == language::Outcome::kFound && resolved.is_sure &&
         resolved.things.front() == thing;
}

constexpr std::array kWords = {Word::kFloor,    Word::kRoom, Word::kColour,
                               Word::kRelation, Word::kSize, Word::kOrder};

/// Word after word until it is clear.
std::optional<DrawnWords> DrawClear(const KnownHome& home, int thing, Description d, Rng& rng) {
  auto words = kWords;
  rng.Shuffle(words);
  const bool wants_more = rng.Chance(0.5);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if ((i > 0 || !wants_more) && Means(d, home, thing))
      return DrawnWords{WordKind::kClear, d, thing};
    if (d.size || d.order != 0) return std::nullopt;  // they are said of all the rest
    Say(words[i], home, home.things[thing], d, rng);
  }
  return std::nullopt;
}

/// One or two attributes that do not identify the object.
std::optional<DrawnWords> DrawAmbiguous(const KnownHome& home, int thing, Description d, Rng& rng) {
  for (int i = Pick(3, rng); i > 0; --i)
    Say(kWords[rng.Below(4)], home, home.things[thing], d, rng);
  if (!HasMargin(d, home) || AllThatFit(d, home, Fit::kYes).size() < 2) return std::nullopt;
  return DrawnWords{WordKind::kAmbiguous, d, -1};
}

/// Words of one thing, one of them changed.
std::optional<DrawnWords> DrawImpossible(const KnownHome& home, int thing, Description d,
                                         Rng& rng) {
  for (int i = Pick(3, rng); i > 0; --i)
    Say(kWords[rng.Below(4)], home, home.things[thing], d, rng);
  const int other = Pick(home.things.size(), rng);
  switch (rng.Below(4)) {
    case 0:
      d.colour = static_cast<language::Colour>(rng.Below(language::kColours));
      break;
    case 1:
      d.room = static_cast<language::RoomType>(rng.Below(language::kRoomTypes));
      break;
    case 2:
      d.floor = FloorOf(home, home.things[other], rng);
      break;
    default: {
      Description landmark;
      landmark.noun = home.things[other].category;
      landmark.is_definite = true;
      d.relations = {{rng.Chance(0.5) ? language::Relation::kNextTo : language::Relation::kOn,
                      std::move(landmark)}};
    }
  }
  if (!AllThatFit(d, home, Fit::kMaybe).empty()) return std::nullopt;
  return DrawnWords{WordKind::kImpossible, d, -1};
}

}  // namespace

std::string_view NameOf(WordKind kind) {
  constexpr std::string_view kNames[kWordKinds] = {"clear", "ambiguous", "impossible"};
  return kNames[static_cast<int>(kind)];
}

std::vector<DrawnWords> DrawWords(const KnownHome& home, WordKind kind, int count,
                                  const std::vector<std::string>& nouns, Rng& rng) {
  std::vector<int> things;
  for (std::size_t i = 0; i < home.things.size(); ++i)
    if (nouns.empty() ||
        std::find(nouns.begin(), nouns.end(), home.things[i].category) != nouns.end())
      things.push_back(static_cast<int>(i));
  std::vector<DrawnWords> drawn;
  std::set<std::string> texts;
  if (things.empty()) return drawn;
  for (int i = 0; i < kTries * count && static_cast<int>(drawn.size()) < count; ++i) {
    const int thing = things[Pick(things.size(), rng)];
    Description d;
    d.noun = home.things[thing].category;
    d.is_definite = true;
    auto words = kind == WordKind::kClear       ? DrawClear(home, thing, d, rng)
                 : kind == WordKind::kAmbiguous ? DrawAmbiguous(home, thing, d, rng)
                                                : DrawImpossible(home, thing, d, rng);
    if (words && texts.insert(TextOf(words->description)).second) drawn.push_back(*words);
  }
  return drawn;
}

}  // namespace crossnav::evaluation
