// SPDX-License-Identifier: MIT
// Which voxels does some pixel's ray pass before it ends? Blocks that no ray can reach are dropped
// first; then a voxel is settled by the ray nearest to its centre where that ray goes on beyond it,
// or by the greatest reach around it where all rays end before it. What remains, next to surfaces,
// is asked ray by ray: all rays (`exact`) or those through eight inner points (`fast`).
#include <algorithm>
#include <array>
#include <cmath>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

using Eigen::Matrix3d;

constexpr double kMargin_m = 1e-5;   // chosen: far above rounding, far below a voxel
constexpr double kMargin_px = 1e-3;  // chosen: likewise

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

enum class Answer { kNo, kYes, kUnsure };

class Projection {
 public:
  Projection(MapData& map, const DepthFrame& frame)
      : map_(map), frame_(frame), view_(map.view), K_(frame.camera) {
    const double s = map.config.voxel_m;
    start_ = frame.T_world_camera.translation() / s;
    to_camera_ = frame.T_world_camera.linear().transpose() * s;
    const Matrix3d R = frame.T_world_camera.linear() / s;
    per_u_ = R.col(0) / K_.fx;
    per_v_ = R.col(1) / K_.fy;
    forward_ = R.col(2) - K_.cx * per_u_ - K_.cy * per_v_;
    const double right = K_.width_px - 1 - K_.cx, bottom = K_.height_px - 1 - K_.cy;
    inward_ = {Vector3d(K_.fx, 0, K_.cx), Vector3d(-K_.fx, 0, right), Vector3d(0, K_.fy, K_.cy),
               Vector3d(0, -K_.fy, bottom)};
    voxel_ = ExtentOf(1);
    block_ = ExtentOf(kBlockSide);
    is_exact_ = map.config.rays == "exact";
    is_counted_ = map.config.clearing == "evidence";
    ball_m2_ = 0.49 * 0.49 * s * s;
    const double reach = std::max(1.0, static_cast<double>(view_.MaxReach()));
    parallel_ = 1e-7 / reach;
    slack_m_ = 1e-7 * reach * reach;
  }

  void Run(const KeyBounds& bounds) {
    const VoxelKey lo = BlockKeyOf(bounds.lo), hi = BlockKeyOf(bounds.hi);
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int x = lo.x; x <= hi.x; ++x) AskBlock({x, y, z});
  }

 private:
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
        if (inward_[i].dot(center) + extent.across[i] < -kMargin_m) return out;
      out.rect = {0, 0, view_.width() - 1, view_.height() - 1};
      return out;
    }
    const double x = center.x() / center.z(), y = center.y() / center.z();
    const double ru = (extent.half.x() + std::abs(x) * extent.half.z()) / out.z_near * K_.fx;
    const double rv = (extent.half.y() + std::abs(y) * extent.half.z()) / out.z_near * K_.fy;
    const double u = K_.fx * x + K_.cx, v = K_.fy * y + K_.cy;
    const double w = view_.width(), h = view_.height();
    out.rect.u0 = static_cast<int>(std::clamp(std::ceil(u - ru - kMargin_px), 0.0, w));
    out.rect.v0 = static_cast<int>(std::clamp(std::ceil(v - rv - kMargin_px), 0.0, h));
    out.rect.u1 = static_cast<int>(std::clamp(std::floor(u + ru + kMargin_px), -1.0, w - 1));
    out.rect.v1 = static_cast<int>(std::clamp(std::floor(v + rv + kMargin_px), -1.0, h - 1));
    return out;
  }

  bool MayReach(const CubeView& cube) const {
    return !cube.rect.empty() && view_.MaxReach(cube.rect) > cube.z_near - kMargin_m;
  }

  Vector3d CameraPointOf(const VoxelKey& key, double center) const {
    return to_camera_ * (Vector3d(key.x + center, key.y + center, key.z + center) - start_);
  }

  /// Voxels of the block whose evidence a passing ray could change.
  BlockMask Open(const VoxelBlock* block) const {
    if (block == nullptr) return ~BlockMask();
    if (is_counted_) return ~block->frame_hit;
    return ~(block->hit | block->frame_hit | (block->free & ~block->agent_support));
  }

  void AskBlock(const VoxelKey& block_key) {
    GridEntry* entry = map_.grid.FindEntry(block_key);
    const BlockMask open = Open(entry != nullptr ? &entry->block : nullptr);
    if (!open.Any()) return;
    const VoxelKey base = KeyInBlock(block_key, 0);
    if (!MayReach(ViewOf(CameraPointOf(base, 0.5 * kBlockSide), block_))) return;
    const Vector3d corner = CameraPointOf(base, 0.5);
    BlockMask passed;
    for (int z = 0; z < kBlockSide; ++z) {
      for (std::uint64_t bits = open.slices[z]; bits != 0; bits &= bits - 1) {
        const int cell = (z << 6) | std::countr_zero(bits);
        const VoxelKey key = KeyInBlock(block_key, cell);
        const Vector3d center = corner + to_camera_.col(0) * (cell & 7) +
                                to_camera_.col(1) * ((cell >> 3) & 7) + to_camera_.col(2) * z;
        if (IsPassed(key, center)) passed.Set(cell);
      }
    }
    if (!passed.Any()) return;
    if (map_.config.clip_to_extent) DropOutside(block_key, &passed);
    if (entry == nullptr) entry = &map_.grid.TouchEntry(block_key);
    entry->block.frame_free |= passed;
    ListInFrame(map_, *entry);
  }

  void DropOutside(const VoxelKey& block_key, BlockMask* mask) const {
    for (int cell = 0; cell < kBlockVoxels; ++cell)
      if (!IsKept(map_, KeyInBlock(block_key, cell))) mask->Reset(cell);
  }

  bool IsPassed(const VoxelKey& key, const Vector3d& center) const {
    if (IsPassedNearCenter(center)) return true;
    const CubeView cube = ViewOf(center, voxel_);
    if (!MayReach(cube)) return false;
    return is_exact_ ? IsPassedByAny(key, cube) : IsPassedInside(key, center);
  }

  /// The pixel whose ray is nearest to `p_camera`, if there is one.
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
    return view_.ReachAt(u, v) > center.z() + voxel_.half.z() + kMargin_m && miss_m2 < ball_m2_;
  }

  bool IsPassedInside(const VoxelKey& key, const Vector3d& center) const {
    constexpr double kInner = 0.3;  // chosen: of the voxel's edge, from the centre
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d offset((corner & 1) ? kInner : -kInner, (corner & 2) ? kInner : -kInner,
                            (corner & 4) ? kInner : -kInner);
      int u = 0, v = 0;
      double miss_m2 = 0;
      if (PixelOf(center + to_camera_ * offset, &u, &v, &miss_m2) && IsPassedBy(key, u, v))
        return true;
    }
    return false;
  }

  bool IsPassedByAny(const VoxelKey& key, const CubeView& cube) const {
    constexpr int kShift = DepthView::kTileShift;
    const PixelRect& r = cube.rect;
    for (int tv = r.v0 >> kShift; tv <= r.v1 >> kShift; ++tv) {
      for (int tu = r.u0 >> kShift; tu <= r.u1 >> kShift; ++tu) {
        if (view_.TileReach(tu, tv) < cube.z_near - kMargin_m) continue;
        const PixelRect tile{std::max(r.u0, tu << kShift), std::max(r.v0, tv << kShift),
                             std::min(r.u1, (tu << kShift) + (1 << kShift) - 1),
                             std::min(r.v1, (tv << kShift) + (1 << kShift) - 1)};
        if (MayMeet(key, tile) && IsPassedInTile(key, tile)) return true;
      }
    }
    return false;
  }

  bool IsPassedInTile(const VoxelKey& key, const PixelRect& tile) const {
    for (int v = tile.v0; v <= tile.v1; ++v)
      for (int u = tile.u0; u <= tile.u1; ++u)
        if (IsPassedBy(key, u, v)) return true;
    return false;
  }

  /// False if no ray between the rectangle's corner rays can meet the voxel.
  bool MayMeet(const VoxelKey& key, const PixelRect& rect) const {
    const std::array<int, 3> cell = {key.x, key.y, key.z};
    double enter = 0, leave = 1e300;
    for (int a = 0; a < 3; ++a) {
      const double d = forward_[a], u0 = per_u_[a] * rect.u0, u1 = per_u_[a] * rect.u1;
      const double v0 = per_v_[a] * rect.v0, v1 = per_v_[a] * rect.v1;
      const double d_lo = d + std::min(u0, u1) + std::min(v0, v1);
      const double d_hi = d + std::max(u0, u1) + std::max(v0, v1);
      const double lo = cell[a] - start_[a] - 1e-6, hi = cell[a] + 1 - start_[a] + 1e-6;
      if (lo > 0) {
        if (d_hi <= 0) return false;
        enter = std::max(enter, lo / d_hi);
        if (d_lo > 0) leave = std::min(leave, hi / d_lo);
      } else if (hi < 0) {
        if (d_lo >= 0) return false;
        enter = std::max(enter, hi / d_lo);
        if (d_hi < 0) leave = std::min(leave, lo / d_hi);
      } else {
        if (d_lo > 0) leave = std::min(leave, hi / d_lo);
        if (d_hi < 0) leave = std::min(leave, lo / d_hi);
      }
    }
    return enter <= leave + slack_m_;
  }

  /// Does the ray of pixel (u, v) pass the voxel before it ends?
  bool IsPassedBy(const VoxelKey& key, int u, int v) const {
    const double reach_m = view_.ReachAt(u, v);
    if (reach_m == 0) return false;
    const Answer answer = AskRay(key, forward_ + per_u_ * u + per_v_ * v, reach_m);
    if (answer != Answer::kUnsure) return answer == Answer::kYes;
    const DepthReach literal =
        ReachOf(frame_.depth_m.At(u, v), map_.config.depth_min_m, map_.config.depth_max_m);
    const Vector3d end =
        BackProjectToVoxels(K_, frame_.T_world_camera, u, v, literal.depth_m, map_.config.voxel_m);
    return RayPasses(start_, end, key);
  }

  /// The ray against the voxel's faces, with room for rounding. `direction`: voxels per metre of
  /// depth.
  Answer AskRay(const VoxelKey& key, const Vector3d& direction, double reach_m) const {
    const std::array<int, 3> cell = {key.x, key.y, key.z};
    double enter = 0, leave = reach_m + 1;
    bool is_unsure = false;
    for (int a = 0; a < 3; ++a) {
      const double lo = cell[a] - start_[a], hi = lo + 1;
      if (std::abs(direction[a]) < parallel_) {
        if (lo > 1e-6 || hi < -1e-6) return Answer::kNo;
        is_unsure = true;
        continue;
      }
      const double inverse = 1 / direction[a];
      const double t0 = lo * inverse, t1 = hi * inverse;
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    if (leave < enter - slack_m_ || reach_m < leave - slack_m_) return Answer::kNo;
    const bool is_sure = leave > enter + slack_m_ && reach_m > leave + slack_m_;
    return is_sure && !is_unsure ? Answer::kYes : Answer::kUnsure;
  }

  MapData& map_;
  const DepthFrame& frame_;
  const DepthView& view_;
  const CameraIntrinsics& K_;
  Vector3d start_;                    ///< camera [voxels]
  Matrix3d to_camera_;                ///< voxels from the camera -> camera frame [m]
  Vector3d per_u_, per_v_, forward_;  ///< ray of (u, v): voxels per metre of depth
  std::array<Vector3d, 4> inward_;    ///< normals of the image's side planes, camera frame
  CubeExtent voxel_, block_;
  bool is_exact_ = false, is_counted_ = false;
  double ball_m2_ = 0, parallel_ = 0, slack_m_ = 0;
};

}  // namespace

void CollectFreeByProjection(MapData& map, const DepthFrame& frame, const KeyBounds& bounds) {
  if (map.view.MaxReach() > 0) Projection(map, frame).Run(bounds);
}

}  // namespace crossnav::geometry
