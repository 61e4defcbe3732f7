// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/ground_truth.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "crossnav/core/categories.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "crossnav/sim/sensing/ground_truth_pictures.h"

namespace crossnav::sim {
namespace {

using perception::Detection;
using perception::PixelBox;

constexpr float kStairProbability = 0.9F;  // chosen: sure, but not certain
constexpr std::array<std::string_view, 3> kStairNames{"stairs", "staircase", "stair"};

/// 0.5 for something barely seen, up to 0.98; halves its distance to that with every 2 % of the
/// image, and loses up to 0.2 over the range.
float ConfidenceOf(const SeenInstance& s, const SensorConfig& sensor,
                   double max_distance_m) {  // chosen: shaped like a detector's, not fitted
  const double share = s.pixels / (static_cast<double>(sensor.width_px) * sensor.height_px);
  const double by_size = 0.98 - 0.48 * std::exp2(-share / 0.02);
  const double by_distance = 0.2 * std::clamp(s.nearest_m / max_distance_m, 0.0, 1.0);
  return static_cast<float>(std::clamp(by_size - by_distance + 0.1, 0.0, 0.98));
}

/// The simulator's last frame, or null if `obs` cannot be made from it. Only the sizes are
/// compared: depth and pose of an observation may have noise.
const Frame* FrameOf(const Simulator& simulator, const Observation& obs) {
  const Frame& frame = simulator.last_frame();
  const bool same = frame.instance.width == obs.depth_m.width &&
                    frame.instance.height == obs.depth_m.height && !frame.instance.empty();
  return same ? &frame : nullptr;
}

/// Calls `fn(u_begin, u_end, id)` for each run of one id in row `v`, columns `u0` to before `u1`.
template <class Fn>
void ForEachRun(const InstanceImage& image, int v, int u0, int u1, Fn&& fn) {
  if (u0 >= u1) return;
  const std::int32_t* row = &image.At(0, v);
  for (int begin = u0; begin < u1;) {
    const std::int32_t id = row[begin];
    int end = begin + 1;
    while (end < u1 && row[end] == id) ++end;
    fn(begin, end, id);
    begin = end;
  }
}

tl::unexpected<Error> StaleFrame() {
  return Fail(ErrorCode::kMismatch,
              "ground-truth perception was asked about an observation that is not the simulator's "
              "last one");
}

/// The instances in the simulator's last frame, found once a frame: detectors are asked for many
/// names.
class LastInstances {
 public:
  explicit LastInstances(const Simulator& simulator) : simulator_(simulator) {}

  const std::map<int, SeenInstance>& Get() {
    if (frames_ != simulator_.frames()) {
      instances_ = InstancesIn(simulator_.last_frame());
      frames_ = simulator_.frames();
    }
    return instances_;
  }

 private:
  const Simulator& simulator_;
  std::int64_t frames_ = -1;
  std::map<int, SeenInstance> instances_;
};

class GroundTruthDetector : public perception::Detector {
 public:
  GroundTruthDetector(const Simulator& simulator, const GroundTruthConfig& config,
                      std::shared_ptr<LastInstances> instances)
      : simulator_(simulator), config_(config), instances_(std::move(instances)) {}

  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) override {
    if (FrameOf(simulator_, obs) == nullptr) return StaleFrame();
    std::vector<Detection> detections;
    for (const auto& [id, seen] : instances_->Get()) {  // by id, so that the order is fixed
      const SceneInstance* instance = simulator_.scene().FindInstance(id);
      if (instance == nullptr) continue;
      const bool wanted = IsCategory(goal) ? instance->category == goal : instance->name == goal;
      if (!wanted) continue;
      if (auto detection = DetectionOf(seen, simulator_.sensor(), config_))
        detections.push_back(std::move(*detection));
    }
    std::stable_sort(detections.begin(), detections.end(),
                     [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
    return detections;
  }

 private:
  const Simulator& simulator_;
  GroundTruthConfig config_;
  std::shared_ptr<LastInstances> instances_;
};

/// Exactly the visible pixels of the instance that fills most of the box.
class GroundTruthSegmenter : public perception::Segmenter {
 public:
  GroundTruthSegmenter(const Simulator& simulator, std::shared_ptr<LastInstances> instances)
      : simulator_(simulator), instances_(std::move(instances)) {}

  Result<void> Segment(const Observation& obs, Detection& detection) override {
    const Frame* frame = FrameOf(simulator_, obs);
    if (frame == nullptr) return StaleFrame();
    const PixelBox box{std::max(detection.box.u0, 0), std::max(detection.box.v0, 0),
                       std::min(detection.box.u1, frame->instance.width),
                       std::min(detection.box.v1, frame->instance.height)};
    const int id = InstanceOf(*frame, box);
    detection.mask = MaskImage(frame->instance.width, frame->instance.height);
    detection.mask_quality = id == 0 ? 0.0F : 1.0F;
    for (int v = box.v0; v < box.v1; ++v) {
      for (int u = box.u0; u < box.u1; ++u) {
        detection.mask.At(u, v) = id != 0 && frame->instance.At(u, v) == id ? 1 : 0;
      }
    }
    return {};
  }

 private:
  /// The goal-like instance with the visible box `box`; else the instance with most pixels in it.
  int InstanceOf(const Frame& frame, const PixelBox& box) const {
    std::map<int, int> count;
    for (int v = box.v0; v < box.v1; ++v) {
      ForEachRun(frame.instance, v, box.u0, box.u1,
                 [&](int u0, int u1, std::int32_t id) { count[id] += u1 - u0; });
    }
    count.erase(0);
    // Walls and floors often fill more of the box than the object: prefer the instance that fits
    // the box.
    const std::map<int, SeenInstance>& seen = instances_->Get();
    int best = 0;
    double best_score = -1;
    for (const auto& [id, pixels] : count) {
      const SceneInstance* instance = simulator_.scene().FindInstance(id);
      const bool is_goal = instance != nullptr && !instance->category.empty();
      const double score = BoxOverlap(seen.at(id).box, box) + (is_goal ? 0.5 : 0) +
                           1e-9 * static_cast<double>(pixels);
      if (score > best_score) {
        best = id;
        best_score = score;
      }
    }
    return best;
  }

  /// Intersection over union of two boxes.
  static double BoxOverlap(const PixelBox& own, const PixelBox& box) {
    const PixelBox both{std::max(own.u0, box.u0), std::max(own.v0, box.v0),
                        std::min(own.u1, box.u1), std::min(own.v1, box.v1)};
    if (both.u1 <= both.u0 || both.v1 <= both.v0) return 0;
    return both.Area() / (own.Area() + box.Area() - both.Area());
  }

  const Simulator& simulator_;
  std::shared_ptr<LastInstances> instances_;
};

class GroundTruthStairs : public perception::StairSegmenter {
 public:
  explicit GroundTruthStairs(const Simulator& simulator) : simulator_(simulator) {
    for (const SceneInstance& instance : simulator.scene().instances) {
      const auto& names = kStairNames;
      if (std::find(names.begin(), names.end(), instance.name) != names.end()) {
        stairs_.insert(instance.id);
      }
    }
  }

  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    const Frame* frame = FrameOf(simulator_, obs);
    if (frame == nullptr) return StaleFrame();
    Image<float> probability(frame->instance.width, frame->instance.height, 0.0F);
    if (stairs_.empty()) return probability;
    for (int v = 0; v < probability.height; ++v) {
      ForEachRun(frame->instance, v, 0, probability.width, [&](int u0, int u1, std::int32_t id) {
        if (id == 0 || stairs_.count(id) == 0) return;
        std::fill(&probability.At(u0, v), &probability.At(u0, v) + (u1 - u0), kStairProbability);
      });
    }
    return probability;
  }

 private:
  const Simulator& simulator_;
  std::set<int> stairs_;
};

}  // namespace

void SeenInstance::AddRun(int u0, int u1, int v, float nearest_depth_m) {
  pixels += u1 - u0;
  nearest_m = std::min(nearest_m, static_cast<double>(nearest_depth_m));
  box = {std::min(box.u0, u0), std::min(box.v0, v), std::max(box.u1, u1), std::max(box.v1, v + 1)};
}

std::map<int, SeenInstance> InstancesIn(const Frame& frame) {
  std::map<int, SeenInstance> seen;
  for (int v = 0; v < frame.instance.height; ++v) {
    ForEachRun(frame.instance, v, 0, frame.instance.width, [&](int u0, int u1, std::int32_t id) {
      if (id == 0) return;
      const float* row_m = &frame.depth_m.At(0, v);
      seen[id].AddRun(u0, u1, v, *std::min_element(row_m + u0, row_m + u1));
    });
  }
  return seen;
}

std::optional<Detection> DetectionOf(const SeenInstance& seen, const SensorConfig& sensor,
                                     const GroundTruthConfig& config) {
  if (seen.pixels < config.min_visible_px || seen.nearest_m > config.max_distance_m)
    return std::nullopt;
  return Detection{seen.box, ConfidenceOf(seen, sensor, config.max_distance_m), {}, 0};
}

std::string EncoderName(const GroundTruthConfig& config) {
  return config.clip_dir.empty() ? "ground-truth" : "ground-truth-clip";
}

Result<perception::PerceptionSuite> GroundTruthPerception(const Simulator& simulator,
                                                          const GroundTruthConfig& config,
                                                          KnownPictures pictures) {
  auto encoder = MakeGroundTruthEncoder(simulator, config);
  if (!encoder) return tl::unexpected(encoder.error());
  auto reader = MakeGroundTruthPictureReader(simulator, config, std::move(pictures));
  if (!reader) return tl::unexpected(reader.error());
  perception::PerceptionSuite suite;
  const auto instances = std::make_shared<LastInstances>(simulator);
  suite.detector = std::make_unique<GroundTruthDetector>(simulator, config, instances);
  suite.segmenter = std::make_unique<GroundTruthSegmenter>(simulator, instances);
  suite.stairs = std::make_unique<GroundTruthStairs>(simulator);
  suite.encoder = std::move(*encoder);
  suite.pictures = std::move(*reader);
  return suite;
}

}  // namespace crossnav::sim
