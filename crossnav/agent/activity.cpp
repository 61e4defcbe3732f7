// SPDX-License-Identifier: MIT
#include "crossnav/agent/activity.h"

#include <iterator>
#include <type_traits>

namespace crossnav::agent {

namespace {

template <class V>
auto PursuedOf(V& pursuit) {
  using Result = std::conditional_t<std::is_const_v<V>, const Pursued*, Pursued*>;
  return std::visit(
      [](auto& p) -> Result {
        if constexpr (std::is_base_of_v<Pursued, std::remove_cvref_t<decltype(p)>>)
          return &p;
        else
          return nullptr;
      },
      pursuit);
}

}  // namespace

Pursuit& PursuitOf(Activity& activity) {
  if (Scan* scan = std::get_if<Scan>(&activity)) return scan->suspended;
  return std::get<Pursuit>(activity);
}
const Pursuit& PursuitOf(const Activity& activity) {
  if (const Scan* scan = std::get_if<Scan>(&activity)) return scan->suspended;
  return std::get<Pursuit>(activity);
}

Pursued* PursuedIn(Pursuit& pursuit) {
  return PursuedOf(pursuit);
}
const Pursued* PursuedIn(const Pursuit& pursuit) {
  return PursuedOf(pursuit);
}

bool IsScanning(const Activity& activity) {
  return std::holds_alternative<Scan>(activity);
}
bool IsExploring(const Pursuit& pursuit) {
  return std::holds_alternative<GoTo>(pursuit) || std::holds_alternative<Climb>(pursuit);
}

std::string_view NameOf(const Activity& activity) {
  return IsScanning(activity) ? "look_around" : NameOf(PursuitOf(activity));
}

std::string_view NameOf(const Pursuit& pursuit) {
  constexpr std::string_view kNames[] = {"none", "go_to", "climb", "visit", "approach"};
  static_assert(std::size(kNames) == std::variant_size_v<Pursuit>);
  return kNames[pursuit.index()];
}

std::string_view NameOf(Ending ending) {
  switch (ending) {
    case Ending::kReached:
      return "reached";
    case Ending::kUndecided:
      return "undecided";
    case Ending::kGone:
      return "gone";
    case Ending::kSuperseded:
      return "superseded";
    case Ending::kNotOpened:
      return "did not open";
    case Ending::kNoProgress:
      return "no progress";
    case Ending::kUnreachable:
      return "unreachable";
    case Ending::kRefuted:
      return "refuted";
  }
  return "unknown";
}

bool IsSpent(const std::vector<Attempt>& attempts, policy::CandidateKind kind,
             const Vector3d& p_focus_world, double same_place_m, int max_choices) {
  int choices = 0;
  for (const Attempt& attempt : attempts) {
    if (attempt.kind != kind) continue;
    if ((attempt.p_focus_world - p_focus_world).norm() > same_place_m) continue;
    switch (attempt.ending) {
      case Ending::kReached:
      case Ending::kNotOpened:
      case Ending::kNoProgress:
      case Ending::kRefuted:
        return true;
      case Ending::kGone:
        break;
      case Ending::kUndecided:
      case Ending::kSuperseded:
      case Ending::kUnreachable:
        ++choices;
        break;
    }
  }
  return choices >= max_choices;
}

}  // namespace crossnav::agent
