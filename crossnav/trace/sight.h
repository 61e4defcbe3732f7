// SPDX-License-Identifier: MIT
// Result of perception for one frame, for display: boxes and masks of the goal, stairs, and
// similarity of each part of the picture to the goal's text. Not part of StepTrace: it is large,
// and no decision reads it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"

namespace crossnav::trace {

/// A detection: [u0, u1) x [v0, v1) px of the frame.
struct SightBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  double confidence = 0, mask_quality = 0;  ///< [0, 1]
};

struct Sight {
  int width_px = 0, height_px = 0;  ///< of the frame; 0 = not recorded
  std::vector<SightBox> boxes;      ///< of the current goal, best first
  MaskImage masks;                  ///< H x W, 1 inside any mask; empty without boxes
  Image<float> stair_probability;   ///< H x W [0, 1]
  Image<float> similarity;          ///< any grid over the frame: cosine with the goal's text
};

/// Boxes and numbers of a sight in a replay; a separate picture holds its images.
struct SightNote {
  int width_px = 0, height_px = 0;
  std::vector<SightBox> boxes;
  double similarity_min = 0, similarity_max = 0;  ///< over the grid; equal without a grid
};

SightNote NoteOf(const Sight& sight);
std::string ToJson(const SightNote& note);
Result<SightNote> SightNoteFromJson(std::string_view json);

/// The images in one picture, at most `max_px` wide and high, sampled: red = masks, green =
/// probability of stairs in 16 steps, blue = similarity between the note's least and greatest in 32
/// steps.
RgbImage MapsOf(const Sight& sight, int max_px);

}  // namespace crossnav::trace
