// SPDX-License-Identifier: MIT
#include "crossnav/objects/appearance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/core/png_image.h"

namespace crossnav::objects {

using geometry::VoxelKey;

namespace {

constexpr int kMostSamples_px = 2000;    // chosen: shares to a few percent
constexpr std::int64_t kMostRows = 400;  // chosen: likewise, of rows for a mean

/// The two bins beside a value in [0, 1], and the weight of the upper one.
std::pair<int, double> BinsOf(double value, int bins) {
  const double at = std::clamp(value, 0.0, 1.0) * bins - 0.5;
  const double low = std::floor(at);
  return {static_cast<int>(low), at - low};
}

double Dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<float> Unit(const std::vector<double>& sum) {
  const double length = std::sqrt(Dot(sum, sum));
  if (!(length > 0)) return {};
  std::vector<float> unit(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) unit[i] = static_cast<float>(sum[i] / length);
  return unit;
}

/// Weighted sum of features of rows.
class FeatureSum {
 public:
  explicit FeatureSum(const memory::SemanticMemory& memory)
      : memory_(memory), sum_(static_cast<std::size_t>(std::max(0, memory.Dim())), 0.0) {}
  void Add(std::int64_t row) {
    const std::vector<float> feature = memory_.FeatureAt(row);
    const double weight = memory_.WeightAt(row);
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += weight * feature[i];
  }
  std::vector<float> Mean() const { return Unit(sum_); }

 private:
  const memory::SemanticMemory& memory_;
  std::vector<double> sum_;
};

/// Of `rows`, evenly kMostRows at most.
std::vector<float> MeanOfRows(const memory::SemanticMemory& memory,
                              const std::vector<std::int64_t>& rows) {
  FeatureSum sum(memory);
  const std::size_t step = std::max<std::size_t>(1, rows.size() / kMostRows);
  for (std::size_t i = 0; i < rows.size(); i += step) sum.Add(rows[i]);
  return sum.Mean();
}

}  // namespace

void ColourHistogram::AddPixel(const Rgb8& pixel) {
  const double r = pixel.r / 255.0, g = pixel.g / 255.0, b = pixel.b / 255.0;
  const auto [l, l_upper] = BinsOf((r + g + b) / 3, kLight);
  // Saturated colours are rare in homes: the middle half of the range has most bins.
  const auto [x, x_upper] = BinsOf(0.5 + (r - g), kHue);
  const auto [y, y_upper] = BinsOf(0.5 + (0.5 * (r + g) - b), kHue);
  for (int corner = 0; corner < 8; ++corner) {
    const int dl = corner & 1, dx = corner >> 1 & 1, dy = corner >> 2 & 1;
    const double weight =
        (dl ? l_upper : 1 - l_upper) * (dx ? x_upper : 1 - x_upper) * (dy ? y_upper : 1 - y_upper);
    const int bin =
        (std::clamp(l + dl, 0, kLight - 1) * kHue + std::clamp(x + dx, 0, kHue - 1)) * kHue +
        std::clamp(y + dy, 0, kHue - 1);
    bins_[static_cast<std::size_t>(bin)] += weight;
  }
  pixels_ += 1;
}

void ColourHistogram::Add(const RgbImage& rgb, const MaskImage& mask, const PictureBox& box) {
  if (rgb.width != mask.width || rgb.height != mask.height) return;
  const int u0 = std::max(0, box.u0), u1 = std::min(rgb.width, box.u1);
  const int v0 = std::max(0, box.v0), v1 = std::min(rgb.height, box.v1);
  const double area = std::max(0, u1 - u0) * static_cast<double>(std::max(0, v1 - v0));
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kMostSamples_px))));
  ColourHistogram seen;
  bool is_black = true;
  for (int v = v0; v < v1; v += step)
    for (int u = u0; u < u1; u += step) {
      if (mask.At(u, v) == 0) continue;
      const Rgb8& pixel = rgb.At(u, v);
      is_black = is_black && pixel == Rgb8{};
      seen.AddPixel(pixel);
    }
  if (!is_black) Add(seen);
}

void ColourHistogram::Add(const ColourHistogram& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  pixels_ += other.pixels_;
}

std::optional<double> OverlapOf(const ColourHistogram& a, const ColourHistogram& b) {
  if (a.empty() || b.empty()) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < a.bins_.size(); ++i) sum += std::sqrt(a.bins_[i] * b.bins_[i]);
  return sum / std::sqrt(a.pixels_ * b.pixels_);
}

ColourHistogram ColoursOfPortrait(const std::vector<std::uint8_t>& png) {
  ColourHistogram colours;
  const auto rgba = DecodePng(png, "portrait");
  if (!rgba) return colours;
  RgbImage rgb(rgba->width, rgba->height);
  for (std::size_t i = 0; i < rgba->data.size(); ++i)
    rgb.data[i] = {rgba->data[i][0], rgba->data[i][1], rgba->data[i][2]};
  // The object's box without its outer sixth, which often shows the background.
  const int u = rgb.width / 4, v = rgb.height / 4;
  colours.Add(rgb, MaskImage(rgb.width, rgb.height, 1), {u, v, rgb.width - u, rgb.height - v});
  return colours;
}

std::vector<float> FeatureAt(const memory::SemanticMemory& memory,
                             std::span<const VoxelKey> voxels) {
  std::vector<std::int64_t> rows;
  for (const VoxelKey& key : voxels)
    if (const auto row = memory.RowOf(key)) rows.push_back(*row);
  return MeanOfRows(memory, rows);
}

std::vector<float> FeatureAround(const memory::SemanticMemory& memory,
                                 std::span<const VoxelKey> voxels, double range_m) {
  if (voxels.empty()) return {};
  VoxelKey low = voxels.front(), high = voxels.front();
  for (const VoxelKey& key : voxels) {
    low = {std::min(low.x, key.x), std::min(low.y, key.y), std::min(low.z, key.z)};
    high = {std::max(high.x, key.x), std::max(high.y, key.y), std::max(high.z, key.z)};
  }
  const int range = static_cast<int>(std::lround(range_m / memory.VoxelSize()));
  const auto is_in = [](int at, int from, int to) { return at >= from && at <= to; };
  std::vector<std::int64_t> rows;
  const auto keys = memory.Keys();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const VoxelKey& key = keys[i];
    if (!is_in(key.x, low.x - range, high.x + range) ||
        !is_in(key.y, low.y - range, high.y + range) ||
        !is_in(key.z, low.z - range, high.z + range))
      continue;
    // The object's own box, and the voxels beside it, hold its own features.
    if (is_in(key.x, low.x - 1, high.x + 1) && is_in(key.y, low.y - 1, high.y + 1) &&
        is_in(key.z, low.z, high.z + 1))
      continue;
    rows.push_back(static_cast<std::int64_t>(i));
  }
  return MeanOfRows(memory, rows);
}

std::vector<float> MeanFeature(const memory::SemanticMemory& memory) {
  std::vector<std::int64_t> rows(static_cast<std::size_t>(memory.Size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<std::int64_t>(i);
  return MeanOfRows(memory, rows);
}

std::optional<double> OwnCosine(std::span<const float> a, std::span<const float> b,
                                std::span<const std::vector<float>> common) {
  if (a.empty() || a.size() != b.size()) return std::nullopt;
  std::vector<std::vector<double>> basis;
  const auto reduced = [&](std::span<const float> v) {
    std::vector<double> rest(v.begin(), v.end());
    for (const auto& direction : basis) {
      const double along = Dot(rest, direction);
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= along * direction[i];
    }
    return rest;
  };
  for (const std::vector<float>& direction : common) {
    if (direction.size() != a.size()) continue;
    std::vector<double> rest = reduced(direction);
    const double length = std::sqrt(Dot(rest, rest));
    if (!(length > 1e-6)) continue;
    for (double& x : rest) x /= length;
    basis.push_back(std::move(rest));
  }
  const std::vector<double> rest_a = reduced(a), rest_b = reduced(b);
  const double length = std::sqrt(Dot(rest_a, rest_a) * Dot(rest_b, rest_b));
  if (!(length > 1e-9)) return std::nullopt;
  return Dot(rest_a, rest_b) / length;
}

}  // namespace crossnav::objects
