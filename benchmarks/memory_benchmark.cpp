// SPDX-License-Identifier: MIT
// Costs of the semantic memory on one thread, each beside its baseline in the same run: lifting a
// frame against a plain upsample-and-scatter, a query against the machine's read bandwidth for the
// same bytes. Process CPU time, runs alternating. Also the same query of int8 rows, the cost of
// compaction, and the cost of saving and loading. Usage:
//
//   memory_benchmark [frames] [rows]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "counted_memory.h"
#include "crossnav/core/rng.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/row_store.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/store/map_file.h"

namespace {

using namespace crossnav;          // NOLINT: a program, not a header
using namespace crossnav::memory;  // NOLINT

constexpr int kSide = 640, kGrid = 24, kDim = 768;
constexpr double kVoxel = 0.10;

double CpuMs() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec * 1e3 + t.tv_nsec * 1e-6;
}

struct Series {
  std::vector<double> ms;
  void Add(double value) { ms.push_back(value); }
  double At(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * (sorted.size() - 1) + 0.5)];
  }
};

// --- A furnished room as boxes, seen by a ray per pixel -----------------------------------------

struct SolidBox {
  Vector3d lo, hi;
};

double RoomDepth(const Vector3d& p, const Vector3d& d, const std::vector<SolidBox>& boxes) {
  const SolidBox room{{-4, -4, 0}, {4, 4, 2.8}};
  double best = 1e9;
  for (int a = 0; a < 3; ++a)
    if (d[a] != 0) best = std::min(best, ((d[a] > 0 ? room.hi[a] : room.lo[a]) - p[a]) / d[a]);
  for (const SolidBox& box : boxes) {
    double enter = 0, leave = best;
    for (int a = 0; a < 3; ++a) {
      const double t0 = (box.lo[a] - p[a]) / d[a], t1 = (box.hi[a] - p[a]) / d[a];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    if (enter < leave) best = std::min(best, enter);
  }
  return best;
}

struct BenchFrame {
  DepthImage depth;
  Pose T_world_camera;
  std::vector<PixelVoxel> pixels;
};

BenchFrame MakeFrame(int i, int count, const CameraIntrinsics& camera,
                     const std::vector<SolidBox>& boxes) {
  BenchFrame f;
  f.depth = DepthImage(kSide, kSide);
  const double a = 2 * M_PI * i / count;
  f.T_world_camera =
      CameraPose({{1.5 * std::cos(a), 1.5 * std::sin(a), 0}, 3 * a, DegToRad(-15)}, 0.88);
  f.pixels.reserve(f.depth.data.size());
  const Vector3d p = f.T_world_camera.translation();
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      const Vector3d ray = f.T_world_camera.linear() * BackProjectPixel(camera, u, v, 1.0);
      const double z = RoomDepth(p, ray, boxes) + 1e-4;
      if (z > 5.0) continue;
      f.depth.At(u, v) = static_cast<float>(z);
      f.pixels.push_back({v * kSide + u, geometry::KeyOf(p + z * ray, kVoxel)});
    }
  return f;
}

// --- Upsample and scatter, written plainly ------------------------------------------------------

class PlainMemory {
 public:
  void Fuse(const BenchFrame& f, const CameraIntrinsics& camera, const FeatureGridView& grid) {
    const Image<float> quality = ObservationQuality(f.depth, camera, {});
    const std::vector<float> dense = Upsample(grid);
    std::unordered_map<VoxelKey, std::int32_t, geometry::VoxelKeyHash> slots;
    std::vector<float> sums;
    std::vector<double> totals;
    std::vector<VoxelKey> keys;
    for (const PixelVoxel& p : f.pixels) {
      const auto [it, is_new] = slots.emplace(p.key, static_cast<std::int32_t>(keys.size()));
      if (is_new) {
        keys.push_back(p.key);
        totals.push_back(0);
        sums.resize(sums.size() + kDim, 0.0f);
      }
      const float q = quality.data[p.pixel];
      float* sum = &sums[static_cast<std::size_t>(it->second) * kDim];
      const float* feature = &dense[static_cast<std::size_t>(p.pixel) * kDim];
      for (int i = 0; i < kDim; ++i) sum[i] += q * feature[i];
      totals[it->second] += q;
    }
    for (std::size_t k = 0; k < keys.size(); ++k) {
      auto& [feature, weight] = rows_[keys[k]];
      feature.resize(kDim, 0.0f);
      const double c = totals[k];
      const auto keep = static_cast<float>(weight / (weight + c));
      const auto share = static_cast<float>(c / (weight + c) / (c + 1e-6));
      for (int i = 0; i < kDim; ++i) feature[i] = keep * feature[i] + share * sums[k * kDim + i];
      weight += c;
    }
  }

  double WorstError(const SemanticMemory& memory) const {
    double worst = 0;
    for (const auto& [key, row] : rows_) {
      const std::vector<float> mine = memory.FeatureAt(*memory.RowOf(key));
      double scale = 0, error = 0;
      for (int i = 0; i < kDim; ++i) {
        scale = std::max(scale, std::abs(static_cast<double>(row.first[i])));
        error = std::max(error, std::abs(static_cast<double>(row.first[i]) - mine[i]));
      }
      worst = std::max(worst, error / scale);
    }
    return worst;
  }

 private:
  static std::vector<float> Upsample(const FeatureGridView& grid) {
    std::vector<float> dense(static_cast<std::size_t>(kSide) * kSide * kDim);
    for (int v = 0; v < kSide; ++v)
      for (int u = 0; u < kSide; ++u) {
        const double y = std::clamp((v + 0.5) * kGrid / kSide - 0.5, 0.0, kGrid - 1.0);
        const double x = std::clamp((u + 0.5) * kGrid / kSide - 0.5, 0.0, kGrid - 1.0);
        const int y0 = static_cast<int>(y), x0 = static_cast<int>(x);
        const int y1 = std::min(y0 + 1, kGrid - 1), x1 = std::min(x0 + 1, kGrid - 1);
        const auto fy = static_cast<float>(y - y0), fx = static_cast<float>(x - x0);
        const auto cell = [&](int r, int c) { return &grid.data[(r * kGrid + c) * kDim]; };
        const float *a = cell(y0, x0), *b = cell(y0, x1), *c = cell(y1, x0), *d = cell(y1, x1);
        float* out = &dense[(static_cast<std::size_t>(v) * kSide + u) * kDim];
        for (int i = 0; i < kDim; ++i)
          out[i] = (1 - fy) * ((1 - fx) * a[i] + fx * b[i]) + fy * ((1 - fx) * c[i] + fx * d[i]);
      }
    return dense;
  }

  std::unordered_map<VoxelKey, std::pair<std::vector<float>, double>, geometry::VoxelKeyHash> rows_;
};

void BenchLifting(int frame_count) {
  const CameraIntrinsics camera = IntrinsicsFromHfov(kSide, kSide, DegToRad(90));
  std::vector<SolidBox> boxes;
  Rng rng(1);
  for (int i = 0; i < 8; ++i) {
    const Vector3d lo(rng.Uniform(-3.8, 2.8), rng.Uniform(-3.8, 2.8), 0);
    boxes.push_back(
        {lo, lo + Vector3d(rng.Uniform(0.4, 1.2), rng.Uniform(0.4, 1.2), rng.Uniform(0.4, 1.8))});
  }
  std::vector<float> data(static_cast<std::size_t>(kGrid) * kGrid * kDim);
  for (float& x : data) x = static_cast<float>(rng.Normal());
  const FeatureGridView grid{kGrid, kGrid, kDim, data};

  SemanticMemory memory, exact(FusionConfig{.storage = "float"});
  PlainMemory plain;
  Series ours, plain_ms;
  double pixels = 0, transient_mb = 0, voxels = 0, plain_mb = 0;
  for (int i = 0; i < frame_count; ++i) {
    const BenchFrame f = MakeFrame(i, frame_count, camera, boxes);
    pixels += static_cast<double>(f.pixels.size()) / frame_count;
    std::vector<VoxelKey> keys;
    for (const PixelVoxel& p : f.pixels) keys.push_back(p.key);
    std::sort(keys.begin(), keys.end());
    voxels +=
        static_cast<double>(std::unique(keys.begin(), keys.end()) - keys.begin()) / frame_count;

    const auto runs = geometry::RunsOf(f.pixels, kSide);  // as the map gives them
    const long long rows_before = memory.Size();
    const long long held = MarkHeldBytes();
    const double start = CpuMs();
    memory.FuseRuns(runs, f.depth, camera, f.T_world_camera, grid);
    ours.Add(CpuMs() - start);
    const double grown = static_cast<double>(memory.Size() - rows_before) * RowStride(kDim) * 2;
    transient_mb = std::max(transient_mb, (static_cast<double>(PeakBytes() - held) - grown) / 1e6);

    if (i % 40 != 0) continue;  // the plain code is slow
    exact = SemanticMemory(FusionConfig{.storage = "float"});
    plain = PlainMemory();
    exact.Fuse(f.pixels, f.depth, camera, f.T_world_camera, grid);
    const long long plain_held = MarkHeldBytes();
    const double plain_start = CpuMs();
    plain.Fuse(f, camera, grid);
    plain_ms.Add(CpuMs() - plain_start);
    plain_mb = std::max(plain_mb, static_cast<double>(PeakBytes() - plain_held) / 1e6);
  }
  std::printf("lifting %dx%d, %dx%dx%d: %.0f pixels, %.0f voxels a frame, %d frames, %lld rows\n",
              kSide, kSide, kGrid, kGrid, kDim, pixels, voxels, frame_count,
              static_cast<long long>(memory.Size()));
  std::printf("  sparse weights      p50 %8.2f ms  p95 %8.2f ms   transient %8.1f MB\n",
              ours.At(0.5), ours.At(0.95), transient_mb);
  std::printf("  upsample + scatter  p50 %8.2f ms                  transient %8.1f MB  (%.0fx)\n",
              plain_ms.At(0.5), plain_mb, plain_ms.At(0.5) / ours.At(0.5));
  std::printf("  largest relative difference of a row (float rows, last compared frame) %.1e\n",
              plain.WorstError(exact));
}

// Reads every byte once; compiled for the widest registers this machine has.
#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
std::uint64_t
ReadAll(const std::uint64_t* p, std::size_t n) {
  std::uint64_t a[64] = {};
  for (std::size_t i = 0; i + 64 <= n; i += 64)
    for (int k = 0; k < 64; ++k) a[k] ^= p[i + k];
  std::uint64_t x = 0;
  for (std::uint64_t v : a) x ^= v;
  return x;
}

// CPU time, without the disk's share.
void BenchFile(const memory::SemanticMemory& memory) {
  const auto path = std::filesystem::temp_directory_path() / "crossnav_memory_benchmark.map";
  std::filesystem::remove(path);
  const geometry::VoxelMap map;
  double start = CpuMs();
  const auto first = store::SaveMemory(path, map, memory, {});
  const double first_ms = CpuMs() - start;
  start = CpuMs();
  const auto again = store::SaveMemory(path, map, memory, {});
  const double again_ms = CpuMs() - start;
  start = CpuMs();
  const auto loaded = store::LoadMemory(path);
  const double load_ms = CpuMs() - start;
  if (!first || !again || !loaded) {
    std::printf("saving failed\n");
    return;
  }
  std::printf("map file %.0f MB: first save %.0f ms, save without changes %.0f ms, load %.0f ms\n",
              static_cast<double>(std::filesystem::file_size(path)) / 1e6, first_ms, again_ms,
              load_ms);
  std::filesystem::remove(path);
}

// The same rows under half the budget, so that all become int8.
void BenchCompact(const SemanticMemory& full, const std::vector<float>& text, double read_ms) {
  FusionConfig config;
  config.max_rows = static_cast<int>((full.Size() + 1) * 10 / 18);
  SemanticMemory memory(config, kVoxel, kDim);
  for (std::int64_t row = 0; row < full.Size(); ++row) memory.AppendRow(full.RowAt(row));
  const std::vector<float> data(kDim, 1.0f);
  const CameraIntrinsics camera = IntrinsicsFromHfov(8, 8, 1.4);
  double start = CpuMs();
  memory.Fuse({}, DepthImage(8, 8), camera, Pose::Identity(), {1, 1, kDim, data});
  const double compact_ms = CpuMs() - start;
  const auto compacted = static_cast<double>(memory.Counters().compacted_rows);

  const std::vector<float> before = full.Similarity(text);
  double worst = 0;
  Series similarity;
  for (int i = 0; i < 31; ++i) {
    start = CpuMs();
    const std::vector<float> after = memory.Similarity(text);
    similarity.Add(CpuMs() - start);
    for (std::size_t row = 0; row < after.size() && i == 0; ++row)
      worst = std::max(worst, static_cast<double>(std::abs(after[row] - before[row])));
  }
  std::printf(
      "  similarity, %3.0f %% int8 p50 %6.2f ms  %.2fx of reading half the bytes; largest "
      "difference %.1e\n",
      100 * compacted / static_cast<double>(memory.Size()), similarity.At(0.5),
      similarity.At(0.5) / (read_ms / 2), worst);
  std::printf("  compacting them     %.0f ms, %.2f us a row; %.0f MB instead of %.0f\n", compact_ms,
              1e3 * compact_ms / compacted, static_cast<double>(memory.Bytes()) / 1e6,
              static_cast<double>(full.Bytes()) / 1e6);
}

void BenchQuery(std::int64_t row_count) {
  SemanticMemory memory({}, kVoxel, kDim);
  Rng rng(2);
  MemoryRow row;
  row.half.resize(kDim);
  std::vector<float> f(kDim);
  for (std::int64_t i = 0; i < row_count; ++i) {
    for (float& x : f) x = static_cast<float>(rng.Uniform(-1, 1));
    ToHalf(f, row.half.data());
    row.key = {static_cast<int>(i % 500), static_cast<int>(i / 500), static_cast<int>(i % 7)};
    row.weight = 1;
    memory.AppendRow(row);
  }
  std::vector<float> text(kDim);
  for (float& x : text) x = static_cast<float>(rng.Normal());
  const std::size_t words = static_cast<std::size_t>(row_count) * kDim * 2 / 8;
  constexpr std::size_t kHugePage = std::size_t{2} << 20;
  auto* buffer = static_cast<std::uint64_t*>(
      std::aligned_alloc(kHugePage, (words * 8 + kHugePage - 1) / kHugePage * kHugePage));
  AdviseHugePages(buffer, words * 8);
  for (std::size_t i = 0; i < words; ++i) buffer[i] = i * 0x9e3779b97f4a7c15ULL;

  Series read, similarity, query;
  std::uint64_t sink = 0;
  double checksum = 0;
  for (int i = 0; i < 31; ++i) {
    double start = CpuMs();
    sink ^= ReadAll(buffer, words);
    read.Add(CpuMs() - start);
    start = CpuMs();
    checksum += memory.Similarity(text)[i];
    similarity.Add(CpuMs() - start);
    if (i % 3 != 0) continue;
    start = CpuMs();
    checksum += static_cast<double>(Query(memory, text, {}).size());
    query.Add(CpuMs() - start);
  }
  std::free(buffer);
  const double gb = static_cast<double>(words) * 8 / 1e9;
  std::printf("query %lld rows x %d half precision, %.0f MB, kernels %s (checks %llx %.3f)\n",
              static_cast<long long>(row_count), kDim, gb * 1e3, KernelTarget(),
              static_cast<unsigned long long>(sink & 0xff), checksum);
  std::printf("  read bandwidth      p50 %8.2f ms  best %8.2f ms   %.1f GB/s\n", read.At(0.5),
              read.At(0), gb / read.At(0.5) * 1e3);
  std::printf(
      "  similarity          p50 %8.2f ms  best %8.2f ms   %.2fx of the limit (best %.2fx)\n",
      similarity.At(0.5), similarity.At(0), similarity.At(0.5) / read.At(0.5),
      similarity.At(0) / read.At(0));
  std::printf("  whole query         p50 %8.2f ms  (clusters and scores included)\n",
              query.At(0.5));
  BenchCompact(memory, text, read.At(0.5));
  BenchFile(memory);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
  const long long rows = argc > 2 ? std::max(1LL, std::atoll(argv[2])) : 200000;
  BenchLifting(frames);
  BenchQuery(rows);
  return 0;
}
