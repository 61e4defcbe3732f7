// SPDX-License-Identifier: MIT
// What a client sent as an observation, checked and turned into one.
#pragma once

#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/serve/messages.h"

namespace crossnav::serve {

/// Errors, at the key `where`: sizes that no image has, focal lengths that are not positive.
Result<void> CheckCamera(const CameraIntrinsics& camera, const char* where = "hello.camera");

/// `camera` is that of Hello. Errors name the field: an image of another size than its camera's, a
/// camera or a pose that is none.
Result<Observation> ObservationOf(const RawObservation& raw, const CameraIntrinsics& camera);

}  // namespace crossnav::serve
