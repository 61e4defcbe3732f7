// SPDX-License-Identifier: MIT
#include "crossnav/language/answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "crossnav/language/resolve.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::language {
namespace {

std::string Counted(int count, std::string_view noun) {
  return fmt::format("{} {}", count, count == 1 ? std::string(noun) : PluralOf(noun));
}

/// "the plant: kitchen (room 0) on the ground floor, at (...); last seen on day 2, step 40; ..."
std::string ThingText(const Thing& thing, const KnownHome& home) {
  const Vector3d& p = thing.p_center_world;
  std::string text = fmt::format("  {}: {}, at ({:.2f}, {:.2f}, {:.2f})", thing.category,
                                 PlaceText(thing, home), p.x(), p.y(), p.z());
  if (thing.last_seen)
    text += fmt::format("; last seen on day {}, step {}", thing.last_seen->day + 1,
                        thing.last_seen->step);
  text += fmt::format("; {} {:.2f}\n", thing.is_certain ? "confidence" : "match", thing.confidence);
  return text;
}

std::string ThingsText(const std::vector<int>& things, const KnownHome& home) {
  std::string text;
  for (const int i : things) text += ThingText(home.things[i], home);
  return text;
}

std::string UnseenText(const std::vector<int>& unseen, const KnownHome& home) {
  if (unseen.empty()) return "";
  std::string text = "  not looked at:";
  for (std::size_t i = 0; i < unseen.size(); ++i)
    text += (i == 0 ? " " : ", ") + RoomText(unseen[i], home);
  return text + "\n";
}

/// Fitting objects, the last seen first; possible ones if no object fits.
std::vector<int> Fitting(const Description& subject, const KnownHome& home) {
  std::vector<int> things;
  if (subject.order != 0 || subject.size) {
    const Resolution resolved = Resolve(subject, home);
    if (resolved.outcome == Outcome::kFound || resolved.outcome == Outcome::kAmbiguous)
      things = resolved.things;
  } else {
    things = AllThatFit(subject, home, Fit::kYes);
    if (things.empty()) things = AllThatFit(subject, home, Fit::kMaybe);
  }
  std::stable_sort(things.begin(), things.end(), [&](int a, int b) {
    const auto& x = home.things[a].last_seen;
    const auto& y = home.things[b].last_seen;
    const auto key = [](const std::optional<LastSeen>& seen) {
      return seen ? std::pair<int, std::int64_t>(seen->day, seen->step)
                  : std::pair<int, std::int64_t>(-1, 0);
    };
    return key(x) > key(y);
  });
  return things;
}

bool AreSure(const std::vector<int>& things, const Description& subject, const KnownHome& home) {
  return std::all_of(things.begin(), things.end(), [&](int i) {
    return home.things[i].is_certain && FitOf(subject, home, home.things[i]) == Fit::kYes;
  });
}

/// The subject's own words without the article: "chair", "red chair near the table upstairs".
std::string SubjectText(const Description& subject) {
  const std::string text = TextOf(subject);
  return text.substr(text.find(' ') + 1);
}

/// Reason for an empty result.
std::string NothingText(const Description& subject, const KnownHome& home) {
  const Resolution none = Resolve(subject, home);
  const std::string what = SubjectText(subject);
  if (none.outcome == Outcome::kAbsent)
    return fmt::format("there is no {}: {}\n", what, none.reason);
  return fmt::format("no {} is known{}\n", what, none.reason.empty() ? "" : ": " + none.reason);
}

Answer Where(const Question& question, const KnownHome& home) {
  Answer answer;
  answer.things = Fitting(question.subject, home);
  answer.unseen = UnseenRooms(question.subject, home);
  if (answer.things.empty()) {
    answer.is_known = Resolve(question.subject, home).outcome == Outcome::kAbsent;
    answer.text = NothingText(question.subject, home) + UnseenText(answer.unseen, home);
    return answer;
  }
  answer.is_known = AreSure(answer.things, question.subject, home);
  answer.text = fmt::format("{}{}\n", answer.is_known ? "" : "perhaps ",
                            Counted(static_cast<int>(answer.things.size()), question.subject.noun));
  answer.text += ThingsText(answer.things, home);
  return answer;
}

Answer HowMany(const Question& question, const KnownHome& home) {
  Answer answer;
  answer.things = AllThatFit(question.subject, home, Fit::kYes);
  const auto maybe = AllThatFit(question.subject, home, Fit::kMaybe);
  answer.unseen = UnseenRooms(question.subject, home);
  const auto count = static_cast<int>(answer.things.size());
  const int doubtful = static_cast<int>(maybe.size()) - count;
  answer.count = count;
  answer.is_known =
      answer.unseen.empty() && doubtful == 0 && AreSure(answer.things, question.subject, home);
  answer.text = Counted(count, question.subject.noun);
  if (doubtful > 0) answer.text += fmt::format("; {} more may fit", doubtful);
  if (!answer.unseen.empty()) answer.text += "; there may be more where nobody looked";
  answer.text += "\n" + ThingsText(answer.things, home) + UnseenText(answer.unseen, home);
  return answer;
}

Answer IsThere(const Question& question, const KnownHome& home) {
  Answer answer = Where(question, home);
  if (!answer.things.empty() && answer.is_known) {
    answer.is_true = true;
    answer.text = "yes: " + answer.text;
  } else if (answer.things.empty() && answer.is_known) {
    answer.is_true = false;
    answer.text = "no: " + answer.text;
  } else {
    answer.text = "not known: " + answer.text;
  }
  return answer;
}

Answer WhatIs(const Question& question, const KnownHome& home) {
  Answer answer;
  answer.things = AllThatFit(question.subject, home, Fit::kYes);
  if (answer.things.empty()) answer.things = AllThatFit(question.subject, home, Fit::kMaybe);
  answer.unseen =
      question.subject.relations.empty() ? UnseenRooms(question.subject, home) : std::vector<int>();
  answer.is_known = answer.unseen.empty() && AreSure(answer.things, question.subject, home);
  const bool is_landmark_known =
      std::all_of(question.subject.relations.begin(), question.subject.relations.end(),
                  [&](const RelationPhrase& phrase) {
                    return !AllThatFit(phrase.landmark, home, Fit::kMaybe).empty();
                  });
  if (!is_landmark_known) {
    answer.is_known = false;
    answer.text = NothingText(question.subject.relations.front().landmark, home);
    return answer;
  }
  answer.text = answer.things.empty()
                    ? "nothing that is known\n"
                    : Counted(static_cast<int>(answer.things.size()), "thing") + "\n";
  answer.text += ThingsText(answer.things, home) + UnseenText(answer.unseen, home);
  return answer;
}

/// Rooms of the floor and type that the subject names.
bool IsAsked(const KnownRoom& room, const Description& subject, const KnownHome& home) {
  if (subject.room && room.fits[static_cast<int>(*subject.room)] == Fit::kNo) return false;
  if (!subject.floor) return true;
  const auto floors = FloorsOf(*subject.floor, home);
  return std::find(floors.begin(), floors.end(), room.floor) != floors.end();
}

/// Best fit among the things in the room.
Fit HeldBy(int room, const Description& subject, const KnownHome& home) {
  Fit best = subject.noun.empty() ? Fit::kYes : Fit::kNo;
  for (const Thing& thing : home.things)
    if (thing.room == room) best = std::max(best, FitOf(subject, home, thing));
  return best;
}

Answer WhichRooms(const Question& question, const KnownHome& home) {
  Answer answer;
  const Description& subject = question.subject;
  for (std::size_t i = 0; i < home.rooms.size(); ++i) {
    if (!IsAsked(home.rooms[i], subject, home)) continue;
    const auto room = static_cast<int>(i);
    const Fit held = HeldBy(room, subject, home);
    const bool is_told = held == Fit::kYes || home.rooms[i].WasLookedAt();
    if (!is_told || held == Fit::kMaybe) {
      answer.unseen.push_back(room);
    } else if ((held == Fit::kYes) != question.is_negated) {
      answer.rooms.push_back(room);
    }
  }
  answer.is_known = answer.unseen.empty();
  answer.text = Counted(static_cast<int>(answer.rooms.size()), "room") + "\n";
  for (const int room : answer.rooms) answer.text += "  " + RoomText(room, home) + "\n";
  if (!answer.unseen.empty()) answer.text += "  not known:";
  for (const int room : answer.unseen) answer.text += " " + RoomText(room, home) + ";";
  if (!answer.unseen.empty()) answer.text.back() = '\n';
  if (question.is_count) answer.count = static_cast<int>(answer.rooms.size());
  return answer;
}

/// Whether counts and lists are of a floor that the map does not have: they would be of nothing.
bool IsOfUnknownFloor(const Question& question, const KnownHome& home) {
  const bool lists = question.kind == QuestionKind::kHowMany ||
                     question.kind == QuestionKind::kWhatIs ||
                     question.kind == QuestionKind::kWhichRooms;
  return lists && question.subject.floor && FloorsOf(*question.subject.floor, home).empty();
}

Answer UnknownFloor(const KnownHome& home) {
  Answer answer;
  answer.is_known = false;
  answer.text = "not known: no such floor is known; the map has " +
                Counted(static_cast<int>(home.floors.size()), "floor") + "\n";
  return answer;
}

}  // namespace

Answer AnswerTo(const Question& question, const KnownHome& home) {
  if (IsOfUnknownFloor(question, home)) return UnknownFloor(home);
  switch (question.kind) {
    case QuestionKind::kWhere:
      return Where(question, home);
    case QuestionKind::kHowMany:
      return HowMany(question, home);
    case QuestionKind::kIsThere:
      return IsThere(question, home);
    case QuestionKind::kWhatIs:
      return WhatIs(question, home);
    case QuestionKind::kWhichRooms:
      return WhichRooms(question, home);
    case QuestionKind::kHowManyFloors:
      break;
  }
  Answer floors;
  floors.count = static_cast<int>(home.floors.size());
  floors.text = Counted(*floors.count, "floor") + "\n";
  return floors;
}

std::string FloorText(int floor, const KnownHome& home) {
  const int number = floor - home.ground_floor;
  if (number < 0) return "basement";
  return number == 0 ? "ground floor" : OrdinalOf(number) + " floor";
}

std::string RoomText(int room, const KnownHome& home) {
  const std::string type = TextOf(home.rooms[room].fits);
  const int floor = home.rooms[room].floor;
  return fmt::format("room {}{} {} the {}", room, type.empty() ? "" : " (" + type + ")",
                     floor < home.ground_floor ? "in" : "on", FloorText(floor, home));
}

std::string PlaceText(const Thing& thing, const KnownHome& home) {
  if (thing.room) return RoomText(*thing.room, home);
  return thing.floor ? FloorText(*thing.floor, home) : "on no floor that is known";
}

}  // namespace crossnav::language
