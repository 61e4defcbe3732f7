// SPDX-License-Identifier: MIT
// `bench words`: descriptions of things in generated houses against the truth.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ask_command.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/evaluation/trials/word_trials.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::WordScore;

Json ScoreJson(const WordScore& score) {
  const auto interval = evaluation::WilsonInterval(score.right, score.count);
  return {{"count", score.count},
          {"right", score.right},
          {"found_wrongly", score.wrong},
          {"interval", {interval.low, interval.high}}};
}

std::string Row(const std::string& name, const WordScore& score) {
  const auto interval = evaluation::WilsonInterval(score.right, score.count);
  return fmt::format("| {} | {} | {:.1f} | {:.1f} to {:.1f} | {} |\n", name, score.count,
                     score.count > 0 ? 100.0 * score.right / score.count : 0, 100 * interval.low,
                     100 * interval.high, score.wrong);
}

}  // namespace

Result<void> BenchWords(const WordBenchOptions& options, const CommonOptions& common,
                        Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  evaluation::WordTrial all;
  for (int i = 0; i < options.count; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, options.count));
    const auto trial =
        evaluation::TryWords({options.seed + static_cast<std::uint64_t>(i), options.each}, *config);
    if (!trial) return tl::unexpected(trial.error());
    all += *trial;
    for (const auto& failure : trial->failures)
      if (options.with_failures)
        console.Log(fmt::format("{}: {} \"{}\": {}", trial->house, NameOf(failure.kind),
                                failure.text, failure.outcome));
  }
  std::string table =
      fmt::format("{} of {} things have a record\n\n", all.things_found, all.things);
  table += "| descriptions | count | right % | 95 % | found wrongly |\n|---|--:|--:|---|--:|\n";
  Json kinds = Json::object(), words = Json::object();
  for (const auto& [kind, score] : all.by_kind) {
    table += Row(std::string(NameOf(kind)), score);
    kinds[std::string(NameOf(kind))] = ScoreJson(score);
  }
  WordScore refused = all.by_kind[evaluation::WordKind::kAmbiguous];
  refused += all.by_kind[evaluation::WordKind::kImpossible];
  table += Row("ambiguous or impossible", refused);
  for (const auto& [word, score] : all.by_word) {
    table += Row("clear, with " + word, score);
    words[word] = ScoreJson(score);
  }
  console.Print(table);
  console.Document(Json({{"seed", options.seed},
                         {"count", options.count},
                         {"things", all.things},
                         {"things_found", all.things_found},
                         {"kinds", std::move(kinds)},
                         {"ambiguous_or_impossible", ScoreJson(refused)},
                         {"words", std::move(words)}}));
  return {};
}

}  // namespace crossnav::app
