// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/shade_lanes.h"

#include <bit>
#include <cstring>

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/sim/render/shade_lanes.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                   // IWYU pragma: keep

#include <hwy/highway.h>

#include "crossnav/sim/render/lane_words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Operations come in shading.h's order and are not fused: the same bytes on every processor.
using Wide = hn::CappedTag<float, kShadeLanes>;
using Index = hn::RebindToSigned<Wide>;
using V = hn::Vec<Wide>;
using I = hn::Vec<Index>;
using M = hn::Mask<Wide>;

struct Colours {
  V r, g, b;
};

HWY_INLINE Colours Unpack(I packed) {
  const Wide d;
  const I low = hn::Set(Index(), 255);
  return {hn::ConvertTo(d, hn::And(packed, low)),
          hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(packed), low)),
          hn::ConvertTo(d, hn::And(hn::ShiftRight<16>(packed), low))};
}

// Words of the lanes' triangles.
struct Lanes {
  LaneWords<Index> words;

  HWY_INLINE Lanes(const Skins& skins, I triangle)
      : words(skins.triangles.front().words.data(), hn::ShiftLeft<4>(triangle)) {
    static_assert(Skins::kWords == 1 << 4);
  }
  HWY_INLINE I Word(int k) const { return words(k); }
  HWY_INLINE V Float(int k) const { return hn::BitCast(Wide(), Word(k)); }
};

// Weights of the three corners.
struct Weights {
  V a, b, c;

  HWY_INLINE V Of(V at_a, V at_b, V at_c) const {
    return hn::Add(hn::Add(hn::Mul(a, at_a), hn::Mul(b, at_b)), hn::Mul(c, at_c));
  }
  HWY_INLINE V Of(const Lanes& lanes, int k) const {
    return Of(lanes.Float(k), lanes.Float(k + 1), lanes.Float(k + 2));
  }
};

// A texture coordinate as the two pixels it lies between and the share of the second.
struct Between {
  I first, second;
  V share;
};

HWY_INLINE I Wrap(I i, I size) {
  const Index di;
  const I up = hn::IfThenElse(hn::Lt(i, hn::Zero(di)), hn::Add(i, size), i);
  return hn::IfThenElse(hn::Lt(up, size), up, hn::Sub(up, size));
}

HWY_INLINE Between Locate(V coordinate, I size) {
  const Wide d;
  const Index di;
  const V x = hn::Sub(hn::Mul(hn::Sub(coordinate, hn::Floor(coordinate)), hn::ConvertTo(d, size)),
                      hn::Set(d, 0.5F));
  const V floor = hn::Floor(x);
  const I first = Wrap(hn::ConvertTo(di, floor), size);
  return {first, Wrap(hn::Add(first, hn::Set(di, 1)), size), hn::Sub(x, floor)};
}

// Pixels of the lanes' textures, packed.
struct Texels {
  const Skins& skins;
  I texture;
  const std::uint8_t* bytes = nullptr;  // of the one texture that all lanes show; or null
  std::int32_t last = 0;                // where a word may begin that ends with that texture

  HWY_INLINE Texels(const Skins& all, I textures, I width, I height)
      : skins(all), texture(textures) {
    const std::int32_t first = hn::GetLane(texture);
    const bool is_one = hn::AllTrue(Index(), hn::Eq(texture, hn::Set(Index(), first)));
    if (!is_one || std::endian::native != std::endian::little) return;
    last = 3 * hn::GetLane(width) * hn::GetLane(height) - 4;
    if (last >= 0) bytes = &skins.textures[static_cast<std::size_t>(first)]->r;
  }

  HWY_INLINE I At(I pixel) const { return bytes != nullptr ? AtOne(pixel) : AtAny(pixel); }

 private:
  // A word for each pixel, the last one's begins a byte before it.
  HWY_INLINE I AtOne(I pixel) const {
    const Index di;
    const I byte = hn::Add(hn::Add(pixel, pixel), pixel);
    const I from = hn::Min(byte, hn::Set(di, last));
    alignas(64) std::array<std::int32_t, kShadeLanes> place, word;
    hn::Store(from, di, place.data());
    for (std::size_t lane = 0; lane < hn::Lanes(di); ++lane)
      std::memcpy(&word[lane], bytes + place[lane], sizeof(std::int32_t));
    const I words = hn::Load(di, word.data());
    const I moved = hn::IfThenElse(hn::Eq(byte, from), words, hn::ShiftRight<8>(words));
    return hn::And(moved, hn::Set(di, 0xffffff));
  }

  HWY_INLINE I AtAny(I pixel) const {
    const Index di;
    alignas(64) std::array<std::int32_t, kShadeLanes> number, place, colour{};
    hn::Store(texture, di, number.data());
    hn::Store(pixel, di, place.data());
    for (std::size_t lane = 0; lane < hn::Lanes(di); ++lane) {
      if (number[lane] < 0) continue;
      const Rgb8& p = skins.textures[static_cast<std::size_t>(number[lane])][place[lane]];
      colour[lane] = p.r | p.g << 8 | p.b << 16;
    }
    return hn::Load(di, colour.data());
  }
};

HWY_INLINE Colours Sample(const Skins& skins, const Lanes& lanes, I texture, const Weights& w) {
  const V one = hn::Set(Wide(), 1.0F);
  const I width = lanes.Word(Skins::kWidth), height = lanes.Word(Skins::kHeight);
  const Texels texels(skins, texture, width, height);
  const Between x = Locate(w.Of(lanes, Skins::kU), width);
  const Between y = Locate(w.Of(lanes, Skins::kV), height);
  const I row0 = hn::Mul(y.first, width), row1 = hn::Mul(y.second, width);
  const auto pixel = [&](I row, I column) { return Unpack(texels.At(hn::Add(row, column))); };
  const Colours a = pixel(row0, x.first), b = pixel(row0, x.second), c = pixel(row1, x.first),
                e = pixel(row1, x.second);
  const V left = hn::Sub(one, x.share), top = hn::Sub(one, y.share);
  const V wa = hn::Mul(left, top), wb = hn::Mul(x.share, top), wc = hn::Mul(left, y.share),
          we = hn::Mul(x.share, y.share);
  const auto mix = [&](V at_a, V at_b, V at_c, V at_e) {
    const V three = hn::Add(hn::Add(hn::Mul(wa, at_a), hn::Mul(wb, at_b)), hn::Mul(wc, at_c));
    return hn::Add(three, hn::Mul(we, at_e));
  };
  return {mix(a.r, b.r, c.r, e.r), mix(a.g, b.g, c.g, e.g), mix(a.b, b.b, c.b, e.b)};
}

// Light() of shading.h.
HWY_INLINE V LightOn(const PacketHits& hits, std::size_t i) {
  const Wide d;
  const auto at = [&](const std::array<const float*, 3>& v, std::size_t axis) {
    return hn::LoadU(d, v[axis] + i);
  };
  const V nx = at(hits.normal, 0), ny = at(hits.normal, 1), nz = at(hits.normal, 2);
  const V dx = at(hits.ray, 0), dy = at(hits.ray, 1), dz = at(hits.ray, 2);
  const auto dot = [](V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
  };
  const V turned = dot(nx, ny, nz, dx, dy, dz);
  const V n2 = hn::Add(dot(nx, ny, nz, nx, ny, nz), hn::Set(d, 1e-30F));
  const V d2 = dot(dx, dy, dz, dx, dy, dz);
  const V one_over_n = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(n2));
  const V facing = hn::Div(hn::Mul(hn::Abs(turned), one_over_n), hn::Sqrt(d2));
  const V side = dot(hn::Set(d, 0.10F), hn::Set(d, 0.06F), hn::Set(d, 0.03F), nz, nx, ny);
  const V turned_side = hn::Mul(hn::CopySign(one_over_n, hn::Neg(turned)), side);
  return hn::Add(hn::Add(hn::Set(d, 0.52F), hn::Mul(hn::Set(d, 0.32F), facing)), turned_side);
}

HWY_INLINE Colours Multiply(const Colours& colour, const Colours& by, M where) {
  const V whole = hn::Set(Wide(), 255.0F);
  const auto times = [&](V x, V y) {
    return hn::IfThenElse(where, hn::Div(hn::Mul(x, y), whole), x);
  };
  return {times(colour.r, by.r), times(colour.g, by.g), times(colour.b, by.b)};
}

HWY_INLINE I Pack(const Colours& colour, V light) {
  const Wide d;
  const Index di;
  const auto byte = [&](V x) {
    return hn::ConvertTo(di, hn::Add(hn::Mul(x, light), hn::Set(d, 0.5F)));
  };
  return hn::Or(byte(colour.r),
                hn::Or(hn::ShiftLeft<8>(byte(colour.g)), hn::ShiftLeft<16>(byte(colour.b))));
}

void Shade(const Skins& skins, const PacketHits& hits, std::uint32_t* colours) {
  const Wide d;
  const Index di;
  for (std::size_t i = 0; i < kShadeLanes; i += hn::Lanes(d)) {
    const Lanes lanes(skins, hn::LoadU(di, hits.triangle + i));
    const V s = hn::LoadU(d, hits.s + i), t = hn::LoadU(d, hits.t + i);
    const Weights weights{hn::Sub(hn::Sub(hn::Set(d, 1.0F), s), t), s, t};
    Colours colour = Unpack(lanes.Word(Skins::kBase));
    if (skins.has_textures) {
      const I texture = lanes.Word(Skins::kTexture);
      const M textured = hn::RebindMask(d, hn::Gt(texture, hn::Set(di, -1)));
      if (!hn::AllFalse(d, textured))
        colour = Multiply(colour, Sample(skins, lanes, texture, weights), textured);
    }
    if (skins.has_corners) {
      const Colours a = Unpack(lanes.Word(Skins::kCorner)),
                    b = Unpack(lanes.Word(Skins::kCorner + 1)),
                    c = Unpack(lanes.Word(Skins::kCorner + 2));
      const Colours by{weights.Of(a.r, b.r, c.r), weights.Of(a.g, b.g, c.g),
                       weights.Of(a.b, b.b, c.b)};
      colour = Multiply(colour, by, hn::Eq(s, s));
    }
    const M unlit = hn::RebindMask(d, hn::Ne(lanes.Word(Skins::kUnlit), hn::Zero(di)));
    const V light = hn::IfThenElse(unlit, hn::Set(d, 1.0F), LightOn(hits, i));
    hn::StoreU(hn::BitCast(hn::RebindToUnsigned<Wide>(), Pack(colour, light)),
               hn::RebindToUnsigned<Wide>(), colours + i);
  }
}

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::sim {
namespace {

std::int32_t Packed(const Rgb8& colour) {
  return colour.r | colour.g << 8 | colour.b << 16;
}

}  // namespace

Skins::Skins(const Scene& scene) : triangles(scene.mesh.triangles.size()) {
  const TriangleMesh& mesh = scene.mesh;
  has_corners = !mesh.vertex_colours.empty();
  for (const Texture& texture : scene.textures) textures.push_back(texture.rgb.data.data());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    auto& words = triangles[t].words;
    const Material& material = scene.materials[mesh.triangle_material[t]];
    words[kBase] = Packed(material.colour);
    words[kUnlit] = material.is_unlit ? 1 : 0;
    words[kTexture] = -1;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh.triangles[t][corner];
      if (has_corners) words[kCorner + corner] = Packed(mesh.vertex_colours[vertex]);
      if (mesh.uvs.empty()) continue;
      words[kU + corner] = std::bit_cast<std::int32_t>(mesh.uvs[vertex][0]);
      words[kV + corner] = std::bit_cast<std::int32_t>(mesh.uvs[vertex][1]);
    }
    if (material.texture < 0 || mesh.uvs.empty()) continue;
    const RgbImage& image = scene.textures[static_cast<std::size_t>(material.texture)].rgb;
    words[kTexture] = material.texture;
    words[kWidth] = image.width;
    words[kHeight] = image.height;
    has_textures = true;
  }
}

HWY_EXPORT(Shade);

void ShadePacket(const Skins& skins, const PacketHits& hits,
                 std::span<std::uint32_t, kShadeLanes> colours) {
  HWY_DYNAMIC_DISPATCH(Shade)(skins, hits, colours.data());
}

}  // namespace crossnav::sim
#endif  // HWY_ONCE
