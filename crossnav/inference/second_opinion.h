// SPDX-License-Identifier: MIT
// Two detectors as one. Networks that learned from different pictures rarely mistake the same
// thing: a second one, usually slower, corrects the confidence of the first where both have a box.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "crossnav/inference/parts.h"
#include "crossnav/perception/perception.h"

namespace crossnav::inference {

inline constexpr double kLeastScore = 0.05;  // chosen: lower scores of the second say nothing
inline constexpr double kLeastAlone = 0.1;   // chosen: score of a box that the second alone has

/// Log-odds of a score between `kLeastScore` and 0.98.
double BoundedLogOdds(double score);

/// Scores of the second detector for a box of either.
struct PairScores {
  double goal = 0, rival = 0;       ///< best scores of the goal and of other classes; 0 = no box
  std::optional<std::size_t> best;  ///< index of the box of `goal`
};
/// `boxes`: of the second; `labels`: of the goal.
PairScores ScoresAt(const perception::PixelBox& box, const std::vector<FoundBox>& boxes,
                    const std::vector<int>& labels);

/// Confidence of a box, from its confidence by the first detector (nullopt = it has no such box)
/// and the scores of the second for the goal and for its best other class there (0 = no such box).
/// In log-odds the sum of the first, of `opinion.weight` times the difference of the others, and of
/// `opinion.neutral`; `label` is the goal's, of the second.
double FusedConfidence(std::optional<double> first, double second, double rival, int label,
                       const ModelCard::Opinion& opinion);

struct DetectorPair {
  std::unique_ptr<perception::Detector> detector;
  std::unique_ptr<perception::Segmenter> segmenter;  ///< for the detector's boxes
};

/// The second network runs in frames in which the first has a box for the goal, and in one of
/// `every` of all others. Boxes that it alone has get their mask from depth, others from
/// `segmenter`. A goal that it has no label for is the first's alone. `card` is of `second`, with
/// `opinion.weight`.
DetectorPair MakeDetectorPair(std::unique_ptr<perception::Detector> first,
                              std::unique_ptr<perception::Segmenter> segmenter,
                              std::shared_ptr<Model> second, const ModelCard& card, int every);

}  // namespace crossnav::inference
