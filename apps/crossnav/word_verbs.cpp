// SPDX-License-Identifier: MIT
// `ask`, `bench words` and `bench pictures`.
#include "verbs.h"

namespace crossnav::app {

void AddAsk(CLI::App& app, Options& o) {
  CLI::App* ask = AddVerb(app, o, "ask", "A question in words about a saved map",
                          "crossnav ask home.map \"where did I last see a toilet?\"",
                          [&o](Console& c) { return Ask(o.ask, o.common, c); });
  ask->add_option("MAP", o.ask.file, "Map file")->required();
  ask->add_option(
         "QUESTION", o.ask.question,
         "where is, where did I last see, how many, is there, what is on, which rooms have")
      ->required();
  ask->add_option("--from", o.ask.from,
                  "Where you stand (foot point [m]): what first, nearest and upstairs start from")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  ask->add_option("--ground-floor", o.ask.ground_floor, "Number of the ground floor, lowest 0")
      ->check(CLI::Range(0, 100));
  ask->add_option("--pictures", o.ask.pictures, "Folder for the pictures of what is found");
  ask->add_flag("--skip-damaged", o.ask.skip_damaged, "Go on with what is intact");
}

void AddWordTrials(CLI::App& bench, Options& o) {
  CLI::App* words =
      AddVerb(bench, o, "words", "Descriptions of things in generated houses against the truth",
              "crossnav bench words --seed 7001 --count 10",
              [&o](Console& c) { return BenchWords(o.word_bench, o.common, c); });
  words->add_option("--seed", o.word_bench.seed, "Of the first house");
  words->add_option("--count", o.word_bench.count, "Houses")->check(CLI::Range(1, 100000));
  words->add_option("--each", o.word_bench.each, "Descriptions of each kind a house")
      ->check(CLI::Range(1, 10000));
  words->add_flag("--failures", o.word_bench.with_failures, "List what was understood wrongly");
  CLI::App* pictures =
      AddVerb(bench, o, "pictures", "Pictures of objects of generated houses, found in their maps",
              "crossnav bench pictures --seed 301 --count 10",
              [&o](Console& c) { return BenchPictures(o.picture_bench, o.common, c); });
  pictures->add_option("--seed", o.picture_bench.seed, "Of the first house");
  pictures->add_option("--count", o.picture_bench.count, "Houses")->check(CLI::Range(1, 100000));
  pictures->add_option("--each", o.picture_bench.each, "Pictures of each category a house")
      ->check(CLI::Range(1, 1000));
  pictures->add_option("--perception", o.picture_bench.perception,
                       "oracle (ground truth), or networks; default: eval.perception");
}

}  // namespace crossnav::app
