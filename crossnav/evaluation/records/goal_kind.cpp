// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/records/goal_kind.h"

#include "crossnav/language/parse_description.h"
#include "crossnav/perception/goal_picture.h"

namespace crossnav::evaluation {

std::string_view NameOf(GoalKind kind) {
  switch (kind) {
    case GoalKind::kDescription:
      return "description";
    case GoalKind::kPicture:
      return "picture";
    default:
      return "category";
  }
}

GoalKind KindOf(std::string_view goal) {
  if (perception::IsPictureName(goal)) return GoalKind::kPicture;
  return language::IsDescription(goal) ? GoalKind::kDescription : GoalKind::kCategory;
}

}  // namespace crossnav::evaluation
