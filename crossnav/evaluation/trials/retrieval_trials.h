// SPDX-License-Identifier: MIT
// Retrieval thresholds of an encoder, measured: houses are seen whole, then asked for every name
// that any of them has and for things that no house has. Answers are held against the instances.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::evaluation {

/// Settings of one query that are tried (memory::QueryConfig).
struct RetrievalChoice {
  double min_similarity = 0, min_z_score = 0, min_peak_share = 0;
};

/// Places of all queries under one choice.
struct RetrievalCount {
  int asked = 0;  ///< words that are in the house and were seen
  int found = 0;  ///< of these, with a place on an instance of that name among the best four
  int right = 0;  ///< places on such an instance
  int wrong = 0;  ///< other places, of words that are there and of words that are not

  /// Harmonic mean of found/asked and right/(right + wrong); 0 where nothing is right.
  double F1() const;
  RetrievalCount& operator+=(const RetrievalCount& other);
};

/// A word asked of a house, under the default query: how well it matches (memory/query_match.h).
struct RetrievalQuery {
  std::string house, word;
  bool is_there = false;
  double match = 0;
};

struct RetrievalTrial {
  std::vector<RetrievalQuery> queries;
  std::vector<RetrievalCount> counts;  ///< one for each choice
};

/// An encoder for the views of `simulator`; `keep` owns its dependencies.
struct HeldEncoder {
  perception::DenseEncoder* encoder = nullptr;
  std::shared_ptr<void> keep;
};
using MakeEncoder = std::function<Result<HeldEncoder>(const sim::Simulator& simulator)>;

/// Combinations that a calibration tries, the defaults of memory::QueryConfig first.
std::vector<RetrievalChoice> RetrievalChoices();

/// Names of the instances of a scene, and twenty things that no house has.
std::set<std::string> WordsOf(const sim::Scene& scene);
std::set<std::string> WordsOfNoHouse();

/// One house asked for all `words`. A word that is not there is left out where the encoder holds it
/// for a name that is (cosine above 0.9). `choices` may be empty.
Result<RetrievalTrial> TryRetrieval(const sim::Scene& scene, const std::set<std::string>& words,
                                    const std::vector<RetrievalChoice>& choices,
                                    const MakeEncoder& make_encoder, const RunConfig& config);

/// From which match on a text is present: the threshold with the greatest difference of the share
/// found and the share falsely found. Nothing where that difference is below 0.8 (chosen: a verdict
/// that errs more often is none), or with fewer than ten questions of either kind.
struct PresenceThreshold {
  std::optional<double> present_from;
  int there = 0, found = 0;        ///< words that are there; of these, at or above it
  int not_there = 0, falsely = 0;  ///< words that are not; of these, at or above it
  double separation = 0;           ///< the difference of both shares, at its best
};
PresenceThreshold ChoosePresence(const std::vector<RetrievalQuery>& queries);

/// The index of the choice with the best F1 of places; the first of equals.
std::size_t BestChoice(const std::vector<RetrievalCount>& counts);

}  // namespace crossnav::evaluation
