// SPDX-License-Identifier: MIT
// Interfaces of perception: the results of networks, or of stand-ins for them, for one frame. Four
// small interfaces, each replaceable alone; PerceptionSuite calls them in the paper's order. The
// ground-truth implementations are in the simulator's room (sensing/ground_truth.h).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"

namespace crossnav::perception {

/// Axis-aligned box in pixels: [u0, u1) x [v0, v1).
struct PixelBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  double Area() const { return static_cast<double>(u1 - u0) * (v1 - v0); }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

struct Detection {
  PixelBox box;
  float confidence = 0;    ///< [0, 1]
  MaskImage mask;          ///< H x W, filled by the segmenter; empty before
  float mask_quality = 0;  ///< [0, 1], predicted overlap with the object
};

/// Dense features aligned with the text embedding: rows x cols x dim, row-major, covering the
/// whole image with half-pixel-centred cells.
struct FeatureGrid {
  int rows = 0, cols = 0, dim = 0;
  std::vector<float> data;
};

/// Finds boxes of one category (paper: YOLOv7 or YOLO-World).
class Detector {
 public:
  virtual ~Detector() = default;
  virtual Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) = 0;
};

/// Turns a box into a mask (paper: MobileSAM). Fills `mask` and `mask_quality`.
class Segmenter {
 public:
  virtual ~Segmenter() = default;
  virtual Result<void> Segment(const Observation& obs, Detection& detection) = 0;
};

/// Probability per pixel of a stair surface (paper: SegFormer-B2), H x W in [0, 1].
class StairSegmenter {
 public:
  virtual ~StairSegmenter() = default;
  virtual Result<Image<float>> SegmentStairs(const Observation& obs) = 0;
};

/// Dense image features and text vectors of a common space (paper: SED/CLIP).
class DenseEncoder {
 public:
  virtual ~DenseEncoder() = default;
  virtual int Dim() const = 0;
  virtual std::string Name() const = 0;
  virtual Result<FeatureGrid> EncodeImage(const Observation& obs) = 0;
  /// Unit vector of `Dim()` numbers.
  virtual Result<std::vector<float>> EncodeText(std::string_view text) = 0;
};

/// A goal as a picture: a photograph of the wanted object (perception/goal_picture.h).
struct GoalPicture {
  RgbImage rgb;
  std::optional<PixelBox> box;  ///< about the object; empty = it is in the middle
};

/// Category, mask and features of the object in a goal's picture.
struct PictureReading {
  std::string category;  ///< as the detector knows it
  MaskImage mask;        ///< pixels of the object; not empty
  FeatureGrid features;  ///< of the encoder, over the whole picture
};

/// Reads goals that are pictures. Optional: without it the other interfaces do (ReadPicture).
class PictureReader {
 public:
  virtual ~PictureReader() = default;
  virtual Result<PictureReading> Read(const GoalPicture& picture) = 0;
};

/// Unit vectors of the texts that the encoder can encode (a table of names may lack some). Error
/// kUnsupported: it can encode none of them.
Result<std::vector<std::vector<float>>> EncodeTexts(DenseEncoder& encoder,
                                                    std::span<const char* const> texts);

/// Result of perception for one frame.
struct Percept {
  std::vector<Detection> detections;  ///< of the current goal, with masks, best first
  Image<float> stair_probability;     ///< H x W
  FeatureGrid features;
};

struct PerceptionSuite {
  std::unique_ptr<Detector> detector;
  std::unique_ptr<Segmenter> segmenter;
  std::unique_ptr<StairSegmenter> stairs;
  std::unique_ptr<DenseEncoder> encoder;
  std::unique_ptr<PictureReader> pictures = nullptr;  ///< null = by the four above

  /// Runs all four interfaces on one frame. Deterministic if they are.
  Result<Percept> Look(const Observation& obs, std::string_view goal);
};

}  // namespace crossnav::perception
