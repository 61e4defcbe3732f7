// SPDX-License-Identifier: MIT
// Projection: the voxels that a pixel's ray passes before its end. Blocks out of every ray's reach
// are dropped first. A voxel is passed if the ray nearest to its centre goes on beyond it, and is
// not passed if the greatest reach around it ends before it. The remaining voxels, next to
// surfaces, are tested ray by ray: all rays (`exact`), or some rows of them (`fast`).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/pixel_rays.h"
#include "crossnav/geometry/project_lanes.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

using Eigen::Matrix3d;

constexpr double kMargin_px = 1e-3;   // chosen: far above rounding of a pixel coordinate
constexpr double kLaneMargin = 1e-4;  // chosen: of the greatest reach, for positions in float
constexpr double kLaneSlack = 1e-6;   // chosen: sixteen roundings of a float
constexpr double kInner = 0.4;        // chosen: of a voxel's edge, near its corners
constexpr double kSkip = 0.5;         // chosen: of a voxel's depth, where `fast` does not look
constexpr int kRows = 8;              // chosen: of a voxel's pixels, that `fast` looks at

/// Half the extent of a cube, along the camera's axes and across the image's four side planes.
struct CubeExtent {
  Vector3d half;
  std::array<double, 4> across{};
};

/// The rays that could meet a cube.
struct CubeView {
  double z_near = 0, z_far = 0;  ///< camera depth [m]
  PixelRect rect;                ///< empty: none
};

/// First pixel after `bound` and last pixel before it, in a line of `count` pixels.
int FirstPixel(double bound, int count) {
  if (bound < 0) return 0;
  return bound >= count ? count : static_cast<int>(bound) + 1;
}
int LastPixel(double bound, int count) {
  if (bound < 0) return -1;
  return bound >= count ? count - 1 : static_cast<int>(bound);
}

class Projection {
 public:
  Projection(MapData& map, const DepthFrame& frame)
      : map_(map), view_(map.view), K_(frame.camera), rays_(map, frame) {
    const double s = map.config.voxel_m;
    start_key_ = KeyOfVoxelPoint(rays_.start());
    fraction_ = rays_.start() - Vector3d(start_key_.x, start_key_.y, start_key_.z);
    nearest_m_ = 0.5 * s;
    to_camera_ = frame.T_world_camera.linear().transpose() * s;
    const double right = K_.width_px - 1 - K_.cx, bottom = K_.height_px - 1 - K_.cy;
    inward_ = {Vector3d(K_.fx, 0, K_.cx), Vector3d(-K_.fx, 0, right), Vector3d(0, K_.fy, K_.cy),
               Vector3d(0, -K_.fy, bottom)};
    for (int level = 0; level < 4; ++level) cubes_[level] = ExtentOf(1 << level);
    for (int part = 0; part < 8; ++part)
      part_offset_[part] =
          to_camera_ * Vector3d(part & 1 ? 2 : -2, part & 2 ? 2 : -2, part & 4 ? 2 : -2);
    is_exact_ = map.config.rays == "exact";
    is_counted_ = map.config.clearing == "evidence";
    ball_m2_ = 0.49 * 0.49 * s * s;
    const double reach = std::max(1.0, static_cast<double>(view_.MaxReach()));
    margin_m_ = 1e-5 * reach;
    FillLanes(reach);
  }

  void Run(const KeyBounds& bounds) {
    const VoxelKey lo = BlockKeyOf(bounds.lo), hi = BlockKeyOf(bounds.hi);
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int x = lo.x; x <= hi.x; ++x) AskBlock({x, y, z});
  }

 private:
  void FillLanes(double reach_m) {
    const double s = map_.config.voxel_m;
    lanes_.fx = static_cast<float>(K_.fx);
    lanes_.fy = static_cast<float>(K_.fy);
    lanes_.cx = static_cast<float>(K_.cx);
    lanes_.cy = static_cast<float>(K_.cy);
    lanes_.width = view_.width();
    lanes_.height = view_.height();
    lanes_.reach_m = view_.Row(0);
    for (int a = 0; a < 9; ++a) lanes_.to_camera[a] = static_cast<float>(to_camera_(a / 3, a % 3));
    for (int a = 0; a < 3; ++a) lanes_.fraction[a] = static_cast<float>(fraction_[a]);
    lanes_.half_x = static_cast<float>(cubes_[0].half.x());
    lanes_.half_y = static_cast<float>(cubes_[0].half.y());
    lanes_.half_z = static_cast<float>(cubes_[0].half.z());
    lanes_.skip_m = static_cast<float>(is_exact_ ? 0 : 2 * kSkip * cubes_[0].half.z());
    lanes_.margin_m = static_cast<float>(kLaneMargin * reach_m);
    const double ball = std::max(0.0, 0.49 * s - kLaneMargin * reach_m);
    lanes_.ball_m2 = static_cast<float>(ball * ball);
    for (int a = 0; a < 3; ++a) {
      lanes_.per_u[a] = static_cast<float>(rays_.per_u()[a]);
      lanes_.per_v[a] = static_cast<float>(rays_.per_v()[a]);
      lanes_.ray[a] = static_cast<float>(rays_.forward()[a]);
    }
    const double reach_vox = reach_m / s,
                 ray_vox = rays_.per_u().cwiseAbs().maxCoeff() * view_.width() +
                           rays_.per_v().cwiseAbs().maxCoeff() * view_.height() + 1 / s;
    lanes_.room_slack = static_cast<float>(kLaneSlack * reach_vox * ray_vox);
    lanes_.beyond_slack = static_cast<float>(kLaneSlack * reach_m * ray_vox);
  }

  CubeExtent ExtentOf(double side_vox) const {
    CubeExtent extent;
    for (int a = 0; a < 3; ++a)
      extent.half[a] = 0.5 * side_vox * to_camera_.row(a).cwiseAbs().sum();
    for (int i = 0; i < 4; ++i)
      extent.across[i] = 0.5 * side_vox * (inward_[i].transpose() * to_camera_).cwiseAbs().sum();
    return extent;
  }

  /// Conservative: every ray that meets the cube is in the rectangle.
  CubeView ViewOf(const Vector3d& center, const CubeExtent& extent) const {
    CubeView out{center.z() - extent.half.z(), center.z() + extent.half.z(), {}};
    if (out.z_far < 0) return out;
    if (out.z_near < 0.25 * extent.half.z()) {  // at the camera: all rays that the sides allow
      for (int i = 0; i < 4; ++i)
        if (inward_[i].dot(center) + extent.across[i] < -margin_m_) return out;
      out.rect = {0, 0, view_.width() - 1, view_.height() - 1};
      return out;
    }
    const double x = center.x() / center.z(), y = center.y() / center.z();
    const double ru = (extent.half.x() + std::abs(x) * extent.half.z()) / out.z_near * K_.fx;
    const double rv = (extent.half.y() + std::abs(y) * extent.half.z()) / out.z_near * K_.fy;
    const double u = K_.fx * x + K_.cx, v = K_.fy * y + K_.cy;
    out.rect = {FirstPixel(u - ru - kMargin_px, view_.width()),
                FirstPixel(v - rv - kMargin_px, view_.height()),
                LastPixel(u + ru + kMargin_px, view_.width()),
                LastPixel(v + rv + kMargin_px, view_.height())};
    return out;
  }

  bool MayReach(const CubeView& cube) const {
    return !cube.rect.empty() && view_.MaxReach(cube.rect) > cube.z_near - margin_m_;
  }

  Vector3d CameraPointOf(const VoxelKey& key, double center) const {
    const VoxelKey offset = key - start_key_;
    return to_camera_ * Vector3d(offset.x + (center - fraction_.x()),
                                 offset.y + (center - fraction_.y()),
                                 offset.z + (center - fraction_.z()));
  }

  /// Voxels of the block with evidence that a passing ray could change.
  BlockMask Open(const VoxelBlock* block) const {
    if (block == nullptr) return ~BlockMask();
    if (is_counted_)
      return ~(block->frame_hit | (block->settled & block->free & ~block->agent_support));
    return ~(block->hit | block->frame_hit | (block->free & ~block->agent_support));
  }

  void AskBlock(const VoxelKey& block_key) {
    GridEntry* entry = map_.grid.FindEntry(block_key);
    const BlockMask open = Open(entry != nullptr ? &entry->block : nullptr);
    if (!open.Any()) return;
    const VoxelKey base = KeyInBlock(block_key, 0);
    const Vector3d center = CameraPointOf(base, 0.5 * kBlockSide);
    if (!MayReach(ViewOf(center, cubes_[3]))) return;
    BlockMask passed;
    for (int part = 0; part < 8; ++part) {
      const VoxelKey at{part & 1 ? 4 : 0, part & 2 ? 4 : 0, part & 4 ? 4 : 0};
      const std::uint64_t asked = PartBits(open, at);
      if (asked != 0)
        AddPartBits(AskPart(base + at, center + part_offset_[part], asked), at, &passed);
    }
    if (!passed.Any()) return;
    if (map_.config.clip_to_extent) DropOutside(block_key, &passed);
    if (entry == nullptr) entry = &map_.grid.TouchEntry(block_key);
    entry->block.frame_free |= passed;
    ListInFrame(map_, *entry);
  }

  /// 4 x 4 x 4 voxels from `first` on. Bits as PartBits.
  std::uint64_t AskPart(const VoxelKey& first, const Vector3d& center, std::uint64_t asked) {
    const CubeView cube = ViewOf(center, cubes_[2]);
    if (!MayReach(cube)) return 0;
    std::uint64_t at_camera = 0;
    if (cube.z_near < nearest_m_) at_camera = AtCamera(first, asked);
    LaneCube lanes;
    lanes.first = {static_cast<float>(first.x - start_key_.x),
                   static_cast<float>(first.y - start_key_.y),
                   static_cast<float>(first.z - start_key_.z)};
    lanes.dilated_m = view_.Dilated(PictureRadius(cube, center));
    lanes.columns = view_.tile_columns();
    lanes.asked = asked & ~at_camera;
    lanes.rows = is_exact_ ? 0 : kRows;
    LaneAnswer answer;
    if (lanes.asked != 0) answer = AskLaneCube(lanes_, lanes);
    return answer.passed |
           AskOneByOne(first, at_camera | (is_exact_ ? answer.possible : std::uint64_t{0}));
  }

  /// Voxels too near for the lanes.
  std::uint64_t AtCamera(const VoxelKey& first, std::uint64_t asked) const {
    std::uint64_t near = 0;
    for (; asked != 0; asked &= asked - 1) {
      const int i = std::countr_zero(asked);
      const VoxelKey key = first + VoxelKey{i & 3, (i >> 2) & 3, i >> 4};
      if (CameraPointOf(key, 0.5).z() - cubes_[0].half.z() < nearest_m_)
        near |= std::uint64_t{1} << i;
    }
    return near;
  }

  /// The same in double: at the camera, and where float cannot decide.
  std::uint64_t AskOneByOne(const VoxelKey& first, std::uint64_t asked) const {
    std::uint64_t found = 0;
    for (; asked != 0; asked &= asked - 1) {
      const int i = std::countr_zero(asked);
      const VoxelKey key = first + VoxelKey{i & 3, (i >> 2) & 3, i >> 4};
      const Vector3d center = CameraPointOf(key, 0.5);
      const CubeView cube = ViewOf(center, cubes_[0]);
      if (IsPassedNearCenter(center) || (MayReach(cube) && IsPassedInPicture(key, center, cube)))
        found |= std::uint64_t{1} << i;
    }
    return found;
  }

  /// At least half the size, in pixels, of the picture of any voxel of the part.
  double PictureRadius(const CubeView& cube, const Vector3d& center) const {
    const double margin = 2 * lanes_.margin_m;  // the lanes leave room for one
    const Vector3d half = cubes_[0].half + Vector3d::Constant(margin);
    const Vector3d& part = cubes_[2].half;
    const double inverse =
        1 / std::max(0.1 * nearest_m_, std::max(cube.z_near, nearest_m_) - margin);
    const double x = (std::abs(center.x()) + part.x()) * inverse;
    const double y = (std::abs(center.y()) + part.y()) * inverse;
    return 1.2 +  // from a place in a tile to whole pixels, and rounding
           inverse * std::max(K_.fx * (half.x() + x * half.z()), K_.fy * (half.y() + y * half.z()));
  }

  /// Bit x + 4 y + 16 z of the part at `at`.
  static std::uint64_t PartBits(const BlockMask& mask, const VoxelKey& at) {
    std::uint64_t bits = 0;
    for (int z = 3; z >= 0; --z) {
      const std::uint64_t slice = mask.slices[at.z + z] >> (at.y * kBlockSide + at.x);
      bits = bits << 16 | (slice & 0xf) | (slice >> 4 & 0xf0) | (slice >> 8 & 0xf00) |
             (slice >> 12 & 0xf000);
    }
    return bits;
  }
  static void AddPartBits(std::uint64_t bits, const VoxelKey& at, BlockMask* mask) {
    for (int z = 0; z < 4; ++z, bits >>= 16) {
      const std::uint64_t slice =
          (bits & 0xf) | (bits & 0xf0) << 4 | (bits & 0xf00) << 8 | (bits & 0xf000) << 12;
      mask->slices[at.z + z] |= slice << (at.y * kBlockSide + at.x);
    }
  }

  void DropOutside(const VoxelKey& block_key, BlockMask* mask) const {
    for (int cell = 0; cell < kBlockVoxels; ++cell)
      if (!IsKept(map_, KeyInBlock(block_key, cell))) mask->Reset(cell);
  }

  /// Pixel with the ray nearest to `p_camera`, if any.
  bool PixelOf(const Vector3d& p_camera, int* u, int* v, double* miss_m2) const {
    if (p_camera.z() <= 0) return false;
    const double inverse = 1 / p_camera.z();
    const double x = K_.fx * p_camera.x() * inverse + K_.cx + 0.5;
    const double y = K_.fy * p_camera.y() * inverse + K_.cy + 0.5;
    if (!(x >= 0 && y >= 0 && x < view_.width() && y < view_.height())) return false;
    *u = static_cast<int>(x);
    *v = static_cast<int>(y);
    const double du = (x - 0.5 - *u) * p_camera.z() / K_.fx;
    const double dv = (y - 0.5 - *v) * p_camera.z() / K_.fy;
    *miss_m2 = du * du + dv * dv;
    return true;
  }

  /// The ray nearest to the centre passes through the voxel's inner ball and ends beyond the voxel.
  bool IsPassedNearCenter(const Vector3d& center) const {
    int u = 0, v = 0;
    double miss_m2 = 0;
    if (!PixelOf(center, &u, &v, &miss_m2)) return false;
    return view_.ReachAt(u, v) > center.z() + cubes_[0].half.z() + margin_m_ && miss_m2 < ball_m2_;
  }

  bool IsPassedInPicture(const VoxelKey& key, const Vector3d& center, const CubeView& cube) const {
    return is_exact_ ? IsPassedByAny(key, cube) : IsPassedInside(key, center);
  }

  /// The rays nearest to eight inner points.
  bool IsPassedInside(const VoxelKey& key, const Vector3d& center) const {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d offset((corner & 1) ? kInner : -kInner, (corner & 2) ? kInner : -kInner,
                            (corner & 4) ? kInner : -kInner);
      int u = 0, v = 0;
      double miss_m2 = 0;
      if (PixelOf(center + to_camera_ * offset, &u, &v, &miss_m2) && rays_.Passes(key, u, v))
        return true;
    }
    return false;
  }

  bool IsPassedByAny(const VoxelKey& key, const CubeView& cube) const {
    constexpr int kSide = 32;  // chosen: larger pictures are asked part by part first
    const PixelRect& r = cube.rect;
    const bool is_whole = r.u1 - r.u0 < kSide && r.v1 - r.v0 < kSide;
    for (int v = r.v0; v <= r.v1; v += kSide) {
      for (int u = r.u0; u <= r.u1; u += kSide) {
        const PixelRect part{u, v, std::min(r.u1, u + kSide - 1), std::min(r.v1, v + kSide - 1)};
        if (!is_whole && !rays_.MayMeet(key, part)) continue;
        if (IsPassedInPart(key, part, cube.z_near - margin_m_)) return true;
      }
    }
    return false;
  }

  bool IsPassedInPart(const VoxelKey& key, const PixelRect& r, double z_near) const {
    const RowsAnswer answer =
        AskLaneRows(lanes_, {r.u0,
                             r.u1,
                             r.v0,
                             r.v1,
                             1,
                             static_cast<float>(std::max(0.0, z_near - lanes_.margin_m)),
                             {static_cast<float>(key.x - rays_.start().x()),
                              static_cast<float>(key.y - rays_.start().y()),
                              static_cast<float>(key.z - rays_.start().z())}});
    if (answer == RowsAnswer::kCertain) return true;
    return answer == RowsAnswer::kPossible && IsPassedInTile(key, r, z_near);
  }

  bool IsPassedInTile(const VoxelKey& key, const PixelRect& tile, double z_near) const {
    for (int v = tile.v0; v <= tile.v1; ++v)
      for (int u = tile.u0; u <= tile.u1; ++u)
        if (view_.ReachAt(u, v) >= z_near && rays_.Passes(key, u, v)) return true;
    return false;
  }

  MapData& map_;
  DepthView& view_;
  const CameraIntrinsics& K_;
  PixelRays rays_;
  LaneFrame lanes_;
  VoxelKey start_key_;
  Vector3d fraction_;                    ///< of rays_.start() in its voxel
  double nearest_m_ = 0;                 ///< nearer voxels are tested individually
  Matrix3d to_camera_;                   ///< voxels from the camera -> camera frame [m]
  std::array<Vector3d, 4> inward_;       ///< normals of the image's side planes, camera frame
  std::array<Vector3d, 8> part_offset_;  ///< of a block's eight parts from its centre, camera frame
  std::array<CubeExtent, 4> cubes_;      ///< of edges 1, 2, 4 and 8 voxels
  bool is_exact_ = false, is_counted_ = false;
  double margin_m_ = 0;  ///< far above rounding, far below a voxel
  double ball_m2_ = 0;
};

}  // namespace

void CollectFreeByProjection(MapData& map, const DepthFrame& frame, const KeyBounds& bounds) {
  if (map.view.MaxReach() > 0) Projection(map, frame).Run(bounds);
}

}  // namespace crossnav::geometry
