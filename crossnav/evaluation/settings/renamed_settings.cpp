// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/settings/renamed_settings.h"

#include <algorithm>
#include <iterator>

namespace crossnav::evaluation {
namespace {

struct RenamedKey {
  std::string_view old_key, key;
};

/// Old keys of version 0.2, read by 0.3 and refused by 0.4.
constexpr RenamedKey kRenamed[] = {
    {"policy.explore.crumb_m", "policy.explore.small_frontier_penalty_m"},
    {"policy.explore.elsewhere_m", "policy.explore.other_floor_penalty_m"},
    {"policy.explore.resemblance_steps", "policy.explore.relevancy_steps"},
    {"policy.explore.sighting_m", "policy.explore.hint_bonus_m"},
    {"policy.explore.storey_bit_m", "policy.explore.floor_prior_m_per_bit"},
};
constexpr std::string_view kEndOfOldKeys = "0.4";

}  // namespace

std::string RenamedSettings::PresentKey(const std::string& key) {
  const auto* renamed = std::find_if(std::begin(kRenamed), std::end(kRenamed),
                                     [&](const RenamedKey& r) { return r.old_key == key; });
  const bool is_old = renamed != std::end(kRenamed);
  std::string present = is_old ? std::string(renamed->key) : key;
  if (const auto [first, is_new] = given_.emplace(present, key); !is_new && first->second != key) {
    problems_.push_back("key \"" + first->second + "\" and key \"" + key +
                        "\" name one setting; keep \"" + present + "\"");
  } else if (is_old && is_new) {
    warnings_.push_back(source_ + ": key \"" + key + "\" is now \"" + present +
                        "\"; the old key is read until version " + std::string(kEndOfOldKeys));
  }
  return present;
}

}  // namespace crossnav::evaluation
