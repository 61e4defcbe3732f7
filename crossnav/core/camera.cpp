// SPDX-License-Identifier: MIT
#include "crossnav/core/camera.h"

#include <cmath>

namespace crossnav {

CameraIntrinsics IntrinsicsFromHfov(int width_px, int height_px, double hfov_rad) {
  CameraIntrinsics K;
  K.width_px = width_px;
  K.height_px = height_px;
  K.fx = K.fy = 0.5 * width_px / std::tan(0.5 * hfov_rad);
  K.cx = 0.5 * (width_px - 1);
  K.cy = 0.5 * (height_px - 1);
  return K;
}

}  // namespace crossnav
