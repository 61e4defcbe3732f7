// SPDX-License-Identifier: MIT
// From which match on a text counts as present among ground-truth features
// (crossnav/memory/query_match.h); networks have `crossnav networks calibrate`. Usage:
// query_calibration [--clip DIR] [--lines] HOUSE_FOLDER...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/evaluation/trials/retrieval_trials.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header
using evaluation::RetrievalQuery;

struct Options {
  std::filesystem::path clip_dir;
  bool has_lines = false;
  std::vector<std::filesystem::path> houses;
};

Options Parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--clip" && i + 1 < argc) {
      options.clip_dir = argv[++i];
    } else if (word == "--lines") {
      options.has_lines = true;
    } else {
      options.houses.emplace_back(word);
    }
  }
  return options;
}

evaluation::MakeEncoder MakerOf(const Options& options) {
  return [options](const sim::Simulator& simulator) -> Result<evaluation::HeldEncoder> {
    sim::GroundTruthConfig config;
    config.clip_dir = options.clip_dir;
    auto made = sim::MakeGroundTruthEncoder(simulator, config);
    if (!made) return tl::unexpected(made.error());
    const std::shared_ptr<perception::DenseEncoder> own = std::move(*made);
    return evaluation::HeldEncoder{own.get(), own};
  };
}

void PrintTable(const std::vector<RetrievalQuery>& queries) {
  const auto count = [&](bool is_there, double from, double to) {
    return std::count_if(queries.begin(), queries.end(), [&](const RetrievalQuery& q) {
      return q.is_there == is_there && q.match[0] >= from && q.match[0] < to;
    });
  };
  std::printf("match        there  not there\n");
  for (double from = 0.1; from < 0.95; from += 0.1)
    std::printf("%.1f to %.1f  %6ld  %9ld\n", from, from + 0.1, count(true, from, from + 0.1),
                count(false, from, from + 0.1));
  for (double from = 0.40; from < 0.61; from += 0.02)
    std::printf("present from %.2f: %ld of %ld there, %ld of %ld not there\n", from,
                count(true, from, 9), count(true, -9, 9), count(false, from, 9),
                count(false, -9, 9));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  auto words = evaluation::WordsOfNoHouse();
  std::vector<sim::Scene> scenes;
  for (const auto& folder : options.houses) {
    auto scene = sim::LoadScene(folder);
    if (!scene) {
      std::fprintf(stderr, "%s\n", scene.error().Message().c_str());
      return 1;
    }
    words.merge(evaluation::WordsOf(*scene));
    scenes.push_back(std::move(*scene));
  }
  const std::vector<evaluation::RetrievalChoice> defaults = {
      evaluation::RetrievalChoices().front()};
  std::vector<RetrievalQuery> all;
  for (const sim::Scene& scene : scenes) {
    const auto trial = evaluation::TryRetrieval(scene, words, defaults, MakerOf(options), {});
    if (!trial) {
      std::fprintf(stderr, "%s\n", trial.error().Message().c_str());
      return 1;
    }
    for (const RetrievalQuery& q : trial->queries) {
      all.push_back(q);
      if (options.has_lines)
        std::printf("%s\t%s\t%d\t%.3f\n", q.house.c_str(), q.word.c_str(), q.is_there, q.match[0]);
    }
    std::fprintf(stderr, "%s: %zu queries so far\n", scene.id.c_str(), all.size());
  }
  PrintTable(all);
  return 0;
}
