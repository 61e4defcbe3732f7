// SPDX-License-Identifier: MIT
// The four interfaces in Python, and the suite that passes Python's objects to an agent.
#pragma once

#include <memory>

#include "common.h"
#include "crossnav/perception/perception.h"

namespace crossnav::python {

/// Python's own objects; an agent keeps them alive.
struct PerceptionHandle {
  nb::object detector, segmenter, stairs, encoder;
  std::shared_ptr<perception::PictureReader> pictures = nullptr;  ///< ground truth's; else null

  /// Forwards to the four objects, which must outlive it.
  perception::PerceptionSuite Suite() const;
};

}  // namespace crossnav::python
