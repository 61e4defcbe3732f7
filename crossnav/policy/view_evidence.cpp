// SPDX-License-Identifier: MIT
#include "crossnav/policy/view_evidence.h"

#include <algorithm>
#include <cmath>

namespace crossnav::policy {

double LogOddsOf(double score, const EvidenceConfig& config) {
  constexpr double kLeast = 0.01;  // chosen: no score is certain
  const double p = std::clamp(score, kLeast, 1 - kLeast);
  return config.offset + config.slope * std::log(p / (1 - p));
}

double ProbabilityOf(const std::vector<ViewScore>& views, const EvidenceConfig& config) {
  std::vector<double> means;
  for (const ViewScore& view : views)
    if (view.frames > 0) means.push_back(view.Mean());
  std::sort(means.begin(), means.end(), [](double a, double b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a > b;
  });
  double sum = 0, worth = 1;
  for (const double mean : means) {
    sum += worth * mean;
    worth *= config.discount;
  }
  return 1 / (1 + std::exp(-sum));
}

}  // namespace crossnav::policy
