// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/resolve_lanes.h"

#include <algorithm>

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/sim/render/resolve_lanes.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                     // IWYU pragma: keep

#include <hwy/highway.h>

#include "crossnav/sim/render/lane_words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Double = hn::CappedTag<double, 4>;
using Single = hn::Rebind<float, Double>;
using Instance = hn::Rebind<std::int32_t, Double>;

// A row of the canvas and of its rays.
struct Row {
  const float* inverse_depth;
  const std::uint32_t* drawn;
  const PixelRays& rays;
  std::size_t v;

  HWY_INLINE hn::Vec<Double> Ray(std::size_t axis, std::size_t u) const {
    const Single d;
    return hn::PromoteTo(
        Double(), hn::Add(hn::LoadU(d, &rays.across[axis][u]), hn::Set(d, rays.down[axis][v])));
  }
};

// Adjacent pixels and their triangles.
struct Group {
  std::array<const Drawn*, 4> drawn;  // by lane; arbitrary for empty pixels
  bool is_one;                        // triangle for all

  HWY_INLINE Group(const Canvas& canvas, const Row& row, std::size_t u) {
    const std::size_t count = hn::Lanes(Double());
    is_one = true;
    for (std::size_t lane = 0; lane < count; ++lane) {
      const bool is_drawn = row.inverse_depth[u + lane] > 0;
      drawn[lane] = &canvas.triangles[is_drawn ? row.drawn[u + lane] : 0];
      is_one = is_one && drawn[lane] == drawn[0];
    }
  }

  // Words of their planes.
  HWY_INLINE hn::Vec<Double> Plane(std::size_t k) const {
    const Double d;
    if (is_one) return hn::Set(d, drawn[0]->plane[k]);
    alignas(32) std::array<double, 4> words;
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) words[lane] = drawn[lane]->plane[k];
    return hn::Load(d, words.data());
  }
};

// Where the rays of pixels from `u` on meet the planes of their triangles, in double precision.
HWY_INLINE hn::Vec<Single> Meet(const Group& group, const Row& row, std::size_t u) {
  const Double d;
  const Single ds;
  const auto along = hn::Add(
      hn::Mul(group.Plane(0), row.Ray(0, u)),
      hn::Add(hn::Mul(group.Plane(1), row.Ray(1, u)), hn::Mul(group.Plane(2), row.Ray(2, u))));
  const auto meets = hn::DemoteTo(ds, hn::Div(group.Plane(3), along));
  const auto grazes = hn::Lt(hn::Mul(along, along), group.Plane(4));
  const auto inverse = hn::LoadU(ds, row.inverse_depth + u);
  if (hn::AllFalse(d, grazes)) return hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(ds)), meets);
  const auto which =
      hn::Gt(hn::DemoteTo(ds, hn::IfThenElseZero(grazes, hn::Set(d, 1.0))), hn::Zero(ds));
  const auto depth = hn::IfThenElse(which, hn::Div(hn::Set(ds, 1.0F), inverse), meets);
  return hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(ds)), depth);
}

HWY_INLINE hn::Vec<Instance> InstancesOf(const Group& group, const Row& row, std::size_t u) {
  const Instance d;
  const Single ds;
  alignas(32) std::array<std::int32_t, 4> of;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) of[lane] = group.drawn[lane]->instance;
  const auto is_drawn = hn::Gt(hn::LoadU(ds, row.inverse_depth + u), hn::Zero(ds));
  return hn::IfThenElseZero(hn::RebindMask(d, is_drawn), hn::Load(d, of.data()));
}

void Geometry(const Canvas& canvas, const PixelRays& rays, Frame& frame) {
  const std::size_t step = hn::Lanes(Double());
  const auto width = static_cast<std::size_t>(canvas.width);
  for (std::size_t v = 0; v < static_cast<std::size_t>(canvas.height); ++v) {
    const std::size_t at = v * static_cast<std::size_t>(canvas.stride);
    const Row row{canvas.inverse_depth.data() + at, canvas.drawn.data() + at, rays, v};
    float* const depth_m = &frame.depth_m.data[v * width];
    std::int32_t* const instance = &frame.instance.data[v * width];
    for (std::size_t u = 0; u < width; u += step) {
      const Group group(canvas, row, u);
      const auto depths = Meet(group, row, u);
      const auto instances = InstancesOf(group, row, u);
      if (u + step <= width) {
        hn::StoreU(depths, Single(), depth_m + u);
        hn::StoreU(instances, Instance(), instance + u);
        continue;
      }
      std::array<float, 4> last_depths{};
      std::array<std::int32_t, 4> last_instances{};
      hn::StoreU(depths, Single(), last_depths.data());
      hn::StoreU(instances, Instance(), last_instances.data());
      std::copy_n(last_depths.begin(), width - u, depth_m + u);
      std::copy_n(last_instances.begin(), width - u, instance + u);
    }
  }
}

// Eight pixels as ShadePacket takes them.
struct Packet {
  using Lane = std::array<float, kShadeLanes>;
  alignas(32) std::array<std::int32_t, kShadeLanes> triangle{};
  alignas(32) Lane s{}, t{};
  alignas(32) std::array<Lane, 3> normal{}, ray{};
};

HWY_INLINE void Fill(const Canvas& canvas, const Row& row, std::size_t u, Packet& packet) {
  using Wide = hn::CappedTag<float, kShadeLanes>;
  const Wide d;
  const hn::RebindToSigned<Wide> di;
  static_assert(sizeof(Drawn) == 32 * 4);
  const auto* words = reinterpret_cast<const std::int32_t*>(canvas.triangles.data());
  for (std::size_t i = 0; i < kShadeLanes; i += hn::Lanes(d)) {
    const auto is_drawn = hn::Gt(hn::LoadU(d, row.inverse_depth + u + i), hn::Zero(d));
    const auto drawn = hn::BitCast(di, hn::LoadU(hn::RebindToUnsigned<Wide>(), row.drawn + u + i));
    const auto at = hn::ShiftLeft<5>(hn::IfThenElseZero(hn::RebindMask(di, is_drawn), drawn));
    const LaneWords<hn::RebindToSigned<Wide>> word(words, at);
    const auto number = [&](int k) { return hn::BitCast(d, word(k)); };
    const auto fu = hn::Iota(d, static_cast<float>(u + i));
    const auto fv = hn::Set(d, static_cast<float>(row.v));
    const auto weight = [&](int k) {
      return hn::Add(hn::Mul(number(k), fu), hn::Add(hn::Mul(number(k + 1), fv), number(k + 2)));
    };
    const auto a = weight(0), b = weight(3), c = weight(6);
    const auto sum = hn::Add(hn::Add(a, b), c);
    const auto share = [&](auto x) {
      const auto whole = hn::Min(hn::Max(hn::Div(x, sum), hn::Zero(d)), hn::Set(d, 1.0F));
      return hn::IfThenElseZero(hn::And(is_drawn, hn::Gt(sum, hn::Zero(d))), whole);
    };
    hn::StoreU(share(b), d, packet.s.data() + i);
    hn::StoreU(share(c), d, packet.t.data() + i);
    hn::StoreU(word(12), di, packet.triangle.data() + i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::StoreU(number(9 + static_cast<int>(axis)), d, packet.normal[axis].data() + i);
      hn::StoreU(hn::Add(hn::LoadU(d, &row.rays.across[axis][u + i]),
                         hn::Set(d, row.rays.down[axis][row.v])),
                 d, packet.ray[axis].data() + i);
    }
  }
}

void Colour(const Canvas& canvas, const PixelRays& rays, const Skins& skins, RgbImage& rgb) {
  const auto width = static_cast<std::size_t>(canvas.width);
  Packet packet;
  std::array<std::uint32_t, kShadeLanes> colours{};
  for (std::size_t v = 0; v < static_cast<std::size_t>(canvas.height); ++v) {
    const std::size_t at = v * static_cast<std::size_t>(canvas.stride);
    const Row row{canvas.inverse_depth.data() + at, canvas.drawn.data() + at, rays, v};
    for (std::size_t u = 0; u < width; u += kShadeLanes) {
      Fill(canvas, row, u, packet);
      const auto three = [](const std::array<Packet::Lane, 3>& p) {
        return std::array{p[0].data(), p[1].data(), p[2].data()};
      };
      ShadePacket(skins,
                  {packet.triangle.data(), packet.s.data(), packet.t.data(), three(packet.normal),
                   three(packet.ray)},
                  colours);
      for (std::size_t lane = 0; lane < std::min<std::size_t>(kShadeLanes, width - u); ++lane) {
        if (!(row.inverse_depth[u + lane] > 0)) continue;
        const std::uint32_t c = colours[lane];
        rgb.data[v * width + u + lane] = {static_cast<std::uint8_t>(c),
                                          static_cast<std::uint8_t>(c >> 8),
                                          static_cast<std::uint8_t>(c >> 16)};
      }
    }
  }
}

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::sim {

PixelRays::PixelRays(const CameraIntrinsics& K, const Pose& T_world_camera) {
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const auto at = [](int pixel, double centre, double focal) {
    return (static_cast<float>(pixel) - static_cast<float>(centre)) / static_cast<float>(focal);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    for (int u = 0; u < K.width_px + kShadeLanes; ++u)
      across[k].push_back(R(axis, 2) + at(u, K.cx, K.fx) * R(axis, 0));
    for (int v = 0; v < K.height_px; ++v) down[k].push_back(at(v, K.cy, K.fy) * R(axis, 1));
  }
}

HWY_EXPORT(Geometry);
HWY_EXPORT(Colour);

void ResolveGeometry(const Canvas& canvas, const PixelRays& rays, Frame& frame) {
  if (canvas.triangles.empty()) return;
  HWY_DYNAMIC_DISPATCH(Geometry)(canvas, rays, frame);
}

void ResolveColour(const Canvas& canvas, const PixelRays& rays, const Skins& skins, RgbImage& rgb) {
  if (canvas.triangles.empty()) return;
  HWY_DYNAMIC_DISPATCH(Colour)(canvas, rays, skins, rgb);
}

}  // namespace crossnav::sim
#endif  // HWY_ONCE
