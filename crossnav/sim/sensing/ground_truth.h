// SPDX-License-Identifier: MIT
// Ground-truth perception: the four interfaces of crossnav/perception answered from the simulator's
// instance image. For tests and for evaluation without networks; results say "oracle-perception".
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "crossnav/core/setting.h"
#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::sim {

struct GroundTruthConfig {
  double max_distance_m = 8.0;  // chosen: detectors miss far objects
  int min_visible_px = 200;     // chosen: and tiny objects
  int feature_dim = 768;
  int feature_rows = 24, feature_cols = 24;
  double feature_noise = 0.25;  // chosen: norm of the seeded noise against unit text vectors
  double confusion = 0.35;      // chosen: cosine between look-alikes such as bed and sofa
  std::uint64_t seed = 1;
  /// Folder of real CLIP text vectors (docs/cli.md, "Words"), which give the dimension and make
  /// synonyms work; empty = vectors made up from the names.
  std::string clip_dir;
};

template <class V>
void Visit(V& visit, GroundTruthConfig& c) {
  visit(CROSSNAV_SETTING(c, max_distance_m), 0.1, 100.0);
  visit(CROSSNAV_SETTING(c, min_visible_px), 1, 1000000);
  visit(CROSSNAV_SETTING(c, feature_dim), 8, 4096);
  visit(CROSSNAV_SETTING(c, feature_rows), 1, 256);
  visit(CROSSNAV_SETTING(c, feature_cols), 1, 256);
  visit(CROSSNAV_SETTING(c, feature_noise), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, confusion), 0.0, 0.99);
  visit(CROSSNAV_SETTING(c, seed), std::uint64_t{0}, ~std::uint64_t{0});
  visit(CROSSNAV_SETTING(c, clip_dir));
}

/// View of one instance in a picture.
struct SeenInstance {
  int pixels = 0;
  double nearest_m = 1e30;  ///< depth of its nearest pixel
  perception::PixelBox box{1 << 30, 1 << 30, 0, 0};

  void Add(int u, int v, float depth_m) { AddRun(u, u + 1, v, depth_m); }
  /// The pixels of row `v` from column `u0` to before `u1`.
  void AddRun(int u0, int u1, int v, float nearest_depth_m);
};

/// Views of all instances in a picture, by id; without id 0.
std::map<int, SeenInstance> InstancesIn(const Frame& frame);

/// The detection that ground truth makes of it, without a mask; empty where it is too small or too
/// far away.
std::optional<perception::Detection> DetectionOf(const SeenInstance& seen,
                                                 const SensorConfig& sensor,
                                                 const GroundTruthConfig& config);

/// Where a goal's picture was taken, and of which instance.
struct PictureView {
  int instance = 0;
  Pose T_world_camera = Pose::Identity();
  double hfov_deg = 0;
};

/// By perception::NameOfPicture.
using KnownPictures = std::map<std::string, PictureView>;

/// All four interfaces, answered from `simulator`, which must outlive the suite. Detections of the
/// goal category are true instances; names that are not one of kCategories match raw names exactly.
/// Goals that are pictures are read if they are in `pictures` (ground_truth_pictures.h). Errors:
/// `clip_dir` without readable vectors.
Result<perception::PerceptionSuite> GroundTruthPerception(const Simulator& simulator,
                                                          const GroundTruthConfig& config,
                                                          KnownPictures pictures = {});

/// Name of the encoder that `config` asks for: features of one mean nothing to the other.
std::string EncoderName(const GroundTruthConfig& config);

}  // namespace crossnav::sim
