// SPDX-License-Identifier: MIT
// Checks a client's observation and converts it.
#pragma once

#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/serve/messages.h"

namespace crossnav::serve {

/// Errors, at the key `where`: impossible image sizes, focal lengths that are not positive.
Result<void> CheckCamera(const CameraIntrinsics& camera, const char* where = "hello.camera");

/// `camera` is from Hello. Errors name the field: an image of another size than its camera's, an
/// invalid camera or pose.
Result<Observation> ObservationOf(const RawObservation& raw, const CameraIntrinsics& camera);

}  // namespace crossnav::serve
