// SPDX-License-Identifier: MIT
// Kinds of goals, as GOAT-Bench mixes them. The kind follows from the goal's text in episodes and
// records.
#pragma once

#include <array>
#include <string_view>

namespace crossnav::evaluation {

enum class GoalKind { kCategory, kDescription, kPicture };
inline constexpr std::array kGoalKinds = {GoalKind::kCategory, GoalKind::kDescription,
                                          GoalKind::kPicture};

std::string_view NameOf(GoalKind kind);
/// A name of a category or an object, a description (language::IsDescription) or the name of a
/// picture (perception::IsPictureName).
GoalKind KindOf(std::string_view goal);

}  // namespace crossnav::evaluation
