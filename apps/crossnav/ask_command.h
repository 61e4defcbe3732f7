// SPDX-License-Identifier: MIT
// `ask`: a question in words about a saved map.
#pragma once

#include <string>
#include <vector>

#include "commands.h"

namespace crossnav::app {

struct AskOptions {
  std::string file, question;
  std::vector<double> from;  ///< foot point of who asks, world [m]; empty = nobody stands anywhere
  int ground_floor = 0;      ///< index of the ground floor, lowest 0
  std::string pictures;      ///< folder for the pictures of things; empty = none
  bool skip_damaged = false;
};
Result<void> Ask(const AskOptions& options, const CommonOptions& common, Console& console);

/// `bench words`: descriptions of things in generated houses against the truth.
struct WordBenchOptions {
  std::uint64_t seed = 301;
  int count = 10, each = 12;
  bool with_failures = false;
};
struct PictureBenchOptions {
  std::uint64_t seed = 301;
  int count = 10, each = 3;
  std::string perception;  ///< oracle | networks; empty = eval.perception
};
Result<void> BenchPictures(const PictureBenchOptions& options, const CommonOptions& common,
                           Console& console);
Result<void> BenchWords(const WordBenchOptions& options, const CommonOptions& common,
                        Console& console);

}  // namespace crossnav::app
