// SPDX-License-Identifier: MIT
#include "crossnav/recordings/depth_image.h"
#include "crossnav/sim/scene/image_codec.h"
#include "fuzz/harness.h"

FUZZ(image, input) {
  (void)crossnav::sim::DecodeImage(input, "input.png");
  (void)crossnav::recordings::DecodeDepth16(input, "input.png");
}
