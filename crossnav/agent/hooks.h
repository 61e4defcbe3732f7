// SPDX-License-Identifier: MIT
// Hooks: the two decisions that studies replace, namely where to look next and whether to believe a
// claim. Each hook receives the policy's own answer and may return it, so that each can be replaced
// alone. For policy.profile = full. World frame, metres.
#pragma once

#include <span>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// A place that could be looked at next.
struct ExplorationOption {
  policy::Candidate candidate;
  double path_m = 0;   ///< to it; the turns before the first step count as metres
  double score_m = 0;  ///< price of the policy: path_m plus the price of the class
};

/// A claim that this frame makes about an object of the goal.
struct Claim {
  const policy::LivePoi& poi;
  const policy::Verification& verification;                    ///< by the policy's own checks
  policy::ClaimVerdict verdict = policy::ClaimVerdict::kWeak;  ///< the policy's own
};

/// Overrides may throw; the exception leaves Agent::Step, after which the agent is of no use.
class Hooks {
 public:
  virtual ~Hooks() = default;

  /// A score for each option, the least is gone to, infinity is never. Asked when the agent chooses
  /// (policy.explore.reconsider_steps), with every option that can be reached.
  virtual std::vector<double> ScoreExploration(const Situation& now,
                                               std::span<const ExplorationOption> options);

  /// Called for each stable object in view. kAgreed stops now, kWeak looks from elsewhere, kRefuted
  /// gives the object up.
  virtual policy::ClaimVerdict JudgeClaim(const Situation& now, const Claim& claim);
};

}  // namespace crossnav::agent
