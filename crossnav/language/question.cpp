// SPDX-License-Identifier: MIT
#include "crossnav/language/question.h"

#include <set>
#include <utility>

#include "crossnav/language/parse_description.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::language {
namespace {

constexpr std::string_view kOpenings =
    "where is, where did I last see, how many, is there, what is, which rooms have";

bool TakesWhere(WordStream& words) {
  return words.Take({"where did i last see", "where did you last see", "where did i see",
                     "where did you see", "when did i last see", "when did you last see",
                     "where have you seen", "where can i find", "where do i find", "where is",
                     "where are", "where was", "where were", "wheres", "find", "show me"});
}

bool TakesWhat(WordStream& words) {
  return words.Take({"what is there", "what things are", "what stands", "what is", "what are",
                     "what was", "whats", "what lies", "which things are"});
}

void AddNames(const Description& d, std::set<std::string>& names) {
  if (!d.noun.empty())
    for (std::string& kind : KindsOf(d.noun)) names.insert(std::move(kind));
  for (const RelationPhrase& phrase : d.relations) AddNames(phrase.landmark, names);
}

/// "how many" and "which": "how many rooms are upstairs", "which rooms have no plant".
Result<Question> ParseRooms(WordStream& words, Question question) {
  question.kind = QuestionKind::kWhichRooms;
  (void)words.Take({"are there", "do you know", "are", "is there"});
  while (ParsePlace(words, &question.subject)) {
  }
  if (words.Take({"have", "has", "hold", "holds", "contain", "with", "without", "lack"})) {
    const std::size_t mark = words.Mark();
    words.Return(mark - 1);
    question.is_negated = words.Take({"without", "lack"});
    words.Return(mark);
    question.is_negated |= words.Take({"no", "not any", "not a"});
    auto subject = ParseDescription(words);
    if (!subject) return tl::unexpected(subject.error());
    const Description where = std::exchange(question.subject, std::move(*subject));
    if (where.floor) question.subject.floor = where.floor;
    if (where.room) question.subject.room = where.room;
    return question;
  }
  if (auto ok = ParsePlaces(words, &question.subject); !ok) return tl::unexpected(ok.error());
  return question;
}

/// "how many chairs are (there) upstairs": a description with a verb in it.
Result<Question> ParseCount(WordStream& words, Question question) {
  question.kind = QuestionKind::kHowMany;
  const auto colour = words.TakeFrom(ColourWords());
  const auto noun = words.TakeFrom(ThingWords());
  if (!noun) return tl::unexpected(NotUnderstood(words, "a thing"));
  question.subject.noun = *noun;
  question.subject.colour = colour;
  (void)words.Take({"are there", "are", "is there", "do i have", "do we have", "did you see",
                    "do you know", "stand", "were there"});
  if (auto ok = ParsePlaces(words, &question.subject); !ok) return tl::unexpected(ok.error());
  return question;
}

Result<Question> ParseAbout(WordStream& words, QuestionKind kind) {
  Question question;
  question.kind = kind;
  auto subject = ParseDescription(words);
  if (!subject) return tl::unexpected(subject.error());
  question.subject = std::move(*subject);
  return question;
}

}  // namespace

std::string_view NameOf(QuestionKind kind) {
  constexpr std::string_view kNames[] = {"where",   "how many",    "is there",
                                         "what is", "which rooms", "how many floors"};
  return kNames[static_cast<int>(kind)];
}

Result<Question> ParseQuestion(std::string_view text) {
  auto stream = WordStream::Of(text);
  if (!stream) return tl::unexpected(stream.error());
  WordStream& words = *stream;
  (void)words.Take({"please", "and", "so"});
  Question question;
  if (words.Take({"how many"})) {
    question.is_count = true;
    if (words.Take({"rooms"})) return ParseRooms(words, question);
    if (words.Take({"floors", "storeys", "levels"})) {
      question.kind = QuestionKind::kHowManyFloors;
      (void)words.Take({"are there", "do you know", "does the house have"});
      if (!words.IsAtEnd()) return tl::unexpected(NotUnderstood(words, "the end"));
      return question;
    }
    return ParseCount(words, question);
  }
  if (words.Take({"which room is", "which room are", "what room is", "which floor is",
                  "which floor are", "what floor is", "on which floor is", "in which room is"})) {
    words.DropLast({"in", "on", "at"});  // "which room is the bed in" asks for its place
    return ParseAbout(words, QuestionKind::kWhere);
  }
  if (words.Take({"which rooms", "what rooms", "which room", "what room"}))
    return ParseRooms(words, question);
  if (words.Take({"is there", "are there", "was there", "do i have", "do we have", "have we got"}))
    return ParseAbout(words, QuestionKind::kIsThere);
  if (TakesWhere(words)) return ParseAbout(words, QuestionKind::kWhere);
  if (TakesWhat(words)) {
    question.kind = QuestionKind::kWhatIs;
    if (words.IsAtEnd()) return tl::unexpected(NotUnderstood(words, "a place"));
    if (auto ok = ParsePlaces(words, &question.subject); !ok) return tl::unexpected(ok.error());
    return question;
  }
  return tl::unexpected(NotUnderstood(words, kOpenings));
}

std::vector<std::string> NamesFor(const Description& description) {
  std::set<std::string> names(TellingNames().begin(), TellingNames().end());
  AddNames(description, names);
  return {names.begin(), names.end()};
}

std::vector<std::string> NamesFor(const Question& question) {
  std::vector<std::string> names = NamesFor(question.subject);
  if (question.kind != QuestionKind::kWhatIs) return names;
  std::set<std::string> all(names.begin(), names.end());
  for (const auto& [said, name] : ThingWords()) all.insert(name);
  return {all.begin(), all.end()};
}

}  // namespace crossnav::language
