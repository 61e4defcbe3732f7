// SPDX-License-Identifier: MIT
// Pairs depth and colour images, each in the order of its own time. Holds a few of each.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace crossnav::recordings {

/// An image message that waits for its partner.
struct HeldImage {
  std::int64_t time_ns = 0;
  std::string message;
  std::string where;  ///< for errors
};

struct ImagePair {
  HeldImage depth;
  /// nearest within the tolerance; a copy, because the next depth image may need it
  std::optional<HeldImage> colour;
};

class ImagePairs {
 public:
  explicit ImagePairs(std::int64_t match_ns) : match_ns_(match_ns) {}

  void AddDepth(HeldImage image) { depth_.push_back(std::move(image)); }
  void AddColour(HeldImage image);

  /// The first depth image for which no better colour image can arrive; `is_end`: no further image
  /// arrives.
  std::optional<ImagePair> Take(bool is_end);

 private:
  std::int64_t match_ns_;
  std::deque<HeldImage> depth_, colour_;
};

}  // namespace crossnav::recordings
