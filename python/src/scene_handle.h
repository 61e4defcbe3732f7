// SPDX-License-Identifier: MIT
// A scene with its settings; simulators and episodes share it.
#pragma once

#include <memory>

#include "common.h"
#include "crossnav/evaluation/scoring/scene_context.h"

namespace crossnav::python {

struct SceneHandle {
  std::string id;  ///< "<folder>/<file>.glb", as in episode files
  evaluation::RunConfig config;
  std::shared_ptr<const evaluation::SceneContext> context;
  std::shared_ptr<std::atomic<bool>> in_use = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace crossnav::python
