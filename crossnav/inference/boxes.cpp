// SPDX-License-Identifier: MIT
#include "crossnav/inference/boxes.h"

#include <algorithm>

#include "crossnav/core/category_table.h"

namespace crossnav::inference {

double Overlap(const FoundBox& a, const FoundBox& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  if (width <= 0 || height <= 0) return 0;
  const auto area = [](const FoundBox& x) { return (x.right - x.left) * (x.bottom - x.top); };
  return width * height / (area(a) + area(b) - width * height);
}

std::vector<FoundBox> Suppress(std::vector<FoundBox> boxes, double overlap) {
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const FoundBox& a, const FoundBox& b) { return a.score > b.score; });
  std::vector<FoundBox> kept;
  for (const FoundBox& box : boxes) {
    const bool is_double = std::any_of(kept.begin(), kept.end(), [&](const FoundBox& other) {
      return other.label == box.label && Overlap(other, box) > overlap;
    });
    if (!is_double) kept.push_back(box);
  }
  return kept;
}

std::vector<int> LabelsOf(std::string_view goal, const std::vector<std::string>& labels) {
  const std::string wanted = CanonicalName(goal);
  std::vector<int> out;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (CanonicalName(labels[i]) == wanted) out.push_back(static_cast<int>(i));
  return out;
}

tl::unexpected<Error> NoSuchLabel(std::string_view goal, const ModelCard& card) {
  constexpr std::size_t kShown = 12;
  std::string some;
  for (std::size_t i = 0; i < std::min(card.labels.size(), kShown); ++i)
    some += (i == 0 ? "" : ", ") + card.labels[i];
  if (card.labels.size() > kShown) some += ", ...";
  return Fail(ErrorCode::kUnsupported,
              "has no class for the goal \"" + std::string(goal) + "\"; it knows " + some,
              card.path.string() + ": labels");
}

}  // namespace crossnav::inference
