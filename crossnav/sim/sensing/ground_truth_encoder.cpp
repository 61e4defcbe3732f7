// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/ground_truth_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/core/rng.h"
#include "crossnav/perception/named_vectors.h"

namespace crossnav::sim {
namespace {

using perception::FeatureGrid;
using perception::NamedVectors;
constexpr double kCommonShare = 0.5;  // chosen: cosine of unrelated names, below CLIP's 0.7
constexpr double kBiasShare = 0.5;    // chosen: of feature_noise, fixed per instance
constexpr double kPatchShare = 0.8;   // chosen: of the frame's noise, alike in a patch of cells
constexpr int kPatchCells = 3;        // chosen: side of a noise patch
constexpr int kNoiseVectors = 64;     // chosen: enough that repeats do not add up
constexpr int kPixelStride = 2;       // chosen: a quarter of the pixels tells a cell's content

struct LookAlike {
  std::string_view category, word;  ///< the word: another category, or in a raw name
};
constexpr std::array<LookAlike, 21> kLookAlikes = {{
    {"bed", "sofa"},          {"sofa", "bed"},           {"sofa", "chair"},
    {"chair", "sofa"},        {"chair", "stool"},        {"chair", "bench"},
    {"sofa", "ottoman"},      {"sofa", "cushion"},       {"bed", "mattress"},
    {"bed", "blanket"},       {"tv monitor", "picture"}, {"tv monitor", "painting"},
    {"tv monitor", "mirror"}, {"tv monitor", "laptop"},  {"tv monitor", "screen"},
    {"plant", "vase"},        {"plant", "flower"},       {"plant", "tree"},
    {"toilet", "bidet"},      {"toilet", "sink"},        {"toilet", "washbasin"},
}};

using Feature = std::vector<float>;

void AddScaled(double scale, std::span<const float> from, std::span<float> to) {
  const auto s = static_cast<float>(scale);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += s * from[i];
}

void Normalize(std::span<float> v) {
  double squared = 0;
  for (float x : v) squared += static_cast<double>(x) * x;
  const auto inverse = static_cast<float>(1.0 / std::sqrt(std::max(squared, 1e-30)));
  for (float& x : v) x *= inverse;
}

Feature RandomUnit(std::uint64_t seed, int dim) {
  Rng rng(seed);
  Feature v(dim);
  for (float& x : v) x = static_cast<float>(rng.Normal());
  Normalize(v);
  return v;
}

bool IsCategoryText(std::string_view name) {
  return std::any_of(kCategories.begin(), kCategories.end(),
                     [&](std::string_view c) { return SpacedName(c) == name; });
}

bool HasWord(const std::string& name, std::string_view word) {
  return (" " + name + " ").find(" " + std::string(word) + " ") != std::string::npos;
}

// The names that `name` is easily taken for.
std::vector<std::string> LookAlikesOf(const std::string& name) {
  std::vector<std::string> out;
  for (const auto& [category, word] : kLookAlikes) {
    if (category == name && IsCategoryText(word)) out.emplace_back(word);
    if (!IsCategoryText(name) && HasWord(name, word)) out.emplace_back(category);
  }
  return out;
}

// Unit vectors of names: known ones as given, others from one common direction plus each name's
// own, mixed among look-alikes.
class TextSpace {
 public:
  TextSpace(int dim, std::uint64_t seed, double confusion)
      : dim_(dim), seed_(seed), confusion_(confusion), common_(RandomUnit(MixSeed(seed, 7), dim)) {}

  /// In the space of the `known` vectors, of which there must be one.
  TextSpace(NamedVectors known, std::uint64_t seed, double confusion)
      : dim_(static_cast<int>(known.begin()->second.size())),
        seed_(seed),
        confusion_(confusion),
        common_(dim_, 0.0f),
        has_known_(true),
        vectors_(std::move(known)) {
    for (auto& [name, v] : vectors_) {
      Normalize(v);
      AddScaled(1.0 / static_cast<double>(vectors_.size()), v, common_);
    }
    common_share_ = 0;
    for (float x : common_) common_share_ += static_cast<double>(x) * x;
    Normalize(common_);
  }

  int dim() const { return dim_; }

  /// The name under which `text` is known.
  std::string Resolve(std::string_view text) const {
    if (!has_known_) return CanonicalName(text);
    std::string name = SpacedName(text), category = CanonicalName(text);
    if (vectors_.count(name) > 0) return name;
    for (const auto& [from, to] : kClipNames)
      if (from == category && vectors_.count(std::string(to)) > 0) return std::string(to);
    return category;
  }

  /// Name of an object: its raw name if that has a vector, else its category.
  std::string NameOf(const SceneInstance& instance) const {
    std::string raw = SpacedName(instance.name);
    if (has_known_ && vectors_.count(raw) > 0) return raw;
    return Resolve(instance.category.empty() ? instance.name : instance.category);
  }

  /// Of a resolved name.
  const Feature& Of(const std::string& name) {
    const auto found = vectors_.find(name);
    if (found != vectors_.end()) return found->second;
    Feature own = Own(name);
    const double c = confusion_;
    // Weights for a cosine of c: `mutual` if both vectors mix in each other, `lean` if one does.
    const double mutual = c > 0 ? (1 - std::sqrt(1 - c * c)) / c : 0;
    const double lean = c / std::sqrt(1 - c * c);
    for (const std::string& other : LookAlikesOf(name))
      AddScaled(IsCategoryText(name) ? mutual : lean, Own(other), own);
    Normalize(own);
    Feature v(dim_, 0.0f);
    AddScaled(std::sqrt(common_share_), common_, v);
    AddScaled(std::sqrt(1 - common_share_), own, v);
    Normalize(v);
    return vectors_.emplace(name, std::move(v)).first->second;
  }

 private:
  // The categories' words in the list of names that comes with the vectors.
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kClipNames = {
      {{"sofa", "couch"}, {"plant", "houseplant"}, {"tv monitor", "television"}}};

  Feature Own(const std::string& name) const {
    return RandomUnit(MixSeed(seed_, HashString(name)), dim_);
  }

  int dim_;
  std::uint64_t seed_;
  double confusion_;
  double common_share_ = kCommonShare;
  Feature common_;
  bool has_known_ = false;
  NamedVectors vectors_;
};

std::uint64_t SeedOfPose(std::uint64_t seed, const Pose& pose) {
  for (int i = 0; i < 12; ++i) {
    const double value = pose.matrix()(i % 3, i / 3);
    seed = MixSeed(seed, static_cast<std::uint64_t>(std::llround(value * 1e4)));
  }
  return seed;
}

// How much of each cell shows each of the frame's instances: cells x instances.
struct CellContents {
  std::vector<std::int32_t> instances;  // ids, in order of appearance
  std::vector<float> share;             // rows x cols x instances
};

CellContents CountCells(const InstanceImage& image, int rows, int cols) {
  CellContents out;
  std::map<std::int32_t, std::int32_t> index;
  std::int32_t last_id = -1, last_index = -1;
  std::vector<std::pair<std::int32_t, std::int32_t>> samples;  // cell, position in `instances`
  samples.reserve(image.data.size() / (kPixelStride * kPixelStride) + image.width + image.height);
  for (int v = kPixelStride / 2; v < image.height; v += kPixelStride)
    for (int u = kPixelStride / 2; u < image.width; u += kPixelStride) {
      const std::int32_t id = image.At(u, v);
      if (id != last_id || last_index < 0) {
        const auto next = static_cast<std::int32_t>(out.instances.size());
        const auto [it, is_new] = index.emplace(id, next);
        if (is_new) out.instances.push_back(id);
        last_id = id;
        last_index = it->second;
      }
      samples.emplace_back(v * rows / image.height * cols + u * cols / image.width, last_index);
    }
  const std::size_t n = out.instances.size();
  out.share.assign(static_cast<std::size_t>(rows) * cols * n, 0.0f);
  for (const auto& [cell, instance] : samples) out.share[cell * n + instance] += 1;
  return out;
}

// Binomial 3 x 3 blur over the grid, edges clamped; each cell's shares then sum to 1.
void BlurCells(CellContents& contents, int rows, int cols) {
  const std::size_t n = contents.instances.size();
  std::vector<float> out(contents.share.size(), 0.0f);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < cols; ++c) {
      float* to = &out[(static_cast<std::size_t>(r) * cols + c) * n];
      for (int dr = -1; dr <= 1; ++dr)
        for (int dc = -1; dc <= 1; ++dc) {
          const int rr = std::clamp(r + dr, 0, rows - 1), cc = std::clamp(c + dc, 0, cols - 1);
          const auto weight = static_cast<float>((2 - std::abs(dr)) * (2 - std::abs(dc)));
          const float* from = &contents.share[(static_cast<std::size_t>(rr) * cols + cc) * n];
          for (std::size_t k = 0; k < n; ++k) to[k] += weight * from[k];
        }
      float total = 0;
      for (std::size_t k = 0; k < n; ++k) total += to[k];
      for (std::size_t k = 0; k < n; ++k) to[k] /= std::max(total, 1e-6f);
    }
  contents.share = std::move(out);
}

class GroundTruthEncoder : public InstanceEncoder {
 public:
  GroundTruthEncoder(const Simulator* simulator, const GroundTruthConfig& config, TextSpace texts)
      : simulator_(simulator), config_(config), texts_(std::move(texts)) {
    config_.feature_dim = texts_.dim();
    for (int i = 0; i < kNoiseVectors; ++i)
      noise_.push_back(RandomUnit(MixSeed(config.seed, 1000 + i), config_.feature_dim));
  }

  int Dim() const override { return config_.feature_dim; }
  std::string Name() const override { return EncoderName(config_); }

  Result<std::vector<float>> EncodeText(std::string_view text) override {
    return texts_.Of(texts_.Resolve(text));
  }

  Result<FeatureGrid> EncodeImage(const Observation& obs) override {
    if (simulator_ == nullptr)
      return Fail(ErrorCode::kUnsupported, "this encoder has no simulator; it encodes texts");
    const InstanceImage& image = simulator_->last_frame().instance;
    if (image.empty() || image.width != obs.rgb.width || image.height != obs.rgb.height)
      return Fail(ErrorCode::kMismatch, "the observation is not the simulator's last frame");
    return EncodeInstances(image, obs.T_world_camera);
  }

  FeatureGrid EncodeInstances(const InstanceImage& image, const Pose& T_world_camera) override {
    const int rows = config_.feature_rows, cols = config_.feature_cols;
    CellContents contents = CountCells(image, rows, cols);
    BlurCells(contents, rows, cols);
    std::vector<const Feature*> looks;
    for (std::int32_t id : contents.instances) looks.push_back(&LookOf(id));

    FeatureGrid grid{rows, cols, config_.feature_dim, {}};
    grid.data.resize(static_cast<std::size_t>(rows) * cols * grid.dim);
    const std::uint64_t frame_seed = SeedOfPose(config_.seed, T_world_camera);
    for (int cell = 0; cell < rows * cols; ++cell) {
      const std::span<float> out(&grid.data[static_cast<std::size_t>(cell) * grid.dim],
                                 static_cast<std::size_t>(grid.dim));
      for (std::size_t k = 0; k < looks.size(); ++k) {
        const float share = contents.share[cell * looks.size() + k];
        if (share > 0) AddScaled(share, *looks[k], out);
      }
      AddNoise(frame_seed, cell / cols, cell % cols, out);
    }
    return grid;
  }

 private:
  // How instance `id` looks in every frame: its name's vector, leaning towards one look-alike, with
  // a bias of its own.
  const Feature& LookOf(std::int32_t id) {
    const auto found = looks_.find(id);
    if (found != looks_.end()) return found->second;
    const SceneInstance* instance = simulator_->scene().FindInstance(id);
    std::string name = "unknown";
    if (instance != nullptr) name = texts_.NameOf(*instance);
    Rng rng(MixSeed(config_.seed, static_cast<std::uint64_t>(id)), 17);
    Feature look = texts_.Of(name);
    const std::vector<std::string> others = LookAlikesOf(CanonicalName(name));
    if (!others.empty()) {
      const double lean = rng.Uniform(0, config_.confusion);
      const auto which = rng.Below(static_cast<std::uint32_t>(others.size()));
      const Feature& other = texts_.Of(texts_.Resolve(others[which]));
      for (std::size_t k = 0; k < look.size(); ++k)
        look[k] += static_cast<float>(lean) * (other[k] - look[k]);
    }
    AddScaled(kBiasShare * config_.feature_noise, RandomUnit(rng.Next(), config_.feature_dim),
              look);
    Normalize(look);
    return looks_.emplace(id, std::move(look)).first->second;
  }

  // Norm `feature_noise`: one vector shared by a patch of cells, one of the cell's own.
  void AddNoise(std::uint64_t frame_seed, int row, int col, std::span<float> out) const {
    const auto add = [&](std::uint64_t key, double share) {
      const std::uint64_t bits = MixSeed(frame_seed, key);
      const double sign = bits >> 63 != 0 ? -1.0 : 1.0;
      AddScaled(sign * share * config_.feature_noise, noise_[bits % kNoiseVectors], out);
    };
    const auto patch = static_cast<std::uint64_t>(row / kPatchCells) << 16 | (col / kPatchCells);
    const auto cell = static_cast<std::uint64_t>(row) << 16 | static_cast<std::uint64_t>(col);
    add(patch << 1, kPatchShare);
    add(cell << 1 | 1, std::sqrt(1 - kPatchShare * kPatchShare));
  }

  const Simulator* simulator_;  // null = texts alone
  GroundTruthConfig config_;
  TextSpace texts_;
  std::vector<Feature> noise_;
  std::map<std::int32_t, Feature> looks_;
};

Result<TextSpace> MakeTextSpace(const GroundTruthConfig& config) {
  if (config.clip_dir.empty()) return TextSpace(config.feature_dim, config.seed, config.confusion);
  const std::filesystem::path dir = config.clip_dir;
  auto known = perception::ReadNamedVectors(dir / "oid_names.txt", dir / "oid_clip_a+cname.npy");
  if (known) return TextSpace(std::move(*known), config.seed, config.confusion);
  known.error().what += " (needed by ground_truth.clip_dir)";
  return tl::unexpected(known.error());
}

}  // namespace

Result<std::unique_ptr<InstanceEncoder>> MakeGroundTruthEncoder(const Simulator& simulator,
                                                                const GroundTruthConfig& config) {
  auto texts = MakeTextSpace(config);
  if (!texts) return tl::unexpected(texts.error());
  return std::make_unique<GroundTruthEncoder>(&simulator, config, std::move(*texts));
}

Result<std::unique_ptr<perception::DenseEncoder>> MakeGroundTruthTexts(
    const GroundTruthConfig& config) {
  auto texts = MakeTextSpace(config);
  if (!texts) return tl::unexpected(texts.error());
  return std::make_unique<GroundTruthEncoder>(nullptr, config, std::move(*texts));
}

Result<void> CheckGroundTruthEncoder(const GroundTruthConfig& config) {
  const auto texts = MakeTextSpace(config);
  if (!texts) return tl::unexpected(texts.error());
  return {};
}

}  // namespace crossnav::sim
