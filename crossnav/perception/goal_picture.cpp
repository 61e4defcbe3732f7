// SPDX-License-Identifier: MIT
#include "crossnav/perception/goal_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "crossnav/core/png_image.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/rng.h"

namespace crossnav::perception {
namespace {

constexpr std::string_view kPrefix = "picture ";
constexpr std::size_t kHexDigits = 16;
constexpr double kMiddleShare = 0.5;      // chosen: of each side; the object fills most of it
constexpr float kLeastConfidence = 0.2F;  // chosen: the encoder's nearest name is better than less
constexpr double kLeastMask = 0.05;       // chosen: of the box; less is a failed mask

PixelBox PlaceOf(const GoalPicture& picture) {
  if (picture.box) return *picture.box;
  const int width = picture.rgb.width, height = picture.rgb.height;
  const int u = static_cast<int>(width * (1 - kMiddleShare) / 2);
  const int v = static_cast<int>(height * (1 - kMiddleShare) / 2);
  return {u, v, width - u, height - v};
}

PixelBox Shared(const PixelBox& a, const PixelBox& b) {
  PixelBox both{std::max(a.u0, b.u0), std::max(a.v0, b.v0), std::min(a.u1, b.u1),
                std::min(a.v1, b.v1)};
  both.u1 = std::max(both.u0, both.u1);
  both.v1 = std::max(both.v0, both.v1);
  return both;
}

/// Overlap of the boxes; a place that is only guessed must merely be touched in its middle.
double Agreement(const GoalPicture& picture, const PixelBox& found) {
  const PixelBox place = PlaceOf(picture);
  const double shared = Shared(place, found).Area();
  if (picture.box) return shared / std::max(1.0, place.Area() + found.Area() - shared);
  const double u = 0.5 * (place.u0 + place.u1), v = 0.5 * (place.v0 + place.v1);
  const double off_u = std::abs(0.5 * (found.u0 + found.u1) - u) / (0.5 * picture.rgb.width);
  const double off_v = std::abs(0.5 * (found.v0 + found.v1) - v) / (0.5 * picture.rgb.height);
  return shared > 0 ? std::max(0.0, 1 - std::hypot(off_u, off_v)) : 0.0;
}

/// The picture as an observation of a camera without depth.
Observation ObservationOf(const GoalPicture& picture) {
  Observation obs;
  obs.rgb = picture.rgb;
  obs.depth_m = DepthImage(picture.rgb.width, picture.rgb.height, 0.0F);
  obs.camera =
      IntrinsicsFromHfov(picture.rgb.width, picture.rgb.height, DegToRad(kPictureHfov_deg));
  return obs;
}

struct Found {
  std::string category;
  Detection detection;
  double score = 0;
};

/// Best detection of any name at the object's place.
Result<std::optional<Found>> Detect(const PerceptionSuite& suite, const GoalPicture& picture,
                                    const Observation& obs, std::span<const std::string> names) {
  std::optional<Found> best;
  for (const std::string& name : names) {
    auto detections = suite.detector->Detect(obs, name);
    if (!detections && detections.error().code == ErrorCode::kUnsupported) continue;
    if (!detections) return tl::unexpected(detections.error());
    for (Detection& detection : *detections) {
      const double score = detection.confidence * Agreement(picture, detection.box);
      if (detection.confidence < kLeastConfidence || score <= (best ? best->score : 0)) continue;
      best = Found{name, std::move(detection), score};
    }
  }
  return best;
}

void FillBox(const PixelBox& box, MaskImage& mask) {
  const PixelBox in = Shared(box, {0, 0, mask.width, mask.height});
  for (int v = in.v0; v < in.v1; ++v)
    for (int u = in.u0; u < in.u1; ++u) mask.At(u, v) = 1;
}

/// The segmenter's mask; the box where that is next to nothing.
Result<MaskImage> MaskOf(const PerceptionSuite& suite, const Observation& obs,
                         Detection& detection) {
  if (auto ok = suite.segmenter->Segment(obs, detection); !ok) return tl::unexpected(ok.error());
  MaskImage& mask = detection.mask;
  const auto pixels = std::count(mask.data.begin(), mask.data.end(), 1);
  if (mask.width == obs.rgb.width && mask.height == obs.rgb.height &&
      static_cast<double>(pixels) >= kLeastMask * detection.box.Area())
    return std::move(mask);
  MaskImage filled(obs.rgb.width, obs.rgb.height);
  FillBox(detection.box, filled);
  return filled;
}

Result<std::string> NearestName(const PerceptionSuite& suite, std::span<const float> vector,
                                std::span<const std::string> names) {
  std::string nearest;
  double best = -2;
  for (const std::string& name : names) {
    const auto text = suite.encoder->EncodeText(name);
    if (!text && text.error().code == ErrorCode::kUnsupported) continue;
    if (!text) return tl::unexpected(text.error());
    double cosine = 0;
    for (std::size_t i = 0; i < std::min(vector.size(), text->size()); ++i)
      cosine += static_cast<double>(vector[i]) * (*text)[i];
    if (cosine <= best) continue;
    best = cosine;
    nearest = name;
  }
  if (nearest.empty())
    return Fail(ErrorCode::kUnsupported, "names nothing in a goal's picture",
                suite.encoder->Name());
  return nearest;
}

}  // namespace

Result<void> CheckGoalPicture(const GoalPicture& picture, const std::string& where) {
  const int width = picture.rgb.width, height = picture.rgb.height;
  if (std::min(width, height) < kLeastPictureSide_px ||
      std::max(width, height) > kMostPictureSide_px ||
      picture.rgb.data.size() != static_cast<std::size_t>(width) * height) {
    return Fail(ErrorCode::kInvalid,
                "a goal's picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " px; sides are " + std::to_string(kLeastPictureSide_px) + " to " +
                    std::to_string(kMostPictureSide_px) + " px",
                where);
  }
  if (!picture.box) return {};
  const PixelBox& box = *picture.box;
  if (box.u0 < 0 || box.v0 < 0 || box.u1 > width || box.v1 > height || box.u0 >= box.u1 ||
      box.v0 >= box.v1)
    return Fail(ErrorCode::kInvalid, "the box of a goal's picture is empty or leaves it", where);
  return {};
}

Result<GoalPicture> DecodeGoalPicture(std::span<const std::uint8_t> png,
                                      const std::optional<PixelBox>& box,
                                      const std::string& where) {
  // The limit is checked before the pixels are unpacked.
  const auto size = PngSize(png, where);
  if (!size) return tl::unexpected(size.error());
  GoalPicture picture;
  picture.box = box;
  if (std::max((*size)[0], (*size)[1]) > kMostPictureSide_px)
    return Fail(
        ErrorCode::kInvalid,
        "a goal's picture has a side of more than " + std::to_string(kMostPictureSide_px) + " px",
        where);
  const auto rgba = DecodePng(png, where);
  if (!rgba) return tl::unexpected(rgba.error());
  picture.rgb = RgbImage(rgba->width, rgba->height);
  for (std::size_t i = 0; i < rgba->data.size(); ++i)
    picture.rgb.data[i] = {rgba->data[i][0], rgba->data[i][1], rgba->data[i][2]};
  if (auto ok = CheckGoalPicture(picture, where); !ok) return tl::unexpected(ok.error());
  return picture;
}

std::string NameOfPicture(const GoalPicture& picture) {
  std::string bytes = std::to_string(picture.rgb.width) + " ";
  if (picture.box) {
    const PixelBox& b = *picture.box;
    for (const int side : {b.u0, b.v0, b.u1, b.v1}) bytes += std::to_string(side) + " ";
  }
  for (const Rgb8& p : picture.rgb.data) {
    bytes += static_cast<char>(p.r);
    bytes += static_cast<char>(p.g);
    bytes += static_cast<char>(p.b);
  }
  char hex[kHexDigits + 1];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(HashString(bytes)));
  return std::string(kPrefix) + hex;
}

bool IsPictureName(std::string_view goal) {
  return goal.size() == kPrefix.size() + kHexDigits && goal.starts_with(kPrefix) &&
         goal.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string_view::npos;
}

std::vector<float> PooledFeature(const FeatureGrid& grid, const MaskImage& mask, bool inverse) {
  std::vector<double> sum(static_cast<std::size_t>(grid.dim), 0.0);
  for (int row = 0; row < grid.rows; ++row)
    for (int col = 0; col < grid.cols; ++col) {
      const int v0 = row * mask.height / grid.rows, v1 = (row + 1) * mask.height / grid.rows;
      const int u0 = col * mask.width / grid.cols, u1 = (col + 1) * mask.width / grid.cols;
      int inside = 0;
      for (int v = v0; v < v1; ++v)
        for (int u = u0; u < u1; ++u) inside += (mask.At(u, v) != 0) != inverse ? 1 : 0;
      if (inside == 0) continue;
      // Squared, so that cells at the border, which show both, hardly count.
      const double share = static_cast<double>(inside) / ((v1 - v0) * (u1 - u0));
      const float* cell = &grid.data[(static_cast<std::size_t>(row) * grid.cols + col) * grid.dim];
      for (int k = 0; k < grid.dim; ++k) sum[k] += share * share * cell[k];
    }
  double squared = 0;
  for (const double x : sum) squared += x * x;
  if (!(squared > 0)) return {};
  std::vector<float> mean(sum.size());
  for (std::size_t k = 0; k < sum.size(); ++k)
    mean[k] = static_cast<float>(sum[k] / std::sqrt(squared));
  return mean;
}

Result<PictureReading> ReadPicture(const PerceptionSuite& suite, const GoalPicture& picture,
                                   std::span<const std::string> names) {
  if (auto ok = CheckGoalPicture(picture, "goal"); !ok) return tl::unexpected(ok.error());
  if (suite.pictures) return suite.pictures->Read(picture);
  const Observation obs = ObservationOf(picture);
  auto found = Detect(suite, picture, obs, names);
  if (!found) return tl::unexpected(found.error());
  auto features = suite.encoder->EncodeImage(obs);
  if (!features) return tl::unexpected(features.error());
  PictureReading reading;
  reading.features = std::move(*features);
  if (*found) {
    auto mask = MaskOf(suite, obs, (*found)->detection);
    if (!mask) return tl::unexpected(mask.error());
    reading.mask = std::move(*mask);
    reading.category = std::move((*found)->category);
    return reading;
  }
  reading.mask = MaskImage(picture.rgb.width, picture.rgb.height);
  FillBox(PlaceOf(picture), reading.mask);
  auto name = NearestName(suite, PooledFeature(reading.features, reading.mask), names);
  if (!name) return tl::unexpected(name.error());
  reading.category = std::move(*name);
  return reading;
}

}  // namespace crossnav::perception
