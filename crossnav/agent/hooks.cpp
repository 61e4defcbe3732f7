// SPDX-License-Identifier: MIT
#include "crossnav/agent/hooks.h"

namespace crossnav::agent {

std::vector<double> Hooks::ScoreExploration(const Situation& /*now*/,
                                            std::span<const ExplorationOption> options) {
  std::vector<double> scores;
  for (const ExplorationOption& option : options) scores.push_back(option.score_m);
  return scores;
}

policy::ClaimVerdict Hooks::JudgeClaim(const Situation& /*now*/, const Claim& claim) {
  return claim.verdict;
}

}  // namespace crossnav::agent
