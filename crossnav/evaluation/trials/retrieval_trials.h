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
#include "crossnav/memory/query_match.h"
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

/// A word asked of a house or a part of it, and its match under each choice
/// (memory/query_match.h).
struct RetrievalQuery {
  std::string house, word;
  bool is_there = false;
  std::vector<double> match;
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

/// Asks the house for all `words`: whole, and in parts of eight places each, as a robot knows it
/// that has not been everywhere. Places are counted in the whole house. A word that is not there is
/// left out where the encoder holds it for a name that is (cosine above 0.9).
Result<RetrievalTrial> TryRetrieval(const sim::Scene& scene, const std::set<std::string>& words,
                                    const std::vector<RetrievalChoice>& choices,
                                    const MakeEncoder& make_encoder, const RunConfig& config);

/// Verdicts on words of one kind: those that are there, or those that are not.
struct VerdictCount {
  int asked = 0, present = 0, absent = 0;  ///< the rest is unknown
};

/// Verdicts under `choice`, and how often they are right at even odds: of as many words that are
/// there as are not.
struct PresenceVerdicts {
  memory::MatchThresholds thresholds;
  VerdictCount there, not_there;
  double PresentIsRight() const;
  double AbsentIsRight() const;
};
PresenceVerdicts CountVerdicts(const std::vector<RetrievalQuery>& queries, std::size_t choice,
                               const memory::MatchThresholds& thresholds);

/// Least `present_from` and greatest `absent_below` from which on a verdict is right in 85 of 100
/// cases (chosen); where they would overlap, the threshold between that errs least. Nothing where
/// no match decides that well, or with fewer than ten questions of either kind.
std::optional<PresenceVerdicts> ChoosePresence(const std::vector<RetrievalQuery>& queries,
                                               std::size_t choice);

/// The index of the choice with the best F1 of places; the first of equals.
std::size_t BestChoice(const std::vector<RetrievalCount>& counts);

}  // namespace crossnav::evaluation
