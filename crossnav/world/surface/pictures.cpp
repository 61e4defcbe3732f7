// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/pictures.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace crossnav::world {
namespace {

constexpr int kWidth_px = 128, kHeight_px = 72;
constexpr double kPlane_m = 0.0005;   // chosen: faces this near to each other are one plane
constexpr double kMinFill = 0.85;     // chosen: share of its rectangle that a face must cover
constexpr double kMinFace_m2 = 0.03;  // chosen: a small laptop's screen is larger
constexpr double kLift_m = 0.0015;    // chosen: the picture's distance from its face

Rgb8 Blend(Rgb8 a, Rgb8 b, double t) {
  const auto mix = [t](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + (y - x) * std::clamp(t, 0.0, 1.0)));
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

Rgb8 AnyColour(Rng& rng, int lo = 20, int hi = 235) {
  const auto channel = [&] { return static_cast<std::uint8_t>(rng.Int(lo, hi)); };
  const auto r = channel(), g = channel(), b = channel();
  return {r, g, b};
}

struct Painter {
  RgbImage image;

  Painter(int width, int height) : image(width, height) {}

  void Gradient(int v0, int v1, Rgb8 top, Rgb8 bottom) {
    for (int v = std::max(0, v0); v < std::min(v1, image.height); ++v) {
      const Rgb8 colour = Blend(top, bottom, (v - v0 + 0.5) / (v1 - v0));
      for (int u = 0; u < image.width; ++u) image.At(u, v) = colour;
    }
  }
  void Rectangle(int u0, int v0, int u1, int v1, Rgb8 colour) {
    for (int v = std::max(0, v0); v < std::min(v1, image.height); ++v) {
      for (int u = std::max(0, u0); u < std::min(u1, image.width); ++u) image.At(u, v) = colour;
    }
  }
  void Ellipse(double cu, double cv, double ru, double rv, Rgb8 colour) {
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const double x = (u - cu) / ru, y = (v - cv) / rv;
        if (x * x + y * y < 1) image.At(u, v) = colour;
      }
    }
  }
  /// Fills the area below a wavy line around `v_mean`.
  void Hills(double v_mean, double height, Rgb8 colour, Rng& rng) {
    const double a = rng.Uniform(0, 6.28), b = rng.Uniform(0, 6.28);
    const double f = rng.Uniform(0.02, 0.06);
    for (int u = 0; u < image.width; ++u) {
      const double top =
          v_mean - height * (0.6 * std::sin(f * u + a) + 0.4 * std::sin(2.7 * f * u + b));
      for (int v = std::max(0, static_cast<int>(top)); v < image.height; ++v) {
        image.At(u, v) = Blend(colour, {30, 40, 30}, 0.5 * (v - top) / image.height);
      }
    }
  }
  sim::Texture Done() { return {std::move(image), {}}; }
};

void PaintLandscape(Painter& p, Rng& rng) {
  const int horizon = rng.Int(kHeight_px / 3, 2 * kHeight_px / 3);
  const Rgb8 sky = rng.Chance(0.3) ? Rgb8{236, 150, 90} : Rgb8{96, 150, 214};
  p.Gradient(0, horizon + 12, sky, {226, 232, 236});
  const double sun_v = rng.Uniform(6, horizon);
  p.Ellipse(rng.Uniform(10, kWidth_px - 10), sun_v, 6, 6, {250, 240, 200});
  p.Hills(horizon, 6, Blend({70, 96, 120}, {90, 120, 70}, rng.Uniform()), rng);
  p.Hills(horizon + 12, 5, Blend({60, 110, 50}, {150, 140, 70}, rng.Uniform()), rng);
  if (rng.Chance(0.5)) p.Gradient(horizon + 22, kHeight_px, {60, 110, 160}, {30, 60, 100});
}

void PaintSpeaker(Painter& p, Rng& rng) {
  const Rgb8 bottom = AnyColour(rng, 20, 110);
  p.Gradient(0, kHeight_px, AnyColour(rng, 40, 160), bottom);
  const Rgb8 board = AnyColour(rng);
  p.Rectangle(rng.Int(66, 80), 8, 122, 46, board);
  const Rgb8 skin = Blend({238, 196, 166}, {110, 72, 50}, rng.Uniform());
  const double u = rng.Uniform(30, 46);
  p.Ellipse(u, 74, 24, 28, AnyColour(rng, 20, 120));
  p.Ellipse(u, 32, 11, 14, AnyColour(rng, 20, 90));
  p.Ellipse(u, 35, 9, 12, skin);
  p.Rectangle(0, 60, kWidth_px, 68, AnyColour(rng, 60, 200));
}

void PaintText(Painter& p, Rng& rng) {
  const Rgb8 bottom = AnyColour(rng, 30, 120);
  p.Gradient(0, kHeight_px, AnyColour(rng, 30, 120), bottom);
  for (int i = 0; i < 2; ++i) {
    const int u0 = 6 + 60 * i, v1 = rng.Int(50, 66);
    p.Rectangle(u0, 6, u0 + 54, v1, {236, 236, 238});
    p.Rectangle(u0, 6, u0 + 54, 10, AnyColour(rng, 60, 180));
    for (int v = 14; v < v1 - 3; v += 4) {
      p.Rectangle(u0 + 4, v, u0 + 4 + rng.Int(12, 46), v + 2, {90, 90, 100});
    }
  }
}

void PaintShapes(Painter& p, Rng& rng) {
  const Rgb8 bottom = AnyColour(rng, 90, 240);
  p.Gradient(0, kHeight_px, AnyColour(rng, 90, 240), bottom);
  for (int i = rng.Int(4, 9); i > 0; --i) {
    const double u = rng.Uniform(0, kWidth_px), v = rng.Uniform(0, kHeight_px);
    const double a = rng.Uniform(6, 26), b = rng.Uniform(6, 26);
    if (rng.Chance(0.5)) {
      p.Ellipse(u, v, a, b, AnyColour(rng));
    } else {
      p.Rectangle(static_cast<int>(u - a), static_cast<int>(v - b), static_cast<int>(u + a),
                  static_cast<int>(v + b), AnyColour(rng));
    }
  }
}

/// Front-facing triangles of a plane.
struct Plane {
  double area_m2 = 0;
  Box3 box;
};

std::map<long, Plane> FrontPlanes(const ObjectModel& model) {
  std::map<long, Plane> planes;
  for (const auto& t : model.mesh.triangles) {
    const Vector3d a = model.mesh.vertices[t[0]].cast<double>(),
                   b = model.mesh.vertices[t[1]].cast<double>(),
                   c = model.mesh.vertices[t[2]].cast<double>();
    const Vector3d n = (b - a).cross(c - a);
    if (std::abs(n.y()) < 0.99 * n.norm()) continue;  // imported faces have either winding
    Plane& plane = planes[std::lround((a.y() + b.y() + c.y()) / 3 / kPlane_m)];
    plane.area_m2 += 0.5 * n.norm();
    for (const Vector3d& p : {a, b, c}) plane.box.Add(p);
  }
  return planes;
}

}  // namespace

sim::Texture MakePictureTexture(Rng& rng) {
  Painter p(kWidth_px, kHeight_px);
  constexpr void (*kKinds[])(Painter&, Rng&) = {PaintLandscape, PaintLandscape, PaintSpeaker,
                                                PaintText, PaintShapes};
  kKinds[rng.Below(std::size(kKinds))](p, rng);
  return p.Done();
}

sim::Texture MakeOutdoorTexture(Rng& rng) {
  Painter p(kWidth_px, 2 * kHeight_px);
  const int horizon = rng.Int(70, 96);
  p.Gradient(0, horizon + 8, {170, 200, 232}, {238, 243, 246});
  for (int i = rng.Int(1, 4); i > 0; --i) {
    const double u = rng.Uniform(0, kWidth_px), v = rng.Uniform(8, 46);
    const double high_px = rng.Uniform(3, 7);
    p.Ellipse(u, v, rng.Uniform(14, 30), high_px, {246, 248, 250});
  }
  p.Hills(horizon, 6, {150, 176, 160}, rng);
  for (int i = rng.Int(0, 2); i > 0; --i) {  // houses across the street
    const int u = rng.Int(0, kWidth_px - 30), w = rng.Int(22, 44), h = rng.Int(18, 34);
    p.Rectangle(u, horizon + 14 - h, u + w, horizon + 20,
                Blend({214, 200, 180}, {180, 120, 96}, rng.Uniform()));
    p.Rectangle(u - 2, horizon + 10 - h, u + w + 2, horizon + 14 - h, {120, 74, 62});
  }
  p.Hills(horizon + 18, 3, {132, 164, 104}, rng);
  for (int i = rng.Int(2, 6); i > 0; --i) {
    const double u = rng.Uniform(0, kWidth_px), v = horizon + rng.Uniform(-6, 16);
    const double r = rng.Uniform(6, 16);
    p.Rectangle(static_cast<int>(u) - 1, static_cast<int>(v), static_cast<int>(u) + 1,
                static_cast<int>(v + r + 8), {96, 78, 62});
    const Rgb8 leaves = Blend({104, 146, 84}, {66, 110, 66}, rng.Uniform());
    p.Ellipse(u, v, r, r * rng.Uniform(0.9, 1.4), leaves);
  }
  return p.Done();
}

std::optional<FrontFace> FindFrontFace(const ObjectModel& model) {
  const Box3 bounds = model.Bounds();
  std::optional<FrontFace> best;
  double best_m2 = kMinFace_m2;
  for (const auto& [at, plane] : FrontPlanes(model)) {
    const Vector3d size = plane.box.max - plane.box.min;
    const double rect_m2 = size.x() * size.z();
    const bool is_front = plane.box.max.y() > bounds.Center().y() - 0.02;
    // Both sides of a thin board cover the rectangle twice; the front side counts.
    if (!is_front || plane.area_m2 < kMinFill * rect_m2 || rect_m2 < 0.6 * best_m2) continue;
    best_m2 = std::max(best_m2, rect_m2);
    best = FrontFace{plane.box.min.x(), plane.box.min.z(), plane.box.max.x(), plane.box.max.z(),
                     plane.box.max.y()};
  }
  return best;
}

void AddPicture(ObjectModel& model, bool is_screen, Rng& rng) {
  const auto face = FindFrontFace(model);
  if (!face) return;
  const int material = static_cast<int>(model.materials.size());
  model.materials.push_back({{255, 255, 255}, static_cast<int>(model.textures.size())});
  model.textures.push_back(MakePictureTexture(rng));
  ++model.own_textures;
  if (is_screen) model.glowing.insert(material);
  auto& mesh = model.mesh;
  if (mesh.uvs.empty()) mesh.uvs.resize(mesh.vertices.size(), {0, 0});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto y = static_cast<float>(face->y + kLift_m);
  const auto x0 = static_cast<float>(face->x0), x1 = static_cast<float>(face->x1);
  const auto z0 = static_cast<float>(face->z0), z1 = static_cast<float>(face->z1);
  // Seen from the front, +x is on the left.
  for (const Vector3f& p :
       {Vector3f(x1, y, z0), Vector3f(x0, y, z0), Vector3f(x0, y, z1), Vector3f(x1, y, z1)}) {
    mesh.vertices.push_back(p);
  }
  constexpr float kIn = 0.004F;  // stays off the edge, where the texture repeats
  mesh.uvs.insert(mesh.uvs.end(), {{kIn, 1 - kIn}, {1 - kIn, 1 - kIn}, {1 - kIn, kIn}, {kIn, kIn}});
  for (const std::array<std::uint32_t, 3>& t :
       {std::array<std::uint32_t, 3>{first, first + 1, first + 2}, {first, first + 2, first + 3}}) {
    mesh.triangles.push_back(t);
    mesh.triangle_material.push_back(static_cast<std::uint16_t>(material));
    mesh.triangle_instance.push_back(0);
  }
}

}  // namespace crossnav::world
