// SPDX-License-Identifier: MIT
#include "crossnav/agent/patience.h"

#include <variant>

#include "crossnav/agent/settle.h"

namespace crossnav::agent {

void LosePatience(StepState& now) {
  constexpr double kLeast = 0.5;  // chosen: a wrong STOP costs as much as none
  if (std::holds_alternative<Approach>(PursuitOf(now.goal.full.activity))) return;
  const policy::RejectedObject* claim = LikeliestRefuted(now, kLeast);
  if (!claim) return;
  const double patience = now.config.verify.patience * (1 - claim->probability);
  if (now.world.step - claim->step < patience) return;
  now.goal.events.push_back("no better claim in time");
  SettleFor(now, claim->poi_id);
}

}  // namespace crossnav::agent
