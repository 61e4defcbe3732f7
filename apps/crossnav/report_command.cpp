// SPDX-License-Identifier: MIT
#include "commands.h"

namespace crossnav::app {

Result<void> Report(const ReportOptions& options, const CommonOptions&, Console&) {
  return Fail(ErrorCode::kUnsupported, "not yet", options.out);
}

}  // namespace crossnav::app
