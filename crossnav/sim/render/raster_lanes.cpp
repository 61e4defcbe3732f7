// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/raster_lanes.h"

#include <algorithm>
#include <bit>

#include "crossnav/sim/render/triangle_plane.h"

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/sim/render/raster_lanes.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                    // IWYU pragma: keep

#include <hwy/highway.h>

#include "crossnav/sim/render/canvas_tiles-inl.h"
#include "crossnav/sim/render/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Index = hn::RebindToSigned<Wide>;
using M = hn::Mask<Wide>;

constexpr float kNear_m = 0.05F;     // chosen: nearer triangles are searched in the whole picture
constexpr float kMargin_px = 0.05F;  // chosen: above the rounding of a pixel coordinate
constexpr float kFlat = 1e-25F;  // chosen: triangles seen edge-on to the last bit, or degenerate
// chosen: of surfaces nearer to each other than this share of their depth the first drawn is kept,
// so that the result does not alternate.
constexpr float kNearer = 1.00001F;

// Image-plane setup of eight triangles.
struct alignas(64) Footprints {
  using Lane = std::array<float, 8>;
  std::array<Lane, 9> lines;
  std::array<Lane, 3> inverse_depth;
  Lane least, greatest;                            // inverse depth of the corners
  std::array<std::array<std::int32_t, 8>, 4> box;  // u0, u1, v0, v1, inclusive
  unsigned alive = 0;
};

HWY_INLINE void StorePoint(const Point& p, Footprints::Lane* to, std::size_t i) {
  const Wide d;
  hn::StoreU(p.x, d, to[0].data() + i);
  hn::StoreU(p.y, d, to[1].data() + i);
  hn::StoreU(p.z, d, to[2].data() + i);
}

HWY_INLINE void Project(const Octet& octet, const RasterView& view, Footprints& out) {
  const Wide d;
  const Index di;
  out.alive = 0;
  for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
    const auto corner = [&](std::size_t k) {
      const auto& at = octet.corners[k];
      return ToPixels(view, {hn::LoadU(d, at[0].data() + i), hn::LoadU(d, at[1].data() + i),
                             hn::LoadU(d, at[2].data() + i)});
    };
    const Point a = corner(0), b = corner(1), c = corner(2);
    const V nearest = Least(a.z, b.z, c.z), farthest = Greatest(a.z, b.z, c.z);
    const V one = hn::Set(d, 1.0F), zero = hn::Zero(d);
    const M is_front = hn::Gt(nearest, hn::Set(d, kNear_m));
    const V ia = hn::Div(one, a.z), ib = hn::Div(one, b.z), ic = hn::Div(one, c.z);
    const V margin = hn::Set(d, kMargin_px);
    const auto range = [&](V x, V y, V z, int count, V& first, V& last) {
      const V end = hn::Set(d, static_cast<float>(count - 1));
      first = hn::Max(hn::Ceil(hn::Sub(Least(x, y, z), margin)), zero);
      last = hn::Min(hn::Floor(hn::Add(Greatest(x, y, z), margin)), end);
      first = hn::IfThenElse(is_front, first, zero);
      last = hn::IfThenElse(is_front, last, end);
    };
    V u0, u1, v0, v1;
    range(hn::Mul(a.x, ia), hn::Mul(b.x, ib), hn::Mul(c.x, ic), view.width, u0, u1);
    range(hn::Mul(a.y, ia), hn::Mul(b.y, ib), hn::Mul(c.y, ic), view.height, v0, v1);
    const Point normal = Cross(Minus(b, a), Minus(c, a));
    const V rise = Dot(normal, a);
    const M alive =
        hn::And(hn::And(hn::Gt(farthest, zero), hn::Gt(hn::Abs(rise), hn::Set(d, kFlat))),
                hn::And(hn::Ge(u1, u0), hn::Ge(v1, v0)));
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, alive, bits.data());
    if (bits[0] == 0) continue;
    out.alive |= static_cast<unsigned>(bits[0]) << i;
    // The sign makes all three weights positive inside.
    const V turn = hn::And(rise, hn::SignBit(d));
    const auto line = [&](const Point& p, const Point& q, std::size_t k) {
      const Point l = Line(p, q);
      StorePoint({hn::Xor(l.x, turn), hn::Xor(l.y, turn), hn::Xor(l.z, turn)}, &out.lines[3 * k],
                 i);
    };
    line(c, b, 0);
    line(a, c, 1);
    line(b, a, 2);
    const V scale = hn::Div(one, rise);
    StorePoint({hn::Mul(normal.x, scale), hn::Mul(normal.y, scale), hn::Mul(normal.z, scale)},
               out.inverse_depth.data(), i);
    hn::StoreU(hn::Div(one, farthest), d, out.least.data() + i);
    hn::StoreU(hn::IfThenElse(is_front, Greatest(ia, ib, ic), hn::Set(d, kHighest)), d,
               out.greatest.data() + i);
    hn::StoreU(hn::ConvertTo(di, u0), di, out.box[0].data() + i);
    hn::StoreU(hn::ConvertTo(di, u1), di, out.box[1].data() + i);
    hn::StoreU(hn::ConvertTo(di, v0), di, out.box[2].data() + i);
    hn::StoreU(hn::ConvertTo(di, v1), di, out.box[3].data() + i);
  }
}

void Remember(const Octet& octet, const Footprints& prints, std::size_t lane,
              const RasterView& view, Canvas& canvas) {
  Drawn& drawn = canvas.triangles.emplace_back();
  for (std::size_t k = 0; k < 9; ++k) drawn.weights[k] = prints.lines[k][lane];
  drawn.triangle = octet.triangle[lane];
  drawn.instance = octet.instance[lane];
  const auto corner = [&](std::size_t k) {
    return Vector3d(octet.corners[k][0][lane], octet.corners[k][1][lane],
                    octet.corners[k][2][lane]);
  };
  const SeenPlane plane = SeePlane(corner(0), corner(1), corner(2), view.origin.cast<double>());
  const Vector3d& n = plane.normal;
  drawn.plane = {n.x(), n.y(), n.z(), plane.rise, plane.least};
  for (int k = 0; k < 3; ++k) drawn.normal[static_cast<std::size_t>(k)] = static_cast<float>(n[k]);
}

// One triangle's functions of the pixel: weight k at (u, v) is wx[k] u + wy[k] v + wc[k].
struct Brush {
  V wx[3];
  float wy[3], wc[3];
  V dx;
  float dy, dc;  // likewise of the inverse depth
  V least, greatest;

  HWY_INLINE Brush(const Footprints& prints, std::size_t lane) {
    const Wide d;
    for (std::size_t k = 0; k < 3; ++k) {
      wx[k] = hn::Set(d, prints.lines[3 * k][lane]);
      wy[k] = prints.lines[3 * k + 1][lane];
      wc[k] = prints.lines[3 * k + 2][lane];
    }
    dx = hn::Set(d, prints.inverse_depth[0][lane]);
    dy = prints.inverse_depth[1][lane];
    dc = prints.inverse_depth[2][lane];
    least = hn::Set(d, prints.least[lane]);
    greatest = hn::Set(d, prints.greatest[lane]);
  }
};

template <bool kHoles>
HWY_INLINE M Solid(M inside, const V* weight, std::uint32_t triangle, const HoleTest& is_hole) {
  if constexpr (!kHoles) {
    return inside;
  } else {
    const Wide d;
    alignas(32) std::array<float, 8> a{}, b{}, c{}, solid{};
    hn::StoreU(weight[0], d, a.data());
    hn::StoreU(weight[1], d, b.data());
    hn::StoreU(weight[2], d, c.data());
    hn::StoreU(hn::IfThenElseZero(inside, hn::Set(d, 1.0F)), d, solid.data());
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (solid[lane] == 0) continue;
      const float sum = a[lane] + b[lane] + c[lane];
      if (!(sum > 0) || is_hole(triangle, b[lane] / sum, c[lane] / sum)) solid[lane] = 0;
    }
    return hn::Gt(hn::LoadU(d, solid.data()), hn::Zero(d));
  }
}

// Drawing state of one triangle.
template <bool kHoles>
struct Stroke {
  const Brush& brush;
  std::uint32_t triangle;
  const HoleTest& is_hole;
  Canvas& canvas;
  bool is_drawn = false;

  // The pixels of row `v` from `u0` to at least `u1`; the least inverse depths that they have then.
  HWY_INLINE V Row(int u0, int u1, int v) {
    const Wide d;
    V least = hn::Set(d, kHighest);
    const hn::RebindToUnsigned<Wide> du;
    const auto mark = hn::Set(du, static_cast<std::uint32_t>(canvas.triangles.size()));
    const auto fv = static_cast<float>(v);
    V row[3];
    for (int k = 0; k < 3; ++k) row[k] = hn::Set(d, brush.wy[k] * fv + brush.wc[k]);
    const V depth_row = hn::Set(d, brush.dy * fv + brush.dc);
    const std::size_t at = static_cast<std::size_t>(v) * static_cast<std::size_t>(canvas.stride);
    float* const nearest = canvas.inverse_depth.data() + at;
    std::uint32_t* const marks = canvas.drawn.data() + at;
    for (int u = u0; u <= u1; u += static_cast<int>(hn::Lanes(d))) {
      const V fu = hn::Iota(d, static_cast<float>(u));
      V weight[3];
      for (int k = 0; k < 3; ++k) weight[k] = hn::Add(hn::Mul(brush.wx[k], fu), row[k]);
      const V outside = Least(weight[0], weight[1], weight[2]);
      const V depth =
          hn::Min(hn::Max(hn::Add(hn::Mul(brush.dx, fu), depth_row), brush.least), brush.greatest);
      const V before = hn::LoadU(d, nearest + u);
      M takes = hn::And(hn::Ge(outside, hn::Zero(d)),
                        hn::Gt(depth, hn::Mul(before, hn::Set(d, kNearer))));
      if (hn::AllFalse(d, takes)) {
        least = hn::Min(least, before);
        continue;
      }
      takes = Solid<kHoles>(takes, weight, triangle, is_hole);  // padding may be drawn on, too
      const V after = hn::IfThenElse(takes, depth, before);
      least = hn::Min(least, after);
      hn::StoreU(after, d, nearest + u);
      const auto old = hn::LoadU(du, marks + u);
      hn::StoreU(hn::IfThenElse(hn::RebindMask(du, takes), mark, old), du, marks + u);
      is_drawn = true;
    }
    return least;
  }

  // One tile; of its rows only `first` to `last` are drawn on.
  HWY_INLINE void Tile(int u0, int v0, int first, int last) {
    V least = hn::Set(Wide(), kHighest);
    for (int v = v0; v < std::min(v0 + kTile, canvas.height); ++v)
      least = hn::Min(least, v < first || v > last ? LeastOfTileRow(canvas, u0, v)
                                                   : Row(u0, u0 + kTile - 1, v));
    NoteTile(canvas, canvas.tiles.Of(u0, v0), least);
  }

  // Whether the pixels from `u0` to `u1` of the row of tiles at `v` are all nearer than this.
  bool IsBehind(int u0, int u1, int v, float greatest) const {
    for (std::size_t tile = canvas.tiles.Of(u0, v); tile <= canvas.tiles.Of(u1, v); ++tile)
      if (greatest > canvas.tiles.least[tile] * kNearer) return false;
    return true;
  }

  // The pixels of a narrow box.
  HWY_INLINE void Rows(const PixelBox& box, float greatest) {
    for (int v = box.v0, next = 0; v <= box.v1; v = next) {
      next = std::min(v / kTile * kTile + kTile, box.v1 + 1);
      if (IsBehind(box.u0, box.u1, v, greatest)) continue;
      for (int y = v; y < next; ++y) Row(box.u0, box.u1, y);
      for (std::size_t tile = canvas.tiles.Of(box.u0, v); tile <= canvas.tiles.Of(box.u1, v);
           ++tile)
        canvas.is_stale[tile] = 1;
    }
  }

  // Tiles of the row from (`u0`, `v0`) on where the triangle may be visible
  // (conservative). The order of operations is that of Row, so that rounding cannot hide a
  // pixel.
  template <int kSide>
  HWY_INLINE std::uint32_t Reached(const Squares<kSide>& squares, int u0, int v0) const {
    const Wide d;
    const V left = hn::Add(hn::Set(d, static_cast<float>(u0)),
                           hn::Mul(hn::Iota(d, 0), hn::Set(d, static_cast<float>(kSide))));
    const V side = hn::Set(d, kSide - 1);
    const auto most = [&](V across, float down, float constant) {
      const V u = hn::Add(left, hn::IfThenElseZero(hn::Gt(across, hn::Zero(d)), side));
      const auto v = static_cast<float>(v0 + (down > 0 ? kSide - 1 : 0));
      return hn::Add(hn::Mul(across, u), hn::Set(d, down * v + constant));
    };
    const V depth =
        hn::Min(hn::Max(most(brush.dx, brush.dy, brush.dc), brush.least), brush.greatest);
    const V shown = hn::LoadU(d, &squares.least[squares.Of(u0, v0)]);
    M may = hn::Gt(depth, hn::Mul(shown, hn::Set(d, kNearer)));
    for (int k = 0; k < 3; ++k)
      may = hn::And(may, hn::Ge(most(brush.wx[k], brush.wy[k], brush.wc[k]), hn::Zero(d)));
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, may, bits.data());
    return bits[0];
  }

  // Calls draw(u, v) for each tile of the box that the triangle may reach.
  template <int kSide, class F>
  HWY_INLINE void EachReached(const Squares<kSide>& squares, const PixelBox& box, F&& draw) {
    constexpr int kStep = kSide * static_cast<int>(hn::MaxLanes(Wide()));
    for (int v = box.v0 / kSide * kSide; v <= box.v1; v += kSide)
      for (int u = box.u0 / kSide * kSide; u <= box.u1; u += kStep)
        for (std::uint32_t of = Reached(squares, u, v); of != 0; of &= of - 1) {
          const int left = u + kSide * std::countr_zero(of);
          if (left > box.u1) break;
          draw(left, v);
        }
  }

  // The pixels of one block that are in the box.
  HWY_INLINE void Block(int u0, int v0, const PixelBox& box) {
    const PixelBox part{std::max(u0, box.u0), std::min(u0 + kBlock - 1, box.u1),
                        std::max(v0, box.v0), std::min(v0 + kBlock - 1, box.v1)};
    bool is_reached = false;
    EachReached(canvas.tiles, part, [&](int u, int v) {
      Tile(u, v, box.v0, box.v1);
      is_reached = true;
    });
    if (is_reached) NoteBlock(canvas, u0, v0);
  }
};

template <bool kHoles>
HWY_INLINE void DrawTriangle(const Octet& octet, const Footprints& prints, std::size_t lane,
                             const RasterView& view, const HoleTest& is_hole, Canvas& canvas) {
  const Brush brush(prints, lane);
  const PixelBox box{prints.box[0][lane], prints.box[1][lane], prints.box[2][lane],
                     prints.box[3][lane]};
  Stroke<kHoles> stroke{brush, octet.triangle[lane], is_hole, canvas};
  if (box.u1 - box.u0 < 2 * kTile) {
    stroke.Rows(box, prints.greatest[lane]);
  } else {
    stroke.EachReached(canvas.blocks, box, [&](int u, int v) { stroke.Block(u, v, box); });
  }
  if (stroke.is_drawn) Remember(octet, prints, lane, view, canvas);
}

template <bool kHoles>
HWY_INLINE void DrawCluster(const TriangleClusters& all, const Cluster& cluster,
                            const RasterView& view, const HoleTest& is_hole, Canvas& canvas) {
  Footprints prints;
  for (std::uint32_t i = 0; i < cluster.count; ++i) {
    const Octet& octet = all.octets[cluster.first + i];
    Project(octet, view, prints);
    for (unsigned alive = prints.alive; alive != 0; alive &= alive - 1)
      DrawTriangle<kHoles>(octet, prints, static_cast<std::size_t>(std::countr_zero(alive)), view,
                           is_hole, canvas);
  }
}

// Whether all that the box covers on the picture is nearer than it.
HWY_INLINE bool IsHidden(const Cluster& cluster, float nearest_m, const RasterView& view,
                         Canvas& canvas) {
  if (nearest_m < kNear_m) return false;
  const Wide d;
  V u_low = hn::Set(d, 1e9F), u_high = hn::Set(d, -1e9F), v_low = u_low, v_high = u_high;
  alignas(32) static constexpr std::array<float, 8> kX{-1, 1, -1, 1, -1, 1, -1, 1},
      kY{-1, -1, 1, 1, -1, -1, 1, 1}, kZ{-1, -1, -1, -1, 1, 1, 1, 1};
  for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
    const auto along = [&](const std::array<float, 8>& side, int axis) {
      return hn::Add(hn::Set(d, cluster.centre[axis]),
                     hn::Mul(hn::Load(d, side.data() + i), hn::Set(d, cluster.half[axis])));
    };
    const Point p = ToPixels(view, {along(kX, 0), along(kY, 1), along(kZ, 2)});
    const V inverse = hn::Div(hn::Set(d, 1.0F), p.z);
    const V u = hn::Mul(p.x, inverse), v = hn::Mul(p.y, inverse);
    u_low = hn::Min(u_low, u);
    u_high = hn::Max(u_high, u);
    v_low = hn::Min(v_low, v);
    v_high = hn::Max(v_high, v);
  }
  const auto first = [&](V low) {
    return static_cast<int>(
        std::max(std::floor(hn::GetLane(hn::MinOfLanes(d, low)) - kMargin_px), 0.0F));
  };
  const auto last = [&](V high, int count) {
    return static_cast<int>(std::min(std::ceil(hn::GetLane(hn::MaxOfLanes(d, high)) + kMargin_px),
                                     static_cast<float>(count - 1)));
  };
  const PixelBox box{first(u_low), last(u_high, view.width), first(v_low),
                     last(v_high, view.height)};
  const float nearest = 1 / nearest_m * 1.00001F;
  for (int v = box.v0 / kTile * kTile; v <= box.v1; v += kTile)
    for (int u = box.u0 / kTile * kTile; u <= box.u1; u += kTile)
      if (canvas.tiles.least[canvas.tiles.Of(u, v)] < nearest &&
          !IsTileNearer(canvas, u, v, box, nearest))
        return false;
  return true;
}

void Draw(const TriangleClusters& all, const RasterView& view, const HoleTest& is_hole,
          Canvas& canvas) {
  for (const ClusterInView& s : ClustersInView(all, view)) {
    const Cluster& cluster = all.clusters[s.cluster];
    if (IsHidden(cluster, s.nearest_m, view, canvas)) continue;
    if (cluster.has_holes) {
      DrawCluster<true>(all, cluster, view, is_hole, canvas);
    } else {
      DrawCluster<false>(all, cluster, view, is_hole, canvas);
    }
  }
}

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::sim {

HWY_EXPORT(Draw);

void DrawClusters(const TriangleClusters& triangles, const RasterView& view,
                  const HoleTest& is_hole, Canvas& canvas) {
  HWY_DYNAMIC_DISPATCH(Draw)(triangles, view, is_hole, canvas);
}

}  // namespace crossnav::sim
#endif  // HWY_ONCE
