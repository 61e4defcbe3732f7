// SPDX-License-Identifier: MIT
#include "crossnav/inference/frame_input.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>

namespace crossnav::inference {
namespace {

constexpr float kLetterboxGrey = 114;  // of 255, the padding of the YOLO family

/// The source pixels of one target pixel, with weights that sum to 1.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

/// Taps along one side: a triangle as wide as a target pixel (as one source pixel without
/// antialiasing or when enlarging).
std::vector<Taps> TapsOf(int from, int to, bool antialias) {
  const double ratio = static_cast<double>(from) / to;
  const double reach = antialias ? std::max(1.0, ratio) : 1.0;
  std::vector<Taps> taps(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double centre = (i + 0.5) * ratio;
    const int first = static_cast<int>(std::floor(centre - reach));
    const int last = static_cast<int>(std::ceil(centre + reach));
    Taps& out = taps[static_cast<std::size_t>(i)];
    out.first = std::clamp(first, 0, from - 1);
    double total = 0;
    std::vector<double> weights(static_cast<std::size_t>(std::min(last, from - 1) - out.first + 1));
    for (int k = first; k <= last; ++k) {
      const double weight = std::max(0.0, 1 - std::abs(k + 0.5 - centre) / reach);
      const bool is_inside = k >= 0 && k < from;
      if (antialias && !is_inside) continue;  // pixels outside do not count, as in Pillow
      const int clamped = std::clamp(k, 0, from - 1);
      weights[static_cast<std::size_t>(clamped - out.first)] += weight;
      total += weight;
    }
    for (const double weight : weights) out.weights.push_back(static_cast<float>(weight / total));
    while (out.weights.size() > 1 && out.weights.back() == 0) out.weights.pop_back();
  }
  return taps;
}

/// Bytes resized to `width` x `height`, three floats a pixel, 0 to 255.
std::vector<float> Resized(const RgbImage& rgb, int width, int height, bool antialias) {
  const auto across = TapsOf(rgb.width, width, antialias);
  const auto down = TapsOf(rgb.height, height, antialias);
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  std::vector<float> narrow(row * static_cast<std::size_t>(rgb.height));
  for (int v = 0; v < rgb.height; ++v) {
    const Rgb8* from = &rgb.data[static_cast<std::size_t>(v) * rgb.width];
    float* to = &narrow[static_cast<std::size_t>(v) * row];
    for (const Taps& taps : across) {
      float r = 0, g = 0, b = 0;
      const Rgb8* p = from + taps.first;
      for (const float weight : taps.weights) {
        r += weight * p->r;
        g += weight * p->g;
        b += weight * p->b;
        ++p;
      }
      *to++ = r;
      *to++ = g;
      *to++ = b;
    }
  }
  std::vector<float> out(row * static_cast<std::size_t>(height), 0.0F);
  for (int v = 0; v < height; ++v) {
    float* to = &out[static_cast<std::size_t>(v) * row];
    const Taps& taps = down[static_cast<std::size_t>(v)];
    const float* from = &narrow[static_cast<std::size_t>(taps.first) * row];
    for (const float weight : taps.weights) {
      for (std::size_t i = 0; i < row; ++i) to[i] += weight * from[i];
      from += row;
    }
  }
  return out;
}

/// Calls use(index in the tensor, u, v) for the nearest frame pixel of every input pixel.
template <class Use>
void ForNearest(int width, int height, const ModelCard::Input& input, const Use& use) {
  std::size_t index = 0;
  for (int y = 0; y < input.height; ++y) {
    const int v = static_cast<int>((y + 0.5) * height / input.height);
    for (int x = 0; x < input.width; ++x, ++index)
      use(index, static_cast<int>((x + 0.5) * width / input.width), v);
  }
}

Tensor OnePlane(const ModelCard::Input& input, const char* name) {
  Tensor out{name, {1, 1, input.height, input.width}, {}};
  out.data.assign(static_cast<std::size_t>(input.width) * input.height, 0.0F);
  return out;
}

/// Of the input's focal length, which is the mean of both axes where the picture is stretched.
float DepthScale(const Observation& obs, const ModelCard::Input& input) {
  if (!input.focal_px) return 1;
  const Placement at = PlacementOf(input, obs.rgb.width, obs.rgb.height);
  const double focal_px = std::sqrt(obs.camera.fx * at.scale_x * obs.camera.fy * at.scale_y);
  return static_cast<float>(*input.focal_px / focal_px);
}

}  // namespace

FrameHash HashOf(const Observation& obs) {
  const Eigen::Matrix4d pose = obs.T_world_camera.matrix();
  const CameraIntrinsics& K = obs.camera;
  const double rest[] = {K.fx,
                         K.fy,
                         K.cx,
                         K.cy,
                         CameraHeightOf(obs, 0),
                         static_cast<double>(obs.rgb.width),
                         static_cast<double>(obs.depth_m.width)};
  const XXH64_hash_t seed = XXH3_64bits(pose.data(), sizeof(double) * 16) ^
                            XXH3_64bits(rest, sizeof(rest)) ^
                            XXH3_64bits(obs.depth_m.data.data(), 4 * obs.depth_m.data.size());
  const XXH128_hash_t hash =
      XXH3_128bits_withSeed(obs.rgb.data.data(), sizeof(Rgb8) * obs.rgb.data.size(), seed);
  return {hash.low64, hash.high64};
}

perception::PixelBox Placement::ToFrame(double left, double top, double right, double bottom,
                                        int width, int height) const {
  const auto pixel = [](double x, int most) {
    return static_cast<int>(std::lround(std::clamp(x, 0.0, static_cast<double>(most))));
  };
  const perception::PixelBox box{
      pixel((left - offset_x) / scale_x, width), pixel((top - offset_y) / scale_y, height),
      pixel((right - offset_x) / scale_x, width), pixel((bottom - offset_y) / scale_y, height)};
  return box.u1 > box.u0 && box.v1 > box.v0 ? box : perception::PixelBox{};
}

Placement PlacementOf(const ModelCard::Input& input, int width, int height) {
  const double across = static_cast<double>(input.width) / width;
  const double down = static_cast<double>(input.height) / height;
  if (input.resize == "plain") return {across, down, 0, 0};
  const double scale = std::min(across, down);
  if (input.resize == "corner") return {scale, scale, 0, 0};
  const int inner_width = static_cast<int>(std::lround(width * scale));
  const int inner_height = static_cast<int>(std::lround(height * scale));
  return {scale, scale, std::floor((input.width - inner_width) / 2.0),
          std::floor((input.height - inner_height) / 2.0)};
}

Tensor ColourTensor(const RgbImage& rgb, const ModelCard::Input& input, const char* name) {
  const Placement at = PlacementOf(input, rgb.width, rgb.height);
  const int width = std::max(1, static_cast<int>(std::lround(rgb.width * at.scale_x)));
  const int height = std::max(1, static_cast<int>(std::lround(rgb.height * at.scale_y)));
  const std::vector<float> pixels = Resized(rgb, width, height, input.antialias);
  const bool is_chw = input.layout == "chw";
  const std::size_t plane = static_cast<std::size_t>(input.width) * input.height;
  Tensor out{name, {1, 3, input.height, input.width}, {}};
  if (!is_chw) out.shape = {1, input.height, input.width, 3};
  out.data.resize(3 * plane);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t from_channel = input.colour == "rgb" ? c : 2 - c;
    const auto scale = static_cast<float>(input.scale / input.deviation[c]);
    const auto shift = static_cast<float>(-input.mean[c] / input.deviation[c]);
    const std::size_t step = is_chw ? 1 : 3;
    float* to = &out.data[is_chw ? c * plane : c];
    for (std::size_t i = 0; i < plane; ++i) to[i * step] = kLetterboxGrey * scale + shift;
    for (int v = 0; v < height; ++v) {
      const std::size_t first = (static_cast<std::size_t>(at.offset_y) + v) * input.width +
                                static_cast<std::size_t>(at.offset_x);
      const float* from = &pixels[static_cast<std::size_t>(v) * width * 3 + from_channel];
      for (int u = 0; u < width; ++u) to[(first + u) * step] = from[3 * u] * scale + shift;
    }
  }
  return out;
}

Tensor DepthTensor(const Observation& obs, const ModelCard::Input& input, const char* name) {
  Tensor out = OnePlane(input, name);
  const float scale = DepthScale(obs, input);
  ForNearest(obs.depth_m.width, obs.depth_m.height, input, [&](std::size_t index, int u, int v) {
    const float d = obs.depth_m.At(u, v);
    if (IsMeasured(d)) out.data[index] = scale * d;
  });
  return out;
}

Tensor HeightTensor(const Observation& obs, double camera_height_m, const ModelCard::Input& input,
                    const char* name) {
  Tensor out = OnePlane(input, name);
  const CameraIntrinsics& K = obs.camera;
  // World z of a point minus z of the foot, which is the camera's height below the camera.
  const Eigen::RowVector3d up = obs.T_world_camera.linear().row(2);
  const double height_m = CameraHeightOf(obs, camera_height_m);
  ForNearest(obs.depth_m.width, obs.depth_m.height, input, [&](std::size_t index, int u, int v) {
    const float d = obs.depth_m.At(u, v);
    if (!IsMeasured(d)) return;
    const double along = up.x() * (u - K.cx) / K.fx + up.y() * (v - K.cy) / K.fy + up.z();
    out.data[index] = static_cast<float>(height_m + along * d);
  });
  return out;
}

Image<float> ToFrameSize(const float* map, int rows, int cols, const Placement& placement,
                         const ModelCard::Input& input, int width, int height) {
  return ToFrameSize(map, rows, cols, placement, input, width, height, {0, 0, width, height});
}

Image<float> ToFrameSize(const float* map, int rows, int cols, const Placement& placement,
                         const ModelCard::Input& input, int width, int height,
                         const perception::PixelBox& box) {
  Image<float> out(width, height, 0.0F);
  struct Cell {
    int a = 0, b = 0;
    float t = 0;
  };
  const auto cell = [](double x, int most) {
    const double clamped = std::clamp(x, 0.0, most - 1.0);
    const int a = static_cast<int>(clamped);
    return Cell{a, std::min(a + 1, most - 1), static_cast<float>(clamped - a)};
  };
  std::vector<Cell> across;
  for (int u = box.u0; u < box.u1; ++u)
    across.push_back(cell(
        ((u + 0.5) * placement.scale_x + placement.offset_x) * cols / input.width - 0.5, cols));
  for (int v = box.v0; v < box.v1; ++v) {
    const Cell y = cell(
        ((v + 0.5) * placement.scale_y + placement.offset_y) * rows / input.height - 0.5, rows);
    const float* upper = map + static_cast<std::size_t>(y.a) * cols;
    const float* lower = map + static_cast<std::size_t>(y.b) * cols;
    float* to = &out.At(box.u0, v);
    for (const Cell& x : across) {
      const float top = upper[x.a] + x.t * (upper[x.b] - upper[x.a]);
      const float bottom = lower[x.a] + x.t * (lower[x.b] - lower[x.a]);
      *to++ = top + y.t * (bottom - top);
    }
  }
  return out;
}

}  // namespace crossnav::inference
